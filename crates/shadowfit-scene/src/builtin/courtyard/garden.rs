//! Objects in the courtyard: fence, pole, lattices, jars, crates, cypresses, low walls.

use std::f32::consts::TAU;

use glam::{Quat, Vec3};

use super::palette::Paint;
use crate::parts::{Builder, CRISP, SMOOTH, block, cypress, ellipsoid, hash, lathe, pillar, rounded_box, torus};

/// Position of the fence along x, in metres.
const FENCE_X: f32 = 4.7;

/// Adds the objects in front of the buildings.
pub(super) fn build(builder: &mut Builder) {
    let group = builder.group("garden", Vec3::ZERO, 0.0);
    fence(builder, group);
    pole(builder, group);
    lattices(builder, group);
    jars(builder, group);
    crates(builder, group);
    cypresses(builder, group);
    low_walls(builder, group);
}

/// Adds a fence of thin round posts between two rails, along z.
fn fence(builder: &mut Builder, group: usize) {
    let post = [(0.02, -0.01), (0.02, 1.2), (0.013, 1.225), (0.021, 1.24), (0.026, 1.26), (0.021, 1.28), (0.0, 1.305)];
    let post = builder.solid("fence post", &lathe(&post, 10), Paint::Iron, 0.9);
    for index in (0..34).filter(|index| index % 11 != 0) {
        builder.place(group, post, [FENCE_X, 0.0, 2.3 - 0.2 * index as f32], 0.0);
    }
    let stout = pillar([0.07; 2], [-0.01, 1.3], 0.006)
        .with(pillar([0.095; 2], [1.295, 1.34], 0.008))
        .with(ellipsoid([0.07; 3], 18, 10).moved(Vec3::Y * 1.395));
    let stout = builder.solid("fence pier", &stout, Paint::Timber, 0.75);
    for index in 0..4 {
        builder.place(group, stout, [FENCE_X, 0.0, 2.3 - 2.2 * index as f32], 0.0);
    }
    let rail = block([-0.016, -0.02, -6.6], [0.016, 0.02, 0.0], 0.005);
    let rail = builder.solid("fence rail", &rail, Paint::Iron, CRISP);
    for height in [0.22, 1.05] {
        builder.place(group, rail, [FENCE_X, height, 2.3], 0.0);
    }
}

/// Adds a tall thin mast with a ball on top and a stone foot.
fn pole(builder: &mut Builder, group: usize) {
    let foot = [(0.3, -0.01), (0.3, 0.14), (0.28, 0.16), (0.2, 0.17), (0.18, 0.2), (0.17, 0.34), (0.14, 0.37)];
    let ball = ellipsoid([0.09; 3], 18, 10).moved(Vec3::Y * 7.05);
    let collar = torus(0.06, 0.018, 0.02, 16, 6).moved(Vec3::Y * 0.42);
    let pole = [
        (lathe(&[(0.055, 0.1), (0.05, 2.5), (0.032, 7.0)], 20), Paint::Timber, 0.9),
        (lathe(&foot, 36), Paint::Stone, CRISP),
        (ball.with(collar), Paint::Bronze, SMOOTH),
    ];
    let pole = builder.solids("mast", pole);
    builder.place(group, pole, [3.5, 0.0, 3.3], 0.0);
}

/// Adds framed lattices with holes cut by a texture: one by the path, two between columns of the loggia.
fn lattices(builder: &mut Builder, group: usize) {
    let (w, h) = (0.75, 2.1);
    let sheet = rounded_box([w, h / 2.0 - 0.05, 0.006], 0.002, 1).moved(Vec3::Y * (h / 2.0 + 0.04));
    let bars = [
        ([-w - 0.06, -0.01, -0.035], [-w + 0.02, h + 0.09, 0.035]),
        ([w - 0.02, -0.01, -0.035], [w + 0.06, h + 0.09, 0.035]),
        ([-w + 0.01, 0.04, -0.03], [w - 0.01, 0.12, 0.03]),
        ([-w + 0.01, h - 0.02, -0.03], [w - 0.01, h + 0.06, 0.03]),
    ];
    let frame = bars.into_iter().map(|(low, high)| block(low, high, 0.006)).collect();
    let lattice = builder.solids("lattice", [(sheet, Paint::Lattice, CRISP), (frame, Paint::Timber, CRISP)]);
    for (at, yaw) in [([4.15, 0.0, 1.95], 0.55), ([5.0, 0.45, -6.4], 0.0), ([-3.0, 0.45, -6.4], 0.0)] {
        builder.place(group, lattice, at, yaw);
    }
}

