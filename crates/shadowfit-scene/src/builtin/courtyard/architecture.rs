//! The courtyard's buildings: floor, loggia with colonnade and roof, free columns, far arcade.

use std::f32::consts::TAU;

use glam::{Affine3A, Quat, Vec3};

use super::palette::Paint;
use crate::parts::{
    Arch, Builder, CRISP, SMOOTH, Solid, block, ellipsoid, ground, lathe, modulated_lathe, pillar, turned,
};
use crate::{Primitive, Transform};

/// Side of the floor, in metres.
const FLOOR: f32 = 120.0;
/// Quads along a side of the floor.
const FLOOR_QUADS: usize = 24;
/// Height of the loggia's platform above the floor.
const PLATFORM: f32 = 0.45;
/// Height of a column with base and capital.
const COLUMN: f32 = 3.5;
/// Middle of the loggia along x.
const MIDDLE: f32 = 1.0;
/// Half of the platform's width.
const HALF_WIDTH: f32 = 8.2;
/// Position of the row of columns along z, in metres.
const ROW: f32 = -6.4;
/// Position of the middle of the rear wall along z, in metres.
const WALL: f32 = -8.2;
/// Slope of the roof, in radians.
const PITCH: f32 = 0.245;

/// Adds everything built of stone.
pub(super) fn build(builder: &mut Builder) {
    builder.lay("floor", floor());
    let column = column(builder);
    loggia(builder, column);
    free_columns(builder, column);
    arcade(builder);
}

/// Builds the floor: level, of one colour.
fn floor() -> Primitive {
    let step = FLOOR / FLOOR_QUADS as f32;
    let lines: Vec<f32> = (0..=FLOOR_QUADS).map(|line| line as f32 * step - FLOOR / 2.0).collect();
    let mut floor = ground(Paint::Paving.into(), [&lines, &lines], |_, _| 0.0, |_| Vec3::ONE);
    floor.colors.clear();
    floor.normals.fill(Vec3::Y);
    floor
}

/// Builds a fluted column on a square foot, with a square slab above its capital.
fn column(builder: &mut Builder) -> usize {
    let point = |step: usize| {
        let t = step as f32 / 5.0;
        // Entasis: the outline swells by a centimetre below the middle.
        (0.19 - 0.035 * t + 0.010 * (t * TAU / 2.0).sin(), 0.2 + 2.98 * t)
    };
    let shaft: Vec<(f32, f32)> = (0..=5).map(point).collect();
    let shaft = modulated_lathe(&shaft, 80, |turn, _| 1.0 - 0.085 * (turn * 10.0).sin().abs().sqrt());
    #[rustfmt::skip]
    let base = [
        (0.245, 0.07), (0.262, 0.085), (0.268, 0.105), (0.262, 0.125), (0.245, 0.14), (0.222, 0.145), (0.215, 0.16),
        (0.222, 0.178), (0.235, 0.19), (0.238, 0.203), (0.232, 0.216), (0.215, 0.226), (0.20, 0.228),
    ];
    #[rustfmt::skip]
    let capital = [
        (0.15, 2.655), (0.178, 2.66), (0.184, 2.672), (0.178, 2.685), (0.165, 2.69), (0.168, 2.72), (0.185, 2.765),
        (0.214, 2.81), (0.238, 2.84), (0.248, 2.862), (0.246, 2.88), (0.235, 2.892),
    ];
    let foot = pillar([0.28; 2], [-0.01, 0.08], 0.008);
    let slab = pillar([0.27; 2], [3.385, COLUMN + 0.01], 0.008);
    let round = lathe(&base, 26).with(lathe(&capital, 26).moved(Vec3::Y * (COLUMN - 3.0))).with(foot).with(slab);
    builder.solids("column", [(shaft, Paint::Marble, CRISP), (round, Paint::Marble, 0.75)])
}

/// Adds the loggia: platform, colonnade, rear wall, roof.
fn loggia(builder: &mut Builder, column: usize) {
    let group = builder.group("loggia", [MIDDLE, 0.0, 0.0], 0.0);
    let step = |step: u8| {
        let rise = f32::from(step);
        let low = [-HALF_WIDTH + 0.3 * rise, 0.1 * rise - 0.02, -9.1 + 0.1 * rise];
        block(low, [HALF_WIDTH - 0.3 * rise, 0.15 * (rise + 1.0), -4.95 - 0.34 * rise], 0.014)
    };
    builder.fix(group, "platform", &(0..3).map(step).collect(), Paint::Stone, CRISP);
    for index in 0..8 {
        builder.place(group, column, [-7.0 + 2.0 * index as f32, PLATFORM, ROW], 0.0);
    }
    rear_wall(builder, group);
    roof(builder, group);
}

