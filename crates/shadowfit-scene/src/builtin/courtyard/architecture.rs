//! The courtyard's buildings: floor, loggia with colonnade and roof, free columns, far arcade.

use std::f32::consts::TAU;

use glam::{Quat, Vec2, Vec3};

use super::palette::Paint;
use crate::builtin::build::{Builder, CRISP, SMOOTH};
use crate::builtin::shapes::{Arch, block, ellipsoid, lathe, modulated_lathe};
use crate::builtin::solid::Solid;
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
/// Where the row of columns stands along z.
const ROW: f32 = -6.4;
/// Where the middle of the rear wall stands along z.
const WALL: f32 = -8.2;
/// Slope of the roof, in radians.
const PITCH: f32 = 0.245;

/// Adds everything built of stone.
pub(super) fn build(builder: &mut Builder) {
    let floor = builder.mesh("floor", vec![floor()]);
    builder.node("floor", None, Transform::default(), Some(floor));
    let column = column(builder);
    loggia(builder, column);
    free_columns(builder, column);
    arcade(builder);
}

/// The floor: an open sheet that faces up, 1 m of texture coordinate a metre.
fn floor() -> Primitive {
    let mut primitive = Primitive { material: Paint::Paving.index(), ..Primitive::default() };
    let step = FLOOR / FLOOR_QUADS as f32;
    let count = FLOOR_QUADS as u32 + 1;
    for row in 0..count {
        for column in 0..count {
            let at = Vec2::new(column as f32, row as f32) * step - FLOOR / 2.0;
            primitive.positions.push(Vec3::new(at.x, 0.0, at.y));
            primitive.normals.push(Vec3::Y);
            primitive.uvs.push(at);
        }
    }
    for row in 0..count - 1 {
        for column in 0..count - 1 {
            let a = row * count + column;
            let [b, c, d] = [a + count, a + count + 1, a + 1];
            primitive.indices.extend([a, b, c, a, c, d]);
        }
    }
    primitive
}

/// A fluted column on a square foot, with a square slab above its capital.
fn column(builder: &mut Builder) -> usize {
    let shaft: Vec<(f32, f32)> = (0..=5)
        .map(|step| {
            let t = step as f32 / 5.0;
            // Entasis: the outline swells by a centimetre below the middle.
            (0.19 - 0.035 * t + 0.010 * (t * TAU / 2.0).sin(), 0.2 + 2.98 * t)
        })
        .collect();
    let flute = |turn: f32, _: f32| 1.0 - 0.085 * (turn * 10.0).sin().abs().sqrt();
    let shaft = modulated_lathe(&shaft, 80, flute);
    let base = [
        (0.245, 0.07),
        (0.262, 0.085),
        (0.268, 0.105),
        (0.262, 0.125),
        (0.245, 0.14),
        (0.222, 0.145),
        (0.215, 0.16),
        (0.222, 0.178),
        (0.235, 0.19),
        (0.238, 0.203),
        (0.232, 0.216),
        (0.215, 0.226),
        (0.20, 0.228),
    ];
    let capital = [
        (0.15, 2.655),
        (0.178, 2.66),
        (0.184, 2.672),
        (0.178, 2.685),
        (0.165, 2.69),
        (0.168, 2.72),
        (0.185, 2.765),
        (0.214, 2.81),
        (0.238, 2.84),
        (0.248, 2.862),
        (0.246, 2.88),
        (0.235, 2.892),
    ];
    let foot = block(Vec3::new(-0.28, -0.01, -0.28), Vec3::new(0.28, 0.08, 0.28), 0.008);
    let slab = block(Vec3::new(-0.27, 3.385, -0.27), Vec3::new(0.27, COLUMN + 0.01, 0.27), 0.008);
    let round = lathe(&base, 26).with(lathe(&capital, 26).moved(Vec3::Y * (COLUMN - 3.0))).with(foot).with(slab);
    let primitives = vec![shaft.primitive(Paint::Marble.index(), CRISP), round.primitive(Paint::Marble.index(), 0.75)];
    builder.mesh("column", primitives)
}

