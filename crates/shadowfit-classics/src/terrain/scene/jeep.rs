//! The jeep: a boxy open body between mudguards, a windscreen frame, a roll bar, a spare wheel behind.
//!
//! Its rear axle is at z = 0, the point about which such a vehicle turns.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Affine3A, Quat, Vec3};
use shadowfit_scene::parts::{CRISP, SMOOTH, block, capsule, lathe, plank, rounded_box, torus, wall_over};

use super::palette::Paint;
use super::parts::{Parts, Wheel, bent_sheet, rect, sideways, wedge};

/// All wheels, including the spare one.
const WHEEL: Wheel = Wheel { radius: 0.92, rim: 0.5, half: 0.31, lugs: 16, lug: 0.06, slant: 0.45 };
/// Distance of the wheels' middle from the body's middle.
const TRACK: f32 = 1.5;
/// Front axle.
const FRONT: f32 = 4.95;

/// Builds all parts.
pub(super) fn parts() -> Parts {
    let mut parts = Parts::default();
    for (side, z) in [(TRACK, 0.0), (-TRACK, 0.0), (TRACK, FRONT), (-TRACK, FRONT)] {
        WHEEL.add(&mut parts, Paint::Sand, Vec3::new(side, WHEEL.radius, z));
    }
    WHEEL.add_turned(&mut parts, Paint::Sand, Vec3::new(0.25, 1.95, -1.98), Quat::from_rotation_y(PI));
    frame(&mut parts);
    tub(&mut parts);
    front(&mut parts);
    mudguards(&mut parts);
    above(&mut parts);
    seats(&mut parts);
    parts
}

/// Adds axles, rails and bumpers.
fn frame(parts: &mut Parts) {
    let rail = |x: f32| block([x - 0.09, 0.86, -1.6], [x + 0.09, 1.08, 6.5], 0.03);
    let axle = |z: f32| {
        let end = Vec3::new(TRACK, WHEEL.radius, z);
        capsule(end * Vec3::new(-1.0, 1.0, 1.0), 0.11, end, 0.11, 12)
    };
    let bumper = block([-1.5, 0.92, 6.48], [1.5, 1.2, 6.7], 0.05);
    let rear = block([-1.2, 0.9, -1.72], [1.2, 1.06, -1.5], 0.04);
    let solids = [rail(0.62), rail(-0.62), axle(0.0), axle(FRONT), bumper, rear];
    parts.add(Paint::Dark, CRISP, solids.into_iter().collect());
}

/// Adds floor, sides with a low entry, tailboard and dashboard.
fn tub(parts: &mut Parts) {
    // Upper edge of a side, from the rear. The wall is built upside down, then flipped.
    let edge = [(-1.5, 2.2), (0.85, 2.2), (1.05, 2.05), (1.2, 1.55), (2.35, 1.5), (2.6, 1.7), (2.8, 2.25), (3.3, 2.3)];
    let over: Vec<_> = edge.iter().map(|&(z, y)| (z, -y)).collect();
    let side = wall_over(&over, -0.98, 0.09).transformed(Affine3A::from_scale(Vec3::new(1.0, -1.0, 1.0)));
    let side = sideways(side).moved(Vec3::X * 1.14);
    let floor = block([-1.12, 1.04, -1.46], [1.12, 1.14, 3.2], 0.03);
    let tailboard = block([-1.12, 1.06, -1.52], [1.12, 2.16, -1.43], 0.03);
    let dashboard = block([-1.1, 1.8, 2.9], [1.1, 2.26, 3.24], 0.05);
    let firewall = plank([-1.1, 1.08, 3.15], [1.1, 1.9, 3.22]);
    let box_sides = |side: f32| block([-0.3, 1.1, -1.44], [0.3, 1.92, 0.82], 0.03).moved(Vec3::X * side * 0.82);
    parts.add(Paint::Sand, CRISP, side.and_mirrored().with(floor).with(tailboard).with(dashboard));
    parts.add(Paint::Sand, CRISP, firewall.with(box_sides(1.0)).with(box_sides(-1.0)));
    let lamp = block([-0.1, 1.3, -1.56], [0.1, 1.48, -1.48], 0.02);
    parts.add(Paint::Red, CRISP, lamp.moved(Vec3::X * 0.95).and_mirrored());
    let can = block([-0.95, 1.35, -1.82], [-0.58, 2.0, -1.54], 0.05);
    parts.add(Paint::Tan, CRISP, can);
}

