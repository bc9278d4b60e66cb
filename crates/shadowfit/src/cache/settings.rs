//! Settings of the cache.

use glam::UVec2;

use super::schedule::UpdateSchedule;
use crate::Technique;
use crate::selection::MapReading;
use crate::settings::CasterPolicy;

/// The casters that are drawn into maps. All variants give the same picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Culling {
    /// In redrawn maps, and for moving casters in all maps: only casters that can cast a shadow into view
    /// ([`caster_volumes`](crate::culling::caster_volumes)). In kept maps: all static casters that the map
    /// can store. The default.
    #[default]
    Swept,
    /// All casters that the map can store.
    WholeMap,
    /// All casters, for comparison.
    Off,
}

/// Settings of a [`MapCache`](super::MapCache). They may change between any two frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CacheSettings {
    /// Whether static casters are kept from frame to frame. Without caching, every map is redrawn in every
    /// frame. Default: `true`.
    pub caching: bool,
    /// The casters that are drawn into maps.
    pub culling: Culling,
    /// Schedule of the maps that may wait.
    pub schedule: UpdateSchedule,
    /// Whether the shadow pass clamps depth at the near plane, so that maps also store the casters in front of it.
    pub depth_clamp: bool,
    /// Selection of the map that a receiver reads, and the filter of the look-up.
    pub reading: MapReading,
    /// Width and height of the layers that store the maps, in texels. A smaller map is kept only while it
    /// does not move.
    pub layer: UVec2,
}

impl CacheSettings {
    /// Returns the settings for the maps of a technique, in layers of its resolution.
    pub fn of(technique: &Technique) -> Self {
        Self {
            caching: true,
            culling: Culling::default(),
            schedule: UpdateSchedule::default(),
            depth_clamp: technique.fit.casters == CasterPolicy::DepthClamp && !technique.maps.are_exact(),
            reading: technique.reading(),
            layer: technique.fit.resolution,
        }
    }

    /// Returns the policy for casters in front of the near plane: a map stores either all or none of them.
    pub(super) fn caster_policy(&self) -> CasterPolicy {
        if self.depth_clamp { CasterPolicy::DepthClamp } else { CasterPolicy::None }
    }
}

impl Default for CacheSettings {
    /// The settings for the maps of [`Technique::default`].
    fn default() -> Self {
        Self::of(&Technique::default())
    }
}
