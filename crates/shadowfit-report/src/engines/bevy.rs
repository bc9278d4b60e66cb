//! Bevy's cascades: a square around each slice of the view, as wide as its diagonal, in whole metres, moved by whole
//! texels.

use glam::{DVec2, DVec3};

use super::slice::{LightAxes, Volume, bounds, corners, with_splits};
use crate::peers::{FitMap, Frame, Scene};

/// Number of cascades.
const CASCADES: i32 = 4;
/// View depth at which the first cascade ends, in metres.
const FIRST_END: f64 = 10.0;
/// View depth at which the first cascade begins, in metres.
const BEGIN: f64 = 0.1;
/// Share by which a cascade begins before the end of the one in front of it.
const OVERLAP: f64 = 0.2;

/// Fits four cascades up to the far plane (`maximum_distance`).
pub(super) fn fit(frame: &Frame, _: &Scene, resolution: u32) -> Vec<FitMap> {
    let base = (frame.far / FIRST_END).powf(1.0 / f64::from(CASCADES - 1));
    let ends: Vec<f64> = (0..CASCADES).map(|index| FIRST_END * base.powi(index)).collect();
    let begins = [BEGIN].into_iter().chain(ends.iter().map(|end| (1.0 - OVERLAP) * end));
    let axes = LightAxes::new(frame.to_light(), DVec3::Y);
    let maps = begins.zip(&ends).map(|(near, far)| cascade(frame, &axes, [near, *far], resolution)).collect();
    let mut maps = with_splits(maps, &ends);
    // Bevy draws no shadows beyond its last cascade.
    maps[ends.len() - 1].split_far = frame.far;
    maps
}

fn cascade(frame: &Frame, axes: &LightAxes, [near, far]: [f64; 2], resolution: u32) -> FitMap {
    let corners = corners(frame, near, far);
    let [low, high] = bounds(corners.map(|corner| axes.light_from_world * corner));
    let body = corners[0].distance(corners[6]);
    let far_plane = corners[4].distance(corners[6]);
    let diameter = body.max(far_plane).ceil();
    let texel = diameter / f64::from(resolution);
    let middle = 0.5 * (low + high).truncate();
    let center = (middle / texel).floor() * texel;
    // Depth is reversed: 1 is nearest to the light.
    axes.map(&Volume { center, half: DVec2::splat(0.5 * diameter), near_z: low.z, far_z: high.z }, resolution)
}
