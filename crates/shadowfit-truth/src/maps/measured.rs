//! Positions of world points in a shadow map, and their exact gradients.
//!
//! A map consists of a matrix, a size and a split here, independent of the renderer or file it comes from.

use glam::{DMat4, DVec2, DVec3, DVec4};

/// Tolerance beyond a side, as a share of the map's size. Points within it count as inside.
const SIDE_TOLERANCE: f64 = 1e-5;
/// Tolerance beyond the depth range, as a share of it. Points within it count as inside.
const DEPTH_TOLERANCE: f64 = 1e-5;
/// Step toward a sun to detect reversed depth, in metres.
const REVERSAL_STEP: f64 = 0.01;
/// Step toward a light's position to detect reversed depth, as a share of the way. Depth changes fast near
/// the light, where the middle of the depth range lies.
const REVERSAL_SHARE: f64 = 0.01;

/// A shadow map that is prepared for measuring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredMap {
    /// Rows of the matrix clip from world.
    rows: [DVec4; 4],
    /// Width and height, in texels.
    pub size: DVec2,
    /// View depth below which the map is read first, in metres. For selection by view depth.
    pub split_far: f64,
    /// View depth from which the map in front is blended into this one, in metres, up to the `split_far` of
    /// the map in front. For selection by view depth. Infinite for no blend.
    pub blend_near: f64,
    /// Radius of the filter in this map, if it differs from [the common
    /// one](super::PictureMaps::filter_radius), as for soft filters: greatest distance per axis, in texels.
    pub filter_radius: Option<f32>,
    /// Whether depth 1 is nearest to the light in the matrix. In [`MapPosition::depth`], 0 always is.
    pub is_reversed: bool,
}

/// Position of a world point in a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapPosition {
    /// Texels from the left and from the top.
    pub texel: DVec2,
    /// Depth, 0 nearest to the light and 1 farthest from it.
    pub depth: f64,
    /// Clip space x, y, z after division by w.
    ndc: DVec3,
    /// Clip space w, positive in front of the light.
    w: f64,
}

/// World-space gradients of a map's coordinates at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapGradients {
    /// Gradient of the texel position to the right, in texels per metre.
    pub u: DVec3,
    /// Gradient of the texel position down, in texels per metre.
    pub v: DVec3,
    /// Gradient of depth (0 nearest to the light), in depth ranges per metre.
    pub depth: DVec3,
}

impl MapGradients {
    /// Returns how many texels to the right and down each of two world-space steps, in metres, moves a point.
    pub fn texels_per_step(&self, steps: [DVec3; 2]) -> [DVec2; 2] {
        steps.map(|step| DVec2::new(self.u.dot(step), self.v.dot(step)))
    }
}

impl MeasuredMap {
    /// Prepares a map of a sun, of `size` texels across and down.
    ///
    /// `clip_from_world` has x and y in -1..=1 (y up), and depth in 0..=1 after division by w, plain or
    /// reversed. It may be a perspective. `split_far` is the view depth, in metres, below which the map is
    /// read first. `to_light` is the unit direction toward the light, world axes, used to detect whether
    /// depth is reversed.
    pub fn new(clip_from_world: &DMat4, size: DVec2, split_far: f64, to_light: DVec3) -> Self {
        Self::prepared(clip_from_world, size, split_far, |_| to_light * REVERSAL_STEP)
    }

    /// Prepares a map of a light with a position (world space, metres), of `size` texels across and down.
    ///
    /// `clip_from_world` is a perspective from that position, as for [`Self::new`], with w above 0 in front
    /// of the light. It may lack a far plane. `split_far` is as for [`Self::new`]; infinite for a map that is
    /// read at every view depth. The tolerances of [`Self::is_inside`] are in the map's depth, which a
    /// perspective spreads unevenly: toward the far plane they are longer in metres.
    pub fn of_spot(clip_from_world: &DMat4, size: DVec2, split_far: f64, position: DVec3) -> Self {
        Self::prepared(clip_from_world, size, split_far, |middle| (position - middle) * REVERSAL_SHARE)
    }

    /// Prepares a map. `step` returns a step from a point toward the light.
    fn prepared(clip_from_world: &DMat4, size: DVec2, split_far: f64, step: impl Fn(DVec3) -> DVec3) -> Self {
        let rows = [0, 1, 2, 3].map(|row| clip_from_world.row(row));
        let is_reversed = is_reversed(clip_from_world, step);
        Self { rows, size, split_far, blend_near: f64::INFINITY, filter_radius: None, is_reversed }
    }

    /// Returns this map, with the map in front blended into it from a view depth on, in metres.
    #[must_use]
    pub fn with_blend_near(self, blend_near: f64) -> Self {
        Self { blend_near, ..self }
    }

