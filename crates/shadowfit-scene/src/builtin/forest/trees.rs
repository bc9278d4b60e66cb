//! The trees: trunks with boughs, each bough a shared mesh of wood and cards of leaves.

use std::f32::consts::TAU;

use glam::{Quat, Vec3};

use super::floor::{on_floor, path_distance};
use super::palette::Paint;
use crate::parts::{Builder, Card, Cards, Dice, Limbs, rotations, turned};
use crate::{Channel, Primitive, Transform};

/// Period of the wind, a gust and a lull, in seconds.
pub(super) const WIND_TIME: f32 = 8.0;
/// Distance between neighbouring trees, in metres, before each is moved by a small random offset.
const SPACING: f32 = 3.9;
/// Trees along a side of the grid.
const ROWS: i32 = 19;
/// Distance from the start view beyond which trees are simpler, in metres.
const FAR: f32 = 11.5;
/// Boughs of a far tree.
const FAR_BOUGHS: usize = 7;
/// Distance from the start view within which boughs sway, in metres.
const SWAYS: f32 = 12.0;
/// Half width of the clear strip along the path, in metres.
const CLEAR: f32 = 1.7;
/// Angle from one bough to the next higher one, in radians: the golden angle, which shades the lower boughs
/// the least.
const GOLDEN: f32 = 2.399_963;
/// Height of the modelled trunks, in metres. Scale makes them differ.
const HEIGHT: f32 = 10.0;

/// Shared meshes.
struct Meshes {
    /// Trunks near the view, by kind (beech, birch) and shape.
    trunks: [[usize; 2]; 2],
    /// Boughs near the view, by kind and shape.
    boughs: [[usize; 3]; 2],
    /// Whole trees far off, by kind and shape.
    far: [[usize; 2]; 2],
}

/// A tree at a place.
struct Tree {
    at: Vec3,
    is_birch: bool,
    /// Scale of the trunk across and along.
    scale: [f32; 2],
    yaw: f32,
    boughs: usize,
    /// Share of the height at which the boughs begin.
    lowest: f32,
    /// Size of the lowest bough.
    spread: f32,
}

/// Adds all trees and returns the animation channels of their boughs.
pub(super) fn build(builder: &mut Builder) -> Vec<Channel> {
    let meshes = meshes(builder);
    let group = builder.group("trees", Vec3::ZERO, 0.0);
    let mut sway = Vec::new();
    let mut dice = Dice::new(1);
    let at = on_floor(1.75, -2.6);
    let great = Tree { at, is_birch: false, scale: [2.1, 1.3], yaw: 0.5, boughs: 13, lowest: 0.30, spread: 1.7 };
    let at = on_floor(-2.7, 0.6);
    let sapling = Tree { at, is_birch: true, scale: [0.28, 0.30], yaw: 0.0, boughs: 8, lowest: 0.28, spread: 0.62 };
    for tree in [great, sapling] {
        plant(builder, &meshes, group, &tree, &mut dice, &mut sway);
    }
    for row in 0..ROWS * ROWS {
        let place = |index: i32, dice: &mut Dice| ((index - ROWS / 2) as f32 + dice.between(-0.36, 0.36)) * SPACING;
        let (x, z) = (place(row % ROWS, &mut dice), place(row / ROWS, &mut dice) - 6.0);
        let tree = tree(x, z, &mut dice);
        if grows(x, z) {
            plant(builder, &meshes, group, &tree, &mut dice, &mut sway);
        }
    }
    sway
}

/// Returns whether a tree may grow here: off the path, inside the wood, not close to the eye of the start
/// view and not in the great tree.
fn grows(x: f32, z: f32) -> bool {
    let round = (x * x + (z + 6.0) * (z + 6.0)).sqrt();
    let from_eye = (x * x + (z - 4.6) * (z - 4.6)).sqrt();
    let from_great = ((x - 1.75).powi(2) + (z + 2.6).powi(2)).sqrt();
    path_distance(x, z) > CLEAR && round < 33.0 && from_eye > 3.6 && from_great > 3.0
}

/// Returns a tree of random kind and size.
fn tree(x: f32, z: f32, dice: &mut Dice) -> Tree {
    let is_birch = dice.roll() < 0.42;
    let girth = if is_birch { dice.between(0.5, 0.95) } else { dice.between(0.6, 1.5) };
    Tree {
        at: on_floor(x, z),
        is_birch,
        scale: [girth, dice.between(0.85, 1.2)],
        yaw: dice.roll() * TAU,
        boughs: 7,
        lowest: dice.between(0.42, 0.6),
        spread: dice.between(0.85, 1.2),
    }
}

