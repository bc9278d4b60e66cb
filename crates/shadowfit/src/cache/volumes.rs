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

/// The casters of a part of a map, for engines that find them themselves, such as on the GPU. The origins of the volumes
/// may differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionVolumes {
    /// Casters outside of it are not drawn.
    pub casters: CasterVolume,
    /// Moving casters outside of it are not drawn either.
    pub moving: Option<CasterVolume>,
}

impl MapCache {
    /// Returns the casters to draw into a part of a map, by the [window](crate::scroll::StoredRect::window) of a piece of
    /// the last plan. Maps that are kept hold all static casters over them; moving casters, and all casters of other
    /// maps, are drawn if they can shadow something in view.
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

    /// Finds the maps that must not wait, whatever the schedule: those that show a static caster that is gone, in view.
    pub(super) fn due(&self, frame: &CacheFrame<'_>) -> Result<[bool; MAX_MAPS], FitError> {
        let mut is_due = [false; MAX_MAPS];
        if self.settings.schedule == UpdateSchedule::EveryFrame {
            return Ok(is_due);
        }
        for (state, is_due) in self.maps.iter().zip(&mut is_due) {
            let Some(drawn) = state.layers.drawn().filter(|drawn| !drawn.gone.is_empty()) else { continue };
            let origin = drawn.map.projection.origin;
            let volume = match frame.in_view {
                // As if it were the only map: which others are read beside it is not known yet.
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

/// Finds the casters of each map, relative to its origin: where passes depend on the view those that can shadow something
/// in it, otherwise all that the map can store.
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
