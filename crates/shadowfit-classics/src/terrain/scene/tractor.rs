//! The tractor: large ribbed rear wheels, small front wheels, a bonnet with its grille, an open cabin.

use glam::{Affine3A, Quat, Vec2, Vec3};
use shadowfit_scene::parts::{CRISP, SMOOTH, block, capsule, lathe, plank, rounded_box, torus};

use super::palette::Paint;
use super::parts::{Parts, Wheel, arc, bent_sheet, rect, wedge};

/// Rear wheels.
const REAR: Wheel = Wheel { radius: 1.72, rim: 0.95, half: 0.46, lugs: 15, lug: 0.11, slant: 0.65 };
/// Front wheels.
const FRONT: Wheel = Wheel { radius: 0.98, rim: 0.55, half: 0.29, lugs: 13, lug: 0.07, slant: 0.6 };
/// Centre of the left rear wheel.
const REAR_AT: Vec3 = Vec3::new(1.52, REAR.radius, -1.65);
/// Centre of the left front wheel.
const FRONT_AT: Vec3 = Vec3::new(1.22, FRONT.radius, 2.62);

/// Builds all parts.
pub(super) fn parts() -> Parts {
    let mut parts = Parts::default();
    for side in [1.0, -1.0] {
        let mirror = Vec3::new(side, 1.0, 1.0);
        REAR.add(&mut parts, Paint::Yellow, REAR_AT * mirror);
        FRONT.add(&mut parts, Paint::Yellow, FRONT_AT * mirror);
    }
    frame(&mut parts);
    bonnet(&mut parts);
    cabin(&mut parts);
    driver(&mut parts);
    parts
}

/// Adds the frame: gearbox, axles, front weights, a drawbar at the rear.
fn frame(parts: &mut Parts) {
    let gearbox = block([-0.5, 1.12, -2.25], [0.5, 1.95, 0.6], 0.08);
    let engine = block([-0.38, 1.02, 0.4], [0.38, 1.75, 3.1], 0.06);
    let [rear, front] =
        [(REAR_AT, 0.26), (FRONT_AT, 0.15)].map(|(at, thick)| capsule([-at.x, at.y, at.z], thick, at, thick, 16));
    let drawbar = block([-0.13, 0.82, -2.95], [0.13, 0.98, -1.9], 0.03);
    parts.add(Paint::Dark, CRISP, gearbox.with(engine).with(rear).with(front).with(drawbar));
    let mut weights = block([-0.5, 1.08, 3.32], [0.5, 1.2, 3.5], 0.03);
    for index in 0..5 {
        let x = (index as f32 - 2.0) * 0.22;
        weights = weights.with(block([x - 0.09, 0.82, 3.4], [x + 0.09, 1.42, 3.86], 0.04));
    }
    parts.add(Paint::Dark, CRISP, weights);
    let tank = block([0.56, 1.0, -0.1], [1.02, 1.62, 0.95], 0.1);
    let steps = plank([-1.12, 0.78, -0.02], [-0.66, 0.84, 0.55])
        .with(plank([-1.12, 1.28, 0.0], [-0.66, 1.34, 0.52]))
        .with(plank([-0.72, 0.76, 0.02], [-0.67, 1.9, 0.1]))
        .with(plank([-0.73, 0.76, 0.42], [-0.68, 1.9, 0.5]));
    parts.add(Paint::Dark, CRISP, tank.with(steps));
}

/// Adds the bonnet, its grille and lamps, and the exhaust pipe.
fn bonnet(parts: &mut Parts) {
    let hood = wedge(rect(0.74, [1.74, 2.92], 0.35), rect(0.64, [1.68, 2.66], 3.42));
    let ridge = wedge(rect(0.40, [2.86, 3.04], 0.4), rect(0.34, [2.6, 2.77], 3.36));
    parts.add(Paint::Red, CRISP, hood.with(ridge));
    let band = |side: f32| {
        let low = Vec3::new(side * 0.71 - 0.03, 2.28, 0.62);
        plank(low, low + Vec3::new(0.06, 0.14, 2.2))
    };
    parts.add(Paint::Cream, CRISP, band(1.0).with(band(-1.0)));
    let grille = plank([-0.52, 1.8, 3.3], [0.52, 2.5, 3.47]);
    parts.add(Paint::Dark, CRISP, grille);
    let mut bars = plank([-0.05, 1.76, 3.3], [0.05, 2.56, 3.53]);
    for index in 0..6 {
        let y = 1.84 + 0.125 * index as f32;
        bars = bars.with(plank([-0.54, y - 0.02, 3.32], [0.54, y + 0.02, 3.505]));
    }
    parts.add(Paint::Steel, CRISP, bars);
    for x in [-0.8, 0.8] {
        let bracket = plank([x - 0.22, 2.2, 2.95], [x + 0.22, 2.27, 3.05]);
        let bowl = lathe(&[(0.08, 0.0), (0.2, 0.16), (0.21, 0.24)], 20);
        let glass = lathe(&[(0.17, 0.2), (0.17, 0.26), (0.1, 0.29)], 20);
        let ahead = Affine3A::from_rotation_translation(
            Quat::from_rotation_x(std::f32::consts::FRAC_PI_2),
            Vec3::new(x * 1.12, 2.3, 2.98),
        );
        parts.add(Paint::Dark, CRISP, bracket.with(bowl.transformed(ahead)));
        parts.add(Paint::Lamp, CRISP, glass.transformed(ahead));
    }
    let pipe =
        [(0.10, 0.0), (0.10, 0.3), (0.2, 0.36), (0.2, 1.1), (0.11, 1.2), (0.11, 2.05), (0.085, 2.05), (0.085, 1.9)];
    let lid = plank([-0.12, 0.0, -0.14], [0.12, 0.03, 0.14])
        .transformed(Affine3A::from_rotation_translation(Quat::from_rotation_x(0.6), Vec3::new(0.0, 2.16, 0.04)));
    parts.add(Paint::Steel, CRISP, lathe(&pipe, 20).with(lid).moved([-0.42, 2.72, 1.75]));
    let cleaner = lathe(&[(0.09, 0.0), (0.09, 0.35), (0.2, 0.4), (0.2, 0.62), (0.12, 0.7)], 18);
    parts.add(Paint::Dark, CRISP, cleaner.moved([0.4, 2.72, 1.2]));
}

