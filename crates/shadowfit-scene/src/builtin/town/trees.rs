//! Lime trees with cut-out leaves, on the square, in the garden and beside the church.

use std::f32::consts::TAU;

use glam::{Quat, Vec3};

use super::palette::Paint;
use super::plan::NORTH;
use crate::Primitive;
use crate::parts::{Builder, Card, Cards, Dice, GOLDEN_ANGLE, Limbs};

/// Height of the crown's middle, in metres.
const MIDDLE: f32 = 4.6;
/// Half axes of the crown, in metres.
const CROWN: Vec3 = Vec3::new(2.0, 2.1, 2.0);
/// Boughs of a tree.
const BOUGHS: usize = 7;
/// Sprays of leaves of a tree.
const SPRAYS: usize = 240;
/// Places along x and z, and sizes.
const PLACES: [(f32, f32, f32); 9] = [
    (13.5, -30.5, 1.0),
    (13.6, 0.5, 1.05),
    (13.4, 8.0, 0.95),
    (-7.9, NORTH - 3.6, 0.9),
    (-3.0 - 14.6, NORTH + 4.5, 1.1),
    (-7.4, -74.0, 1.2),
    (-8.4, 17.2, 1.08),
    (-14.8, 15.8, 0.95),
    (-9.6, 23.4, 1.0),
];

/// Adds the trees.
pub(super) fn build(builder: &mut Builder) {
    let group = builder.group("trees", Vec3::ZERO, 0.0);
    let shapes = [61, 62].map(|seed| {
        let tree = tree(seed);
        builder.mesh("lime tree", tree)
    });
    for (index, (x, z, size)) in PLACES.into_iter().enumerate() {
        builder.place_sized(group, shapes[index % 2], [x, 0.0, z], [size; 3], 1.9 * index as f32);
    }
}

/// Builds a tree: trunk, boughs, and sprays of leaves through the crown.
fn tree(seed: u32) -> Vec<Primitive> {
    let mut dice = Dice::new(seed);
    let mut limbs = Limbs::default();
    let lean = dice.between(-0.2, 0.2);
    let trunk =
        [-0.1, 0.0, 0.15, 0.6, 1.8, 3.2, 5.4].map(|y: f32| Vec3::new(lean * (0.6 * y).sin(), y, 0.1 * lean * y));
    limbs.add(&trunk, 10, |turn, t| {
        0.17 * (1.0 - 0.8 * t) + 0.09 * (1.0 - 6.0 * t).max(0.0) * (1.0 + 0.3 * (5.0 * turn).cos())
    });
    for index in 0..BOUGHS {
        let turn = index as f32 * GOLDEN_ANGLE;
        let from = trunk[4].lerp(trunk[6], index as f32 / BOUGHS as f32 * 0.8);
        let out = Vec3::new(turn.sin(), 0.75, turn.cos()).normalize();
        let reach = dice.between(1.5, 2.0) * (1.0 - 0.4 * index as f32 / BOUGHS as f32);
        let path = [from, from + out * reach * 0.5 + Vec3::Y * 0.12, from + out * reach];
        limbs.add(&path, 5, |_, t| 0.055 * (1.0 - 0.8 * t));
    }
    let mut cards = Cards::new(Paint::Leaves, 1);
    for index in 0..SPRAYS {
        let height = 1.0 - 2.0 * (index as f32 + 0.5) / SPRAYS as f32;
        let turn = index as f32 * GOLDEN_ANGLE * 1.7;
        let flat = (1.0 - height * height).sqrt();
        let out = Vec3::new(turn.sin() * flat, height, turn.cos() * flat);
        let lumps = 1.0 + 0.16 * (3.0 * turn.sin() + 4.0 * height).sin() * (2.0 * turn.cos() - 3.0 * height).cos();
        let base = Vec3::Y * MIDDLE + out * CROWN * (lumps * dice.between(0.45, 0.92));
        let ahead =
            (out + Vec3::new(dice.between(-0.7, 0.7), dice.between(-0.6, 0.4), dice.between(-0.7, 0.7))).normalize();
        let across = Quat::from_axis_angle(ahead, dice.roll() * TAU) * ahead.any_orthonormal_vector();
        let size = dice.between(0.74, 1.1);
        cards.add(
            &Card { base, reach: ahead * size, half: across * 0.45 * size, droop: Vec3::Y * -0.1 * size },
            out,
            0.7,
        );
    }
    vec![limbs.primitive(Paint::Bark), cards.primitive]
}