/// Adds a tree. If it is near, adds the animation channels of its boughs to `sway`.
fn plant(builder: &mut Builder, meshes: &Meshes, group: usize, tree: &Tree, dice: &mut Dice, sway: &mut Vec<Channel>) {
    let kind = usize::from(tree.is_birch);
    let distance = tree.at.distance(Vec3::new(0.0, 0.0, 4.6));
    let shape = (dice.roll() * 2.0) as usize;
    let [across, along] = tree.scale;
    let size = Vec3::new(across, along, across);
    let rest = turned(tree.at, tree.yaw);
    if distance > FAR {
        // A far crown is as wide as other crowns, even if its trunk is thin.
        let scale = Vec3::new(across.max(0.8), along, across.max(0.8));
        let name = ["far beech", "far birch"][kind];
        builder.node(name, Some(group), Transform { scale: scale.as_dvec3(), ..rest }, Some(meshes.far[kind][shape]));
        return;
    }
    let root = builder.node(["beech", "birch"][kind], Some(group), rest, None);
    builder.place_sized(root, meshes.trunks[kind][shape], Vec3::ZERO, size, 0.0);
    for index in 0..tree.boughs {
        let t = index as f32 / (tree.boughs - 1) as f32;
        let at = trunk_middle(shape, tree.lowest + (0.97 - tree.lowest) * t) * size;
        let size = tree.spread * (1.0 - 0.45 * t) * dice.between(0.85, 1.15);
        let rotation = bough_turn(index, t, dice);
        let rest = Transform::new(at, rotation, Vec3::splat(size));
        let bough = builder.pose(root, meshes.boughs[kind][index % 3], rest);
        if distance < SWAYS {
            sway.push(swaying(bough, rotation, size, dice));
        }
    }
}

/// Returns the rotation of a bough: around the trunk and upward. Boughs point up more toward the top (`t` is
/// 1).
fn bough_turn(index: usize, t: f32, dice: &mut Dice) -> Quat {
    let up = -0.05 + 1.15 * t * t + dice.between(-0.1, 0.1);
    let turn = index as f32 * GOLDEN + dice.between(-0.3, 0.3);
    Quat::from_rotation_y(turn) * Quat::from_rotation_x(-up)
}

/// Returns the animation channel of a bough in the wind. Smaller boughs swing farther and faster.
fn swaying(node: usize, rest: Quat, size: f32, dice: &mut Dice) -> Channel {
    let (late, beat) = (dice.roll() * TAU, if size < 0.8 { 4.0 } else { 3.0 });
    rotations(node, WIND_TIME, 32, |phase| {
        let gust = 0.55 + 0.45 * (phase - 0.6).sin();
        let nod = 0.045 * gust * (beat * phase + late).sin() + 0.025 * (phase + late * 0.3).sin();
        let swing = 0.05 * gust * ((beat - 1.0) * phase + late * 1.7).sin();
        Quat::from_rotation_y(swing) * rest * Quat::from_rotation_x(nod)
    })
}

/// Returns the middle of a trunk at a share of its height.
fn trunk_middle(shape: usize, share: f32) -> Vec3 {
    let bend = [0.16, -0.22][shape];
    let x = bend * (share * 4.2).sin() * share.min(0.7);
    Vec3::new(x, share * HEIGHT, 0.6 * bend * (share * 6.5).cos() * share - 0.6 * bend * share)
}

/// Adds the shared meshes.
fn meshes(builder: &mut Builder) -> Meshes {
    let kinds = [("beech", Paint::Bark, Paint::Leaves), ("birch", Paint::Birch, Paint::BirchLeaves)];
    let trunks = kinds.map(|(name, bark, _)| {
        [0, 1].map(|shape| {
            let mut limbs = Limbs::default();
            trunk(&mut limbs, shape, 20, &SHARES);
            builder.mesh(&format!("{name} trunk"), vec![limbs.primitive(bark)])
        })
    });
    let boughs = kinds.map(|(name, _, leaves)| {
        [21, 22, 23].map(|seed| {
            let primitives = bough(leaves, seed);
            builder.mesh(&format!("{name} bough"), primitives)
        })
    });
    let far = kinds.map(|(name, bark, leaves)| {
        [0, 1].map(|shape| {
            let primitives = far_tree(shape, bark, leaves);
            builder.mesh(&format!("far {name}"), primitives)
        })
    });
    Meshes { trunks, boughs, far }
}

/// Ring positions of a near trunk, as shares of its height: closest where the roots spread.
const SHARES: [f32; 13] = [-0.05, -0.01, 0.01, 0.025, 0.05, 0.1, 0.2, 0.32, 0.45, 0.6, 0.75, 0.9, 1.0];
/// Ring positions of a far trunk.
const FAR_SHARES: [f32; 5] = [-0.04, 0.0, 0.04, 0.4, 1.0];

