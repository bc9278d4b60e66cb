//! Cascades of Babylon.js: a sphere or a box around each slice of the view. The box of all casters bounds depth, which the
//! renderer clamps.

use glam::{DVec2, DVec3};

use super::slice::{LightAxes, Volume, bounds, corners, practical_split, with_splits};
use crate::peers::{FitMap, Frame, Scene};

/// Number of cascades.
const CASCADES: usize = 4;
/// Steps of a sphere's radius in a metre.
const RADIUS_STEPS: f64 = 16.0;
/// Least range of depth where all casters lie before a cascade, in metres.
const LEAST_DEPTH: f64 = 1.0;

/// Fits four cascades whose size does not change (`stabilizeCascades`).
pub(super) fn stable(frame: &Frame, scene: &Scene, resolution: u32) -> Vec<FitMap> {
    fit(frame, scene, resolution, true)
}

/// Fits four cascades tightly, which is the default.
pub(super) fn tight(frame: &Frame, scene: &Scene, resolution: u32) -> Vec<FitMap> {
    fit(frame, scene, resolution, false)
}

fn fit(frame: &Frame, scene: &Scene, resolution: u32, is_stable: bool) -> Vec<FitMap> {
    let range = [frame.near, frame.far];
    let ends: Vec<f64> = (1..=CASCADES).map(|index| practical_split(range, index, CASCADES)).collect();
    let axes = LightAxes::new(frame.to_light(), DVec3::Y).mirrored();
    let casters = casters_in_light(scene, &axes);
    let begins = [frame.near].into_iter().chain(ends.iter().copied());
    let cascade = |(near, far): (f64, &f64)| {
        let corners = corners(frame, near, *far).map(|corner| axes.light_from_world * corner);
        let [low, high] = if is_stable { sphere(&corners) } else { bounds(corners) };
        let volume = rounded(&clamped([low, high], casters), resolution);
        axes.map(&volume, resolution)
    };
    with_splits(begins.zip(&ends).map(cascade).collect(), &ends)
}

/// Returns the box around the sphere around a slice, whose radius is rounded up.
fn sphere(corners: &[DVec3; 8]) -> [DVec3; 2] {
    let center = corners.iter().sum::<DVec3>() / 8.0;
    let radius = corners.iter().map(|corner| corner.distance(center)).fold(0.0, f64::max);
    let radius = (radius * RADIUS_STEPS).ceil() / RADIUS_STEPS;
    [center - radius, center + radius]
}

/// Returns the least and the greatest z of the box of all casters, in light space.
fn casters_in_light(scene: &Scene, axes: &LightAxes) -> [f64; 2] {
    let [x0, y0, z0, x1, y1, z1] = scene.aabb;
    let corner = |index: usize| {
        let choose = |bit: usize, low: f64, high: f64| if index >> bit & 1 == 0 { low } else { high };
        DVec3::new(choose(0, x0, x1), choose(1, y0, y1), choose(2, z0, z1))
    };
    let [low, high] = bounds((0..8).map(|index| axes.light_from_world * corner(index)));
    [low.z, high.z]
}

/// Returns the volume of a slice whose depth ends at the casters on both sides.
fn clamped([low, high]: [DVec3; 2], [casters_low, casters_high]: [f64; 2]) -> Volume {
    let (center, half) = (0.5 * (low + high).truncate(), 0.5 * (high - low).truncate());
    let mut volume = Volume { center, half, near_z: high.z, far_z: low.z };
    // Casters that are all farther from the light than the slice change nothing.
    if casters_high >= low.z {
        volume.near_z = high.z.min(casters_high);
        volume.far_z = low.z.max(casters_low).min(volume.near_z - LEAST_DEPTH);
    }
    volume
}

/// Moves a volume by less than a texel, so that the world's origin lies at a texel's corner.
fn rounded(volume: &Volume, resolution: u32) -> Volume {
    let texels = f64::from(resolution) * 0.5;
    let origin = -volume.center / volume.half * texels;
    // JavaScript rounds halves up.
    let round = |value: f64| (value + 0.5).floor();
    let moved = DVec2::new(round(origin.x), round(origin.y)) - origin;
    Volume { center: volume.center - moved / texels * volume.half, ..*volume }
}
