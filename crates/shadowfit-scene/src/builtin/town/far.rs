//! Farther buildings: the gate tower across the street, slender towers, passages over side streets, roofs behind the
//! rows, and trees on the hills.

use std::f32::consts::{FRAC_PI_2, SQRT_2, TAU};

use glam::{Affine3A, Vec3};

use super::house::{Detail, Ground, roll};
use super::kit::Kit;
use super::palette::Paint;
use super::plan::{DEPTH, EAST, END, GATE, GATE_HALF, START, STREET};
use super::roof::Saddle;
use crate::parts::{Arch, Builder, Dice, SMOOTH, Solid, ellipsoid, gabled, hash, lathe, plank};

/// Merlons around the crown of the round tower.
const MERLONS: usize = 12;
/// Plans that the houses behind the rows share.
const BACK_PLANS: usize = 6;
/// Distance between houses behind the rows, along x and z in metres.
const BACK_STEP: [f32; 2] = [15.0, 14.0];

/// Adds everything far.
pub(super) fn build(builder: &mut Builder) {
    let group = builder.group("far", Vec3::ZERO, 0.0);
    let gate = gate().mesh(builder, "gate tower");
    builder.place(group, gate, [0.0, 0.0, GATE], 0.0);
    let round = round_tower().mesh(builder, "round tower");
    builder.place(group, round, [22.5, 0.0, -98.0], 0.4);
    let spire = far_spire().mesh(builder, "far spire");
    builder.place(group, spire, [-23.0, 0.0, -134.0], 0.0);
    passages(builder, group);
    back_houses(builder, group);
    far_trees(builder, group);
}

/// Returns a pyramid or a stack of square frustums from half widths and heights.
fn square(outline: &[(f32, f32)]) -> Solid {
    let wide: Vec<_> = outline.iter().map(|&(half, y)| (half * SQRT_2, y)).collect();
    lathe(&wide, 4).transformed(Affine3A::from_rotation_y(TAU / 8.0))
}

/// Builds the gate tower, which spans the street with an arch.
fn gate() -> Kit {
    let mut kit = Kit::default();
    let arch = Arch { width: 2.0 * STREET, height: 9.0, depth: 2.0 * GATE_HALF, radius: 2.6, spring: 3.4 };
    kit.add(Paint::Stone, arch.solid(18).moved(Vec3::Y * -0.2));
    let half = GATE_HALF - 0.3;
    kit.plank(Paint::Stone, [-half - 0.2, 8.7, -half], [half + 0.2, 18.5, half]);
    for (y, out) in [(8.6, 0.45), (13.4, 0.15), (18.0, 0.5)] {
        kit.plank(Paint::Trim, [-half - out, y, -half - out], [half + out, y + 0.4, half + out]);
    }
    for side in [-1.0, 1.0] {
        let z = side * half;
        let [low, high] = [z - 0.08, z + 0.08];
        for x in [-1.6, 1.6] {
            kit.plank(Paint::Dark, [x - 0.45, 10.2, low], [x + 0.45, 12.0, high]);
            kit.plank(Paint::Dark, [x - 0.45, 14.8, low], [x + 0.45, 16.6, high]);
        }
        let wing = Saddle { half: GATE_HALF, eaves: 8.7, ridge: 11.6, over: 0.3 };
        let at = [side * (STREET + 4.7) / 2.0, 0.0, 0.0];
        let turn = glam::Quat::from_rotation_y(FRAC_PI_2);
        kit.add(Paint::OldTile, wing.slopes(STREET - 2.9).posed(turn, at));
        kit.add(Paint::Stone, gabled(GATE_HALF - 0.02, [8.6, 8.72, 11.55], STREET - 3.1).posed(turn, at));
    }
    kit.add(Paint::Tile, square(&[(half + 0.75, 18.3), (half + 0.7, 18.5), (2.2, 21.6), (0.9, 25.0), (0.0, 27.0)]));
    kit.add(Paint::Gold, ellipsoid([0.25; 3], 10, 6).moved(Vec3::Y * 27.1));
    kit
}

/// Builds the round tower, with battlements and a pointed roof.
fn round_tower() -> Kit {
    const CROWN: f32 = 24.0;
    let shaft = [(3.0, -0.3), (2.9, 2.0), (2.55, 3.0), (2.3, CROWN - 2.6), (2.35, CROWN - 2.5), (2.95, CROWN - 1.2)];
    let crown = [(2.95, CROWN), (2.6, CROWN), (2.6, CROWN - 0.7)];
    let turret = lathe(&[(1.7, CROWN - 1.0), (1.7, CROWN + 3.4), (1.85, CROWN + 3.6)], 18);
    let merlons = plank([-0.38, CROWN - 0.05, 2.55], [0.38, CROWN + 1.0, 2.91]).around(MERLONS);
    let roof = lathe(&[(2.2, CROWN + 3.5), (2.15, CROWN + 3.7), (0.8, CROWN + 7.6), (0.0, CROWN + 10.8)], 18);
    let slits = (0..6).map(|index| {
        let y = 4.0 + 3.0 * index as f32;
        let slit = plank([-0.2, y, 1.6], [0.2, y + 1.4, 2.56 - 0.0105 * y]);
        slit.transformed(Affine3A::from_rotation_y(4.0 + 0.9 * index as f32))
    });
    let mut kit = Kit::default();
    kit.add(Paint::Stone, lathe(&[&shaft[..], &crown].concat(), 24).with(turret).with(merlons));
    kit.add(Paint::Tile, roof);
    kit.add(Paint::Dark, slits.collect());
    kit
}

