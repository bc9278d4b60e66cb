//! The mill on the slope below: a white tower under a boat-shaped cap, and four sails that turn.

use std::f32::consts::TAU;

use glam::{Affine3A, Quat, Vec3};

use super::land::on_land;
use super::palette::Paint;
use crate::builtin::build::{Builder, CRISP, SMOOTH};
use crate::builtin::motion::rotations;
use crate::builtin::shapes::{block, ellipsoid, lathe, plank};
use crate::builtin::solid::Solid;
use crate::{Channel, Transform};

/// Time of a whole turn of the sails, in seconds: a steady breeze.
pub(super) const TURN_TIME: f32 = 14.0;
/// Keyframes of a turn: enough for rotations to be interpolated the short way.
const TURN_KEYS: usize = 24;
/// Where the mill stands, along x and z in metres.
const AT: [f32; 2] = [-27.0, -102.0];
/// Direction that the sails face, from +z toward +x, in radians: into the wind, so that the sun behind them throws the
/// whole wheel on the slope.
const FACING: f32 = 0.55;
/// How much larger than modelled the mill is: all other lengths are before that.
const SIZE: f32 = 1.3;
/// Height of the shaft that the sails turn on, in metres.
const HUB: f32 = 10.2;
/// Length of a sail, in metres.
const SAIL: f32 = 7.2;
/// Crossbars of a sail.
const BARS: usize = 14;

/// Adds the mill and returns how its sails turn.
pub(super) fn build(builder: &mut Builder) -> Channel {
    let at = on_land(AT[0], AT[1]);
    let mill = builder.group("mill", at, FACING);
    builder.scene.nodes[mill].rest.scale = Vec3::splat(SIZE);
    let tower = [(3.5, -2.0), (3.4, 0.6), (2.25, 8.8), (2.35, 8.9), (2.35, 9.1), (2.2, 9.15)];
    let cap = ellipsoid(Vec3::new(2.35, 2.1, 2.65), 24, 10).moved(Vec3::Y * 9.35);
    let openings = opening(0.25, 0.6).with(opening(2.2, 0.6)).with(opening(3.9, 0.6));
    let upper = opening(0.15, 5.0).with(opening(2.0, 5.4)).with(opening(4.2, 5.0));
    let tail = [plank(Vec3::new(-0.12, 9.0, -5.4), Vec3::new(0.12, 9.24, -1.5)), tail_pole(0.9), tail_pole(-0.9)];
    let primitives = vec![
        lathe(&tower, 32).primitive(Paint::White.into(), 0.5),
        cap.with(tail.into_iter().reduce(Solid::with).unwrap_or_default()).primitive(Paint::Timber.into(), SMOOTH),
        openings.with(upper).primitive(Paint::Dark.into(), CRISP),
    ];
    let mesh = builder.mesh("mill", primitives);
    builder.place(mill, mesh, Vec3::ZERO, 0.0);
    let hub = Transform { translation: Vec3::new(0.0, HUB, 3.2), ..Transform::default() };
    let primitives =
        vec![frame().primitive(Paint::Timber.into(), CRISP), canvas().primitive(Paint::Canvas.into(), CRISP)];
    let sails = builder.mesh("sails", primitives);
    let lean = Quat::from_rotation_x(-0.10);
    let node = builder.node("sails", Some(mill), Transform { rotation: lean, ..hub }, Some(sails));
    let start = 0.35;
    builder.scene.nodes[node].rest.rotation = lean * Quat::from_rotation_z(start);
    rotations(node, TURN_TIME, TURN_KEYS, |phase| lean * Quat::from_rotation_z(start - phase))
}

/// A pole from the end of the cap's tail to the foot of the mill, by which it is turned into the wind.
fn tail_pole(side: f32) -> Solid {
    let (from, to) = (Vec3::new(side * 0.1, 9.1, -5.2), Vec3::new(side * 1.6, 0.4, -6.2));
    crate::builtin::shapes::capsule(from, 0.07, to, 0.09, 8)
}

/// A door or window in the round wall, at a turn from the mill's front and a height.
fn opening(turn: f32, low: f32) -> Solid {
    let (half, tall) = if low < 1.0 { (0.55, 2.0) } else { (0.32, 0.95) };
    let radius = 3.48 - 0.14 * low;
    let slab = plank(Vec3::new(-half, low - 0.6, radius - 0.9), Vec3::new(half, low + tall - 0.6, radius + 0.02));
    slab.transformed(Affine3A::from_rotation_y(turn))
}

/// `sail` at each of four angles.
fn fourfold(sail: &Solid) -> Solid {
    let turned = |quarter: u8| sail.clone().transformed(Affine3A::from_rotation_z(TAU / 4.0 * f32::from(quarter)));
    (0..4).map(turned).reduce(Solid::with).unwrap_or_default()
}

/// Shaft, spars and bars.
fn frame() -> Solid {
    let spar = plank(Vec3::new(-0.10, 0.0, -0.09), Vec3::new(0.10, SAIL, 0.09));
    let edge = |x: f32, thick: f32| plank(Vec3::new(x - thick, 1.25, 0.02), Vec3::new(x + thick, SAIL - 0.05, 0.08));
    let mut sail = spar.with(edge(1.5, 0.035)).with(edge(0.8, 0.025)).with(edge(-0.55, 0.035));
    for bar in 0..BARS {
        let y = 1.3 + (SAIL - 1.4) * bar as f32 / (BARS - 1) as f32;
        sail = sail.with(plank(Vec3::new(-0.6, y - 0.03, -0.04), Vec3::new(1.55, y + 0.03, 0.03)));
    }
    let shaft = block(Vec3::new(-0.26, -0.26, -2.4), Vec3::new(0.26, 0.26, 0.35), 0.05);
    fourfold(&sail).with(shaft)
}

/// Cloth on the inner two thirds of each sail.
fn canvas() -> Solid {
    fourfold(&plank(Vec3::new(0.14, 1.45, 0.09), Vec3::new(1.46, 5.2, 0.11)))
}
