//! The gallery's shell: floor, rear and end walls, the wall over the arches, the groin vault and the roof.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Affine3A, Vec3};

use super::palette::Paint;
use super::plan::{ARCH, BAY, BAYS, END, HALF, ROW, SPRING, START, THICK, column_places};
use crate::parts::{Arch, Builder, CRISP, Solid, block, extrude, prism, wall_over};

/// Rise of the vault above its spring line, in metres.
const RISE: f32 = 1.55;
/// Height of the walls, in metres: above the vault's crown.
const WALL: f32 = 4.75;
/// Depth of the house behind the rear wall, in metres. The house hides any light that leaks through the wall
/// from the ground behind it.
const HOUSE: f32 = 9.5;
/// Height of the red foot of the walls, in metres.
const DADO: f32 = 0.85;
/// Segments of an arch and of a bay of the vault.
const SEGMENTS: usize = 16;
/// Crease angle of the vault, in radians: slightly more than the angle between two segments of a barrel, so
/// that groins stay sharp almost up to the crown.
const GROIN: f32 = 0.2;

/// Adds the shell.
pub(super) fn build(builder: &mut Builder) {
    let group = builder.group("gallery", Vec3::ZERO, 0.0);
    let floor = block([-2.5, -0.5, END - 0.7], [3.1, 0.0, START + 0.7], 0.01);
    let step = block([2.9, -0.6, END - 1.2], [3.5, -0.15, START + 1.2], 0.01);
    let rear = block([-HALF - HOUSE, -0.5, END - 0.6], [-HALF, WALL, START + 0.6], 0.01);
    let dado = block([-HALF - 0.2, -0.05, END - 0.1], [-HALF + 0.018, DADO, START + 0.1], 0.006);
    let rail = block([-HALF - 0.24, DADO - 0.03, END - 0.1], [-HALF + 0.04, DADO + 0.03, START], 0.012);
    let wall = arcade_wall(BAYS).moved([ROW, SPRING, 0.0]);
    for (name, solid, paint, crease) in [
        ("floor", floor, Paint::Tiles, CRISP),
        ("step", step, Paint::Stone, CRISP),
        ("rear wall", rear, Paint::Plaster, CRISP),
        ("dado", dado, Paint::Dado, CRISP),
        ("dado rail", rail, Paint::Stone, CRISP),
        ("vault", vault(), Paint::Vault, GROIN),
        ("arcade wall", wall, Paint::Stone, CRISP),
        ("roof", roof(), Paint::Roof, CRISP),
    ] {
        builder.fix(group, name, &solid, paint, crease);
    }
    ends(builder, group);
    ribs(builder, group);
}

/// Builds the wall over the arches: `bays` arches along z from [`START`], centred on x = 0. The tops of their
/// columns are at y = 0.
pub(super) fn arcade_wall(bays: usize) -> Solid {
    // The ends extend a little into the adjoining walls.
    let mut edge = vec![(-0.05, 0.0)];
    for bay in 0..bays {
        let middle = BAY * (bay as f32 + 0.5);
        edge.extend((0..=SEGMENTS).map(|step| {
            let (sin, cos) = (step as f32 / SEGMENTS as f32 * PI).sin_cos();
            (middle - cos * ARCH, sin.max(0.0) * ARCH)
        }));
    }
    edge.push((BAY * bays as f32 + 0.05, 0.0));
    let wall = wall_over(&edge, WALL - SPRING, THICK);
    // Turns x into -z.
    wall.transformed(Affine3A::from_rotation_y(FRAC_PI_2)).moved(Vec3::Z * START)
}

/// Returns the height of a barrel vault at `share` of its half width, -1..1.
fn barrel(share: f32) -> f32 {
    RISE * (1.0 - share * share).max(0.0).sqrt()
}

/// Positions across and along the vault.
const COLUMNS: usize = SEGMENTS + 1;
const ROWS: usize = SEGMENTS * BAYS + 1;

/// Returns the positions of the vault by row, then the two edges of its flat top for each row.
fn vault_positions() -> Vec<Vec3> {
    // Positions at equal angles of a half circle make its segments equally long.
    let share = |step: usize| -(step as f32 / SEGMENTS as f32 * PI).cos();
    let mut positions = Vec::new();
    for row in 0..ROWS {
        let along = share(row % SEGMENTS);
        let z = START - BAY * ((row / SEGMENTS) as f32 + 0.5 * (along + 1.0));
        for column in 0..COLUMNS {
            let across = share(column);
            // The edges extend into the walls.
            let x = across * (HALF + 0.05);
            positions.push(Vec3::new(x, SPRING + barrel(across).max(barrel(along)), z));
        }
    }
    for row in 0..ROWS {
        for column in [0, COLUMNS - 1] {
            let edge = positions[row * COLUMNS + column];
            positions.push(edge.with_y(WALL - 0.12));
        }
    }
    positions
}

