//! Where world points lie in a shadow map, and the exact gradients of that.

use glam::{DMat4, DVec2, DVec3, DVec4};

use super::FitMap;

/// Points this far outside a side, as a share of the map's size, still count as inside.
const SIDE_TOLERANCE: f64 = 1e-5;
/// Points this far outside the depth range still count as inside.
const DEPTH_TOLERANCE: f64 = 1e-5;
/// Step toward the light that tells reversed depth from plain depth, in metres.
const REVERSAL_STEP: f64 = 0.01;

/// A map made ready to be measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowMap {
    /// Rows of clip from world.
    rows: [DVec4; 4],
    /// Width and height, in texels.
    pub size: DVec2,
    /// View depth below which the map is the first choice, in metres.
    pub split_far: f64,
    /// Whether depth 1 is nearest to the light in the file; [`Place::depth`] never is.
    pub is_reversed: bool,
}

/// Where a world point lies in a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Texels from the left and from the top.
    pub texel: DVec2,
    /// Depth, 0 nearest to the light.
    pub depth: f64,
    /// Clip space x, y, z after division by w.
    ndc: DVec3,
    /// Clip space w, positive in front of the light.
    w: f64,
}

/// World-space gradients at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradients {
    /// Of texels to the right, in texels a metre.
    pub u: DVec3,
    /// Of texels down, in texels a metre.
    pub v: DVec3,
    /// Of depth (0 nearest to the light), in depth ranges a metre.
    pub depth: DVec3,
}

impl ShadowMap {
    /// Prepares a map for a light; `to_light` is the unit direction toward it, world axes.
    pub fn new(map: &FitMap, to_light: DVec3) -> Self {
        let clip_from_world = map.clip_from_world();
        let rows = [0, 1, 2, 3].map(|row| clip_from_world.row(row));
        Self { rows, size: map.size(), split_far: map.split_far, is_reversed: is_reversed(&clip_from_world, to_light) }
    }

    /// Where a point of the world lies.
    pub fn place(&self, point: DVec3) -> Place {
        let [x, y, z, w] = self.rows.map(|row| row.truncate().dot(point) + row.w);
        let ndc = DVec3::new(x, y, z) / w;
        let texel = (0.5 + ndc.truncate() * DVec2::new(0.5, -0.5)) * self.size;
        let depth = if self.is_reversed { 1.0 - ndc.z } else { ndc.z };
        Place { texel, depth, ndc, w }
    }

    /// Whether a place is within the map's sides, whatever its depth.
    pub fn is_within_sides(&self, place: &Place) -> bool {
        let slack = self.size * SIDE_TOLERANCE;
        place.w > 0.0 && place.texel.cmpge(-slack).all() && place.texel.cmple(self.size + slack).all()
    }

    /// Whether a place is in the map: within its sides and its depth range.
    pub fn is_inside(&self, place: &Place) -> bool {
        let depths = -DEPTH_TOLERANCE..=1.0 + DEPTH_TOLERANCE;
        self.is_within_sides(place) && depths.contains(&place.depth)
    }

    /// Gradients at a place of this map.
    pub fn gradients(&self, place: &Place) -> Gradients {
        let along_w = self.rows[3].truncate();
        let gradient = |row: usize| (self.rows[row].truncate() - along_w * place.ndc[row]) / place.w;
        let depth = gradient(2);
        Gradients {
            u: gradient(0) * (0.5 * self.size.x),
            v: gradient(1) * (-0.5 * self.size.y),
            depth: if self.is_reversed { -depth } else { depth },
        }
    }
}

/// Whether depth rises toward the light, at the middle of the map.
fn is_reversed(clip_from_world: &DMat4, to_light: DVec3) -> bool {
    let middle = clip_from_world.inverse().project_point3(DVec3::new(0.0, 0.0, 0.5));
    let depth_at = |point| clip_from_world.project_point3(point).z;
    depth_at(middle + to_light * REVERSAL_STEP) > depth_at(middle)
}
