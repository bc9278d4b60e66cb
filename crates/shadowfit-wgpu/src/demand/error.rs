//! Errors of counting visible points on the GPU. Fits then use the bounding boxes.

use core::fmt;

use shadowfit::FitError;

use crate::pixels::DepthBufferError;

/// The reason why a [`DemandPass`](super::DemandPass) could not be created, or could not count a view.
#[derive(Clone, Debug, PartialEq)]
pub enum DemandPassError {
    /// The device cannot run the pass. Leave [`FitInput::demand`](shadowfit::FitInput::demand) empty, so that
    /// fits use the bounding boxes.
    Unsupported(Unsupported),
    /// The view, the light or the distance is invalid.
    Fit(FitError),
    /// The depth buffer of the view is invalid.
    DepthBuffer(DepthBufferError),
    /// The device refused to create a resource, for example because it is out of memory. Contains the
    /// device's message.
    Device(String),
    /// Counts could not be read back: the device is lost.
    Lost,
}

/// Missing capability of a device for a [`DemandPass`](super::DemandPass), or for a pass of the module
/// `exact_edges`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unsupported {
    /// Compute shaders with storage buffers.
    Compute,
    /// Reads of depth textures in shaders without a sampler. OpenGL lacks them.
    DepthLoads,
    /// Six storage buffers in a compute shader, for rays and a list of pixels.
    StorageBuffers,
}

impl fmt::Display for DemandPassError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unsupported(lack) => {
                let what = match lack {
                    Unsupported::Compute => "run compute shaders with storage buffers",
                    Unsupported::DepthLoads => "load depth textures in compute shaders",
                    Unsupported::StorageBuffers => "bind enough storage buffers to a compute shader",
                };
                write!(f, "visible points cannot be counted, because this device cannot {what}: fit from boxes")
            }
            Self::Fit(error) => error.fmt(f),
            Self::DepthBuffer(error) => error.fmt(f),
            Self::Device(message) => {
                write!(f, "visible points cannot be counted, because the device refused: {message}")
            }
            Self::Lost => write!(f, "visible points could not be read back, because the device is lost: open it again"),
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