/// The loggia: platform, colonnade, rear wall, roof.
fn loggia(builder: &mut Builder, column: usize) {
    let group = builder.group("loggia", Vec3::new(MIDDLE, 0.0, 0.0), 0.0);
    let mut platform = Solid::default();
    for step in 0..3 {
        let rise = step as f32;
        let low = Vec3::new(-HALF_WIDTH + 0.3 * rise, 0.1 * rise - 0.02, -9.1 + 0.1 * rise);
        let high = Vec3::new(HALF_WIDTH - 0.3 * rise, 0.15 * (rise + 1.0), -4.95 - 0.34 * rise);
        platform = platform.with(block(low, high, 0.014));
    }
    let platform = builder.solid("platform", &platform, Paint::Stone, CRISP);
    builder.place(group, platform, Vec3::ZERO, 0.0);
    for index in 0..8 {
        let x = -7.0 + 2.0 * index as f32;
        builder.place(group, column, Vec3::new(x, PLATFORM, ROW), 0.0);
    }
    rear_wall(builder, group);
    roof(builder, group);
}

/// The wall behind the colonnade, with a doorway under an arch.
fn rear_wall(builder: &mut Builder, group: usize) {
    let door = Arch { width: 2.4, height: 4.15, depth: 0.52, radius: 0.75, spring: 2.0 };
    let door = builder.solid("doorway", &door.solid(24), Paint::Stone, CRISP);
    builder.place(group, door, Vec3::new(1.0, PLATFORM - 0.01, WALL), 0.0);
    let top = 4.80;
    let part =
        |from: f32, to: f32, low: f32| block(Vec3::new(from, low, WALL - 0.18), Vec3::new(to, top, WALL + 0.18), 0.01);
    let wall = part(-7.55, -0.1, PLATFORM - 0.01).with(part(2.1, 7.55, PLATFORM - 0.01)).with(part(-0.15, 2.15, 4.3));
    let wall = builder.solid("rear wall", &wall, Paint::Plaster, CRISP);
    builder.place(group, wall, Vec3::ZERO, 0.0);
    let skirting = block(Vec3::new(-7.58, 0.43, WALL - 0.22), Vec3::new(-0.12, 0.72, WALL + 0.22), 0.01).with(block(
        Vec3::new(2.12, 0.43, WALL - 0.22),
        Vec3::new(7.58, 0.72, WALL + 0.22),
        0.01,
    ));
    let skirting = builder.solid("skirting", &skirting, Paint::Stone, CRISP);
    builder.place(group, skirting, Vec3::ZERO, 0.0);
}

/// Beam, rafters, boards and rows of round tiles, overhanging the colonnade.
fn roof(builder: &mut Builder, group: usize) {
    let beam_top = PLATFORM + COLUMN + 0.28;
    let beam = block(Vec3::new(-7.6, beam_top - 0.285, ROW - 0.15), Vec3::new(7.6, beam_top, ROW + 0.15), 0.01);
    let beam = builder.solid("beam", &beam, Paint::Timber, CRISP);
    builder.place(group, beam, Vec3::ZERO, 0.0);
    let tilt = Transform {
        translation: Vec3::new(0.0, beam_top - 0.02, ROW),
        rotation: Quat::from_rotation_x(PITCH),
        ..Transform::default()
    };
    let slope = builder.node("roof", Some(group), tilt, None);
    let rafter = block(Vec3::new(-0.05, 0.0, -2.55), Vec3::new(0.05, 0.15, 0.72), 0.008);
    let rafter = builder.solid("rafter", &rafter, Paint::Timber, CRISP);
    for index in 0..31 {
        builder.place(slope, rafter, Vec3::new(-7.5 + 0.5 * index as f32, 0.0, 0.0), 0.0);
    }
    let boards = block(Vec3::new(-7.95, 0.14, -2.7), Vec3::new(7.95, 0.19, 0.80), 0.006);
    let boards = builder.solid("roof boards", &boards, Paint::Roof, CRISP);
    builder.place(slope, boards, Vec3::ZERO, 0.0);
    let tile = tile_row();
    let tile = builder.solid("tile row", &tile, Paint::Roof, SMOOTH);
    for index in 0..63 {
        builder.place(slope, tile, Vec3::new(-7.75 + 0.25 * index as f32, 0.185, 0.86), 0.0);
    }
}