/// Adds the wall behind the colonnade, with a doorway under an arch.
fn rear_wall(builder: &mut Builder, group: usize) {
    let door = Arch { width: 2.4, height: 4.15, depth: 0.52, radius: 0.75, spring: 2.0 };
    let door = builder.solid("doorway", &door.solid(24), Paint::Stone, CRISP);
    builder.place(group, door, [1.0, PLATFORM - 0.01, WALL], 0.0);
    let part = |[from, to]: [f32; 2], [low, high]: [f32; 2], half: f32| {
        block([from, low, WALL - half], [to, high, WALL + half], 0.01)
    };
    let wall = [([-7.55, -0.1], PLATFORM - 0.01), ([2.1, 7.55], PLATFORM - 0.01), ([-0.15, 2.15], 4.3)];
    let wall = wall.into_iter().map(|(along, low)| part(along, [low, 4.80], 0.18)).collect();
    builder.fix(group, "rear wall", &wall, Paint::Plaster, CRISP);
    let skirting = part([-7.58, -0.12], [0.43, 0.72], 0.22).with(part([2.12, 7.58], [0.43, 0.72], 0.22));
    builder.fix(group, "skirting", &skirting, Paint::Stone, CRISP);
}

/// Adds beam, rafters, boards and rows of round tiles, overhanging the colonnade.
fn roof(builder: &mut Builder, group: usize) {
    let beam_top = PLATFORM + COLUMN + 0.28;
    let beam = block([-7.6, beam_top - 0.285, ROW - 0.15], [7.6, beam_top, ROW + 0.15], 0.01);
    builder.fix(group, "beam", &beam, Paint::Timber, CRISP);
    let tilt =
        Transform { rotation: Quat::from_rotation_x(PITCH).as_dquat(), ..turned([0.0, beam_top - 0.02, ROW], 0.0) };
    let slope = builder.node("roof", Some(group), tilt, None);
    let rafter = block([-0.05, 0.0, -2.55], [0.05, 0.15, 0.72], 0.008);
    let rafter = builder.solid("rafter", &rafter, Paint::Timber, CRISP);
    for index in 0..31 {
        builder.place(slope, rafter, [-7.5 + 0.5 * index as f32, 0.0, 0.0], 0.0);
    }
    let boards = block([-7.95, 0.14, -2.7], [7.95, 0.19, 0.80], 0.006);
    builder.fix(slope, "roof boards", &boards, Paint::Roof, CRISP);
    let tile = builder.solid("tile row", &tile_row(), Paint::Roof, SMOOTH);
    for index in 0..63 {
        builder.place(slope, tile, [-7.75 + 0.25 * index as f32, 0.185, 0.86], 0.0);
    }
}

/// Builds a row of overlapping round tiles along -z, each wider at its lower end.
fn tile_row() -> Solid {
    let mut profile = vec![(0.05, 0.0)];
    for tile in 0..7 {
        let start = 0.515 * tile as f32;
        profile.extend([(0.085, start + 0.001), (0.07, start + 0.51)]);
    }
    lathe(&profile, 8).transformed(Affine3A::from_rotation_x(-TAU / 4.0))
}

/// Adds columns without a roof: two whole ones with a bronze ball, one broken off.
fn free_columns(builder: &mut Builder, column: usize) {
    let group = builder.group("free columns", Vec3::ZERO, 0.0);
    let stand = builder.solid("pedestal", &pillar([0.42; 2], [-0.01, 0.3], 0.012), Paint::Stone, CRISP);
    let ball = builder.solid("ball", &ellipsoid([0.3; 3], 36, 22), Paint::Bronze, SMOOTH);
    for at in [Vec3::new(-5.2, 0.0, -1.2), Vec3::new(8.6, 0.0, -1.6)] {
        for (mesh, height) in [(stand, 0.0), (column, 0.295), (ball, COLUMN + 0.58)] {
            builder.place(group, mesh, at + Vec3::Y * height, 0.0);
        }
    }
}

/// Adds a far row of arches, and an obelisk before it.
fn arcade(builder: &mut Builder) {
    let group = builder.group("arcade", Vec3::ZERO, 0.0);
    let arch = Arch { width: 4.2, height: 6.2, depth: 1.1, radius: 1.5, spring: 3.4 };
    let arch = arch.solid(24).moved(Vec3::Y * -0.02).with(pillar([2.04, 0.7], [6.05, 6.45], 0.03));
    let arch = builder.solid("arch", &arch, Paint::Stone, CRISP);
    // The row follows the far side, then turns toward the eye on the right. Neighbours overlap. Every second
    // arch is a little thinner and lower, so that faces do not coincide.
    for index in 0..24 {
        let (at, yaw) = if index < 15 {
            (Vec3::new(-24.0 + 4.1 * index as f32, 0.0, -34.0), 0.0)
        } else {
            (Vec3::new(36.0, 0.0, -31.0 + 4.1 * (index - 15) as f32), TAU / 4.0)
        };
        let odd = (index % 2) as f32;
        builder.place_sized(group, arch, at - Vec3::Y * 0.01 * odd, [1.0, 1.0, 1.0 - 0.02 * odd], yaw);
    }
    let obelisk = lathe(&[(0.78, 0.55), (0.46, 9.4), (0.0, 10.3)], 4).with(pillar([0.9; 2], [-0.02, 0.6], 0.02));
    let obelisk = builder.solid("obelisk", &obelisk, Paint::Marble, 0.1);
    builder.place(group, obelisk, [17.0, 0.0, -19.0], TAU / 8.0 + 0.3);
}