    /// Returns this map with its own filter radius, in texels, which sets the width of its edge zone.
    #[must_use]
    pub fn with_filter_radius(self, filter_radius: f32) -> Self {
        Self { filter_radius: Some(filter_radius), ..self }
    }

    /// Returns the rows of the matrix clip from positions relative to `origin`.
    #[cfg(feature = "gpu")]
    pub(crate) fn rows_from(&self, origin: DVec3) -> [DVec4; 4] {
        self.rows.map(|row| row.truncate().extend(row.truncate().dot(origin) + row.w))
    }

    /// Projects a world point into the map.
    pub fn project(&self, point: DVec3) -> MapPosition {
        let [x, y, z, w] = self.rows.map(|row| row.truncate().dot(point) + row.w);
        let ndc = DVec3::new(x, y, z) / w;
        let texel = (0.5 + ndc.truncate() * DVec2::new(0.5, -0.5)) * self.size;
        let depth = if self.is_reversed { 1.0 - ndc.z } else { ndc.z };
        MapPosition { texel, depth, ndc, w }
    }

    /// Returns whether a position is within the map's sides at any depth. Positions up to 1e-5 of the map's
    /// size beyond a side count as within.
    pub fn is_within_sides(&self, position: &MapPosition) -> bool {
        let tolerance = self.size * SIDE_TOLERANCE;
        position.w > 0.0 && position.texel.cmpge(-tolerance).all() && position.texel.cmple(self.size + tolerance).all()
    }

    /// Returns whether a position is within the map's sides and its depth range. Positions up to 1e-5 of the
    /// depth range beyond an end count as within.
    pub fn is_inside(&self, position: &MapPosition) -> bool {
        let depths = -DEPTH_TOLERANCE..=1.0 + DEPTH_TOLERANCE;
        self.is_within_sides(position) && depths.contains(&position.depth)
    }

    /// Returns the distance between a position and the nearest side of the map, in texels. Negative outside
    /// of the map.
    pub fn texels_to_edge(&self, position: &MapPosition) -> f64 {
        position.texel.min(self.size - position.texel).min_element()
    }

    /// Computes the gradients at a position in this map.
    pub fn gradients(&self, position: &MapPosition) -> MapGradients {
        let along_w = self.rows[3].truncate();
        let gradient = |row: usize| (self.rows[row].truncate() - along_w * position.ndc[row]) / position.w;
        let depth = gradient(2);
        MapGradients {
            u: gradient(0) * (0.5 * self.size.x),
            v: gradient(1) * (-0.5 * self.size.y),
            depth: if self.is_reversed { -depth } else { depth },
        }
    }
}

/// Returns whether depth rises toward the light at the middle of the map.
fn is_reversed(clip_from_world: &DMat4, step: impl Fn(DVec3) -> DVec3) -> bool {
    let middle = clip_from_world.inverse().project_point3(DVec3::new(0.0, 0.0, 0.5));
    let depth_at = |point| clip_from_world.project_point3(point).z;
    depth_at(middle + step(middle)) > depth_at(middle)
}

#[cfg(test)]
mod tests {
    use glam::dcamera::rh::proj::directx::{orthographic, perspective, perspective_infinite_reverse};
    use glam::dcamera::rh::view::look_at_mat4;

    use super::*;

    const LAMP: DVec3 = DVec3::new(-3.0, 5.0, 2.0);

    /// Returns a headlight that shines toward the origin, 90 degrees wide, of 1024 by 512 texels.
    fn lamp_map(clip_from_light: DMat4) -> MeasuredMap {
        let light_from_world = look_at_mat4(LAMP, DVec3::ZERO, DVec3::Y);
        MeasuredMap::of_spot(&(clip_from_light * light_from_world), DVec2::new(1024.0, 512.0), 9.0, LAMP)
    }

    /// Returns a tilted light, plain or reversed, orthographic or warped, 1024 by 512 texels.
    fn map(is_reversed: bool, warp: f64) -> (MeasuredMap, DVec3) {
        let to_light = DVec3::new(0.3, 0.8, 0.2).normalize();
        let light_from_world = look_at_mat4(to_light * 20.0, DVec3::ZERO, DVec3::X);
        let flat = orthographic(-8.0, 8.0, -4.0, 4.0, 10.0, 30.0);
        let reverse = DMat4::from_cols(DVec4::X, DVec4::Y, -DVec4::Z, DVec4::new(0.0, 0.0, 1.0, 1.0));
        // Adds a share of clip y to w.
        let warped = DMat4::from_cols(DVec4::X, DVec4::new(0.0, 1.0, 0.0, warp), DVec4::Z, DVec4::W);
        let clip_from_light = if is_reversed { reverse * flat } else { flat };
        let clip_from_world = warped * clip_from_light * light_from_world;
        (MeasuredMap::new(&clip_from_world, DVec2::new(1024.0, 512.0), 9.0, to_light), to_light)
    }

