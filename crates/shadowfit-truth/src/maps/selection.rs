//! The map that a point reads, and whether an occluder of the point is in it.

use glam::DVec3;

use super::measured::{MapPosition, MeasuredMap};

/// Depth by which an occluder may lie behind the receiver or before the near plane and still be in the map,
/// as a share of the map's depth range. It allows for rounding.
const OCCLUDER_DEPTH_TOLERANCE: f64 = 1e-6;

/// A map that a point reads, and the point's position in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelectedMap<'a> {
    /// Index of the map among the picture's maps.
    pub index: usize,
    /// The map.
    pub map: &'a MeasuredMap,
    /// Position of the point in the map.
    pub position: MapPosition,
}

/// Place of an occluder relative to the map that a point reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OccluderPlace {
    /// Outside the map's sides, or behind the point.
    Outside,
    /// Before the near plane: drawn only with depth clamp.
    BeforeNear,
    /// In the map.
    Inside,
}

impl SelectedMap<'_> {
    /// Returns the place of an occluder of the point; world space, metres.
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
