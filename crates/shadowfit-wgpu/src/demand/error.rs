//! Why visible points cannot be counted on the GPU. Fits then take boxes instead.

use core::fmt;

use shadowfit::FitError;

use crate::pixels::DepthBufferError;

/// Why a [`DemandPass`](super::DemandPass) could not be made, or could not count a picture.
#[derive(Clone, Debug, PartialEq)]
pub enum DemandPassError {
    /// The device cannot run the pass at all: fit with [`FitInput::demand`](shadowfit::FitInput::demand) left empty, from
    /// boxes.
    Unsupported(Unsupported),
    /// The view, the light or the distance.
    Fit(FitError),
    /// The depth buffer of the view.
    DepthBuffer(DepthBufferError),
    /// The device refused to make a resource, for example because it is out of memory; with its own words.
    Device(String),
    /// Counts could not be read back: the device is lost.
    Lost,
}

/// What a device lacks for a [`DemandPass`](super::DemandPass), or for a pass of the module `exact_edges`.
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
            Self::DepthBuffer(error) => error.fmt(f),
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

impl From<DepthBufferError> for DemandPassError {
    fn from(error: DepthBufferError) -> Self {
        Self::DepthBuffer(error)
    }
}
