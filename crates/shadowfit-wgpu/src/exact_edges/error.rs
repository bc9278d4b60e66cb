//! Errors of the edge pass.

use core::fmt;

use shadowfit::glam::DVec3;

use crate::pixels::DepthBufferError;

/// The reason why edges cannot be traced. Then the pass records no commands, and the filter decides all
/// pixels.
#[derive(Clone, Debug, PartialEq)]
pub enum EdgeError {
    /// The depth buffer of the view is invalid.
    DepthBuffer(DepthBufferError),
    /// The texture of normals is not a float texture with the size of the depth texture, one sample and the
    /// usage `TEXTURE_BINDING`.
    Normals {
        /// Format of the texture.
        format: wgpu::TextureFormat,
        /// Width and height of the texture, in pixels.
        size: [u32; 2],
        /// Width and height of the depth texture, in pixels.
        expected: [u32; 2],
    },
    /// The ray offset is negative or not finite.
    RayOffset(f32),
    /// The eye is not finite.
    Eye(DVec3),
    /// The WGSL of an [`AnyHit`](super::AnyHit), or its layout together with the pass's layouts, does not
    /// form a valid pipeline. Contains the shader compiler's message.
    AnyHit(String),
    /// A bind group for an [`AnyHit`](super::AnyHit) without a layout, or a layout without a bind group.
    /// Contains whether there is a layout.
    AnyHitGroup(bool),
    /// The device refused to create a resource, for example because it is out of memory. Contains the
    /// device's message.
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
                write!(f, "rays start {offset} m above the surface: set a finite distance that is not negative")
            }
            Self::Eye(eye) => write!(f, "the view's eye is at {eye}: set a finite world position, in metres"),
            Self::AnyHit(message) => write!(f, "the engine's alpha test of ray hits does not compile: {message}"),
            Self::AnyHitGroup(has_layout) => f.write_str(any_hit_group(*has_layout)),
            Self::Device(message) => {
                write!(f, "edges cannot be traced, because the device refused: {message}")
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

/// Returns the message for a view and a pass if only one of them has a bind group for the alpha test of ray
/// hits.
fn any_hit_group(has_layout: bool) -> &'static str {
    if has_layout {
        "the engine's alpha test of ray hits reads a bind group, but the view has none: set EdgeView::any_hit"
    } else {
        "the view has a bind group for the alpha test of ray hits, but the pass has no layout for it: create the pass \
         with EdgePass::with_any_hit and a layout"
    }
}
