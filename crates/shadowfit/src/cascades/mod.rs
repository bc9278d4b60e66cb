//! Cascades: each map has a separate range of view depths.
//!
//! ```text
//!        ┌─────────────────╱ │   a map for each slice: all that the views see
//!   eye  │  1  ╱  2   ╱    3 │   between two depths, or the receivers in it
//!     ●──┼────┼──────┼───────┤
//!        │  1  ╲  2   ╲    3 │
//!        └─────────────────╲ │
//! ```

mod bins;
mod extents;
mod hold;
mod motion;
mod optimise;
mod splits;

use glam::{DVec2, Vec3};

use crate::base::FitError;
use crate::base::checks::VIEW_DEPTH_ROUNDING;
use crate::fits::{self, Alignment, Frame, PlacedMap, PlacedMaps, Snapping};
use crate::light::Volume;
use crate::selection::DepthRange;
use crate::technique::Cascades;
use crate::technique::settings::{Hysteresis, MAX_MAPS, MapSelection, Stabilise};
use crate::view::{Range, ViewFrustum};

use bins::Splits;
use hold::{HeldMap, Holder};
use motion::Motion;
use splits::{Chooser, HeldSplits};

/// State that cascades start from in the next frame.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct HeldCascades {
    splits: HeldSplits,
    maps: [Option<HeldMap>; MAX_MAPS],
    depths: [Option<HeldDepth>; MAX_MAPS],
}

/// Depth range of an earlier frame's map that is not held itself.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct HeldDepth {
    /// Direction toward the light.
    to_light: Vec3,
    /// Far and near plane along this direction from the world's origin, in metres.
    z: (f64, f64),
}

/// Places the maps of a frame, each around its slice of the view.
pub(crate) fn place(
    frame: &Frame,
    settings: &Cascades,
    before: Option<&HeldCascades>,
    points: &mut [DVec2],
) -> Result<(PlacedMaps, HeldCascades), FitError> {
    // 1. Splits between the slices.
    let splits = Chooser::new(frame, settings).held_or_chosen(before.map(|before| before.splits))?;
    // 2. Volumes of the maps: new ones, or the last frame's while they are good enough.
    let mut placer = Placer { frame, settings, splits: splits.splits, points };
    let mut held = HeldCascades { splits, maps: [None; MAX_MAPS], depths: [None; MAX_MAPS] };
    let mut maps = if let Stabilise::Hysteresis(hold) = settings.stabilise {
        placer.hold(hold, before.map(|before| &before.maps), &mut held.maps)?
    } else {
        placer.fit(before.map(|before| &before.depths), &mut held.depths)?
    };
    // 3. Distance of the receivers' farthest vertices in view. Only large boxes have some beyond the maps'
    //    own corners.
    let reach = maps.iter().flatten().map(|map| map.volume.farthest_corner()).fold(0.0, f64::max);
    let farthest = frame.content.farthest_seen(frame.range, reach);
    maps.iter_mut().flatten().for_each(|map| map.volume.vertex_distance = farthest);
    // 4. Depths of maps without a range, so that no point selects them.
    set_empty_ranges_apart(&mut maps[..settings.count as usize], frame.range.far);
    Ok((maps, held))
}

/// Returns the smallest number of cascades that is enough; see [`fewest_maps`](crate::fewest_maps).
pub(crate) fn fewest(frame: &Frame, settings: &Cascades, max_oversize: f64) -> u32 {
    Chooser::new(frame, settings).fewest(max_oversize)
}

/// Context for placing the cascades of a frame.
struct Placer<'a, 'b> {
    frame: &'a Frame<'a, 'b>,
    settings: &'a Cascades,
    splits: Splits,
    points: &'a mut [DVec2],
}

impl Placer<'_, '_> {
    /// Fits all maps for this frame alone, with depth ranges of the last frame while they are good enough.
    fn fit(
        &mut self,
        before: Option<&[Option<HeldDepth>; MAX_MAPS]>,
        held: &mut [Option<HeldDepth>; MAX_MAPS],
    ) -> Result<PlacedMaps, FitError> {
        let is_snapped = matches!(self.settings.stabilise, Stabilise::Snap { .. });
        let snapping = if is_snapped { Snapping::OnGrid } else { Snapping::Tight };
        let (origin, max_oversize) = (self.frame.content.origin, f64::from(self.settings.stabilise.max_oversize()));
        let mut maps = [None; MAX_MAPS];
        for (i, map) in maps.iter_mut().enumerate().take(self.settings.count as usize) {
            let volume = self.fitted(i, snapping)?;
            *map = Some(self.placed(i, volume));
        }
        for (i, PlacedMap { volume, .. }) in maps.iter_mut().flatten().enumerate() {
            let to_light = volume.axes.z;
            let last = before.and_then(|before| before[i]).filter(|last| last.to_light == to_light);
            volume.stabilise_depth(origin, last.map(|last| last.z), max_oversize);
            held[i] = volume.grid.map(|grid| HeldDepth { to_light, z: grid.z });
        }
        Ok(maps)
    }

