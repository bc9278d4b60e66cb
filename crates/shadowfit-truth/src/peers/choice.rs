//! Which map a point reads, and whether an occluder of it is in there: one answer for the measures
//! of fits and for those of pictures.

use glam::{DVec2, DVec3};

use super::shadow_map::{Place, ShadowMap};

/// Points with a smaller cosine toward the light have no say in the texel errors, and are grazing.
pub(crate) const LEAST_FACING: f64 = 0.05;
/// An occluder is in the map up to this depth behind the receiver, and before the near plane.
pub(crate) const OCCLUDER_DEPTH_TOLERANCE: f64 = 1e-6;

/// The map that a point reads.
pub(crate) struct Choice<'a> {
    pub(crate) index: usize,
    pub(crate) map: &'a ShadowMap,
    pub(crate) place: Place,
}

/// The first map whose split is beyond the point, or the next later one that holds it.
pub(crate) fn choose(maps: &[ShadowMap], view_depth: f64, position: DVec3) -> Option<Choice<'_>> {
    maps.iter().enumerate().skip_while(|(_, map)| view_depth >= map.split_far).find_map(|(index, map)| {
        let place = map.place(position);
        map.is_inside(&place).then_some(Choice { index, map, place })
    })
}

/// Where an occluder is, for a point that reads a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Occluder {
    /// Beside the map, or behind the point.
    Out,
    /// Before the near plane: drawn only where depth is clamped.
    BeforeNear,
    /// In the map.
    In,
}

impl Choice<'_> {
    /// Where an occluder of the point, world space, lies.
    pub(crate) fn occluder(&self, occluder: DVec3) -> Occluder {
        let place = self.map.place(occluder);
        if !self.map.is_within_sides(&place) || place.depth > self.place.depth + OCCLUDER_DEPTH_TOLERANCE {
            Occluder::Out
        } else if place.depth >= -OCCLUDER_DEPTH_TOLERANCE {
            Occluder::In
        } else {
            Occluder::BeforeNear
        }
    }
}

/// Pixels per texel along the worse axis: one over the smaller singular value of the matrix with
/// these columns, texels a pixel. Infinite or not a number where that is 0.
pub(crate) fn pixels_per_texel([right, down]: [DVec2; 2]) -> f64 {
    // The singular values are half of the sum and the difference of these lengths, and their product
    // is the determinant, which keeps its digits where the difference loses them.
    let sum = DVec2::new(right.x + down.y, right.y - down.x).length();
    let difference = DVec2::new(right.x - down.y, right.y + down.x).length();
    0.5 * (sum + difference) / right.perp_dot(down).abs()
}
