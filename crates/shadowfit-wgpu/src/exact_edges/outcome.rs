//! How a picture's edges came out.

use core::fmt;

use crate::demand::Unsupported;

/// How the edges of a frame came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeOutcome {
    /// Rays were traced where the maps were not sure.
    Traced,
    /// The filter decides everywhere.
    Filtered(FallbackReason),
}

/// Why the edges of a frame are filtered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FallbackReason {
    /// The technique's edges are.
    Technique,
    /// The device lacks something.
    Device(Unsupported),
    /// There are no rays.
    Rays,
    /// The edges of no picture were traced yet, or it was an error.
    Picture,
    /// The sun gives nothing, or had no frame yet.
    NoMaps,
    /// Two sets of maps are mixed while the sun [steps](crate::SunShadows::set_light_steps).
    Fading,
}

impl fmt::Display for FallbackReason {
    /// A clause, such as "this graphics device has no compute shaders".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Technique => "the technique says so",
            Self::Device(Unsupported::Compute) => "this graphics device has no compute shaders",
            Self::Device(Unsupported::DepthLoads) => "OpenGL's shaders cannot read the depth buffer",
            Self::Device(Unsupported::StorageBuffers) => {
                "this graphics device binds too few storage buffers to a shader"
            }
            Self::Rays => "there are no rays, since this graphics device cannot hold the scene's triangles for them",
            Self::Picture => "the edges of the picture were not traced",
            Self::NoMaps => "the sun gives no light, or has no maps yet",
            Self::Fading => "one set of maps fades into another one",
        })
    }
}

/// How many pixels of a picture were traced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EdgeCounts {
    /// Pixels that face the light within the distance of shadows.
    pub facing: u32,
    /// Those of them that the maps were not sure of.
    pub unsure: u32,
    /// Those of them that were traced.
    pub traced: u32,
    /// Those that were left to the filter.
    pub filtered: u32,
}
