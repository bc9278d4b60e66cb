//! The casters of each map that can shadow something in view.

use alloc::vec::Vec;

use super::MapCache;
use super::frame::{CacheFrame, InView};
use super::plan::PassKind;
use super::schedule::UpdateSchedule;
use super::settings::{CacheSettings, Culling};
use crate::culling::caster_volumes;
use crate::scroll::TexelRect;
use crate::settings::{CasterPolicy, MAX_MAPS};
use crate::{CasterVolume, FitError, FittedMap};

/// The volumes that contain the casters of a part of a map, for engines that cull by themselves, such as on
/// the GPU. Each volume is relative to its own origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionVolumes {
    /// All casters outside this volume are culled.
    pub casters: CasterVolume,
    /// Moving casters outside this second volume are culled as well.
    pub moving: Option<CasterVolume>,
}

impl MapCache {
    /// Returns the volumes of the casters to draw into a part of a map. `part` is the
    /// [window](crate::scroll::StoredRect::window) of a region of the last plan. In kept maps, all static
    /// casters over the part are drawn, and moving casters only if they can shadow something in view. In
    /// other maps, only casters that can shadow something in view are drawn.
    pub fn region_volumes(&self, map: usize, content: PassKind, part: TexelRect) -> RegionVolumes {
        let plan = &self.plan;
        let (Some(in_view), Some(read)) = (plan.in_view.get(map), plan.maps.get(map)) else {
            return RegionVolumes { casters: CasterVolume::everywhere(plan.origin), moving: None };
        };
        if self.settings.culling == Culling::Off {
            return RegionVolumes { casters: CasterVolume::everywhere(plan.origin), moving: None };
        }
        if !self.is_kept(map) {
            return RegionVolumes { casters: *in_view, moving: None };
        }
        let casters = CasterVolume::of_part(&read.projection, self.settings.caster_policy(), part);
        RegionVolumes { casters, moving: (content != PassKind::Static).then_some(*in_view) }
    }

    /// Finds the maps that must not wait, on any schedule, because they show a static caster in view that has
    /// disappeared.
    pub(super) fn due(&self, frame: &CacheFrame<'_>) -> Result<[bool; MAX_MAPS], FitError> {
        let mut is_due = [false; MAX_MAPS];
        if self.settings.schedule == UpdateSchedule::EveryFrame {
            return Ok(is_due);
        }
        for (state, is_due) in self.maps.iter().zip(&mut is_due) {
            let Some(drawn) = state.layers.drawn().filter(|drawn| !drawn.gone.is_empty()) else { continue };
            let origin = drawn.map.projection.origin;
            let volume = match frame.in_view {
                // Computed as if this were the only map, because the maps that are read beside it are not
                // chosen yet.
                InView::Views(views) => {
                    let mut volume = [CasterVolume::everywhere(origin)];
                    let reading = &self.settings.reading;
                    caster_volumes(core::slice::from_ref(&drawn.map), reading, &frame.reader, views, &mut volume)?;
                    volume[0]
                }
                InView::Volumes(_) => CasterVolume::everywhere(origin),
            };
            let mut gone = drawn.gone.iter().map(|gone| gone.relative_to(volume.origin));
            *is_due = gone.any(|gone| volume.intersects_aabb(gone.min, gone.max));
        }
        Ok(is_due)
    }
}

/// Computes the caster volume of each map, relative to its origin. If passes depend on the views, it holds
/// the casters that can shadow something in view, otherwise all casters that the map can store.
pub(super) fn find(
    settings: &CacheSettings,
    frame: &CacheFrame<'_>,
    maps: &[FittedMap],
    depends_on_view: bool,
    volumes: &mut Vec<CasterVolume>,
) -> Result<(), FitError> {
    volumes.clear();
    if depends_on_view && settings.culling == Culling::Off {
        volumes.extend(maps.iter().map(|map| CasterVolume::everywhere(map.projection.origin)));
        return Ok(());
    }
    let policy = if settings.culling == Culling::Off { CasterPolicy::DepthClamp } else { settings.caster_policy() };
    volumes.extend(maps.iter().map(|map| CasterVolume::of_map(&map.projection, policy)));
    if !depends_on_view || settings.culling != Culling::Swept {
        return Ok(());
    }
    match frame.in_view {
        InView::Views(views) => caster_volumes(maps, &settings.reading, &frame.reader, views, volumes)?,
        InView::Volumes(given) => {
            let given = given.iter().copied().map(Some).chain(core::iter::repeat(None));
            for ((volume, map), given) in volumes.iter_mut().zip(maps).zip(given) {
                *volume = given.unwrap_or(CasterVolume::everywhere(map.projection.origin));
            }
        }
    }
    if !settings.depth_clamp {
        for (volume, map) in volumes.iter_mut().zip(maps) {
            *volume = volume.cut_at_near_plane(&map.projection);
        }
    }
    Ok(())
}
