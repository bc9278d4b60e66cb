//! The mill on the slope below: a white tower under a boat-shaped cap, and four sails that turn.

use std::f32::consts::TAU;

use glam::{Affine3A, Quat, Vec3};

use super::land::on_land;
use super::palette::Paint;
use crate::parts::{Builder, CRISP, SMOOTH, Solid, block, capsule, ellipsoid, lathe, plank, rotations};
use crate::{Channel, Transform};

/// Time of a full turn of the sails in a steady breeze, in seconds.
pub(super) const TURN_TIME: f32 = 14.0;
/// Keyframes of a turn: enough for rotations to be interpolated along the shorter arc.
const TURN_KEYS: usize = 24;
/// Position of the mill along x and z, in metres.
const AT: [f32; 2] = [-27.0, -102.0];
/// Direction that the sails face, from +z toward +x, in radians: into the wind, so that the sun behind them
/// casts the shadow of the whole wheel on the slope.
const FACING: f32 = 0.55;
/// Scale of the mill. All other lengths are before scaling.
const SIZE: f32 = 1.3;
/// Height of the shaft that the sails turn on, in metres.
const HUB: f32 = 10.2;
/// Length of a sail, in metres.
const SAIL: f32 = 7.2;
/// Crossbars of a sail.
const BARS: usize = 14;

/// Adds the mill and returns the animation channel of its sails.
pub(super) fn build(builder: &mut Builder) -> Channel {
    let at = on_land(AT[0], AT[1]);
    let mill = builder.group("mill", at, FACING);
    builder.scene.nodes[mill].rest.scale = Vec3::splat(SIZE).as_dvec3();
    let tower = [(3.5, -2.0), (3.4, 0.6), (2.25, 8.8), (2.35, 8.9), (2.35, 9.1), (2.2, 9.15)];
    let cap = ellipsoid([2.35, 2.1, 2.65], 24, 10).moved(Vec3::Y * 9.35);
    let low = [0.25, 2.2, 3.9].map(|turn| opening(turn, 0.6));
    let openings = low.into_iter().chain([opening(0.15, 5.0), opening(2.0, 5.4), opening(4.2, 5.0)]).collect();
    let tail = [plank([-0.12, 9.0, -5.4], [0.12, 9.24, -1.5]), tail_pole(0.9), tail_pole(-0.9)];
    let body = [
        (lathe(&tower, 32), Paint::White, 0.5),
        (cap.with(tail.into_iter().collect()), Paint::Timber, SMOOTH),
        (openings, Paint::Dark, CRISP),
    ];
    let mesh = builder.solids("mill", body);
    builder.place(mill, mesh, Vec3::ZERO, 0.0);
    let sails = builder.solids("sails", [(frame(), Paint::Timber, CRISP), (canvas(), Paint::Canvas, CRISP)]);
    let (lean, start) = (Quat::from_rotation_x(-0.10), 0.35);
    let rotation = lean * Quat::from_rotation_z(start);
    let node = builder.pose(mill, sails, Transform::new(Vec3::new(0.0, HUB, 3.2), rotation, Vec3::ONE));
    rotations(node, TURN_TIME, TURN_KEYS, |phase| lean * Quat::from_rotation_z(start - phase))
}

/// Builds a pole from the end of the cap's tail to the foot of the mill, which serves to turn the cap into
/// the wind.
fn tail_pole(side: f32) -> Solid {
    capsule([side * 0.1, 9.1, -5.2], 0.07, [side * 1.6, 0.4, -6.2], 0.09, 8)
}

/// Builds a door or window in the round wall, at an angle from the mill's front and a height.
fn opening(turn: f32, low: f32) -> Solid {
    let (half, tall) = if low < 1.0 { (0.55, 2.0) } else { (0.32, 0.95) };
    let radius = 3.48 - 0.14 * low;
    let slab = plank([-half, low - 0.6, radius - 0.9], [half, low + tall - 0.6, radius + 0.02]);
    slab.transformed(Affine3A::from_rotation_y(turn))
}

/// Returns `sail` at four angles, a quarter turn apart.
fn fourfold(sail: &Solid) -> Solid {
    let turned = |quarter: u8| sail.clone().transformed(Affine3A::from_rotation_z(TAU / 4.0 * f32::from(quarter)));
    (0..4).map(turned).collect()
}

/// Builds the shaft, spars and bars.
fn frame() -> Solid {
    let spar = plank([-0.10, 0.0, -0.09], [0.10, SAIL, 0.09]);
    let edge = |x: f32, thick: f32| plank([x - thick, 1.25, 0.02], [x + thick, SAIL - 0.05, 0.08]);
    let edges = spar.with(edge(1.5, 0.035)).with(edge(0.8, 0.025)).with(edge(-0.55, 0.035));
    let bar = |bar: usize| {
        let y = 1.3 + (SAIL - 1.4) * bar as f32 / (BARS - 1) as f32;
        plank([-0.6, y - 0.03, -0.04], [1.55, y + 0.03, 0.03])
    };
    let sail = (0..BARS).map(bar).fold(edges, Solid::with);
    let shaft = block([-0.26, -0.26, -2.4], [0.26, 0.26, 0.35], 0.05);
    fourfold(&sail).with(shaft)
}

/// Builds the cloth on the inner two thirds of each sail.
fn canvas() -> Solid {
    fourfold(&plank([0.14, 1.45, 0.09], [1.46, 5.2, 0.11]))
}