/// Adds platform, mudguards, four posts and the roof.
fn cabin(parts: &mut Parts) {
    let platform = block([-1.0, 1.86, -2.3], [1.0, 2.02, 0.42], 0.04);
    let board = block([-0.82, 1.95, 0.12], [0.82, 3.05, 0.4], 0.08);
    parts.add(Paint::Red, CRISP, platform.with(board));
    for side in [1.0, -1.0] {
        let line = arc(Vec2::new(REAR_AT.z, REAR_AT.y), REAR.radius + 0.13, 0.35..2.5, 16);
        let guard = bent_sheet(&line, 0.07, 0.98).moved(Vec3::X * side * 1.5);
        let wall = block([-0.035, 1.9, -2.95], [0.035, 3.05, -0.35], 0.03);
        parts.add(Paint::Red, CRISP, guard.with(wall.moved(Vec3::X * side * 1.01)));
        let lamp = block([-0.16, 0.0, -0.06], [0.16, 0.22, 0.06], 0.03);
        parts.add(Paint::Lamp, CRISP, lamp.moved([side * 1.55, 3.56, -1.2]));
    }
    for x in [-0.93, 0.93] {
        let posts = [(0.26, 0.12, 2.0), (-2.16, -1.98, 1.95)]
            .map(|(foot, head, low)| capsule([x, low, foot], 0.065, [x * 0.97, 4.6, head], 0.065, 10));
        let rail = capsule([x, 3.55, -2.08], 0.05, [x, 3.05, -0.6], 0.05, 10);
        for solid in posts.into_iter().chain([rail]) {
            parts.add(Paint::Dark, SMOOTH, solid);
        }
    }
    let roof = rounded_box([1.22, 0.12, 1.48], 0.1, 2).moved([0.0, 4.66, -0.92]);
    let crown = rounded_box([0.95, 0.1, 1.15], 0.09, 2).moved([0.0, 4.76, -0.92]);
    parts.add(Paint::Cream, CRISP, roof.with(crown));
    let beacon = lathe(&[(0.11, 0.0), (0.11, 0.14), (0.06, 0.2)], 14).moved([0.7, 4.82, -1.8]);
    parts.add(Paint::Yellow, CRISP, beacon);
}

/// Adds seat and steering wheel.
fn driver(parts: &mut Parts) {
    let stand = block([-0.22, 1.95, -1.55], [0.22, 2.4, -1.05], 0.04);
    parts.add(Paint::Dark, CRISP, stand);
    let cushion = rounded_box([0.44, 0.1, 0.4], 0.08, 2).moved([0.0, 2.48, -1.3]);
    let back = rounded_box([0.44, 0.48, 0.09], 0.08, 2)
        .transformed(Affine3A::from_rotation_translation(Quat::from_rotation_x(-0.15), Vec3::new(0.0, 2.98, -1.72)));
    parts.add(Paint::Seat, CRISP, cushion.with(back));
    let tilt = Affine3A::from_rotation_translation(Quat::from_rotation_x(-0.65), Vec3::new(0.0, 3.28, -0.42));
    let spokes = plank([-0.36, -0.02, -0.04], [0.36, 0.02, 0.04]);
    let wheel = torus(0.37, 0.035, 0.035, 28, 8).with(spokes).transformed(tilt);
    let column = capsule([0.0, 3.26, -0.4], 0.05, [0.0, 2.6, 0.2], 0.06, 10);
    parts.add(Paint::Dark, SMOOTH, wheel.with(column));
}
