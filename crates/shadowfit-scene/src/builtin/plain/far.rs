//! Far objects: stacks of straw on the fields, farms, rows of poplars, round trees.

use std::f32::consts::TAU;

use glam::Vec3;

use super::land::on_land;
use super::palette::Paint;
use crate::parts::{Builder, CRISP, Dice, GOLDEN_ANGLE, SMOOTH, Solid, extrude, gabled, lathe, modulated_lathe, plank};

/// Adds the far objects.
pub(super) fn build(builder: &mut Builder) {
    let group = builder.group("far", Vec3::ZERO, 0.0);
    stacks(builder, group);
    farms(builder, group);
    trees(builder, group);
}

/// Adds stacks of straw in rows on a stubble field.
fn stacks(builder: &mut Builder, group: usize) {
    let outline = [(1.15, -0.3), (1.3, 0.4), (1.45, 1.3), (1.5, 1.75), (1.1, 2.5), (0.5, 3.2), (0.0, 3.6)];
    let lump = |turn: f32, y: f32| 1.0 + 0.03 * (4.0 * turn + 3.0 * y).sin();
    let stack = builder.solid("straw stack", &modulated_lathe(&outline, 10, lump), Paint::Straw, SMOOTH);
    let mut dice = Dice::new(100);
    for row in 0..3 {
        for index in 0..6 {
            let along = 13.0 * index as f32 + 4.0 * row as f32 + dice.between(-1.5, 1.5);
            let across = 17.0 * row as f32 + dice.between(-1.5, 1.5);
            let at = on_land(26.0 + 0.92 * along - 0.30 * across, -108.0 - 0.30 * along - 0.95 * across);
            let size = dice.between(0.85, 1.1);
            builder.place_sized(group, stack, at, [size; 3], dice.roll() * TAU);
        }
    }
}

/// Adds houses and barns, alone and in a village.
fn farms(builder: &mut Builder, group: usize) {
    let walls = gabled(3.2, [-2.0, 3.4, 5.9], 9.5);
    let roof = [(-3.7, 3.15), (-3.5, 2.95), (0.0, 5.75), (3.5, 2.95), (3.7, 3.15), (0.0, 6.15)];
    let roof = extrude(&roof, &[[0, 1, 2], [0, 2, 5], [2, 3, 4], [2, 4, 5]], 10.3);
    let windows = [-3.0, 0.0, 3.0].map(|z| plank([-3.25, 1.2, z - 0.5], [3.25, 2.5, z + 0.5]));
    let dark = windows.into_iter().fold(plank([-0.7, 0.0, 4.6], [0.7, 2.2, 4.78]), Solid::with);
    let chimney = plank([-0.45, 4.5, -3.2], [0.45, 7.3, -2.3]);
    let house = [(walls.with(chimney), Paint::White, CRISP), (roof, Paint::Roof, CRISP), (dark, Paint::Dark, CRISP)];
    let house = builder.solids("house", house);
    let mut dice = Dice::new(110);
    let village = (0..16).map(|index| {
        let turn = index as f32 * GOLDEN_ANGLE;
        let away = 9.0 * (index as f32 + 1.0).sqrt();
        (95.0 + away * turn.sin() * 1.6, -330.0 + away * turn.cos())
    });
    let alone = [(88.0, -150.0), (103.0, -158.0), (-150.0, -240.0), (-136.0, -250.0), (-210.0, -420.0), (10.0, -460.0)];
    for (x, z) in village.chain(alone) {
        let yaw = dice.roll() * TAU;
        builder.place_sized(group, house, on_land(x, z), [dice.between(0.8, 1.15); 3], yaw);
    }
    let spire = [(2.4, -2.0), (2.4, 13.0), (2.7, 13.2), (2.7, 13.6), (0.0, 24.0)];
    let spire = builder.solid("church tower", &lathe(&spire, 8), Paint::White, CRISP);
    builder.place(group, spire, on_land(96.0, -334.0), 0.2);
}

/// Adds poplars along a road, and round trees in hedges, by the farms and on the hills.
fn trees(builder: &mut Builder, group: usize) {
    let poplar = [(0.12, -1.0), (0.16, 1.4), (0.9, 2.4), (1.3, 5.0), (1.15, 8.5), (0.6, 11.5), (0.0, 13.5)];
    let lump = |turn: f32, y: f32| 1.0 + 0.15 * (3.0 * turn + 1.9 * y).sin();
    let poplar = builder.solid("poplar", &modulated_lathe(&poplar, 9, lump), Paint::Foliage, SMOOTH);
    let round = [(0.3, -1.0), (0.25, 1.0), (2.1, 1.5), (2.8, 3.4), (2.0, 5.6), (0.0, 6.7)];
    let round = builder.solid("round tree", &modulated_lathe(&round, 7, lump), Paint::Foliage, SMOOTH);
    let mut dice = Dice::new(120);
    let mut grow = |mesh: usize, x: f32, z: f32, dice: &mut Dice| {
        let scale = Vec3::new(1.0, dice.between(0.8, 1.2), 1.0) * dice.between(0.75, 1.3);
        builder.place_sized(group, mesh, on_land(x, z), scale, dice.roll() * TAU);
    };
    for index in 0..26 {
        let along = 8.5 * index as f32;
        grow(poplar, -118.0 + 0.97 * along, -212.0 - 0.24 * along, &mut dice);
    }
    for index in 0..63 {
        let hedge = (index / 9) as f32 * 1.4;
        let step = (index % 9) as f32;
        let (x, z) = (-320.0 + 71.0 * hedge + 11.0 * step, -250.0 - 37.0 * ((index / 9 * 7) % 10) as f32 + 5.0 * step);
        grow(round, x + dice.between(-4.0, 4.0), z + dice.between(-4.0, 4.0), &mut dice);
    }
    for _ in 0..45 {
        let (turn, away) = (dice.between(-0.9, 0.9), dice.between(480.0, 800.0));
        grow(round, away * turn.sin(), -away * turn.cos(), &mut dice);
    }
    for (x, z) in [(-62.0, -92.0), (-68.0, -97.0), (-58.0, -99.0), (38.0, -74.0), (96.0, -148.0), (-39.0, -120.0)] {
        grow(round, x, z, &mut dice);
    }
}
