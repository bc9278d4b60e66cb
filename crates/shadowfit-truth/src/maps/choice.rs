//! Which map a point reads, and whether an occluder of the point is in it.

use glam::DVec3;

use super::measured::{MapPosition, MeasuredMap};

/// Depth, as a share of the map's depth range, by which an occluder may lie behind the receiver or
/// before the near plane and still be in the map: what rounding may move it.
const OCCLUDER_DEPTH_TOLERANCE: f64 = 1e-6;

/// A map that a point reads, and where the point lies in it.
pub(crate) struct MapSelection<'a> {
    pub(crate) index: usize,
    pub(crate) map: &'a MeasuredMap,
    pub(crate) position: MapPosition,
}

/// The choice of fit files: the first map whose split is beyond the point's view depth; where that one does not hold the
/// point, the next later one that does. `None` where no such map holds it.
pub(crate) fn choose(maps: &[MeasuredMap], view_depth: f64, point: DVec3) -> Option<MapSelection<'_>> {
    maps.iter().enumerate().skip_while(|(_, map)| view_depth >= map.split_far).find_map(|(index, map)| {
        let position = map.project(point);
        map.is_inside(&position).then_some(MapSelection { index, map, position })
    })
}

/// Where an occluder is, for a point that reads a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OccluderPlace {
    /// Beside the map, or behind the point.
    Outside,
    /// Before the near plane: drawn only where depth is clamped.
    BeforeNear,
    /// In the map.
    Inside,
}

impl MapSelection<'_> {
    /// Where an occluder of the point, world space, lies.
    pub(crate) fn occluder(&self, occluder: DVec3) -> OccluderPlace {
        let position = self.map.project(occluder);
        if !self.map.is_within_sides(&position) || position.depth > self.position.depth + OCCLUDER_DEPTH_TOLERANCE {
            OccluderPlace::Outside
        } else if position.depth >= -OCCLUDER_DEPTH_TOLERANCE {
            OccluderPlace::Inside
        } else {
            OccluderPlace::BeforeNear
        }
    }
}