    /// Places all maps, and holds the last frame's while they are good enough.
    fn hold(
        &mut self,
        hold: Hysteresis,
        before: Option<&[Option<HeldMap>; MAX_MAPS]>,
        held: &mut [Option<HeldMap>; MAX_MAPS],
    ) -> Result<PlacedMaps, FitError> {
        let frame = self.frame;
        let motion = frame.last_view.and_then(|last| Motion::between(last, &frame.input.views[0]));
        let holder = Holder { frame, settings: hold, motion };
        let mut maps = [None; MAX_MAPS];
        for (i, map) in maps.iter_mut().enumerate().take(self.settings.count as usize) {
            let volume = if frame.rule.form.alignment == Alignment::Exact {
                self.fitted(i, Snapping::Tight)?
            } else {
                let now = holder.hold(before.and_then(|before| before[i]), self.slice(i), self.points)?;
                held[i] = Some(now);
                now.volume(frame.content.origin)
            };
            *map = Some(self.placed(i, volume));
        }
        Ok(maps)
    }

    /// Fits the volume around a slice, for this frame alone.
    #[inline(always)]
    fn fitted(&mut self, map: usize, snapping: Snapping) -> Result<Volume, FitError> {
        let Frame { content, light, rule, .. } = self.frame;
        fits::fit_map(content, light, rule, self.slice(map), snapping, self.points)
    }

    /// Returns a map with the view depths at which points select it.
    fn placed(&self, map: usize, mut volume: Volume) -> PlacedMap {
        let slice = self.slice_range(map);
        let is_empty = is_empty(self.frame.content.views, slice);
        volume.is_empty |= is_empty;
        let [near, far] = [map, map + 1].map(|split| f64::from(self.splits[split]));
        let covered_from = if is_empty { near } else { f64::from(slice.near) };
        PlacedMap { volume, depths: Some(DepthRange { near, far: Some(far), covered_from: Some(covered_from) }) }
    }

    /// Returns the view depths that a map is fitted to. For a map without depths it returns the whole range.
    fn slice(&self, map: usize) -> Range {
        let slice = self.slice_range(map);
        if is_empty(self.frame.content.views, slice) { self.frame.range } else { widened(slice) }
    }

    /// Returns the view depths that a map covers.
    fn slice_range(&self, map: usize) -> Range {
        let splits = &self.splits;
        let overlap = if let MapSelection::ViewDepth { overlap } = self.settings.selection { overlap } else { 0.0 };
        let near =
            if map == 0 { self.frame.range.near } else { splits[map] - overlap * (splits[map] - splits[map - 1]) };
        Range { near, far: splits[map + 1] }
    }
}

/// Returns whether no view has a part between two view depths, so that a map would have no content.
fn is_empty(views: &[ViewFrustum], slice: Range) -> bool {
    views.iter().all(|view| slice.near.max(view.near) >= slice.far.min(view.far))
}

/// Widens the view depths that a map is fitted to. A shader rounds view depths, so a point may read the map
/// next to its own.
fn widened(slice: Range) -> Range {
    let rounding = slice.far.abs() * VIEW_DEPTH_ROUNDING;
    Range { near: slice.near - rounding, far: slice.far + rounding }
}

/// Sets the depths of maps without a range, so that no point selects them, even with a rounded depth. Maps in
/// front of all others get no depths. The last map with a range and all maps after it get no end. The maps
/// after it begin at `end`, where shadows end, and points read them only if no map in front covers the point.
fn set_empty_ranges_apart(maps: &mut [Option<PlacedMap>], end: f32) {
    let is_empty = |range: &DepthRange| range.far.is_some_and(|far| range.near >= far);
    for range in maps.iter_mut().rev().flatten().filter_map(|map| map.depths.as_mut()) {
        let is_last = !is_empty(range);
        range.far = None;
        if is_last {
            break;
        }
        (range.near, range.covered_from) = (end.into(), None);
    }
    for map in maps.iter_mut().flatten().take_while(|map| map.depths.as_ref().is_some_and(is_empty)) {
        map.depths = None;
    }
}
