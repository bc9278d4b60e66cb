//! Errors of the resolve pass.

use core::fmt;

use shadowfit::DepthConvention;
use shadowfit::glam::DVec3;

/// Why a picture cannot be resolved; nothing is recorded then, and the filter decides everywhere.
#[derive(Clone, Debug, PartialEq)]
pub enum ResolveError {
    /// A depth convention that wgpu's clip space does not have.
    Depth(DepthConvention),
    /// The matrix has another depth convention than this one, which it was said to have.
    OtherDepth(DepthConvention),
    /// The matrix has no inverse, or one that is not finite.
    SingularMatrix,
    /// The depth texture has another format, sample count or usage than the pass reads.
    Texture {
        /// Format of the texture.
        format: wgpu::TextureFormat,
        /// Its samples per pixel.
        samples: u32,
        /// Its usages.
        usage: wgpu::TextureUsages,
    },
    /// The texture of normals has another size or sample count than the pass reads, or is no float texture.
    Normals {
        /// Format of the texture.
        format: wgpu::TextureFormat,
        /// Its width and height, in pixels.
        size: [u32; 2],
        /// Those of the depth texture.
        expected: [u32; 2],
    },
    /// The picture is empty or reaches out of the texture.
    Rectangle {
        /// Left, top, width and height of the picture, in pixels.
        rectangle: [u32; 4],
        /// Width and height of the texture, in pixels.
        texture: [u32; 2],
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

impl fmt::Display for ResolveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Depth(depth) => {
                write!(f, "depth convention {depth:?}: wgpu's clip space has 0..1, plain or reversed")
            }
            Self::OtherDepth(depth) => write!(
                f,
                "clip_from_eye has another depth convention than {depth:?}: give the one that the depth buffer was \
                 drawn with"
            ),
            Self::SingularMatrix => {
                write!(f, "clip_from_eye has no finite inverse: give the matrix that the depth buffer was drawn with")
            }
            Self::Texture { format, samples, usage } => write!(
                f,
                "the depth texture has format {format:?}, {samples} samples and usage {usage:?}: a depth format of 24 or \
                 32 bits with 1 or 4 samples and usage TEXTURE_BINDING is needed"
            ),
            Self::Normals { format, size: [width, height], expected: [columns, rows] } => write!(
                f,
                "the texture of normals has format {format:?} and {width} × {height} pixels: a float format with one \
                 sample, usage TEXTURE_BINDING and the depth texture's {columns} × {rows} pixels is needed"
            ),
            Self::Rectangle { rectangle: [x, y, width, height], texture: [columns, rows] } => write!(
                f,
                "a picture of {width} × {height} pixels at ({x}, {y}) does not lie in a depth texture of {columns} × {rows}"
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

impl core::error::Error for ResolveError {}

/// The message for a view and a pass of which one lacks what the other has of an engine's own test of hits.
fn any_hit_group(has_layout: bool) -> &'static str {
    if has_layout {
        "the engine's own test of hits reads a bind group, and the view has none: set ResolveView::any_hit"
    } else {
        "the view has a bind group for the engine's own test of hits, and the pass has no layout for it: make the pass \
         with ResolvePass::with_any_hit and a layout"
    }
}
