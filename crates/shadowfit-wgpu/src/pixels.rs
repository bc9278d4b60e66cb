//! The checks of a depth buffer.

use core::fmt;

use shadowfit::DepthConvention;

/// The reason why a pass cannot read the depth buffer of a view.
#[derive(Clone, Debug, PartialEq)]
pub enum DepthBufferError {
    /// A depth convention that wgpu's clip space does not have.
    Depth(DepthConvention),
    /// The matrix has a different depth convention from the view, whose convention this is.
    OtherDepth(DepthConvention),
    /// The matrix has no inverse, or one that is not finite.
    SingularMatrix,
    /// The pass cannot read the texture's format, sample count or usage.
    Texture {
        /// Format of the texture.
        format: wgpu::TextureFormat,
        /// Samples per pixel of the texture.
        samples: u32,
        /// Usages of the texture.
        usage: wgpu::TextureUsages,
        /// Sample counts that the pass reads.
        expected_samples: Vec<u32>,
    },
    /// The view's rectangle is empty or reaches outside the texture.
    Rectangle {
        /// Left, top, width and height of the rectangle, in pixels.
        rectangle: [u32; 4],
        /// Width and height of the texture, in pixels.
        texture: [u32; 2],
    },
}

impl fmt::Display for DepthBufferError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Depth(depth) => {
                write!(f, "depth convention {depth:?}: wgpu's clip space has 0..1, plain or reversed")
            }
            Self::OtherDepth(depth) => write!(
                f,
                "the view's matrix has a different depth convention from {depth:?}: pass the convention that the depth \
                 buffer was drawn with"
            ),
            Self::SingularMatrix => {
                write!(
                    f,
                    "the view's matrix has no finite inverse: pass the matrix that the depth buffer was drawn with"
                )
            }
            Self::Texture { format, samples, usage, expected_samples } => {
                let expected: Vec<String> = expected_samples.iter().map(u32::to_string).collect();
                write!(
                    f,
                    "the depth texture has format {format:?}, {samples} samples and usage {usage:?}: a depth format with \
                     {} samples and usage TEXTURE_BINDING is needed",
                    expected.join(" or ")
                )
            }
            Self::Rectangle { rectangle: [x, y, width, height], texture: [columns, rows] } => write!(
                f,
                "a picture of {width} × {height} pixels at ({x}, {y}) does not lie in a depth texture of {columns} × {rows}"
            ),
        }
    }
}

impl core::error::Error for DepthBufferError {}

/// Refuses a depth texture that has none of these sample counts or cannot be bound, and a rectangle outside
/// it.
pub(crate) fn check(texture: &wgpu::Texture, samples: &[u32], rectangle: [u32; 4]) -> Result<(), DepthBufferError> {
    let (format, usage) = (texture.format(), texture.usage());
    let is_readable = usage.contains(wgpu::TextureUsages::TEXTURE_BINDING) && format.has_depth_aspect();
    if !is_readable || !samples.contains(&texture.sample_count()) {
        let samples_found = texture.sample_count();
        let expected_samples = samples.to_vec();
        return Err(DepthBufferError::Texture { format, samples: samples_found, usage, expected_samples });
    }
    check_rectangle(rectangle, [texture.width(), texture.height()])
}

/// Refuses a rectangle that is empty or lies partly outside a texture of this size.
pub(crate) fn check_rectangle(rectangle: [u32; 4], texture: [u32; 2]) -> Result<(), DepthBufferError> {
    if lies_in(rectangle, texture) { Ok(()) } else { Err(DepthBufferError::Rectangle { rectangle, texture }) }
}

/// Returns whether a rectangle (left, top, width, height) is not empty and lies inside a texture of this
/// size. All values are in pixels.
fn lies_in([left, top, width, height]: [u32; 4], [columns, rows]: [u32; 2]) -> bool {
    let is_inside = |start: u32, side: u32, whole: u32| side > 0 && start <= whole && side <= whole - start;
    is_inside(left, width, columns) && is_inside(top, height, rows)
}