/// Adds clay jars, with and without handles.
fn jars(builder: &mut Builder, group: usize) {
    #[rustfmt::skip]
    let profile = [
        (0.11, -0.005), (0.125, 0.01), (0.12, 0.03), (0.15, 0.10), (0.205, 0.24), (0.232, 0.38), (0.225, 0.48),
        (0.185, 0.58), (0.115, 0.655), (0.085, 0.70), (0.082, 0.76), (0.10, 0.80), (0.125, 0.82), (0.13, 0.84),
        (0.12, 0.852), (0.10, 0.848), (0.075, 0.82), (0.07, 0.74), (0.0, 0.72),
    ];
    let handle = torus(0.075, 0.016, 0.014, 18, 8).posed(Quat::from_rotation_x(TAU / 4.0), [0.15, 0.68, 0.0]);
    let jar = lathe(&profile, 32).with(handle.and_mirrored());
    let jar = builder.solid("jar", &jar, Paint::Clay, 0.9);
    for (at, size, yaw) in [
        ([-1.15, 0.0, -3.9], 1.0, 0.4),
        ([-1.75, 0.0, -4.35], 1.25, 1.3),
        ([-0.95, 0.0, -4.5], 0.8, 2.0),
        ([5.35, 0.45, -5.85], 0.8, 0.2),
        ([7.6, 0.45, -5.9], 1.1, 0.9),
    ] {
        builder.place_sized(group, jar, at, [size; 3], yaw);
    }
}

/// Adds wooden crates by the fence.
fn crates(builder: &mut Builder, group: usize) {
    let half = 0.3;
    let mut boxes = rounded_box([half - 0.02; 3], 0.004, 1);
    for side in [-1.0, 1.0] {
        for other in [-1.0, 1.0] {
            // Bars at the edges. Each direction is a little thicker and nearer than the previous one, so that
            // no faces coincide.
            for (bar, inset, at) in [
                ([0.03, 0.03, half + 0.004], 0.025, [side, other, 0.0]),
                ([half + 0.001, 0.031, 0.031], 0.024, [0.0, side, other]),
                ([0.032, half + 0.002, 0.032], 0.023, [side, 0.0, other]),
            ] {
                boxes = boxes.with(rounded_box(bar, 0.005, 1).moved((half - inset) * Vec3::from(at)));
            }
        }
    }
    let crate_box = boxes.moved(Vec3::Y * (half - 0.005));
    let crate_box = builder.solid("crate", &crate_box, Paint::Timber, CRISP);
    for (at, yaw) in [([3.75, 0.0, -3.7], 0.3), ([3.05, 0.0, -4.15], -0.2), ([3.45, 0.595, -3.9], 0.62)] {
        builder.place(group, crate_box, at, yaw);
    }
}

/// Adds cypresses: a dense row behind the loggia and a few farther away.
fn cypresses(builder: &mut Builder, group: usize) {
    let trunk = lathe(&[(0.13, -0.02), (0.10, 0.8)], 14);
    let crown = cypress(1.75, [0.35, 6.4], 17, 24);
    let tree = builder.solids("cypress", [(crown, Paint::Cypress, SMOOTH), (trunk, Paint::Bark, CRISP)]);
    let row = (0..9).map(|index| Vec3::new(-9.0 + 2.9 * index as f32, 0.0, -12.6 - 0.9 * (index % 2) as f32));
    let far = (0..16).map(|index| {
        let angle = index as f32 / 16.0 * TAU + 0.1;
        Vec3::new(angle.sin(), 0.0, angle.cos()) * (27.0 + 14.0 * hash(index, 3))
    });
    let near = [Vec3::new(11.4, 0.0, -5.2), Vec3::new(-8.9, 0.0, -5.4), Vec3::new(12.0, 0.0, 1.5)];
    for (index, at) in row.chain(far).chain(near).enumerate() {
        let size = 0.85 + 0.4 * hash(index as u32, 9);
        builder.place_sized(group, tree, at, [1.0, size, 1.0], TAU * hash(index as u32, 11));
    }
}

/// Adds low walls at the sides of the court, with coping.
fn low_walls(builder: &mut Builder, group: usize) {
    let wall = pillar([0.16, 2.5], [-0.02, 0.95], 0.01);
    let coping = pillar([0.22, 2.54], [0.93, 1.02], 0.012);
    let wall = builder.solids("low wall", [(wall, Paint::Plaster, CRISP), (coping, Paint::Stone, CRISP)]);
    for index in 0..5 {
        for x in [10.4, -7.6] {
            builder.place(group, wall, [x, 0.0, -8.0 + 5.3 * index as f32], 0.0);
        }
    }
}
