//! Why visible points cannot be counted on the GPU. Fits then take boxes instead.

use core::fmt;

use shadowfit::{DepthConvention, FitError};

/// Why a [`DemandPass`](super::DemandPass) could not be made, or could not count a picture.
#[derive(Clone, Debug, PartialEq)]
pub enum DemandPassError {
    /// The device cannot run the pass at all: fit with [`FitInput::demand`](shadowfit::FitInput::demand) left empty, from
    /// boxes.
    Unsupported(Unsupported),
    /// The view, the light or the distance.
    Fit(FitError),
    /// A depth convention that wgpu's clip space does not have.
    Depth(DepthConvention),
    /// The matrix has another depth convention than this one, which it was said to have.
    OtherDepth(DepthConvention),
    /// The matrix has no inverse, or one that is not finite.
    SingularMatrix,
    /// The depth texture is of another format, sample count or usage than the pass reads.
    Texture {
        /// Format of the texture.
        format: wgpu::TextureFormat,
        /// Its samples per pixel.
        samples: u32,
        /// Its usages.
        usage: wgpu::TextureUsages,
        /// Samples per pixel that the pass was made for.
        expected_samples: u32,
    },
    /// The picture is empty or reaches out of the texture.
    Rectangle {
        /// Left, top, width and height of the picture, in pixels.
        rectangle: [u32; 4],
        /// Width and height of the texture, in pixels.
        texture: [u32; 2],
    },
    /// The device refused to make a resource, for example because it is out of memory; with its own words.
    Device(String),
    /// Counts could not be read back: the device is lost.
    Lost,
}

/// What a device lacks for a [`DemandPass`](super::DemandPass), or for a pass of the module `resolve`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unsupported {
    /// Compute shaders with storage buffers.
    Compute,
    /// Reading depth textures in shaders without a sampler, which OpenGL does not have.
    DepthLoads,
    /// As many storage buffers in a compute shader as rays need beside a list of pixels: 6.
    StorageBuffers,
}

impl fmt::Display for DemandPassError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unsupported(lack) => {
                let what = match lack {
                    Unsupported::Compute => "run compute shaders with storage buffers",
                    Unsupported::DepthLoads => "load depth textures in compute shaders",
                    Unsupported::StorageBuffers => "bind as many storage buffers to a compute shader as it takes",
                };
                write!(f, "what is visible cannot be counted here, since this device cannot {what}: fit from boxes")
            }
            Self::Fit(error) => error.fmt(f),
            Self::Depth(depth) => {
                write!(f, "depth convention {depth:?}: wgpu's clip space has 0..1, plain or reversed")
            }
            Self::OtherDepth(depth) => write!(
                f,
                "clip_from_world has another depth convention than {depth:?}: give the one that the depth buffer was \
                 drawn with"
            ),
            Self::SingularMatrix => {
                write!(f, "clip_from_world has no finite inverse: give the matrix that the depth buffer was drawn with")
            }
            Self::Texture { format, samples, usage, expected_samples } => write!(
                f,
                "the depth texture has format {format:?}, {samples} samples and usage {usage:?}: a depth format with \
                 {expected_samples} samples and usage TEXTURE_BINDING is needed"
            ),
            Self::Rectangle { rectangle: [x, y, width, height], texture: [columns, rows] } => write!(
                f,
                "a picture of {width} × {height} pixels at ({x}, {y}) does not lie in a depth texture of {columns} × {rows}"
            ),
            Self::Device(message) => {
                write!(f, "what is visible cannot be counted, since the device refused it: {message}")
            }
            Self::Lost => write!(f, "what is visible could not be read back, since the device is lost: open it again"),
        }
    }
}

impl core::error::Error for DemandPassError {}

impl From<FitError> for DemandPassError {
    fn from(error: FitError) -> Self {
        Self::Fit(error)
    }
}