    #[test]
    fn positions_are_texels_from_the_top_left_and_depth_from_the_light() {
        for is_reversed in [false, true] {
            let (map, to_light) = map(is_reversed, 0.0);
            assert_eq!(map.is_reversed, is_reversed);
            let position = map.project(DVec3::ZERO);
            assert!(position.texel.abs_diff_eq(DVec2::new(512.0, 256.0), 1e-9) && (position.depth - 0.5).abs() < 1e-12);
            assert!((map.project(to_light * 5.0).depth - 0.25).abs() < 1e-12);
            // World x is up in the map, and 4 m are half of its height.
            let up = (DVec3::X - to_light * to_light.x).normalize();
            assert!(map.project(up * 3.0).texel.abs_diff_eq(DVec2::new(512.0, 64.0), 1e-9));
        }
    }

    #[test]
    fn a_perspective_map_divides_by_the_way_before_the_light() {
        let wide = 90f64.to_radians();
        // The smallest near plane is far nearer to the light than any step in metres.
        for near in [1e-4, 0.1, 1.0] {
            let plain = lamp_map(perspective(wide, 1.0, near, 100.0));
            let reversed = lamp_map(perspective_infinite_reverse(wide, 1.0, near));
            assert!(!plain.is_reversed && reversed.is_reversed);
            let forward = -LAMP.normalize();
            let right = forward.cross(DVec3::Y).normalize();
            for way in [2.0, 20.0] {
                // With 90 degrees, half of the width is as long as the way before the light. Half of that is
                // a quarter of the map's width from its middle.
                let point = LAMP + (forward + right * 0.5) * way;
                for map in [plain, reversed] {
                    let texel = map.project(point).texel;
                    assert!(texel.abs_diff_eq(DVec2::new(768.0, 256.0), 1e-6), "{texel}");
                    let inside = |point| map.is_inside(&map.project(point));
                    assert!(inside(point) && !inside(LAMP + (forward + right * 1.01) * way));
                    assert!(!inside(LAMP - forward * way), "behind the light");
                }
                // far/(far - near) (1 - near/way), and near/way from 1 down.
                let depth = 100.0 / (100.0 - near) * (1.0 - near / way);
                assert!((plain.project(point).depth - depth).abs() < 1e-9);
                assert!((reversed.project(point).depth - (1.0 - near / way)).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn points_a_hair_outside_are_inside_and_further_ones_are_not() {
        let (map, to_light) = map(false, 0.0);
        let inside = |point| map.is_inside(&map.project(point));
        let up = (DVec3::X - to_light * to_light.x).normalize();
        // 1e-5 of the height of 8 m, and of the depth of 20 m.
        assert!(inside(up * (4.0 + 7e-5)) && !inside(up * (4.0 + 9e-5)));
        assert!(inside(to_light * (10.0 + 1.9e-4)) && !inside(to_light * (10.0 + 2.1e-4)));
        assert!(map.is_within_sides(&map.project(to_light * 99.0)));
    }

    #[test]
    fn what_lies_behind_a_warped_map_is_not_in_it() {
        let (map, to_light) = map(false, 0.5);
        let up = (DVec3::X - to_light * to_light.x).normalize();
        assert!(map.is_within_sides(&map.project(DVec3::ZERO)) && !map.is_within_sides(&map.project(up * -9.0)));
    }

    #[test]
    fn gradients_are_the_limits_of_differences() {
        let suns = [(false, 0.0), (true, 0.3), (false, -0.4)].map(|(is_reversed, warp)| map(is_reversed, warp).0);
        let lamps = [perspective(1.5, 1.0, 1.0, 50.0), perspective_infinite_reverse(1.5, 1.0, 1.0)].map(lamp_map);
        for map in suns.into_iter().chain(lamps) {
            let point = DVec3::new(1.0, 2.0, -0.5);
            let gradients = map.gradients(&map.project(point));
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let [before, after] = [-1e-5, 1e-5].map(|step| map.project(point + axis * step));
                let texel = (after.texel - before.texel) / 2e-5;
                let wanted = DVec2::new(gradients.u.dot(axis), gradients.v.dot(axis));
                assert!(texel.abs_diff_eq(wanted, 1e-4), "{texel} {wanted}");
                let depth = (after.depth - before.depth) / 2e-5;
                assert!((depth - gradients.depth.dot(axis)).abs() < 1e-7);
            }
        }
    }
}
