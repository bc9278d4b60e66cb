//! Errors of the edge pass.

use core::fmt;

use shadowfit::glam::DVec3;

use crate::pixels::DepthBufferError;

/// Why the edges of a picture cannot be traced; nothing is recorded then, and the filter decides everywhere.
#[derive(Clone, Debug, PartialEq)]
pub enum EdgeError {
    /// The depth buffer of the view.
    DepthBuffer(DepthBufferError),
    /// The texture of normals has another size or sample count than the pass reads, or is no float texture.
    Normals {
        /// Format of the texture.
        format: wgpu::TextureFormat,
        /// Its width and height, in pixels.
        size: [u32; 2],
        /// Those of the depth texture.
        expected: [u32; 2],
    },
    /// A distance of the rays' start that is not a finite number, or is negative.
    RayOffset(f32),
    /// An eye that is not finite.
    Eye(DVec3),
    /// The WGSL of an [`AnyHit`](super::AnyHit), or its layout beside that of the pass, makes no pipeline; in the words of
    /// the shader compiler.
    AnyHit(String),
    /// The bind group of an [`AnyHit`](super::AnyHit) is missing, or it has none. Says whether it has one.
    AnyHitGroup(bool),
    /// The device refused to make a resource, for example because it is out of memory; with its own words.
    Device(String),
}

impl fmt::Display for EdgeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::DepthBuffer(error) => error.fmt(f),
            Self::Normals { format, size: [width, height], expected: [columns, rows] } => write!(
                f,
                "the texture of normals has format {format:?} and {width} × {height} pixels: a float format with one \
                 sample, usage TEXTURE_BINDING and the depth texture's {columns} × {rows} pixels is needed"
            ),
            Self::RayOffset(offset) => {
                write!(f, "rays start {offset} m above the surface: give a finite distance that is not negative")
            }
            Self::Eye(eye) => write!(f, "the view's eye is at {eye}: give a finite world position, in metres"),
            Self::AnyHit(message) => write!(f, "the engine's own test of hits does not compile: {message}"),
            Self::AnyHitGroup(has_layout) => f.write_str(any_hit_group(*has_layout)),
            Self::Device(message) => {
                write!(f, "edges cannot be traced, since the device refused it: {message}")
            }
        }
    }
}

impl core::error::Error for EdgeError {}

impl From<DepthBufferError> for EdgeError {
    fn from(error: DepthBufferError) -> Self {
        Self::DepthBuffer(error)
    }
}

/// The message for a view and a pass of which one lacks what the other has of an engine's own test of hits.
fn any_hit_group(has_layout: bool) -> &'static str {
    if has_layout {
        "the engine's own test of hits reads a bind group, and the view has none: set EdgeView::any_hit"
    } else {
        "the view has a bind group for the engine's own test of hits, and the pass has no layout for it: make the pass \
         with EdgePass::with_any_hit and a layout"
    }
}
