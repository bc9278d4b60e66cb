//! The helicopter: a bubble of dark glass, a boom with fin and tail rotor, four thin blades on a mast, skids.
//!
//! The mast is at z = 0, the axis of the blades.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::{Affine3A, Quat, Vec3};
use shadowfit_scene::parts::{
    CRISP, SMOOTH, Solid, block, capsule, ellipsoid, lathe, loft, plank, rounded_box, section, torus,
};

use super::palette::Paint;
use super::parts::{Parts, rect, wedge};

/// Height of the main rotor.
const ROTOR: f32 = 5.8;
/// Length of its blades from the mast: about the length of the boom, as on light helicopters.
const BLADE: f32 = 7.1;
/// Angle of the first blade from straight ahead, in radians, so that one blade's shadow falls on the jeep.
const BLADE_TURN: f32 = 1.466;
/// Distance from the mast to the middle between nose and tail.
pub(super) const MIDDLE: f32 = 2.2;
/// End of the tail boom.
const TAIL: Vec3 = Vec3::new(0.0, 3.2, -6.9);

/// Builds all parts.
pub(super) fn parts() -> Parts {
    let mut parts = Parts::default();
    cabin(&mut parts);
    engine(&mut parts);
    tail(&mut parts);
    rotor(&mut parts);
    skids(&mut parts);
    parts
}

/// Builds a loft along +z instead of +y: `section(z, half width, half height, height of the centre)`.
fn along_z(sections: &[(f32, f32, f32, f32)], power: f32) -> Solid {
    let sections: Vec<_> = sections.iter().map(|&(z, rx, ry, y)| section(z, rx, ry, -y)).collect();
    loft(&sections, power, 4, 36).transformed(Affine3A::from_rotation_x(FRAC_PI_2))
}

/// Adds the bubble, the belly below it, and the frame of its panes.
fn cabin(parts: &mut Parts) {
    let bubble = [(-0.2, 1.3, 1.35, 2.45), (0.9, 1.36, 1.36, 2.42), (2.0, 1.16, 1.1, 2.28), (2.7, 0.72, 0.68, 2.1)];
    parts.add(Paint::Glass, SMOOTH, along_z(&bubble, 2.2));
    let belly = [
        (-1.9, 0.62, 0.62, 2.45),
        (-1.2, 1.0, 0.98, 2.2),
        (-0.2, 1.28, 1.1, 1.98),
        (0.9, 1.34, 0.98, 1.8),
        (2.0, 1.12, 0.76, 1.7),
        (2.75, 0.66, 0.42, 1.68),
    ];
    parts.add(Paint::Blue, SMOOTH, along_z(&belly, 2.3));
    let rear = [(-1.9, 0.7, 0.75, 2.8), (-1.0, 1.18, 1.2, 2.55), (-0.1, 1.36, 1.42, 2.45)];
    parts.add(Paint::Blue, SMOOTH, along_z(&rear, 2.3));
    // Ribs protrude slightly from the glass.
    let rib = |z: f32, rx: f32, ry: f32, y: f32| {
        let scale = Affine3A::from_scale(Vec3::new(rx, 1.0, ry));
        let ring = torus(1.0, 0.04, 0.07, 48, 8).transformed(scale);
        ring.transformed(Affine3A::from_rotation_x(FRAC_PI_2)).moved([0.0, y, z])
    };
    parts.add(Paint::Pale, SMOOTH, rib(1.05, 1.36, 1.36, 2.40));
    let keel: Vec<Vec3> = [(0.0, 3.86), (0.9, 3.82), (1.6, 3.63), (2.2, 3.27), (2.75, 2.74), (2.98, 2.3)]
        .map(|(z, y)| Vec3::new(0.0, y, z))
        .to_vec();
    let pane = keel.windows(2).map(|pair| capsule(pair[0], 0.07, pair[1], 0.07, 10)).reduce(Solid::with);
    parts.add(Paint::Pale, SMOOTH, pane.unwrap_or_default());
    let lamp = ellipsoid([0.17, 0.17, 0.12], 18, 8).moved([0.0, 1.42, 3.0]);
    parts.add(Paint::Lamp, SMOOTH, lamp);
}

/// Adds the engine's cowling behind and above the cabin, its exhausts, and the mast.
fn engine(parts: &mut Parts) {
    let cowling =
        [(-1.9, 0.45, 0.42, 3.45), (-1.0, 0.68, 0.58, 3.72), (0.1, 0.62, 0.56, 3.82), (0.7, 0.34, 0.28, 3.82)];
    parts.add(Paint::Blue, SMOOTH, along_z(&cowling, 2.5));
    let intake = block([0.5, 3.5, -0.75], [0.8, 4.0, 0.05], 0.06).and_mirrored();
    let exhaust = capsule([0.4, 3.6, -1.5], 0.17, [0.62, 3.82, -2.2], 0.19, 14).and_mirrored();
    parts.add(Paint::Dark, CRISP, intake.with(exhaust));
    let mast = lathe(&[(0.34, 4.2), (0.2, 4.55), (0.1, 4.7), (0.1, ROTOR + 0.1)], 18);
    let plate = lathe(&[(0.3, 5.0), (0.34, 5.04), (0.34, 5.12), (0.3, 5.16)], 20);
    parts.add(Paint::Steel, CRISP, mast.with(plate));
}

