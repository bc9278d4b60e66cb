//! The wheels of the car: tyres, and hubs of five spokes.

use std::f32::consts::FRAC_PI_2;

use glam::{Affine3A, Quat, Vec3};
use shadowfit_scene::parts::{Solid, block, lathe, torus};

use super::body::{AXLES, HALF_WIDTH, WHEEL};

/// Half of a wheel's width.
const HALF: f32 = 0.10;
/// Radius of the rim, inside the tyre.
const RIM: f32 = 0.158;
/// Number of spokes.
const SPOKES: usize = 5;

/// Builds four tyres with the dark discs behind the spokes.
pub(super) fn tyres() -> Solid {
    let bead = [(RIM, -HALF + 0.02), (RIM + 0.01, -HALF), (0.215, -HALF)];
    let tread = [(0.243, -HALF + 0.014), (WHEEL, -HALF + 0.04), (WHEEL, HALF - 0.04), (0.243, HALF - 0.014)];
    let outside = [(0.215, HALF), (RIM + 0.01, HALF), (RIM - 0.005, HALF - 0.05)];
    on_axles(&lathe(&[&bead[..], &tread, &outside].concat(), 36))
}

/// Builds four hubs.
pub(super) fn hubs() -> Solid {
    let cap = lathe(&[(0.05, 0.03), (0.048, 0.078), (0.036, 0.09), (0.0, 0.095)], 20);
    let rim = torus(RIM, 0.014, 0.02, 36, 8).moved(Vec3::Y * (HALF - 0.008));
    let spoke = block([-0.022, 0.045, 0.036], [0.022, 0.078, RIM], 0.008);
    on_axles(&cap.with(rim).with(spoke.around(SPOKES)))
}

/// Places a wheel, whose outer side faces +y, at the four positions of the car.
fn on_axles(wheel: &Solid) -> Solid {
    let turn = Quat::from_rotation_z(-FRAC_PI_2);
    let place = |z: f32| {
        let at = Vec3::new(HALF_WIDTH - HALF - 0.012, WHEEL, z);
        wheel.clone().transformed(Affine3A::from_rotation_translation(turn, at))
    };
    AXLES.into_iter().map(place).collect::<Solid>().and_mirrored()
}
