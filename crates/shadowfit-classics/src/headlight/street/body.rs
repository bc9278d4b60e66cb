//! The lower body of the car: bonnet, flanks and boot, with arches for the wheels.
//!
//! A cross-section moves from the tail at -z to the nose at +z. Its width depends on z and on the height, so
//! that flanks stay smooth where the lower edge rises over a wheel.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::Vec3;
use shadowfit_scene::parts::{Solid, tube};

/// Half of the car's length.
pub(super) const HALF_LENGTH: f32 = 1.6;
/// Half of the car's width.
pub(super) const HALF_WIDTH: f32 = 0.71;
/// Positions of the axles along z.
pub(super) const AXLES: [f32; 2] = [-0.97, 1.0];
/// Radius of the wheels, which is also the height of the axles.
pub(super) const WHEEL: f32 = 0.255;
/// Radius of the wheel arches.
const ARCH: f32 = 0.30;
/// Height of the lower edge.
const SILL: f32 = 0.17;
/// Height of the rounded transition from flanks to bonnet and boot.
const SHOULDER: f32 = 0.11;
/// Length over which nose and tail are rounded.
const ROUND: f32 = 0.16;

/// Points of half a cross-section up the flank, and from there to the middle of the top.
const POINTS: [usize; 2] = [7, 9];

/// Height of the body's middle line along z: tail, boot, doors, bonnet, nose.
const TOP: [(f32, f32); 7] =
    [(-1.6, 0.72), (-1.45, 0.765), (-1.0, 0.785), (0.2, 0.775), (0.8, 0.745), (1.3, 0.68), (1.6, 0.60)];

/// Builds the body.
pub(super) fn solid() -> Solid {
    let stations = stations();
    let rings: Vec<Vec<Vec3>> = stations.iter().map(|&(z, low)| ring(z, low)).collect();
    let end = |z: f32| Vec3::new(0.0, 0.45, z);
    tube(&rings, end(-HALF_LENGTH), end(HALF_LENGTH))
}

/// Returns a point of the flank on the +x side, at a height and z.
pub(super) fn flank(y: f32, z: f32) -> Vec3 {
    Vec3::new(half_width(y, z), y, z)
}

/// Returns the positions of the cross-sections along z, with the height of their lower edge.
fn stations() -> Vec<(f32, f32)> {
    let mut stations: Vec<(f32, f32)> = Vec::new();
    for axle in AXLES {
        const STEPS: usize = 18;
        let outside = ARCH + 0.002;
        stations.extend([(axle - outside, SILL), (axle + outside, SILL)]);
        stations.extend((0..=STEPS).map(|step| {
            let (sin, cos) = (step as f32 / STEPS as f32 * PI).sin_cos();
            (axle - ARCH * cos, WHEEL + ARCH * sin.max(0.0))
        }));
    }
    for share in [0.0, 0.04, 0.12, 0.25, 0.45, 0.7, 1.0, 1.25, 1.5, 1.75] {
        let z = HALF_LENGTH - ROUND * share;
        stations.extend([(-z, SILL), (z, SILL)]);
    }
    let doors = AXLES[0] + ARCH..AXLES[1] - ARCH;
    stations.extend((-9..=9).map(|step| (step as f32 * 0.1, SILL)).filter(|station| doors.contains(&station.0)));
    stations.sort_by(|a, b| a.0.total_cmp(&b.0));
    stations
}

/// Returns the size of a cross-section as a share of the full size, 0 to 1. It is less than 1 at nose and
/// tail.
fn fullness(z: f32) -> f32 {
    let share = ((HALF_LENGTH - z.abs()) / ROUND).clamp(0.0, 1.0);
    (1.0 - (1.0 - share).powi(2)).sqrt()
}

/// Returns the height of the middle line.
fn top(z: f32) -> f32 {
    let next = TOP.iter().position(|point| point.0 >= z).unwrap_or(TOP.len() - 1).max(1);
    let (from, to) = (TOP[next - 1], TOP[next]);
    let t = ((z - from.0) / (to.0 - from.0)).clamp(0.0, 1.0);
    // Central differences as slopes keep the line smooth.
    let slope = |index: usize| {
        let (a, b) = (TOP[index.saturating_sub(1)], TOP[(index + 1).min(TOP.len() - 1)]);
        (b.1 - a.1) / (b.0 - a.0) * (to.0 - from.0)
    };
    let (rise, [s0, s1]) = (to.1 - from.1, [slope(next - 1), slope(next)]);
    from.1 + t * (s0 + t * (3.0 * rise - 2.0 * s0 - s1 + t * (s0 + s1 - 2.0 * rise)))
}

/// Returns the half width at a height and z: widest at the height of the bumpers, narrower toward nose and
/// tail.
fn half_width(y: f32, z: f32) -> f32 {
    let plan = (1.0 - (z.abs() / (HALF_LENGTH + 0.08)).powi(8)).max(0.0).powf(0.25);
    let bulge = 1.0 - 0.45 * (y - 0.45).powi(2);
    HALF_WIDTH * plan * bulge * (0.95 + 0.05 * fullness(z))
}

/// Returns the cross-section at z above a lower edge, counter-clockwise seen from the nose, starting in the
/// middle of its underside.
fn ring(z: f32, low: f32) -> Vec<Vec3> {
    let full = fullness(z);
    let low = low + 0.07 * (1.0 - full);
    let high = top(z) - 0.10 * (1.0 - full);
    let shoulder = high - SHOULDER * (1.0 + 0.3 * (1.0 - full));
    let edge = half_width(low, z);
    let mut half = vec![Vec3::new(0.0, low, z), Vec3::new(edge * 0.5, low, z)];
    half.extend((0..POINTS[0]).map(|step| {
        let y = low + (shoulder - low) * step as f32 / (POINTS[0] - 1) as f32;
        flank(y, z)
    }));
    let widest = half_width(shoulder, z);
    half.extend((1..=POINTS[1]).map(|step| {
        // Denser where the flank turns.
        let turn = (step as f32 / POINTS[1] as f32).powf(1.3) * FRAC_PI_2;
        let (sin, cos) = turn.sin_cos();
        let x = if step == POINTS[1] { 0.0 } else { widest * cos.sqrt() };
        Vec3::new(x, shoulder + (high - shoulder) * sin.sqrt(), z)
    }));
    let mirrored = half[1..half.len() - 1].iter().rev().map(|point| point.with_x(-point.x));
    half.iter().copied().chain(mirrored).collect()
}
