//! The garden next to the arcade: gravel, lawns, hedges, a fountain, cypresses, and the wing across.

use std::f32::consts::{PI, TAU};

use glam::{Quat, Vec3};

use super::columns::column;
use super::palette::Paint;
use super::plan::{BAY, END, GARDEN, HALF, SPRING, START};
use super::shell::arcade_wall;
use crate::parts::{Builder, CRISP, Dice, SMOOTH, block, cypress, ellipsoid, ground, hash, lathe, rounded_box, turned};
use crate::{Primitive, Transform};

/// Middle of the garden, in metres.
const MIDDLE: Vec3 = Vec3::new(9.6, GARDEN, -6.0);
/// Position of the columns of the wing across, along x, in metres.
const ACROSS: f32 = 17.5;
/// Bays of the wing across.
const BAYS_ACROSS: usize = 9;

/// Adds the garden.
pub(super) fn build(builder: &mut Builder) {
    let group = builder.group("garden", Vec3::ZERO, 0.0);
    builder.lay("gravel", gravel());
    beds(builder, group);
    fountain(builder, group);
    cypresses(builder, group);
    wing_across(builder, group);
}

/// Builds the gravel on all sides of the gallery and its house, but not below them.
fn gravel() -> Primitive {
    let (xs, zs) = ([-60.0, -HALF - 9.0, 3.2, 20.0, 60.0], [-60.0, END - 0.4, START + 0.4, 60.0]);
    let mut gravel = ground(Paint::Gravel.into(), [&xs, &zs], |_, _| GARDEN, |_| Vec3::ONE);
    // Drops the two triangles of the cell in the second row and second column.
    let cell = (xs.len() - 1 + 1) * 6;
    gravel.indices.drain(cell..cell + 6);
    gravel
}

/// Adds lawns framed by hedges, with round box shrubs at their corners, around a crossing of paths.
fn beds(builder: &mut Builder, group: usize) {
    let lawn = builder.solid("lawn", &rounded_box([2.0, 0.06, 3.4], 0.02, 1), Paint::Lawn, CRISP);
    let long = builder.solid("long hedge", &rounded_box([0.22, 0.3, 3.5], 0.05, 1), Paint::Hedge, CRISP);
    let short = builder.solid("short hedge", &rounded_box([2.1, 0.29, 0.215], 0.05, 1), Paint::Hedge, CRISP);
    let ball = ellipsoid([0.48; 3], 12, 7).moved(Vec3::Y * 0.5);
    let ball = builder.solid("box ball", &ball, Paint::Hedge, SMOOTH);
    for (x, z) in [(-3.6, 5.4), (3.6, 5.4), (-3.6, -5.4), (3.6, -5.4), (-3.6, -14.4), (3.6, -14.4)] {
        let at = MIDDLE + Vec3::new(x, 0.0, z);
        builder.place(group, lawn, at, 0.0);
        for side in [-1.0, 1.0] {
            builder.place(group, long, at + Vec3::new(2.0 * side, 0.25, 0.0), 0.0);
            builder.place(group, short, at + Vec3::new(0.0, 0.245, 3.35 * side), 0.0);
            for end in [-1.0, 1.0] {
                builder.place(group, ball, at + Vec3::new(2.0 * side, 0.25, 3.35 * end), 0.0);
            }
        }
    }
}

/// Adds a fountain of two bowls where the paths cross.
fn fountain(builder: &mut Builder, group: usize) {
    #[rustfmt::skip]
    let basin = [
        (1.75, -0.05), (1.78, 0.08), (1.68, 0.12), (1.66, 0.42), (1.78, 0.46), (1.80, 0.52), (1.70, 0.55),
        (1.5, 0.55), (1.45, 0.5), (1.45, 0.30),
    ];
    let stem = [(0.34, 0.28), (0.36, 0.40), (0.22, 0.48), (0.16, 0.62), (0.20, 0.9), (0.15, 1.12), (0.22, 1.2)];
    let bowl = [(0.5, 1.24), (0.82, 1.36), (0.95, 1.5), (0.93, 1.54), (0.86, 1.53), (0.75, 1.44), (0.35, 1.36)];
    let foot = [(0.12, 1.5), (0.10, 1.72), (0.15, 1.78), (0.30, 1.88)];
    let top = [(0.36, 1.97), (0.33, 1.98), (0.2, 1.93), (0.0, 1.92)];
    let marble = lathe(&basin, 40).with(lathe(&[&stem[..], &bowl, &foot, &top].concat(), 20));
    let water = lathe(&[(1.47, 0.2), (1.47, 0.43)], 40);
    let fountain = builder.solids("fountain", [(marble, Paint::Marble, CRISP), (water, Paint::Water, CRISP)]);
    builder.place(group, fountain, MIDDLE, 0.0);
}

