//! Rows of houses along the streets and around the square, and the signs that swing before their shops.

use std::f32::consts::TAU;

use glam::{Quat, Vec3};

use super::house::{Detail, Ground, Top, roll};
use super::kit::Kit;
use super::palette::Paint;
use super::plan::{KERB, ROWS, Row};
use super::{SWAY_KEYS, SWAY_TIME};
use crate::Channel;
use crate::parts::{Builder, Dice, rotations, torus, turned};

/// Width that a house has about, in metres.
const WIDTH: f32 = 7.0;
/// Height of the arm that a sign hangs from, above the pavement in metres.
const SIGN_HEIGHT: f32 = 3.75;
/// Angle that a sign swings to each side, in radians.
const SWING: f32 = 0.22;

/// Adds all rows and returns how the signs swing.
pub(super) fn build(builder: &mut Builder) -> Vec<Channel> {
    let mut dice = Dice::new(10);
    let group = builder.group("houses", Vec3::ZERO, 0.0);
    let mut sway = Vec::new();
    for (index, row) in ROWS.iter().enumerate() {
        build_row(builder, group, row, index * 3, &mut dice, &mut sway);
    }
    sway
}

/// Adds the houses of a row. Their widths vary, and together they fill the row.
fn build_row(builder: &mut Builder, group: usize, row: &Row, first: usize, dice: &mut Dice, sway: &mut Vec<Channel>) {
    let [from, to] = [row.from, row.to].map(|[x, z]| Vec3::new(x, KERB, z));
    let way = to - from;
    let count = (way.length() / WIDTH).round().max(1.0) as usize;
    let shares: Vec<f32> = (0..count).map(|_| dice.between(0.8, 1.25)).collect();
    let total: f32 = shares.iter().sum();
    let yaw = (-way.z).atan2(way.x);
    let mut reached = 0.0;
    for (index, share) in shares.iter().enumerate() {
        let width = way.length() * share / total;
        let mut house = roll(dice, width, first + index);
        house.detail = if row.is_near { Detail::Near } else { Detail::Street };
        house.floors = house.floors.min(row.floors);
        house.flanks = [index == 0 && row.flanks[0], index + 1 == count && row.flanks[1]];
        let at = from + way.normalize() * (reached + width / 2.0);
        let mesh = house.kit().mesh(builder, "house");
        let node = builder.node("house", Some(group), turned(at, yaw), Some(mesh));
        if house.shop == Ground::Shop && row.is_near && house.top != Top::Steps {
            sway.push(sign(builder, node, width / 2.0 - 0.2, house.leaf, dice.roll() * TAU));
        }
        reached += width;
    }
}

/// Adds a sign on an arm at a place along a front, and returns how it swings about the arm.
fn sign(builder: &mut Builder, house: usize, x: f32, paint: Paint, late: f32) -> Channel {
    let mut arm = Kit::default();
    arm.plank(Paint::Iron, [-0.018, -0.018, -0.05], [0.018, 0.018, 1.1]);
    arm.plank(Paint::Iron, [-0.05, -0.3, -0.02], [0.05, 0.1, 0.02]);
    let arm = arm.mesh(builder, "sign arm");
    builder.place(house, arm, [x, SIGN_HEIGHT, 0.0], 0.0);
    let mut board = Kit::default();
    for z in [0.3, 0.92] {
        board.plank(Paint::Iron, [-0.006, -0.2, z - 0.006], [0.006, 0.03, z + 0.006]);
    }
    board.plank(paint, [-0.025, -0.78, 0.18], [0.025, -0.18, 1.04]);
    let ring = torus(0.17, 0.022, 0.04, 14, 6);
    let ring = ring.posed(Quat::from_rotation_z(TAU / 4.0), [0.0, -0.48, 0.61]);
    board.add(Paint::Gold, ring);
    let board = board.mesh(builder, "sign");
    let node = builder.place(house, board, [x, SIGN_HEIGHT, 0.0], 0.0);
    rotations(node, SWAY_TIME, SWAY_KEYS, |phase| {
        let turn = SWING * (3.0 * phase + late).sin() + 0.06 * (2.0 * phase).sin();
        Quat::from_rotation_z(turn)
    })
}
