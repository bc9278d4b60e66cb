//! A lamp post: a foot, a slender shaft that bends over the road toward -x, and a lamp at its end.
//!
//! 20 of its units are one of the street's.

use std::f32::consts::FRAC_PI_2;

use glam::{Affine3A, Quat, Vec3};
use shadowfit_scene::Primitive;
use shadowfit_scene::parts::{SMOOTH, Solid, Stop, lathe, loft, section, stop, sweep};

use super::palette::Paint;

/// Height at which the shaft begins to bend.
const BEND: f32 = 270.0;
/// Radius of the bend, and reach of the arm after it.
const REACH: [f32; 2] = [52.0, 30.0];
/// Steps of the bend.
const STEPS: usize = 14;
/// Radii of the shaft above its foot, and of the arm.
const THICK: [f32; 2] = [7.0, 4.4];

/// Builds the whole post.
pub(super) fn primitive() -> Primitive {
    let foot = [
        (18.0, -1.0),
        (18.5, 6.0),
        (16.5, 9.0),
        (13.5, 12.0),
        (12.0, 40.0),
        (13.5, 43.0),
        (13.0, 47.0),
        (9.5, 52.0),
        (7.5, 60.0),
    ];
    let collar = [(8.8, BEND - 13.0), (10.2, BEND - 10.0), (10.2, BEND - 5.0), (8.6, BEND - 1.0), (5.4, BEND + 4.0)];
    let post = lathe(&foot, 24).with(lathe(&collar, 20)).with(shaft()).with(lamp());
    post.primitive(Paint::LampPost.into(), SMOOTH)
}

/// Builds shaft and arm in one piece.
fn shaft() -> Solid {
    let upright = |y: f32, share: f32| stop(Vec3::Y * y, THICK[0] + (THICK[1] - THICK[0]) * share);
    let mut stops = vec![upright(20.0, 0.0), upright(20.5, 0.0), upright(120.0, 0.3), upright(200.0, 0.6)];
    stops.extend((0..=STEPS).map(|step| {
        let (sin, cos) = (step as f32 / STEPS as f32 * FRAC_PI_2).sin_cos();
        stop(Vec3::new(-REACH[0] * (1.0 - cos), BEND + REACH[0] * sin, 0.0), THICK[1])
    }));
    let end = Vec3::new(-REACH[0] - REACH[1], BEND + REACH[0], 0.0);
    stops.extend([stop(end, THICK[1]), stop(end - Vec3::X * 0.5, THICK[1])]);
    sweep(&stops, Vec3::Z, 16)
}

/// Builds the lamp: a flat drop along the arm, and the lower bowl of its glass.
fn lamp() -> Solid {
    let at = Vec3::new(-REACH[0] - REACH[1] - 2.0, BEND + REACH[0] - 1.5, 0.0);
    let hood = loft(
        &[
            section(-10.0, 5.0, 5.0, 0.0),
            section(8.0, 8.5, 10.0, 0.0),
            section(30.0, 10.0, 14.0, 0.0),
            section(48.0, 8.0, 11.0, 0.0),
        ],
        2.4,
        4,
        24,
    );
    let bowl = sweep(&bowl(), Vec3::Z, 24);
    // The loft's y becomes the direction of the arm, and its x points up.
    let lying = Affine3A::from_rotation_translation(Quat::from_rotation_z(FRAC_PI_2), at);
    hood.transformed(lying).with(bowl.moved(at + Vec3::new(-26.0, -5.0, 0.0)))
}

/// Returns the stops of the bowl below the hood, downwards.
fn bowl() -> Vec<Stop> {
    let ring = |y: f32, size: f32| Stop { at: Vec3::Y * y, half: [9.5 * size, 17.0 * size] };
    vec![
        ring(0.0, 1.0),
        ring(-0.5, 1.0),
        ring(-4.0, 0.97),
        ring(-7.0, 0.84),
        ring(-9.0, 0.55),
        ring(-9.6, 0.2),
        ring(-9.8, 0.0),
    ]
}
