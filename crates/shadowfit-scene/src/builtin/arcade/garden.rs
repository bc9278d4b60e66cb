//! The garden that the arcade looks on: gravel, lawns, hedges, a fountain, cypresses, and the wing across.

use std::f32::consts::{PI, TAU};

use glam::{Quat, Vec3};

use super::columns::{round, square};
use super::palette::Paint;
use super::shell::arcade_wall;
use super::{BAY, END, GARDEN, HALF, SPRING, START};
use crate::builtin::build::{Builder, CRISP, SMOOTH};
use crate::builtin::flora::Dice;
use crate::builtin::pixels::hash;
use crate::builtin::shapes::{block, ellipsoid, lathe, modulated_lathe, rounded_box};
use crate::builtin::sheet::ground;
use crate::{Primitive, Transform};

/// Middle of the garden, in metres.
const MIDDLE: Vec3 = Vec3::new(9.6, GARDEN, -6.0);
/// Where the columns of the wing across stand along x, in metres.
const ACROSS: f32 = 17.5;
/// Bays of the wing across.
const BAYS_ACROSS: usize = 9;

/// Adds the garden.
pub(super) fn build(builder: &mut Builder) {
    let group = builder.group("garden", Vec3::ZERO, 0.0);
    let gravel = gravel();
    let gravel = builder.mesh("gravel", vec![gravel]);
    builder.node("gravel", None, Transform::default(), Some(gravel));
    beds(builder, group);
    fountain(builder, group);
    cypresses(builder, group);
    wing_across(builder, group);
}

/// Gravel on all sides of the gallery and its house, but not below them.
fn gravel() -> Primitive {
    let (xs, zs) = ([-60.0, -HALF - 9.0, 3.2, 20.0, 60.0], [-60.0, END - 0.4, START + 0.4, 60.0]);
    let mut gravel = ground(Paint::Gravel.into(), [&xs, &zs], |_, _| GARDEN, |_| Vec3::ONE);
    // The cell in the second row and the second column, two triangles each.
    let cell = (xs.len() - 1 + 1) * 6;
    gravel.indices.drain(cell..cell + 6);
    gravel
}

/// Lawns framed by hedges, with balls of box at their corners, around a crossing of paths.
fn beds(builder: &mut Builder, group: usize) {
    let lawn = rounded_box(Vec3::new(2.0, 0.06, 3.4), 0.02, 1);
    let lawn = builder.solid("lawn", &lawn, Paint::Lawn, CRISP);
    let long = rounded_box(Vec3::new(0.22, 0.3, 3.5), 0.05, 1);
    let long = builder.solid("long hedge", &long, Paint::Hedge, CRISP);
    let short = rounded_box(Vec3::new(2.1, 0.29, 0.215), 0.05, 1);
    let short = builder.solid("short hedge", &short, Paint::Hedge, CRISP);
    let ball = ellipsoid(Vec3::splat(0.48), 12, 7).moved(Vec3::Y * 0.5);
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

/// A fountain of two bowls where the paths cross.
fn fountain(builder: &mut Builder, group: usize) {
    let basin = [
        (1.75, -0.05),
        (1.78, 0.08),
        (1.68, 0.12),
        (1.66, 0.42),
        (1.78, 0.46),
        (1.80, 0.52),
        (1.70, 0.55),
        (1.5, 0.55),
        (1.45, 0.5),
        (1.45, 0.30),
    ];
    let stem = [(0.34, 0.28), (0.36, 0.40), (0.22, 0.48), (0.16, 0.62), (0.20, 0.9), (0.15, 1.12), (0.22, 1.2)];
    let bowl = [(0.5, 1.24), (0.82, 1.36), (0.95, 1.5), (0.93, 1.54), (0.86, 1.53), (0.75, 1.44), (0.35, 1.36)];
    let top =
        [(0.12, 1.5), (0.10, 1.72), (0.15, 1.78), (0.30, 1.88), (0.36, 1.97), (0.33, 1.98), (0.2, 1.93), (0.0, 1.92)];
    let column: Vec<(f32, f32)> = [&stem[..], &bowl, &top].concat();
    let primitives = vec![
        lathe(&basin, 40).with(lathe(&column, 20)).primitive(Paint::Marble.into(), CRISP),
        lathe(&[(1.47, 0.2), (1.47, 0.43)], 40).primitive(Paint::Water.into(), CRISP),
    ];
    let fountain = builder.mesh("fountain", primitives);
    builder.place(group, fountain, MIDDLE, 0.0);
}

/// Cypresses in the garden, and beyond the doorway at the end.
fn cypresses(builder: &mut Builder, group: usize) {
    let outline: Vec<(f32, f32)> = (0..=11)
        .map(|step| {
            let t = step as f32 / 11.0;
            let girth = (t * (1.0 - t).powf(0.75)).max(0.0) * 1.55 + 0.12 * (1.0 - t);
            (if step == 11 { 0.0 } else { 0.85 * girth }, 0.3 + 7.5 * t)
        })
        .collect();
    let lump = |turn: f32, y: f32| {
        1.0 + 0.10 * (5.0 * turn + 3.1 * y).sin() * (2.3 * y).cos() + 0.06 * (9.0 * turn - 4.7 * y).sin()
    };
    let primitives = vec![
        modulated_lathe(&outline, 14, lump).primitive(Paint::Cypress.into(), SMOOTH),
        lathe(&[(0.12, -0.05), (0.10, 0.8)], 10).primitive(Paint::Timber.into(), CRISP),
    ];
    let tree = builder.mesh("cypress", primitives);
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
        let node = builder.place_scaled(group, tree, Vec3::new(x, GARDEN, z), scale);
        builder.scene.nodes[node].rest.rotation = Quat::from_rotation_y(dice.roll() * TAU);
    }
}

