//! Which part of the views reads a map by coverage: what no finer map provably holds.

use super::readers::{Reader, holds_slice};
use crate::base::numbers::VIEW_DEPTH_ROUNDING;
use crate::map::FittedMap;
use crate::selection::{MapOrder, MapReading};
use crate::technique::settings::{MAX_MAPS, MapChoice};
use crate::view::ViewFrustum;

/// Halvings of the views' depths in the search for what a finer map holds: to a four thousandth of them.
const HALVINGS: u32 = 12;

/// For each map the view depths, in metres, from which points of the views read it, in the order of `maps`; `None`
/// where no point does.
///
/// Points nearer than that are held by a finer map, with the filter's reach and the blend, whatever a shader rounds.
/// From there on a map is read at any depth, wherever it holds a point that the finer ones leave out.
pub(super) fn read_from(
    maps: &[FittedMap],
    reader: &Reader,
    views: &[ViewFrustum],
    reading: &MapReading,
) -> [Option<f32>; MAX_MAPS] {
    let free = f64::from(reading.softness.reach(reading.filter) + reading.blend);
    let mut from = [None; MAX_MAPS];
    // Up to where the finer maps hold all.
    let mut held = f32::MIN;
    for index in MapOrder::new(MapChoice::Coverage, maps.iter().map(|map| &map.fit)).iter() {
        from[index] = (held < f32::MAX).then_some((held - held.abs() * VIEW_DEPTH_ROUNDING).max(f32::MIN));
        held = held_to(&maps[index], reader, views, free, held);
    }
    from
}

/// View depth up to which a map holds all that the views have from a depth on, in metres, with so many texels around
/// it; that depth where it does not.
fn held_to(map: &FittedMap, reader: &Reader, views: &[ViewFrustum], free: f64, from: f32) -> f32 {
    let fit = map.fit.relative_to(reader.origin);
    let holds = |far: f32| holds_slice(&fit, reader, views, [from, far], free);
    let near = views.iter().map(|view| view.near).fold(f32::MAX, f32::min);
    let far = views.iter().map(|view| view.far).fold(f32::MIN, f32::max);
    if holds(far) {
        return f32::MAX;
    }
    let near = near.max(from);
    let (mut held, mut beyond) = (near, far);
    for _ in 0..HALVINGS {
        let middle = held + (beyond - held) * 0.5;
        *(if holds(middle) { &mut held } else { &mut beyond }) = middle;
    }
    // Where it holds nothing, no depth has been found.
    if held > near { held } else { from }
}
