//! A hawthorn bent by the wind.

use glam::{Quat, Vec3};

use super::land::on_land;
use super::palette::Paint;
use crate::parts::{Builder, Card, Cards, Dice, GOLDEN_ANGLE, Limbs};

/// Branches, each with a cloud of leaves at its end.
const BRANCHES: usize = 15;
/// Leaf cards of a branch.
const CARDS: usize = 30;

/// Adds the tree.
pub(super) fn build(builder: &mut Builder, group: usize) {
    let mut dice = Dice::new(90);
    let mut wood = Limbs::default();
    let mut leaves = Cards::new(Paint::Leaves, 1);
    // The trunk leans with the wind, more toward its top.
    let trunk = |t: f32| Vec3::new(1.15 * t * t + 0.12 * (t * 7.0).sin(), 2.5 * t, 0.15 * (t * 5.0).sin());
    let path: Vec<Vec3> = [-0.08, 0.0, 0.06, 0.15, 0.3, 0.5, 0.75, 1.0].map(trunk).to_vec();
    wood.add(&path, 14, |turn, t| {
        let flare = 0.16 * (-t * 14.0).exp() * (0.8 + 0.4 * (4.0 * turn).cos());
        (0.17 - 0.08 * t) * (1.0 + 0.09 * (3.0 * turn + 11.0 * t).sin()) + flare
    });
    for index in 0..BRANCHES {
        let share = 0.45 + 0.55 * index as f32 / (BRANCHES - 1) as f32;
        let turn = index as f32 * GOLDEN_ANGLE;
        let from = trunk(share);
        // The wind bends all branches in its direction.
        let out = Vec3::new(0.45 + 0.6 * turn.sin(), 0.42 + 0.25 * (turn * 1.3).cos(), 0.85 * turn.cos());
        let length = dice.between(1.0, 1.6) * (1.15 - 0.35 * share);
        let bend = Vec3::new(0.25, -0.12, 0.0) * length;
        let at = |t: f32| from + out * length * t + bend * t * t;
        wood.add(&[at(-0.03), at(0.35), at(0.7), at(1.0)], 6, |_, t| 0.055 * (1.0 - 0.8 * t));
        for _ in 0..CARDS {
            let base = at(dice.between(0.35, 1.05));
            let around =
                Vec3::new(dice.between(-0.6, 1.0), dice.between(-0.5, 0.9), dice.between(-1.0, 1.0)).normalize();
            let across = Quat::from_axis_angle(around, dice.between(-1.5, 1.5)) * around.any_orthonormal_vector();
            let size = dice.between(0.26, 0.42);
            let card = Card {
                base: base + around * 0.08,
                reach: around * size,
                half: across * 0.45 * size,
                droop: Vec3::ZERO,
            };
            leaves.add(&card, (base - trunk(0.8)).normalize(), 0.5);
        }
    }
    let tree = builder.mesh("hawthorn", vec![wood.primitive(Paint::Bark), leaves.primitive]);
    builder.place(group, tree, on_land(-6.0, -6.6), 0.0);
}
