//! `SunLight` of three.js: a sphere around each of two slices of the view, moved by whole texels.

use glam::{DVec2, DVec3};

use super::slice::{LightAxes, Volume, bounds, corners, practical_split, with_splits};
use crate::peers::{FitMap, Frame, Scene};

/// Number of cascades.
const CASCADES: usize = 2;
/// Share of a cascade's depths that blends into the next cascade, which covers it too.
const FADE: f64 = 0.1;
/// Near plane of the shadow camera, in metres.
const NEAR: f64 = 0.5;
/// Greatest view depth of shadows, in metres: the far plane of the shadow camera.
const FAR: f64 = 500.0;
/// Texels at each border of a map that are left free, so that the filter does not read its neighbour in the atlas.
const INSET: u32 = 2;
/// Cosine between the light and the vertical above which z is up.
const STEEP: f64 = 0.99;

/// Fits two cascades.
pub(super) fn fit(frame: &Frame, _: &Scene, resolution: u32) -> Vec<FitMap> {
    let range = [frame.near, frame.far.min(FAR)];
    let to_light = frame.to_light();
    let axes = LightAxes::new(to_light, if to_light.y.abs() > STEEP { DVec3::Z } else { DVec3::Y });
    let in_light = |[near, far]: [f64; 2]| corners(frame, near, far).map(|corner| axes.light_from_world * corner);
    // Casters may be as far above the view as the shadows reach.
    let top = bounds(in_light(range))[1].z + range[1];
    let resolution = resolution - 2 * INSET;
    let ends: Vec<f64> = (1..=CASCADES).map(|index| practical_split(range, index, CASCADES)).collect();
    let begin = |index: usize| match index {
        0 => range[0],
        1 => ends[0] - FADE * (ends[0] - range[0]),
        _ => ends[index - 1] - FADE * (ends[index - 1] - ends[index - 2]),
    };
    let cascade = |index: usize| {
        let corners = in_light([begin(index), ends[index]]);
        let center = corners.iter().sum::<DVec3>() / 8.0;
        let radius = corners.iter().map(|corner| corner.distance(center)).fold(0.0, f64::max);
        // Half a texel on each side, so that moving by texels does not clip a corner.
        let radius = radius / (1.0 - 1.0 / f64::from(resolution));
        let texel = 2.0 * radius / f64::from(resolution);
        let center = (center.truncate() / texel).round() * texel;
        let lowest = corners.iter().map(|corner| corner.z).fold(f64::INFINITY, f64::min);
        let volume = Volume { center, half: DVec2::splat(radius), near_z: top, far_z: lowest - NEAR };
        axes.map(&volume, resolution)
    };
    with_splits((0..CASCADES).map(cascade).collect(), &ends)
}