/// Builds a slender white tower with a tall spire.
fn far_spire() -> Kit {
    let mut kit = Kit::default();
    kit.plank(Paint::Lime, [-2.4, -0.3, -2.4], [2.4, 22.0, 2.4]);
    for (y, out) in [(9.0, 0.12), (16.0, 0.12), (21.73, 0.3)] {
        kit.plank(Paint::Trim, [-2.4 - out, y, -2.4 - out], [2.4 + out, y + 0.3, 2.4 + out]);
    }
    let window = plank([-0.55, 17.2, 2.3], [0.55, 20.4, 2.43]);
    kit.add(Paint::Dark, window.around(4));
    kit.add(Paint::Slate, square(&[(2.75, 21.9), (2.7, 22.1), (1.6, 24.4), (0.75, 31.0), (0.0, 38.0)]));
    kit.add(Paint::Gold, ellipsoid([0.25; 3], 10, 6).moved(Vec3::Y * 38.1));
    kit
}

/// Adds vaulted passages with a room above them, over the side streets east and west.
fn passages(builder: &mut Builder, group: usize) {
    let mut kit = Kit::default();
    let arch = Arch { width: 4.6, height: 4.6, depth: 3.4, radius: 1.6, spring: 2.0 };
    kit.add(Paint::Stone, arch.solid(16).moved(Vec3::Y * -0.2));
    kit.plank(Paint::Rose, [-2.3, 4.35, -1.6], [2.3, 6.7, 1.6]);
    let roof = Saddle { half: 1.6, eaves: 6.7, ridge: 8.2, over: 0.25 };
    let turn = glam::Quat::from_rotation_y(FRAC_PI_2);
    kit.add(Paint::Rose, gabled(1.58, [6.65, 6.68, 8.17], 4.5).posed(turn, Vec3::ZERO));
    kit.add(Paint::Tile, roof.slopes(4.62).posed(turn, Vec3::ZERO));
    for x in [-1.0, 1.0] {
        kit.plank(Paint::Frame, [x - 0.4, 5.0, 1.49], [x + 0.4, 6.2, 1.62]);
        kit.plank(Paint::Glass, [x - 0.33, 5.07, 1.5], [x + 0.33, 6.13, 1.635]);
    }
    let passage = kit.mesh(builder, "passage");
    for (x, z, yaw) in [(EAST + 2.6, -14.75, -FRAC_PI_2), (STREET + 3.0, -66.25, -FRAC_PI_2)] {
        builder.place(group, passage, [x, 0.0, z], yaw);
    }
}

/// Returns whether a house behind the rows overlaps the square, its buildings or a row.
fn is_taken(x: f32, z: f32) -> bool {
    let east = (-50.0..30.0).contains(&z) && (0.0..35.0).contains(&x);
    let west = (-52.0..30.0).contains(&z) && (-39.0..0.0).contains(&x);
    let nave = (-92.0..-30.0).contains(&z) && (-30.0..0.0).contains(&x);
    let towers = [(22.5, -98.0), (-23.0, -134.0)].iter().any(|&(a, b)| (x - a).hypot(z - b) < 9.5);
    east || west || nave || towers || x.abs() < STREET + DEPTH + 5.5
}

/// Adds houses behind the rows, of shared plans without recesses.
fn back_houses(builder: &mut Builder, group: usize) {
    let mut dice = Dice::new(7);
    let plans: Vec<usize> = (0..BACK_PLANS)
        .map(|index| {
            let mut house = roll(&mut dice, 7.6 + 0.5 * index as f32, index);
            house.detail = Detail::Back;
            house.floors = 2;
            house.has_balcony = false;
            house.shop = Ground::Home;
            house.kit().mesh(builder, "back house")
        })
        .collect();
    let (columns, rows) = (7, ((START - END) / BACK_STEP[1]) as usize);
    for index in 0..columns * rows {
        let (column, row) = (index % columns, index / columns);
        let x = (column as f32 - 3.0) * BACK_STEP[0] + dice.between(-1.5, 1.5);
        let z = START - 4.0 - BACK_STEP[1] * row as f32 + dice.between(-1.2, 1.2);
        let yaw = FRAC_PI_2 * (dice.roll() * 4.0).floor() + dice.between(-0.08, 0.08);
        let plan = (dice.roll() * BACK_PLANS as f32) as usize;
        if !is_taken(x, z) && dice.roll() < 0.46 {
            builder.place(group, plans[plan], [x, 0.15, z], yaw);
        }
    }
}

/// Adds trees between the gardens and on the hills.
fn far_trees(builder: &mut Builder, group: usize) {
    let crown = ellipsoid([1.0, 1.15, 1.0], 7, 5).moved(Vec3::Y * 1.55);
    let trunk = lathe(&[(0.12, -0.5), (0.09, 0.9)], 5);
    let tree = builder.solids("far tree", [(crown, Paint::Hedge, SMOOTH), (trunk, Paint::Timber, SMOOTH)]);
    let mut dice = Dice::new(19);
    for index in 0..44 {
        let side = if index % 2 == 0 { 1.0 } else { -1.0 };
        let x = side * dice.between(61.0, 96.0);
        let z = dice.between(END - 20.0, START + 10.0);
        let size = 2.0 + 2.2 * hash(index, 23);
        builder.place_sized(group, tree, [x, super::ground::height(x, z), z], [size; 3], TAU * dice.roll());
    }
}