/// Adds cypresses in the garden and beyond the doorway at the end.
fn cypresses(builder: &mut Builder, group: usize) {
    let trunk = lathe(&[(0.12, -0.05), (0.10, 0.8)], 10);
    let crown = cypress(1.55, [0.3, 7.5], 11, 14);
    let tree = builder.solids("cypress", [(crown, Paint::Cypress, SMOOTH), (trunk, Paint::Timber, CRISP)]);
    let near = [(6.0, 4.2), (13.2, 4.2), (6.0, -16.2), (13.2, -16.2), (6.0, -25.2), (13.2, -25.2)];
    let avenue = (0..6).flat_map(|index| {
        let z = END - 4.5 - 4.2 * index as f32;
        [(-2.9, z), (2.9, z)]
    });
    let mut dice = Dice::new(3);
    let far = (0..12).map(|index| {
        let turn = index as f32 / 12.0 * TAU;
        let away = 42.0 + 12.0 * hash(index, 5);
        (away * turn.sin(), away * turn.cos() - 8.0)
    });
    for (x, z) in near.into_iter().chain(avenue).chain(far) {
        let scale = Vec3::new(1.0, dice.between(0.75, 1.15), 1.0);
        builder.place_sized(group, tree, [x, GARDEN, z], scale, dice.roll() * TAU);
    }
}

/// Adds the wing across the garden: the same arches from outside, in front of a dark gallery.
fn wing_across(builder: &mut Builder, group: usize) {
    let start = START - 2.0 * BAY;
    let length = BAY * BAYS_ACROSS as f32;
    let middle = start - length / 2.0;
    let wing = builder.node("wing across", Some(group), turned([ACROSS, 0.0, middle], PI), None);
    let arches = arcade_wall(BAYS_ACROSS).moved([0.0, SPRING, length / 2.0 - START]);
    builder.fix(wing, "arcade wall across", &arches, Paint::Stone, CRISP);
    let column = column(builder, "column across", 10);
    for index in 0..=BAYS_ACROSS {
        builder.place(wing, column, [0.0, 0.0, length / 2.0 - BAY * index as f32], 0.0);
    }
    let half = length / 2.0 + 0.6;
    let wall = half - 0.27;
    for (name, low, high, paint) in [
        ("platform across", [-4.6, -0.6, -half], [0.55, 0.0, half], Paint::Stone),
        ("rear wall across", [-4.9, -0.5, -half], [-4.3, 5.6, half], Paint::Plaster),
        ("end wall across", [-4.6, -0.5, -wall - 0.25], [0.28, 4.66, -wall + 0.25], Paint::Plaster),
        ("end wall across", [-4.6, -0.5, wall - 0.25], [0.28, 4.66, wall + 0.25], Paint::Plaster),
        ("ceiling across", [-4.6, 4.35, -half], [0.2, 4.7, half], Paint::Vault),
    ] {
        builder.fix(wing, name, &block(low, high, 0.02), paint, CRISP);
    }
    let slope = block([-5.3, -0.06, -half - 0.3], [0.95, 0.06, half + 0.3], 0.02);
    let slope = builder.solid("roof across", &slope, Paint::Roof, CRISP);
    let lie = Transform { rotation: Quat::from_rotation_z(-0.24).as_dquat(), ..turned([0.0, 4.86, 0.0], 0.0) };
    builder.pose(wing, slope, lie);
}