/// Builds the groin vault: where two barrels cross, the higher one bounds the room. The top is flat, so that
/// no light leaks through.
fn vault() -> Solid {
    let mut solid = Solid { positions: vault_positions(), ..Solid::default() };
    let triangles = &mut solid.triangles;
    let at = |row: usize, column: usize| (row * COLUMNS + column) as u32;
    let top = |row: usize, side: u32| at(ROWS, 0) + 2 * row as u32 + side;
    for row in 0..ROWS - 1 {
        for column in 0..COLUMNS - 1 {
            let [a, b, c, d] = [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
            // Diagonals follow the groins, which cross in the middle of a bay.
            let is_even = (row % SEGMENTS < SEGMENTS / 2) == (column < SEGMENTS / 2);
            triangles.extend(if is_even { [[a, d, c], [a, c, b]] } else { [[b, a, d], [b, d, c]] });
        }
        let (left, right) = ([at(row, 0), at(row + 1, 0)], [at(row, COLUMNS - 1), at(row + 1, COLUMNS - 1)]);
        let [a, b, c, d] = [top(row, 0), top(row, 1), top(row + 1, 1), top(row + 1, 0)];
        triangles.extend([[a, b, c], [a, c, d], [left[0], a, d], [left[0], d, left[1]]]);
        triangles.extend([[right[0], right[1], c], [right[0], c, b]]);
    }
    // The triangles of each half of an end's arch meet in the upper corner of their side.
    for column in 0..COLUMNS - 1 {
        let side = u32::from(column >= COLUMNS / 2);
        triangles.push([top(0, side), at(0, column), at(0, column + 1)]);
        triangles.push([top(ROWS - 1, side), at(ROWS - 1, column + 1), at(ROWS - 1, column)]);
    }
    triangles.push([top(0, 0), at(0, COLUMNS / 2), top(0, 1)]);
    triangles.push([top(ROWS - 1, 0), top(ROWS - 1, 1), at(ROWS - 1, COLUMNS / 2)]);
    solid
}

/// Adds ribs across the vault, from pilasters at the rear wall to the columns.
fn ribs(builder: &mut Builder, group: usize) {
    let arc = |width: f32, rise: f32| {
        move |step: usize| {
            let (sin, cos) = (step as f32 / SEGMENTS as f32 * PI).sin_cos();
            (cos * width, sin.max(0.0) * rise)
        }
    };
    let (outer, inner) = (arc(HALF + 0.04, RISE + 0.06), arc(HALF - 0.13, RISE - 0.13));
    let mut outline: Vec<(f32, f32)> = (0..=SEGMENTS).map(outer).collect();
    outline.extend((0..=SEGMENTS).rev().map(inner));
    let last = 2 * SEGMENTS as u32 + 1;
    let faces: Vec<[u32; 3]> =
        (0..SEGMENTS as u32).flat_map(|a| [[a, a + 1, last - a - 1], [a, last - a - 1, last - a]]).collect();
    let rib = extrude(&outline, &faces, 0.42);
    let rib = builder.solid("rib", &rib, Paint::Stone, CRISP);
    let shaft = block([-0.1, -0.02, -0.21], [0.12, SPRING - 0.1, 0.21], 0.01);
    let foot = block([-0.12, -0.02, -0.26], [0.17, 0.22, 0.26], 0.015);
    let head = block([-0.14, SPRING - 0.16, -0.27], [0.2, SPRING + 0.02, 0.27], 0.02);
    let collar = block([-0.16, SPRING - 0.3, -0.235], [0.145, SPRING - 0.25, 0.235], 0.012);
    let pilaster = builder.solid("pilaster", &shaft.with(foot).with(head).with(collar), Paint::Stone, CRISP);
    for z in column_places() {
        builder.place(group, rib, [0.0, SPRING, z], 0.0);
        builder.place(group, pilaster, [-HALF, 0.0, z], 0.0);
    }
}

/// Adds the walls at both ends: an open doorway far ahead, a closed door behind the eye.
fn ends(builder: &mut Builder, group: usize) {
    let doorway = Arch { width: 2.0 * HALF + 1.2, height: WALL, depth: 0.55, radius: 1.05, spring: 2.1 };
    let wall = builder.solid("end wall", &doorway.solid(24), Paint::Plaster, CRISP);
    builder.place(group, wall, [0.0, -0.005, END - 0.2], 0.0);
    builder.place(group, wall, [0.0, -0.005, START + 0.2], 0.0);
    side_door(builder, group);
    let frame = Arch { width: 2.6, height: 3.5, depth: 0.7, radius: 1.0, spring: 2.1 };
    let frame = builder.solid("doorway", &frame.solid(24), Paint::Stone, CRISP);
    builder.place(group, frame, [0.0, -0.01, END - 0.2], 0.0);
    let door = block([-1.2, -0.02, -0.06], [1.2, 3.3, 0.06], 0.01);
    let door = builder.solid("door", &door, Paint::Timber, CRISP);
    builder.place(group, door, [0.0, 0.0, START + 0.2], 0.0);
}

/// Adds a closed door in the rear wall, under a stone arch that projects from it.
fn side_door(builder: &mut Builder, group: usize) {
    let frame = Arch { width: 1.9, height: 2.75, depth: 0.34, radius: 0.68, spring: 1.72 };
    let frame = builder.solid("side doorway", &frame.solid(20), Paint::Stone, CRISP);
    let leaf = |from: f32| block([from, 0.0, -0.03], [from + 0.28, 2.42, 0.03], 0.012);
    let batten = |height: f32| block([-0.66, height, 0.0], [0.66, height + 0.12, 0.05], 0.008);
    let leaves = (0..5).map(|index| leaf(-0.7 + 0.28 * index as f32)).chain([0.35, 1.75].map(batten)).collect();
    let leaves = builder.solid("side door", &leaves, Paint::Timber, CRISP);
    let z = START - 4.5 * BAY;
    builder.place(group, frame, [-HALF, -0.01, z], FRAC_PI_2);
    builder.place(group, leaves, [-HALF + 0.05, 0.01, z], FRAC_PI_2);
}

/// Builds a roof over gallery and house, which overhangs the arcade's wall.
fn roof() -> Solid {
    let [eaves, back] = [HALF + 1.1, -HALF - HOUSE - 0.5];
    let ridge = (f32::midpoint(eaves, back), WALL + 2.4);
    let outline = [(back, WALL - 0.05), (eaves, WALL - 0.05), (eaves, WALL + 0.07), ridge, (back, WALL + 0.07)];
    let length = START - END + 1.6;
    prism(&outline, length).moved(Vec3::Z * (START + END) / 2.0)
}
