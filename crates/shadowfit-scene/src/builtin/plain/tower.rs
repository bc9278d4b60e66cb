//! The far tower: slender, with a crown of battlements and a pointed roof.

use std::f32::consts::TAU;

use glam::{Affine3A, Vec3};

use super::land::on_land;
use super::palette::Paint;
use crate::builtin::build::{Builder, CRISP};
use crate::builtin::shapes::{lathe, plank};
use crate::builtin::solid::Solid;

/// Where the tower stands, along x and z in metres.
const AT: [f32; 2] = [-7.0, -142.0];
/// Height of the battlements, in metres.
const CROWN: f32 = 24.5;
/// Battlements around the crown.
const MERLONS: usize = 14;

/// Adds the tower.
pub(super) fn build(builder: &mut Builder) {
    let shaft = [
        (4.6, -2.0),
        (4.5, 2.2),
        (3.5, 3.0),
        (2.75, CROWN - 3.2),
        (2.85, CROWN - 3.1),
        (2.85, CROWN - 2.8),
        (3.7, CROWN - 1.2),
        (3.7, CROWN),
        (3.3, CROWN),
        (3.3, CROWN - 0.7),
    ];
    let turret = [(2.0, CROWN - 1.0), (2.0, CROWN + 4.2), (2.15, CROWN + 4.3), (2.15, CROWN + 4.6)];
    let roof = [(2.55, CROWN + 4.4), (2.5, CROWN + 4.7), (0.9, CROWN + 9.0), (0.0, CROWN + 12.5)];
    let around = |solid: &Solid, turn: f32| solid.clone().transformed(Affine3A::from_rotation_y(turn));
    let merlon = plank(Vec3::new(-0.42, CROWN - 0.05, 3.24), Vec3::new(0.42, CROWN + 1.15, 3.66));
    let merlons = (0..MERLONS).map(|index| around(&merlon, index as f32 / MERLONS as f32 * TAU));
    let stone = lathe(&shaft, 28).with(lathe(&turret, 20)).with(merlons.reduce(Solid::with).unwrap_or_default());
    let slit = |y: f32, radius: f32| plank(Vec3::new(-0.22, y, radius - 0.8), Vec3::new(0.22, y + 1.5, radius + 0.05));
    let slits = (0..5).map(|index| {
        let y = 5.0 + 3.4 * index as f32;
        around(&slit(y, 3.63 - 0.041 * y), 0.4 + 1.1 * index as f32)
    });
    let windows = (0..6).map(|index| around(&slit(CROWN + 1.9, 2.0), index as f32 / 6.0 * TAU));
    let primitives = vec![
        stone.primitive(Paint::Masonry.into(), CRISP),
        lathe(&roof, 20).primitive(Paint::Roof.into(), CRISP),
        slits.chain(windows).reduce(Solid::with).unwrap_or_default().primitive(Paint::Dark.into(), CRISP),
    ];
    let tower = builder.mesh("tower", primitives);
    let group = builder.group("far tower", Vec3::ZERO, 0.0);
    builder.place(group, tower, on_land(AT[0], AT[1]), 0.0);
}
