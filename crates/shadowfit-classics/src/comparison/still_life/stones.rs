//! Column, arch, a ball on a pedestal, a ring and a vase.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::{Affine3A, Vec3};
use shadowfit_scene::Primitive;
use shadowfit_scene::parts::{
    Arch, Builder, CRISP, SMOOTH, Solid, block, catmull_rom, ellipsoid, lathe, modulated_lathe, smooth, stop, sweep,
    torus,
};

use super::SUNK;
use super::palette::Paint;

/// Flutes of the column.
const FLUTES: f32 = 20.0;

/// Adds the stones.
pub(super) fn build(builder: &mut Builder, group: usize) {
    let mut add = |name: &str, primitives: Vec<Primitive>, x: f32, z: f32, yaw: f32| {
        let mesh = builder.mesh(name, primitives);
        builder.place(group, mesh, Vec3::new(x, 0.0, z), yaw);
    };
    add("column", vec![column().primitive(Paint::Marble.into(), 0.5)], -3.3, -2.9, 0.0);
    add("arch", vec![arch().primitive(Paint::Stone.into(), CRISP)], 2.35, -3.3, -0.32);
    let ball = ellipsoid(Vec3::splat(0.62), 72, 44).moved(Vec3::Y * 1.94);
    let pedestal = pedestal().primitive(Paint::Stone.into(), CRISP);
    add("pedestal", vec![pedestal, ball.primitive(Paint::Ball.into(), SMOOTH)], -0.75, -2.5, 0.35);
    add("ring", vec![ring().primitive(Paint::Bronze.into(), SMOOTH)], 0.75, -0.15, -0.5);
    add("vase", vec![vase().primitive(Paint::Terracotta.into(), 0.9)], 3.3, -0.4, 0.0);
}

/// Builds a column with flutes between a round base and a round capital, each with a square slab.
fn column() -> Solid {
    let flutes = |turn: f32, _: f32| 1.0 - 0.06 * (turn * FLUTES / 2.0).sin().abs();
    let shaft: Vec<(f32, f32)> = (0..=12)
        .map(|step| {
            let t = step as f32 / 12.0;
            // The lower half is slightly wider than a cone.
            (0.40 - 0.06 * t.powf(1.6), 0.44 + 2.98 * t)
        })
        .collect();
    let base = [
        (0.50, 0.15),
        (0.54, 0.19),
        (0.55, 0.235),
        (0.53, 0.28),
        (0.47, 0.31),
        (0.44, 0.33),
        (0.47, 0.36),
        (0.475, 0.39),
        (0.46, 0.42),
        (0.41, 0.45),
    ];
    let capital = [
        (0.36, 3.38),
        (0.385, 3.41),
        (0.375, 3.45),
        (0.36, 3.48),
        (0.39, 3.53),
        (0.47, 3.62),
        (0.53, 3.68),
        (0.545, 3.73),
        (0.52, 3.76),
    ];
    let round = modulated_lathe(&shaft, 120, flutes).with(lathe(&base, 48)).with(lathe(&capital, 48));
    let stand = block([-0.58, -SUNK, -0.58], [0.58, 0.17, 0.58], 0.015);
    let slab = block([-0.58, 3.74, -0.58], [0.58, 3.92, 0.58], 0.015);
    round.with(stand).with(slab)
}

/// Builds an arch with imposts at its springing and a keystone.
fn arch() -> Solid {
    let (radius, spring, depth) = (0.95, 1.75, 0.75);
    let wall = Arch { width: 3.1, height: 3.25, depth, radius, spring }.solid(28).moved(Vec3::Y * -SUNK);
    let side = |sign: f32| {
        let pier = |from: f32, to: f32, low: f32, high: f32| {
            let z = depth / 2.0 + 0.06;
            let [a, b] = [from * sign, to * sign];
            block(Vec3::new(a.min(b), low, -z), Vec3::new(a.max(b), high, z), 0.02)
        };
        let foot = pier(radius - 0.06, 1.61, -SUNK, 0.22);
        foot.with(pier(radius - 0.06, 1.61, spring - 0.2, spring - 0.03))
    };
    let key = block([-0.15, spring + radius - 0.07, -0.46], [0.15, 3.13, 0.46], 0.02);
    let cornice = block([-1.63, 3.15, -0.46], [1.63, 3.36, 0.46], 0.025);
    wall.with(side(1.0)).with(side(-1.0)).with(key).with(cornice)
}

