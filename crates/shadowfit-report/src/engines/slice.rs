//! Slices of a view, the axes of a light, and maps along them.

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

use crate::peers::{FitMap, Frame};

/// The axes of a light as the engines place them: z toward the light, x horizontal.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightAxes {
    /// Light space from world space, a rotation.
    pub(super) light_from_world: DMat3,
}

/// The volume of an orthographic map, in light space, metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Volume {
    /// Middle across the light.
    pub(super) center: DVec2,
    /// Half of the width and height.
    pub(super) half: DVec2,
    /// z where depth is 0.
    pub(super) near_z: f64,
    /// z where depth is 1.
    pub(super) far_z: f64,
}

impl LightAxes {
    /// Axes of a light from the unit direction toward it, with `up` across the map's top.
    pub(super) fn new(to_light: DVec3, up: DVec3) -> Self {
        let x = up.cross(to_light).normalize();
        let world_from_light = DMat3::from_cols(x, to_light.cross(x), to_light);
        Self { light_from_world: world_from_light.transpose() }
    }

    /// The same axes with x to the other side: a left-handed light space.
    pub(super) fn mirrored(self) -> Self {
        Self { light_from_world: DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)) * self.light_from_world }
    }

    /// Returns the map of a volume.
    pub(super) fn map(&self, volume: &Volume, resolution: u32) -> FitMap {
        let Volume { center, half, near_z, far_z } = *volume;
        let depth = 1.0 / (near_z - far_z);
        let clip_from_light = DMat4::from_cols(
            DVec4::new(1.0 / half.x, 0.0, 0.0, 0.0),
            DVec4::new(0.0, 1.0 / half.y, 0.0, 0.0),
            DVec4::new(0.0, 0.0, -depth, 0.0),
            DVec4::new(-center.x / half.x, -center.y / half.y, near_z * depth, 1.0),
        );
        let view_proj = clip_from_light * DMat4::from_mat3(self.light_from_world);
        let (split_near, split_far) = (0.0, FitMap::NO_END);
        FitMap { view_proj: view_proj.to_cols_array(), resolution, resolution_xy: None, split_near, split_far }
    }
}

/// Returns the world corners of the part of a frame's view between two view depths: four near ones, then four far ones,
/// around the view.
pub(super) fn corners(frame: &Frame, near: f64, far: f64) -> [DVec3; 8] {
    let world_from_view = frame.view_from_world().inverse();
    let y = frame.tan_half_fov();
    let x = y * frame.aspect;
    let corner = |depth: f64, [right, up]: [f64; 2]| {
        world_from_view.transform_point3(DVec3::new(right * x * depth, up * y * depth, -depth))
    };
    let around = [[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]];
    std::array::from_fn(|index| corner(if index < 4 { near } else { far }, around[index % 4]))
}

/// Returns the least and the greatest coordinates of points.
pub(super) fn bounds(points: impl IntoIterator<Item = DVec3>) -> [DVec3; 2] {
    let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    points.into_iter().fold(none, |[low, high], point| [low.min(point), high.max(point)])
}

/// Sets where each map begins and ends, view depths in metres; the last one has no end.
pub(super) fn with_splits(mut maps: Vec<FitMap>, ends: &[f64]) -> Vec<FitMap> {
    let last = maps.len() - 1;
    for (index, map) in maps.iter_mut().enumerate() {
        map.split_near = if index == 0 { 0.0 } else { ends[index - 1] };
        map.split_far = if index == last { FitMap::NO_END } else { ends[index] };
    }
    maps
}

/// Returns the view depth at which slice `index` of `count` ends: the mean of a uniform and a logarithmic split.
pub(super) fn practical_split([near, far]: [f64; 2], index: usize, count: usize) -> f64 {
    let share = index as f64 / count as f64;
    let logarithmic = near * (far / near).powf(share);
    let uniform = near + (far - near) * share;
    0.5 * (logarithmic + uniform)
}
