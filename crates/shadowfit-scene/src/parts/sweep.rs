//! Solids that follow a bent line: pipes, bumpers, necks.

use std::f32::consts::TAU;

use glam::Vec3;

use super::shapes::{curve, tube};
use super::solid::Solid;

/// A point of the line with its elliptical cross-section, in metres.
#[derive(Clone, Copy, Debug)]
pub struct Stop {
    /// Position on the line.
    pub at: Vec3,
    /// Half axes of the ellipse: along the sweep's side, and perpendicular to side and line.
    pub half: [f32; 2],
}

/// Returns a stop with a round cross-section.
pub const fn stop(at: Vec3, radius: f32) -> Stop {
    Stop { at, half: [radius; 2] }
}

/// Builds the solid around a line of at least four stops in a plane perpendicular to `side` (a unit vector).
/// The first and the last stop are the tips that close it. Their cross-sections are ignored.
pub fn sweep(stops: &[Stop], side: Vec3, segments: usize) -> Solid {
    let ring = |index: usize| {
        let along = (stops[index + 1].at - stops[index - 1].at).normalize();
        let across = along.cross(side);
        let Stop { at, half: [a, b] } = stops[index];
        let point = |step: usize| {
            let (sin, cos) = (step as f32 / segments as f32 * TAU).sin_cos();
            at + side * (a * cos) + across * (b * sin)
        };
        (0..segments).map(point).collect::<Vec<_>>()
    };
    let last = stops.len() - 1;
    let rings: Vec<_> = (1..last).map(ring).collect();
    tube(&rings, stops[0].at, stops[last].at)
}

/// Returns stops on a smooth curve through all of `stops`, `steps` from each to the next.
pub fn smooth(stops: &[Stop], steps: usize) -> Vec<Stop> {
    let points: Vec<_> =
        stops.iter().map(|stop| [stop.at.x, stop.at.y, stop.at.z, stop.half[0], stop.half[1]]).collect();
    let smooth = |[x, y, z, a, b]: [f32; 5]| Stop { at: Vec3::new(x, y, z), half: [a, b].map(|half| half.max(1e-3)) };
    curve(&points, steps).into_iter().map(smooth).collect()
}