/// Adds a trunk 10 m tall and 0.3 m thick, with roots that spread where it meets the floor.
fn trunk(limbs: &mut Limbs, shape: usize, segments: usize, shares: &[f32]) {
    let path: Vec<Vec3> = shares.iter().map(|&share| trunk_middle(shape, share)).collect();
    let last = (shares.len() - 1) as f32;
    limbs.add(&path, segments, |turn, t| {
        let share = shares[(t * last).round() as usize];
        let flare = (-share.max(-0.01) * 26.0).exp() * (0.55 + 0.4 * (5.0 * turn + shape as f32).cos());
        let lumps = 1.0 + 0.045 * (3.0 * turn + 31.0 * share).sin() + 0.03 * (7.0 * turn - 17.0 * share).sin();
        0.15 * (1.0 - 0.82 * share.max(0.0)) * lumps + 0.13 * flare
    });
}

/// Builds a whole tree for far away, with fewer and larger leaves.
fn far_tree(shape: usize, bark: Paint, leaves: Paint) -> Vec<Primitive> {
    let mut dice = Dice::new(29 + shape as u32);
    let mut limbs = Limbs::default();
    let mut cards = Cards::new(leaves, 1);
    trunk(&mut limbs, shape, 6, &FAR_SHARES);
    for index in 0..FAR_BOUGHS {
        let t = index as f32 / (FAR_BOUGHS - 1) as f32;
        let at = trunk_middle(shape, 0.42 + 0.55 * t);
        let turn = bough_turn(index, t, &mut dice);
        let length = 2.3 * (1.0 - 0.45 * t);
        let ahead = turn * Vec3::Z;
        limbs.add(&[at, at + ahead * length], 3, |_, t| 0.04 * (1.0 - 0.8 * t));
        for step in 0..9 {
            let base = at + ahead * length * (0.3 + 0.08 * step as f32);
            let lean = if step % 2 == 0 { 1.0 } else { -1.0 } * dice.between(0.2, 1.3);
            let out = turn * Vec3::new(lean.sin(), dice.between(-0.1, 0.3), lean.cos()).normalize();
            let size = dice.between(0.9, 1.25);
            let half = Quat::from_axis_angle(out, dice.between(-0.7, 0.7)) * (turn * Vec3::Y).cross(out).normalize();
            let card = Card { base, reach: out * size, half: half * 0.45 * size, droop: Vec3::Y * -0.2 * size };
            cards.add(&card, Vec3::Y, 0.3);
        }
    }
    vec![limbs.primitive(bark), cards.primitive]
}

/// Builds a bough of about 2 m that grows from the origin along +z: wood, and leaves in flat sprays.
fn bough(leaves: Paint, seed: u32) -> Vec<Primitive> {
    let mut dice = Dice::new(seed);
    let mut limbs = Limbs::default();
    let mut cards = Cards::new(leaves, 2);
    let wave = dice.between(-0.2, 0.2);
    let middle = |t: f32| Vec3::new(wave * (t * 3.5).sin(), 0.55 * t - 0.42 * t * t, 2.0 * t);
    let path: Vec<Vec3> = (0..=5).map(|step| middle(step as f32 / 5.0 - 0.02)).collect();
    limbs.add(&path, 5, |_, t| 0.032 * (1.0 - 0.85 * t));
    for index in 0..5 {
        let t = 0.22 + 0.16 * index as f32;
        let side = if index % 2 == 0 { 1.0 } else { -1.0 };
        let turn = side * dice.between(0.7, 1.0);
        let length = 1.15 * (1.05 - t) + 0.15;
        let out = Vec3::new(turn.sin(), dice.between(0.0, 0.25), turn.cos());
        let from = middle(t);
        let end = from + out * length - Vec3::Y * 0.12 * length;
        limbs.add(&[from, end], 3, |_, t| 0.014 * (1.0 - 0.7 * t));
        for step in 0..4 {
            let along = 0.3 + 0.25 * step as f32;
            let lean = turn + dice.between(-0.7, 0.7);
            spray(&mut cards, from.lerp(end, along), lean, &mut dice);
        }
    }
    for step in 0..6 {
        let t = 0.45 + 0.1 * step as f32;
        let lean = if step == 5 { 0.0 } else { dice.between(-0.9, 0.9) };
        spray(&mut cards, middle(t), lean, &mut dice);
    }
    vec![limbs.primitive(Paint::Bark), cards.primitive]
}

/// Adds a twig of leaves at a point, turned by `lean` from the bough's direction.
fn spray(cards: &mut Cards, at: Vec3, lean: f32, dice: &mut Dice) {
    let length = dice.between(0.5, 0.72);
    let out = Vec3::new(lean.sin(), dice.between(-0.15, 0.35), lean.cos()).normalize();
    let roll = Quat::from_axis_angle(out, dice.between(-0.6, 0.6));
    let half = roll * Vec3::Y.cross(out).normalize() * (0.45 * length);
    let droop = Vec3::Y * -dice.between(0.05, 0.2) * length;
    cards.add(&Card { base: at, reach: out * length, half, droop }, Vec3::Y, 0.3);
}
