//! CSM of three.js: a square around each slice of the view, as wide as its diagonal, moved by whole texels.

use glam::{DVec2, DVec3};

use super::slice::{LightAxes, Volume, bounds, corners, practical_split, with_splits};
use crate::peers::{FitMap, Frame, Scene};

/// Number of cascades.
const CASCADES: usize = 4;
/// Distance of the shadow camera above the slice, toward the light, in metres (`lightMargin`).
const MARGIN: f64 = 200.0;
/// Near plane of the shadow camera, in metres (`lightNear`).
const NEAR: f64 = 1.0;
/// Far plane of the shadow camera, in metres (`lightFar`).
const FAR: f64 = 2000.0;

/// Fits four cascades up to the far plane (`maxFar`).
pub(super) fn fit(frame: &Frame, _: &Scene, resolution: u32) -> Vec<FitMap> {
    let range = [frame.near, frame.far];
    let ends: Vec<f64> = (1..=CASCADES).map(|index| practical_split(range, index, CASCADES)).collect();
    let axes = LightAxes::new(frame.to_light(), DVec3::Y);
    let begins = [frame.near].into_iter().chain(ends.iter().copied());
    let maps = begins.zip(&ends).map(|(near, far)| cascade(frame, &axes, [near, *far], resolution)).collect();
    // The look-up divides view depths by the far minus the near distance.
    let read: Vec<f64> = ends.iter().map(|end| end / frame.far * (frame.far - frame.near)).collect();
    with_splits(maps, &read)
}

fn cascade(frame: &Frame, axes: &LightAxes, [near, far]: [f64; 2], resolution: u32) -> FitMap {
    let corners = corners(frame, near, far);
    let width = corners[5].distance(corners[7]).max(corners[5].distance(corners[3]));
    let texel = width / f64::from(resolution);
    let [low, high] = bounds(corners.map(|corner| axes.light_from_world * corner));
    let middle = 0.5 * (low + high).truncate();
    let center = (middle / texel).floor() * texel;
    let camera_z = high.z + MARGIN;
    let volume = Volume { center, half: DVec2::splat(0.5 * width), near_z: camera_z - NEAR, far_z: camera_z - FAR };
    axes.map(&volume, resolution)
}