/// Builds a pedestal with a foot and a slab, and the cup that holds the ball.
fn pedestal() -> Solid {
    let part = |half: f32, low: f32, high: f32| block([-half, low, -half], [half, high, half], 0.02);
    let cup = lathe(&[(0.30, 1.28), (0.31, 1.33), (0.25, 1.37), (0.29, 1.42), (0.27, 1.44)], 32);
    part(0.60, -SUNK, 0.20).with(part(0.47, 0.18, 1.16)).with(part(0.58, 1.14, 1.30)).with(cup)
}

/// Builds an upright ring.
fn ring() -> Solid {
    let (radius, thick) = (0.72, 0.20);
    let upright = Affine3A::from_rotation_x(FRAC_PI_2);
    torus(radius, thick, thick, 96, 36).transformed(upright).moved(Vec3::Y * (radius + thick - SUNK))
}

/// Builds a vase that is hollow down to its foot.
fn vase() -> Solid {
    let outside = [
        (0.30, -SUNK),
        (0.31, 0.03),
        (0.285, 0.07),
        (0.27, 0.10),
        (0.33, 0.20),
        (0.44, 0.36),
        (0.53, 0.56),
        (0.575, 0.78),
        (0.57, 0.98),
        (0.51, 1.16),
        (0.41, 1.30),
        (0.31, 1.41),
        (0.265, 1.52),
        (0.27, 1.63),
        (0.32, 1.72),
        (0.385, 1.78),
    ];
    let lip = [(0.40, 1.80), (0.395, 1.82), (0.37, 1.825)];
    let inside = [
        (0.30, 1.75),
        (0.24, 1.64),
        (0.23, 1.52),
        (0.27, 1.40),
        (0.37, 1.27),
        (0.47, 1.13),
        (0.53, 0.97),
        (0.53, 0.78),
        (0.48, 0.56),
        (0.38, 0.36),
        (0.2, 0.22),
        (0.0, 0.20),
    ];
    let body = lathe(&[curved(&outside), lip.to_vec(), curved(&inside)].concat(), 96);
    body.with(handle()).with(handle().transformed(Affine3A::from_rotation_y(TAU / 2.0)))
}

/// Returns a smooth outline through `points`, with twice as many points.
fn curved(points: &[(f32, f32)]) -> Vec<(f32, f32)> {
    let last = points.len() - 1;
    let mut curve = Vec::new();
    for index in 0..last {
        let near = [index.saturating_sub(1), index, index + 1, (index + 2).min(last)].map(|near| points[near]);
        let middle = (catmull_rom(near.map(|point| point.0), 0.5), catmull_rom(near.map(|point| point.1), 0.5));
        curve.extend([points[index], middle]);
    }
    curve.push(points[last]);
    curve
}

/// Builds a handle on the side of +x, from the neck to the shoulder.
fn handle() -> Solid {
    let point = |x: f32, y: f32, radius: f32| stop(Vec3::new(x, y, 0.0), radius);
    let stops = [
        point(0.24, 1.60, 0.03),
        point(0.30, 1.615, 0.042),
        point(0.47, 1.63, 0.038),
        point(0.60, 1.52, 0.036),
        point(0.635, 1.36, 0.036),
        point(0.58, 1.18, 0.04),
        point(0.49, 1.08, 0.046),
        point(0.44, 1.04, 0.04),
    ];
    sweep(&smooth(&stops, 4), Vec3::Z, 12)
}
