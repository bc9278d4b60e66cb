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

impl Gradients {
    /// Texels right and down for steps in the world.
    pub(crate) fn texels_per_step(&self, steps: [DVec3; 2]) -> [DVec2; 2] {
        steps.map(|step| DVec2::new(self.u.dot(step), self.v.dot(step)))
    }
}

impl ShadowMap {
    /// Prepares a map for a light; `to_light` is the unit direction toward it, world axes.
    pub fn new(map: &FitMap, to_light: DVec3) -> Self {
        let clip_from_world = map.clip_from_world();
        let rows = [0, 1, 2, 3].map(|row| clip_from_world.row(row));
        Self { rows, size: map.size(), split_far: map.split_far, is_reversed: is_reversed(&clip_from_world, to_light) }
    }

    /// Rows of clip from positions relative to a point of the world.
    #[cfg(feature = "gpu")]
    pub(crate) fn rows_from(&self, origin: DVec3) -> [DVec4; 4] {
        self.rows.map(|row| row.truncate().extend(row.truncate().dot(origin) + row.w))
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

#[cfg(test)]
mod tests {
    use glam::dcamera::rh::{proj::directx::orthographic, view::look_at_mat4};

    use super::*;

    /// A tilted light, plain or reversed, orthographic or warped, 1024 by 512 texels.
    fn map(is_reversed: bool, warp: f64) -> (ShadowMap, DVec3) {
        let to_light = DVec3::new(0.3, 0.8, 0.2).normalize();
        let light_from_world = look_at_mat4(to_light * 20.0, DVec3::ZERO, DVec3::X);
        let flat = orthographic(-8.0, 8.0, -4.0, 4.0, 10.0, 30.0);
        let reverse = DMat4::from_cols(DVec4::X, DVec4::Y, -DVec4::Z, DVec4::new(0.0, 0.0, 1.0, 1.0));
        // Adds a share of clip y to w.
        let warped = DMat4::from_cols(DVec4::X, DVec4::new(0.0, 1.0, 0.0, warp), DVec4::Z, DVec4::W);
        let clip_from_light = if is_reversed { reverse * flat } else { flat };
        let view_proj = (warped * clip_from_light * light_from_world).to_cols_array();
        let size = Some([1024, 512]);
        let file = FitMap { view_proj, resolution: 1, resolution_xy: size, split_near: 0.0, split_far: 9.0 };
        (ShadowMap::new(&file, to_light), to_light)
    }

    #[test]
    fn places_are_texels_from_the_top_left_and_depth_from_the_light() {
        for is_reversed in [false, true] {
            let (map, to_light) = map(is_reversed, 0.0);
            assert_eq!(map.is_reversed, is_reversed);
            let place = map.place(DVec3::ZERO);
            assert!(place.texel.abs_diff_eq(DVec2::new(512.0, 256.0), 1e-9) && (place.depth - 0.5).abs() < 1e-12);
            assert!((map.place(to_light * 5.0).depth - 0.25).abs() < 1e-12);
            // World x is up in the map, and 4 m are half of its height.
            let up = (DVec3::X - to_light * to_light.x).normalize();
            assert!(map.place(up * 3.0).texel.abs_diff_eq(DVec2::new(512.0, 64.0), 1e-9));
        }
    }

    #[test]
    fn points_a_hair_outside_are_inside_and_further_ones_are_not() {
        let (map, to_light) = map(false, 0.0);
        let inside = |point| map.is_inside(&map.place(point));
        let up = (DVec3::X - to_light * to_light.x).normalize();
        // 1e-5 of the height of 8 m, and of the depth of 20 m.
        assert!(inside(up * (4.0 + 7e-5)) && !inside(up * (4.0 + 9e-5)));
        assert!(inside(to_light * (10.0 + 1.9e-4)) && !inside(to_light * (10.0 + 2.1e-4)));
        assert!(map.is_within_sides(&map.place(to_light * 99.0)));
    }

    #[test]
    fn what_lies_behind_a_warped_map_is_not_in_it() {
        let (map, to_light) = map(false, 0.5);
        let up = (DVec3::X - to_light * to_light.x).normalize();
        assert!(map.is_within_sides(&map.place(DVec3::ZERO)) && !map.is_within_sides(&map.place(up * -9.0)));
    }

    #[test]
    fn gradients_are_the_limits_of_differences() {
        for (is_reversed, warp) in [(false, 0.0), (true, 0.3), (false, -0.4)] {
            let (map, _) = map(is_reversed, warp);
            let point = DVec3::new(1.0, 2.0, -0.5);
            let gradients = map.gradients(&map.place(point));
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let [before, after] = [-1e-5, 1e-5].map(|step| map.place(point + axis * step));
                let texel = (after.texel - before.texel) / 2e-5;
                let wanted = DVec2::new(gradients.u.dot(axis), gradients.v.dot(axis));
                assert!(texel.abs_diff_eq(wanted, 1e-4), "{texel} {wanted}");
                let depth = (after.depth - before.depth) / 2e-5;
                assert!((depth - gradients.depth.dot(axis)).abs() < 1e-7);
            }
        }
    }
}