/// A row of overlapping round tiles along -z, each wider at its lower end.
fn tile_row() -> Solid {
    let mut profile = vec![(0.05, 0.0)];
    for tile in 0..7 {
        let start = 0.515 * tile as f32;
        profile.extend([(0.085, start + 0.001), (0.07, start + 0.51)]);
    }
    lathe(&profile, 8).transformed(glam::Affine3A::from_rotation_x(-TAU / 4.0))
}

/// Columns without a roof: two whole ones with a bronze ball, one broken off.
fn free_columns(builder: &mut Builder, column: usize) {
    let group = builder.group("free columns", Vec3::ZERO, 0.0);
    let stand = block(Vec3::new(-0.42, -0.01, -0.42), Vec3::new(0.42, 0.3, 0.42), 0.012);
    let stand = builder.solid("pedestal", &stand, Paint::Stone, CRISP);
    let ball = ellipsoid(Vec3::splat(0.3), 36, 22);
    let ball = builder.solid("ball", &ball, Paint::Bronze, SMOOTH);
    for at in [Vec3::new(-5.2, 0.0, -1.2), Vec3::new(8.6, 0.0, -1.6)] {
        builder.place(group, stand, at, 0.0);
        builder.place(group, column, at + Vec3::Y * 0.295, 0.0);
        builder.place(group, ball, at + Vec3::Y * (COLUMN + 0.58), 0.0);
    }
}

/// A far row of arches, and an obelisk before it.
fn arcade(builder: &mut Builder) {
    let group = builder.group("arcade", Vec3::ZERO, 0.0);
    let arch = Arch { width: 4.2, height: 6.2, depth: 1.1, radius: 1.5, spring: 3.4 };
    let cornice = block(Vec3::new(-2.04, 6.05, -0.7), Vec3::new(2.04, 6.45, 0.7), 0.03);
    let arch = arch.solid(24).moved(Vec3::Y * -0.02).with(cornice);
    let arch = builder.solid("arch", &arch, Paint::Stone, CRISP);
    // Along the far side, then toward the eye on the right; neighbours overlap, so every second one
    // is a little thinner and lower, so that faces do not coincide.
    for index in 0..24 {
        let (at, yaw) = if index < 15 {
            (Vec3::new(-24.0 + 4.1 * index as f32, 0.0, -34.0), 0.0)
        } else {
            (Vec3::new(36.0, 0.0, -31.0 + 4.1 * (index - 15) as f32), TAU / 4.0)
        };
        let odd = (index % 2) as f32;
        let node = builder.place(group, arch, at - Vec3::Y * 0.01 * odd, yaw);
        builder.scene.nodes[node].rest.scale.z = 1.0 - 0.02 * odd;
    }
    let shaft = [(0.78, 0.55), (0.46, 9.4), (0.0, 10.3)];
    let foot = block(Vec3::new(-0.9, -0.02, -0.9), Vec3::new(0.9, 0.6, 0.9), 0.02);
    let obelisk = lathe(&shaft, 4).with(foot);
    let obelisk = builder.solid("obelisk", &obelisk, Paint::Marble, 0.1);
    builder.place(group, obelisk, Vec3::new(17.0, 0.0, -19.0), TAU / 8.0 + 0.3);
}
