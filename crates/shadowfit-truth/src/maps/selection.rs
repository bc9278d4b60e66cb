//! Which map a point reads, and whether an occluder of the point is in it.

use glam::DVec3;

use super::measured::{MapPosition, MeasuredMap};

/// Depth, as a share of the map's depth range, by which an occluder may lie behind the receiver or
/// before the near plane and still be in the map: what rounding may move it.
const OCCLUDER_DEPTH_TOLERANCE: f64 = 1e-6;

/// A map that a point reads, and where the point lies in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelectedMap<'a> {
    /// Place of the map among those of the picture.
    pub index: usize,
    /// The map.
    pub map: &'a MeasuredMap,
    /// Position of the point in the map.
    pub position: MapPosition,
}

/// Where an occluder is, for a point that reads a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OccluderPlace {
    /// Beside the map, or behind the point.
    Outside,
    /// Before the near plane: drawn only where depth is clamped.
    BeforeNear,
    /// In the map.
    Inside,
}

impl SelectedMap<'_> {
    /// Returns where an occluder of the point lies; world space, metres.
    pub fn occluder(&self, occluder: DVec3) -> OccluderPlace {
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
