//! Ferns and grass: knee-high cards.

use std::f32::consts::TAU;

use glam::{Quat, Vec3};

use super::floor::{on_floor, path_distance};
use super::palette::Paint;
use crate::Primitive;
use crate::parts::{Builder, Card, Cards, Dice, GOLDEN_ANGLE, Tuft};

/// Clumps to place, each of one kind of plant. Plants on or close to the path are skipped.
const CLUMPS: usize = 150;
/// Farthest distance of a clump from the start view's foreground, in metres. Plants farther away would be
/// invisible.
const REACH: f32 = 17.0;
/// Leaf cards of a bush.
const BUSH_CARDS: usize = 52;
/// Bushes between the trees.
const BUSHES: usize = 70;
/// Bushes in the ring around the wood.
const RING: usize = 64;

/// Adds the plants on the floor.
pub(super) fn build(builder: &mut Builder) {
    let group = builder.group("undergrowth", Vec3::ZERO, 0.0);
    let (height, wind) = ([0.24, 0.36], Vec3::ZERO);
    let tuft = Tuft { cards: 4, height, sunk: 0.02, spread: 0.05, wind, bend: 0.10, lean: 0.5 };
    let tuft = tuft.primitive(Paint::Grass, &mut Dice::new(8));
    let [fern, tuft, bush] = [("fern", fern()), ("grass", tuft), ("bush", bush())]
        .map(|(name, primitive)| builder.mesh(name, vec![primitive]));
    let mut dice = Dice::new(5);
    let mut grow = |mesh: usize, x: f32, z: f32, size: f32, dice: &mut Dice| {
        builder.place_sized(group, mesh, on_floor(x, z), [size; 3], dice.roll() * TAU);
    };
    for index in 0..CLUMPS {
        let (turn, away) = (dice.roll() * TAU, REACH * dice.roll().powf(0.8));
        let (x, z) = (away * turn.sin(), away * turn.cos() - 5.0);
        let (mesh, plants, clear, spread) = if index % 3 == 0 { (fern, 2, 1.5, 0.8) } else { (tuft, 4, 0.9, 0.5) };
        for _ in 0..plants {
            let (x, z) = (x + dice.between(-spread, spread), z + dice.between(-spread, spread));
            let size = dice.between(0.6, 1.2);
            if path_distance(x, z) > clear && !is_before_eye(x, z) {
                grow(mesh, x, z, size, &mut dice);
            }
        }
    }
    for index in 0..BUSHES + RING {
        let is_ring = index >= BUSHES;
        let away = if is_ring { dice.between(30.0, 34.0) } else { dice.between(9.0, 29.0) };
        let turn = if is_ring { (index - BUSHES) as f32 / RING as f32 * TAU } else { dice.roll() * TAU };
        let (x, z) = (away * turn.sin(), away * turn.cos() - 4.0);
        let size = if is_ring { dice.between(1.5, 2.3) } else { dice.between(0.6, 1.2) };
        if is_ring || path_distance(x, z) > 2.2 {
            grow(bush, x, z, size, &mut dice);
        }
    }
}

/// Returns whether a plant would be right in front of the eye of the start view.
fn is_before_eye(x: f32, z: f32) -> bool {
    (x + 0.7).hypot(z - 4.2) < 1.1
}

/// Builds a bush about 1.5 m wide: leaves around a middle.
fn bush() -> Primitive {
    let mut dice = Dice::new(9);
    let mut cards = Cards::new(Paint::Leaves, 1);
    for index in 0..BUSH_CARDS {
        let height = (index as f32 + 0.5) / BUSH_CARDS as f32;
        let turn = index as f32 * GOLDEN_ANGLE;
        let out = Vec3::new(turn.sin(), 1.5 * height - 0.35, turn.cos()).normalize();
        let across = Quat::from_axis_angle(out, dice.between(-0.9, 0.9)) * Vec3::Y.cross(out).normalize();
        let base = Vec3::new(0.0, 0.2 + 0.7 * height, 0.0) + out * dice.between(0.05, 0.5);
        let length = dice.between(0.38, 0.55);
        cards.add(&Card { base, reach: out * length, half: across * 0.45 * length, droop: Vec3::ZERO }, out, 0.5);
    }
    cards.primitive
}

/// Builds a rosette of fronds that rise and bow.
fn fern() -> Primitive {
    let mut dice = Dice::new(6);
    let mut cards = Cards::new(Paint::Fern, 2);
    for index in 0..9 {
        let turn = (index as f32 + dice.between(-0.25, 0.25)) / 9.0 * TAU;
        let out = Vec3::new(turn.sin(), 0.0, turn.cos());
        let length = dice.between(0.55, 0.8);
        let rise = dice.between(0.5, 0.85);
        let card = Card {
            base: Vec3::Y * -0.02 + out * 0.03,
            reach: (out * 0.75 + Vec3::Y * rise) * length,
            half: Vec3::Y.cross(out) * 0.21 * length,
            droop: (out * 0.15 - Vec3::Y * rise * 0.62) * length,
        };
        cards.add(&card, Vec3::Y, 0.35);
    }
    cards.primitive
}
