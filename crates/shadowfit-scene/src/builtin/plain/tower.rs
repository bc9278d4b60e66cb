//! The far tower: slender, with a crown of battlements and a pointed roof.

use glam::{Affine3A, Vec3};

use super::land::on_land;
use super::palette::Paint;
use crate::parts::{Builder, CRISP, lathe, plank};

/// Position of the tower along x and z, in metres.
const AT: [f32; 2] = [-7.0, -142.0];
/// Height of the battlements, in metres.
const CROWN: f32 = 24.5;
/// Battlements around the crown.
const MERLONS: usize = 14;

/// Adds the tower.
pub(super) fn build(builder: &mut Builder) {
    #[rustfmt::skip]
    let shaft = [
        (4.6, -2.0), (4.5, 2.2), (3.5, 3.0), (2.75, CROWN - 3.2), (2.85, CROWN - 3.1), (2.85, CROWN - 2.8),
        (3.7, CROWN - 1.2), (3.7, CROWN), (3.3, CROWN), (3.3, CROWN - 0.7),
    ];
    let turret = [(2.0, CROWN - 1.0), (2.0, CROWN + 4.2), (2.15, CROWN + 4.3), (2.15, CROWN + 4.6)];
    let roof = [(2.55, CROWN + 4.4), (2.5, CROWN + 4.7), (0.9, CROWN + 9.0), (0.0, CROWN + 12.5)];
    let merlons = plank([-0.42, CROWN - 0.05, 3.24], [0.42, CROWN + 1.15, 3.66]).around(MERLONS);
    let stone = lathe(&shaft, 28).with(lathe(&turret, 20)).with(merlons);
    let slit = |y: f32, radius: f32| plank([-0.22, y, radius - 0.8], [0.22, y + 1.5, radius + 0.05]);
    let slits = (0..5).map(|index| {
        let y = 5.0 + 3.4 * index as f32;
        slit(y, 3.63 - 0.041 * y).transformed(Affine3A::from_rotation_y(0.4 + 1.1 * index as f32))
    });
    let openings = slits.chain([slit(CROWN + 1.9, 2.0).around(6)]).collect();
    let tower =
        [(stone, Paint::Masonry, CRISP), (lathe(&roof, 20), Paint::Roof, CRISP), (openings, Paint::Dark, CRISP)];
    let tower = builder.solids("tower", tower);
    let group = builder.group("far tower", Vec3::ZERO, 0.0);
    builder.place(group, tower, on_land(AT[0], AT[1]), 0.0);
}