/// Adds bonnet, grille and headlights.
fn front(parts: &mut Parts) {
    let hood = wedge(rect(1.06, [1.2, 2.28], 3.26), rect(0.92, [1.2, 2.12], 6.2));
    let ridge = wedge(rect(0.5, [2.2, 2.36], 3.28), rect(0.42, [2.05, 2.2], 6.1));
    let grille = block([-1.04, 1.06, 6.14], [1.04, 2.18, 6.32], 0.06);
    parts.add(Paint::Sand, CRISP, hood.with(ridge).with(grille));
    let slot = |index: usize| {
        let x = (index as f32 - 3.0) * 0.145;
        plank([x - 0.042, 1.28, 6.2], [x + 0.042, 2.0, 6.335])
    };
    parts.add(Paint::Dark, CRISP, (0..7).map(slot).collect());
    let ahead = Affine3A::from_rotation_translation(Quat::from_rotation_x(FRAC_PI_2), Vec3::new(0.76, 1.74, 6.25));
    let ring = lathe(&[(0.24, 0.0), (0.25, 0.12), (0.21, 0.15)], 24).transformed(ahead);
    let glass = lathe(&[(0.19, 0.1), (0.19, 0.17), (0.12, 0.21)], 24).transformed(ahead);
    parts.add(Paint::Dark, CRISP, ring.and_mirrored());
    parts.add(Paint::Lamp, CRISP, glass.and_mirrored());
    let wheel = lathe(&[(0.07, 0.0), (0.07, 0.06)], 10);
    let catches = wheel.moved([1.02, 1.95, 4.2]).and_mirrored();
    parts.add(Paint::Steel, CRISP, catches);
}

/// Adds sheets over all wheels.
fn mudguards(parts: &mut Parts) {
    let ahead = [(3.3, 1.15), (3.75, 1.95), (4.0, 2.02), (5.85, 2.02), (6.15, 1.9), (6.3, 1.6)];
    let behind = [(-1.3, 1.35), (-0.95, 1.9), (-0.75, 1.98), (0.75, 1.98), (0.95, 1.9), (1.3, 1.3)];
    let ahead = bent_sheet(&ahead, 0.07, 0.86).moved(Vec3::X * 1.42);
    let behind = bent_sheet(&behind, 0.07, 0.7).moved(Vec3::X * 1.5);
    parts.add(Paint::Sand, CRISP, ahead.and_mirrored().with(behind.and_mirrored()));
}

/// Adds windscreen frame, roll bar and mirrors.
fn above(parts: &mut Parts) {
    let bar = |low: Vec3, high: Vec3| block(low, high, 0.03);
    let posts = bar(Vec3::new(1.0, 0.0, -0.05), Vec3::new(1.12, 1.25, 0.05)).and_mirrored();
    let bars = bar(Vec3::new(-1.06, 1.14, -0.055), Vec3::new(1.06, 1.28, 0.055));
    let sill = bar(Vec3::new(-1.06, 0.02, -0.045), Vec3::new(1.06, 0.14, 0.045));
    let middle = bar(Vec3::new(-0.04, 0.1, -0.04), Vec3::new(0.04, 1.2, 0.04));
    let lean = Affine3A::from_rotation_translation(Quat::from_rotation_x(-0.16), Vec3::new(0.0, 2.2, 3.12));
    parts.add(Paint::Sand, CRISP, posts.with(bars).with(sill).with(middle).transformed(lean));
    let tube = |a: [f32; 3], b: [f32; 3]| capsule(Vec3::from(a), 0.075, Vec3::from(b), 0.075, 12);
    let legs = tube([1.0, 1.2, 0.72], [0.94, 3.45, 0.72]).with(tube([0.92, 3.42, 0.72], [0.95, 2.0, -1.2]));
    let top = tube([-0.94, 3.45, 0.72], [0.94, 3.45, 0.72]);
    parts.add(Paint::Dark, SMOOTH, legs.and_mirrored().with(top));
    let arm = capsule([1.1, 2.35, 3.05], 0.025, [1.42, 2.62, 3.1], 0.025, 8);
    let mirror = block([1.3, 2.55, 3.06], [1.6, 2.9, 3.12], 0.02);
    parts.add(Paint::Dark, SMOOTH, arm.with(mirror).and_mirrored());
}

/// Adds two seats, a bench behind them, and the steering wheel.
fn seats(parts: &mut Parts) {
    let seat = |x: f32, z: f32, half: f32| {
        let cushion = rounded_box([half, 0.13, 0.36], 0.08, 2).moved([x, 1.5, z]);
        let lean = Affine3A::from_rotation_translation(Quat::from_rotation_x(-0.18), Vec3::new(x, 1.95, z - 0.42));
        cushion.with(rounded_box([half, 0.48, 0.1], 0.08, 2).transformed(lean))
    };
    parts.add(Paint::Tan, CRISP, seat(0.55, 1.75, 0.4).with(seat(-0.55, 1.75, 0.4)).with(seat(0.0, -0.55, 0.48)));
    let tilt = Affine3A::from_rotation_translation(Quat::from_rotation_x(-0.9), Vec3::new(0.55, 2.3, 2.55));
    let spokes = plank([-0.3, -0.015, -0.035], [0.3, 0.015, 0.035]);
    let wheel = torus(0.31, 0.03, 0.03, 26, 8).with(spokes).transformed(tilt);
    let column = capsule([0.55, 2.29, 2.56], 0.04, [0.55, 1.95, 3.0], 0.04, 10);
    parts.add(Paint::Dark, SMOOTH, wheel.with(column));
}