/// Adds boom, fin, stabiliser and tail rotor.
fn tail(parts: &mut Parts) {
    let boom = [(TAIL.z, 0.17, 0.19, TAIL.y), (-4.0, 0.28, 0.31, 3.02), (-1.6, 0.5, 0.56, 2.82)];
    parts.add(Paint::Blue, SMOOTH, along_z(&boom, 2.0));
    let band = lathe(&[(0.245, 0.0), (0.252, 0.02), (0.278, 0.5), (0.27, 0.52)], 28);
    let lie = Affine3A::from_rotation_translation(Quat::from_rotation_x(FRAC_PI_2 + 0.07), Vec3::new(0.0, 3.12, -5.2));
    parts.add(Paint::Pale, CRISP, band.transformed(lie));
    // Modelled lying along z, then rotated up: z becomes up, and y points to the rear.
    let upright = Affine3A::from_rotation_x(-FRAC_PI_2);
    let fin = wedge(rect(0.09, [6.2, 7.35], 3.15), rect(0.05, [7.15, 7.85], 4.85));
    let lower = wedge(rect(0.05, [6.95, 7.5], 2.0), rect(0.08, [6.35, 7.3], 3.2));
    parts.add(Paint::Blue, CRISP, fin.with(lower).transformed(upright));
    let tip = wedge(rect(0.07, [6.98, 7.82], 4.45), rect(0.065, [7.12, 7.9], 4.9));
    parts.add(Paint::Pale, CRISP, tip.transformed(upright));
    let stabiliser = rounded_box([1.25, 0.045, 0.32], 0.04, 2).moved([0.0, 3.16, -5.75]);
    let plates = block([1.2, 2.95, -6.1], [1.27, 3.45, -5.45], 0.03).and_mirrored();
    parts.add(Paint::Pale, CRISP, stabiliser.with(plates));
    let blade = plank([-0.02, 0.12, -0.09], [0.02, 1.15, 0.09]);
    let hub = capsule([-0.45, 0.0, 0.0], 0.09, [0.06, 0.0, 0.0], 0.11, 12);
    let spin = |quarter: usize| blade.clone().transformed(Affine3A::from_rotation_x(0.5 + TAU / 4.0 * quarter as f32));
    let rotor = (0..4).map(spin).fold(hub, Solid::with).moved([0.42, 3.78, -7.1]);
    parts.add(Paint::Dark, CRISP, rotor);
}

/// Adds four thin blades and their hub.
fn rotor(parts: &mut Parts) {
    // Modelled along +z.
    let blade = wedge(rect(0.2, [-0.03, 0.03], 0.55), rect(0.2, [-0.03, 0.01], BLADE));
    let grip = capsule(Vec3::ZERO, 0.11, [0.0, 0.0, 0.75], 0.09, 10);
    let end = wedge(rect(0.205, [-0.036, 0.018], BLADE - 0.75), rect(0.205, [-0.036, 0.018], BLADE + 0.01));
    let turned = |solid: &Solid| {
        let turn = |quarter: usize| Affine3A::from_rotation_y(BLADE_TURN + TAU / 4.0 * quarter as f32);
        let all = (0..4).map(|quarter| solid.clone().transformed(turn(quarter))).reduce(Solid::with);
        all.unwrap_or_default().moved(Vec3::Y * ROTOR)
    };
    parts.add(Paint::Dark, CRISP, turned(&blade).with(turned(&grip)));
    parts.add(Paint::Yellow, CRISP, turned(&end));
    let hub = ellipsoid([0.26, 0.17, 0.26], 20, 10).moved(Vec3::Y * (ROTOR + 0.02));
    parts.add(Paint::Steel, CRISP, hub);
}

/// Adds two skids with turned-up ends, on bent legs.
fn skids(parts: &mut Parts) {
    let tube = |a: [f32; 3], b: [f32; 3], radius: f32| capsule(Vec3::from(a), radius, Vec3::from(b), radius, 12);
    let mut skid = tube([1.45, 0.1, -2.1], [1.45, 0.1, 2.4], 0.1)
        .with(tube([1.45, 0.1, 2.4], [1.45, 0.28, 2.95], 0.1))
        .with(tube([1.45, 0.28, 2.95], [1.45, 0.62, 3.2], 0.1));
    for z in [-1.15, 1.35] {
        skid = skid.with(tube([1.45, 0.12, z], [1.2, 0.75, z], 0.085)).with(tube([1.2, 0.75, z], [0.5, 1.2, z], 0.085));
    }
    parts.add(Paint::Steel, SMOOTH, skid.and_mirrored());
}
