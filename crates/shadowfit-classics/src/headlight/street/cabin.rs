//! The upper body of the car: roof and pillars, with windows on their surface.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};
use shadowfit_scene::parts::{Solid, superellipse, tube};

use super::panel::Panel;

/// Squareness of the cabin from above.
const POWER: f32 = 4.5;
/// Points around it.
const AROUND: usize = 64;
/// Steps from the belt up to the roof.
const STEPS: usize = 6;
/// Scale of the outline, and height, of the rings above the windows.
const ROOF: [(f32, f32); 5] = [(0.975, 1.072), (0.92, 1.095), (0.80, 1.113), (0.55, 1.127), (0.25, 1.134)];
/// Height of the roof's middle.
const SUMMIT: f32 = 1.136;

/// Lower and upper edge of the windows, as shares of the cabin's height below the roof.
const WINDOWS: [f32; 2] = [0.27, 0.93];
/// Distance of the panes from the cabin's surface.
const PROUD: f32 = 0.004;

/// Returns half width, middle along z, half length and height of the outline, at a share of the height below
/// the roof.
fn outline(share: f32) -> (f32, f32, f32, f32) {
    let mix = |low: f32, high: f32| low + (high - low) * share;
    let (front, rear) = (mix(0.84, 0.17) + 0.05 * share * (1.0 - share), mix(-1.20, -0.66));
    (mix(0.645, 0.525), f32::midpoint(front, rear), (front - rear) / 2.0, mix(0.69, 1.04))
}

/// Returns a point of the cabin at a turn (in radians from +z toward +x) and a share of its height below the
/// roof.
fn surface(at: Vec2) -> Vec3 {
    let (rx, cz, rz, y) = outline(at.y);
    let (x, z) = superellipse(at.x, POWER);
    Vec3::new(x * rx, y, cz + z * rz)
}

/// Builds the painted cabin.
pub(super) fn solid() -> Solid {
    let ring = |point: &dyn Fn(f32) -> Vec3| -> Vec<Vec3> {
        (0..AROUND).map(|index| point(index as f32 / AROUND as f32 * TAU)).collect()
    };
    let walls = (0..=STEPS).map(|step| ring(&|turn| surface(Vec2::new(turn, step as f32 / STEPS as f32))));
    let (rx, cz, rz, _) = outline(1.0);
    let roof = ROOF.iter().map(|&(scale, y)| {
        ring(&|turn| {
            let (x, z) = superellipse(turn, POWER);
            Vec3::new(x * rx * scale, y, cz + z * rz * scale)
        })
    });
    let rings: Vec<_> = walls.chain(roof).collect();
    tube(&rings, Vec3::new(0.0, rings[0][0].y, cz), Vec3::new(0.0, SUMMIT, cz))
}

/// Builds windscreen, rear window, and two windows on each side.
pub(super) fn windows() -> Solid {
    let pane = |from: f32, to: f32| {
        let [low, high] = [(from, WINDOWS[0]), (to, WINDOWS[1])].map(|(turn, share)| Vec2::new(turn, share));
        Panel::between(low, high, 0.12, PROUD).solid(surface, [14, 8])
    };
    let sides = pane(0.93, 1.60).with(pane(1.68, 2.22));
    pane(-0.68, 0.68).with(pane(PI - 0.62, PI + 0.62)).with(sides.and_mirrored())
}