/// The wing across the garden: the same arches, seen from outside, before a dark gallery.
fn wing_across(builder: &mut Builder, group: usize) {
    let start = START - 2.0 * BAY;
    let length = BAY * BAYS_ACROSS as f32;
    let middle = start - length / 2.0;
    let wing = builder.node(
        "wing across",
        Some(group),
        Transform {
            translation: Vec3::new(ACROSS, 0.0, middle),
            rotation: Quat::from_rotation_y(PI),
            ..Transform::default()
        },
        None,
    );
    let arches = arcade_wall(BAYS_ACROSS).moved(Vec3::new(0.0, SPRING, length / 2.0 - START));
    let arches = builder.solid("arcade wall across", &arches, Paint::Stone, CRISP);
    builder.place(wing, arches, Vec3::ZERO, 0.0);
    let primitives =
        vec![round(10).primitive(Paint::Marble.into(), 0.75), square().primitive(Paint::Stone.into(), CRISP)];
    let column = builder.mesh("column across", primitives);
    for index in 0..=BAYS_ACROSS {
        builder.place(wing, column, Vec3::new(0.0, 0.0, length / 2.0 - BAY * index as f32), 0.0);
    }
    let half = length / 2.0 + 0.6;
    let mut shell = |name: &str, low: Vec3, high: Vec3, paint: Paint| {
        let mesh = builder.solid(name, &block(low, high, 0.02), paint, CRISP);
        builder.place(wing, mesh, Vec3::ZERO, 0.0);
    };
    shell("platform across", Vec3::new(-4.6, -0.6, -half), Vec3::new(0.55, 0.0, half), Paint::Stone);
    shell("rear wall across", Vec3::new(-4.9, -0.5, -half), Vec3::new(-4.3, 5.6, half), Paint::Plaster);
    for end in [-1.0, 1.0] {
        let z = end * (half - 0.27);
        let (low, high) = (Vec3::new(-4.6, -0.5, z - 0.25), Vec3::new(0.28, 4.66, z + 0.25));
        shell("end wall across", low, high, Paint::Plaster);
    }
    shell("ceiling across", Vec3::new(-4.6, 4.35, -half), Vec3::new(0.2, 4.7, half), Paint::Vault);
    let slope = block(Vec3::new(-5.3, -0.06, -half - 0.3), Vec3::new(0.95, 0.06, half + 0.3), 0.02);
    let slope = builder.solid("roof across", &slope, Paint::Roof, CRISP);
    let roof = builder.place(wing, slope, Vec3::new(0.0, 4.86, 0.0), 0.0);
    builder.scene.nodes[roof].rest.rotation = Quat::from_rotation_z(-0.24);
}
