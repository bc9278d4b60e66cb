//! Result of tracing a frame's edges.

use core::fmt;

use crate::demand::Unsupported;

/// Result of tracing a frame's edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeOutcome {
    /// Rays were traced where the texels of the maps disagree.
    Traced,
    /// The filter decides all pixels.
    Filtered(FallbackReason),
}

/// The reason why the edges of a frame are filtered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FallbackReason {
    /// The technique has filtered edges.
    Technique,
    /// The device lacks a capability.
    Device(Unsupported),
    /// No rays were passed in.
    Rays,
    /// No edges have been traced yet, or tracing failed.
    Picture,
    /// The sun is off, or had no frame yet.
    NoMaps,
    /// The look-up blends two sets of maps during a [light step](crate::SunShadows::set_light_steps).
    Fading,
}

impl fmt::Display for FallbackReason {
    /// Writes a clause, such as "this graphics device has no compute shaders".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Technique => "the technique filters edges",
            Self::Device(Unsupported::Compute) => "this graphics device has no compute shaders",
            Self::Device(Unsupported::DepthLoads) => "OpenGL's shaders cannot read the depth buffer",
            Self::Device(Unsupported::StorageBuffers) => {
                "this graphics device binds too few storage buffers to a shader"
            }
            Self::Rays => "there are no rays, because this graphics device cannot hold the scene's triangles for them",
            Self::Picture => "the edges of this frame were not traced",
            Self::NoMaps => "the sun is off, or has no maps yet",
            Self::Fading => "one set of maps is fading into another",
        })
    }
}

/// Pixel counts of a view by the source of their factor: the map, rays or the filter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EdgeCounts {
    /// Pixels that face the light within the shadow distance.
    pub facing: u32,
    /// Facing pixels whose texels in the maps disagree.
    pub unsure: u32,
    /// Unsure pixels that were traced.
    pub traced: u32,
    /// Facing pixels whose factor comes from the filter.
    pub filtered: u32,
}
