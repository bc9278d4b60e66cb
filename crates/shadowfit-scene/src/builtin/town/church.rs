//! The church: a tower of 38 m with an open belfry and a spire, a nave with buttresses behind it.
//!
//! The tower's shadow is 55 m long. Light falls through the belfry's arches, so that the shadow has holes.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::{Affine3A, Quat, Vec3};

use super::kit::Kit;
use super::palette::Paint;
use super::plan::NORTH;
use super::roof::Saddle;
use super::{SWAY_KEYS, SWAY_TIME};
use crate::Channel;
use crate::parts::{Arch, Builder, Solid, ellipsoid, gabled, lathe, plank, rotations};

/// Middle of the tower along x, in metres.
pub(super) const MIDDLE: f32 = -13.2;
/// Half of the tower's side, in metres.
const TOWER: f32 = 3.8;
/// Height of the belfry's floor and of its cornice, in metres.
const BELFRY: [f32; 2] = [18.0, 25.0];
/// Height of the spire's tip, in metres.
const TIP: f32 = 36.6;
/// Half of the nave's width, in metres.
const NAVE: f32 = 6.2;
/// Length of the nave behind the tower's middle, in metres.
const LENGTH: f32 = 23.4;
/// Height of the nave's eaves, in metres.
const EAVES: f32 = 9.5;

/// Adds the church and returns how its weather vane turns.
pub(super) fn build(builder: &mut Builder) -> Channel {
    let group = builder.group("church", [MIDDLE, 0.0, NORTH - TOWER], 0.0);
    let mut tower = Kit::default();
    shaft(&mut tower);
    belfry(&mut tower);
    spire(&mut tower);
    portal(&mut tower);
    let tower = tower.mesh(builder, "church tower");
    builder.place(group, tower, Vec3::ZERO, 0.0);
    let mut body = Kit::default();
    nave(&mut body);
    let body = body.mesh(builder, "nave");
    builder.place(group, body, Vec3::ZERO, 0.0);
    let mut vane = Kit::default();
    vane.plank(Paint::Gold, [-0.62, 0.02, -0.012], [0.5, 0.34, 0.012]);
    vane.plank(Paint::Gold, [0.48, 0.12, -0.02], [0.95, 0.24, 0.02]);
    let vane = vane.mesh(builder, "weather vane");
    let vane = builder.place(group, vane, [0.0, TIP + 0.7, 0.0], 0.0);
    rotations(vane, SWAY_TIME, SWAY_KEYS, |phase| {
        Quat::from_rotation_y(0.5 + 0.5 * phase.sin() + 0.2 * (2.0 * phase).sin())
    })
}

/// Returns `solid` on all four sides of the tower.
fn fourfold(solid: &Solid) -> Solid {
    solid.around(4)
}

/// Adds the shaft with bands, corner buttresses, slits and clocks.
fn shaft(kit: &mut Kit) {
    kit.plank(Paint::Stone, [-TOWER, -0.3, -TOWER], [TOWER, BELFRY[0], TOWER]);
    kit.plank(Paint::Granite, [-TOWER - 0.12, -0.3, -TOWER - 0.12], [TOWER + 0.12, 0.9, TOWER + 0.12]);
    for (y, out) in [(8.2, 0.14), (13.6, 0.14), (BELFRY[0] - 0.37, 0.22)] {
        kit.plank(Paint::Trim, [-TOWER - out, y, -TOWER - out], [TOWER + out, y + 0.35, TOWER + out]);
    }
    let mut buttress = plank([-TOWER - 0.55, -0.3, TOWER - 0.7], [-TOWER + 0.5, 7.2, TOWER + 0.55]);
    buttress = buttress.with(plank([-TOWER - 0.35, 7.1, TOWER - 0.6], [-TOWER + 0.4, 12.6, TOWER + 0.35]));
    kit.add(Paint::Stone, fourfold(&buttress));
    let slit = plank([-0.28, 10.0, TOWER - 0.1], [0.28, 12.2, TOWER + 0.03]);
    let sill = plank([-0.45, 9.8, TOWER - 0.1], [0.45, 10.02, TOWER + 0.16]);
    let head = plank([-0.45, 12.18, TOWER - 0.1], [0.45, 12.42, TOWER + 0.12]);
    kit.add(Paint::Dark, fourfold(&slit));
    kit.add(Paint::Trim, fourfold(&sill.with(head)));
    clock(kit);
}

/// Adds a clock with hands on each side.
fn clock(kit: &mut Kit) {
    let upright = Affine3A::from_rotation_x(FRAC_PI_2);
    let at = Affine3A::from_translation(Vec3::new(0.0, 15.7, TOWER));
    let rim = lathe(&[(1.32, -0.1), (1.36, 0.12), (1.22, 0.16), (1.16, 0.08), (0.0, 0.08)], 24);
    let face = lathe(&[(1.17, 0.0), (1.17, 0.10)], 24);
    kit.add(Paint::Gold, fourfold(&rim.transformed(at * upright)));
    kit.add(Paint::Frame, fourfold(&face.transformed(at * upright)));
    let marks = (0..12).map(|hour| {
        let turn = Affine3A::from_rotation_z(f32::from(hour as u8) / 12.0 * TAU);
        plank([-0.045, 0.88, 0.05], [0.045, 1.1, 0.12]).transformed(at * turn)
    });
    let hand = |turn: f32, length: f32, out: f32| {
        let hand = plank([-0.05, -0.2, 0.08], [0.05, length, out]);
        hand.transformed(at * Affine3A::from_rotation_z(turn))
    };
    let hands: Solid = marks.chain([hand(-0.9, 0.98, 0.16), hand(1.15, 0.66, 0.15)]).collect();
    kit.add(Paint::Dark, fourfold(&hands));
}

/// Adds the belfry: four walls with arches, a bell, a cornice and a parapet.
fn belfry(kit: &mut Kit) {
    let [low, high] = BELFRY;
    let wall = Arch { width: 2.0 * TOWER - 0.2, height: high - low, depth: 0.8, radius: 1.25, spring: 3.6 };
    let side = Arch { width: wall.width - 2.0 * wall.depth, ..wall };
    let out = wall.width / 2.0 - wall.depth / 2.0;
    for (arch, turn) in [(wall, 0.0), (side, FRAC_PI_2), (wall, 2.0 * FRAC_PI_2), (side, 3.0 * FRAC_PI_2)] {
        let solid = arch.solid(14).moved([0.0, low - 0.02, out]);
        kit.add(Paint::Stone, solid.transformed(Affine3A::from_rotation_y(turn)));
    }
    let mullion = plank([-0.11, low, out - 0.12], [0.11, low + 4.7, out + 0.12]);
    let ledge = plank([-1.5, low + 0.02, out - 0.2], [1.5, low + 0.8, out + 0.3]);
    kit.add(Paint::Trim, fourfold(&mullion.with(ledge)));
    let bell = [(0.85, 20.0), (0.8, 20.15), (0.56, 20.7), (0.45, 21.3), (0.2, 21.6), (0.0, 21.65)];
    kit.add(Paint::Gold, lathe(&bell, 20));
    kit.plank(Paint::Timber, [-2.9, 21.6, -0.15], [2.9, 21.95, 0.15]);
    let edge = TOWER + 0.3;
    kit.plank(Paint::Trim, [-edge, high - 0.1, -edge], [edge, high + 0.3, edge]);
    kit.plank(Paint::Stone, [-edge + 0.15, high + 0.2, -edge + 0.15], [edge - 0.15, high + 0.75, edge - 0.15]);
    let pinnacle = lathe(&[(0.42, high + 0.7), (0.42, high + 1.7), (0.52, high + 1.75), (0.0, high + 3.6)], 8);
    kit.add(Paint::Trim, fourfold(&pinnacle.moved([edge - 0.6, 0.0, edge - 0.6])));
}

/// Adds the spire with its ball and rod.
fn spire(kit: &mut Kit) {
    let foot = BELFRY[1] + 0.7;
    let outline = [(3.4, foot), (3.35, foot + 0.2), (2.25, foot + 2.2), (1.15, foot + 6.0), (0.0, TIP)];
    let turn = Affine3A::from_rotation_y(TAU / 16.0);
    kit.add(Paint::Slate, lathe(&outline, 8).transformed(turn));
    kit.add(Paint::Gold, ellipsoid([0.3, 0.28, 0.3], 14, 8).moved(Vec3::Y * (TIP - 0.1)));
    kit.add(Paint::Iron, lathe(&[(0.04, TIP - 0.2), (0.035, TIP + 1.5), (0.0, TIP + 1.7)], 8));
}

/// Adds the portal: a deep arch with a door below a gable, and steps.
fn portal(kit: &mut Kit) {
    let arch = Arch { width: 4.2, height: 5.2, depth: 1.1, radius: 1.25, spring: 2.5 };
    kit.add(Paint::Stone, arch.solid(16).moved([0.0, 0.3, TOWER + 0.45]));
    let inner = Arch { width: 3.6, height: 4.6, depth: 0.6, radius: 1.0, spring: 2.5 };
    kit.add(Paint::Trim, inner.solid(16).moved([0.0, 0.3, TOWER + 0.4]));
    kit.plank(Paint::Oak, [-1.6, 0.35, TOWER - 0.2], [-0.02, 4.4, TOWER + 0.16]);
    kit.plank(Paint::Oak, [0.02, 0.35, TOWER - 0.2], [1.6, 4.4, TOWER + 0.16]);
    kit.add(Paint::Stone, gabled(2.08, [5.45, 5.5, 6.88], 1.08).moved([0.0, 0.0, TOWER + 0.45]));
    let roof = Saddle { half: 2.1, eaves: 5.5, ridge: 6.9, over: 0.2 };
    kit.add(Paint::Slate, roof.slopes(1.3).moved([0.0, 0.0, TOWER + 0.5]));
    for step in 0..3 {
        let (out, top) = (2.4 - 0.35 * step as f32, 0.12 * (step + 1) as f32);
        kit.plank(Paint::Granite, [-out - 0.3, -0.2, TOWER - 0.05 * out], [out + 0.3, top, TOWER + out]);
    }
}

/// Adds the nave behind the tower: walls, roof, windows, buttresses and a round apse.
fn nave(kit: &mut Kit) {
    let roof = Saddle { half: NAVE, eaves: EAVES, ridge: EAVES + 7.2, over: 0.5 };
    let middle = Vec3::new(0.0, 0.0, -LENGTH / 2.0 - 1.5);
    kit.add(Paint::Lime, gabled(NAVE, [-0.3, roof.eaves, roof.ridge], LENGTH).moved(middle));
    kit.add(Paint::Slate, roof.slopes(LENGTH + 0.5).moved(middle));
    kit.add(Paint::Slate, roof.ridge_tiles(LENGTH + 0.6).moved(middle));
    let back = middle.z - LENGTH / 2.0;
    let apse = lathe(&[(4.6, -0.3), (4.6, 8.0)], 24).moved([0.0, 0.0, back]);
    kit.add(Paint::Lime, apse);
    kit.add(Paint::Slate, lathe(&[(4.95, 7.9), (4.9, 8.1), (0.0, 12.0)], 24).moved([0.0, 0.0, back]));
    for index in 0..5 {
        let z = middle.z + LENGTH / 2.0 - 3.6 - 4.4 * index as f32;
        buttress(kit, z - 2.2 + 4.4);
        if index < 4 {
            window(kit, z);
        }
    }
    for side in [-1.0, 1.0] {
        let outer = side * (NAVE + 0.08);
        let [low, high] = [outer.min(side * 6.0), outer.max(side * 6.0)];
        kit.plank(Paint::Granite, [low, -0.3, back + 0.05], [high, 0.8, middle.z + LENGTH / 2.0 - 0.05]);
    }
}

/// Adds a buttress to both walls of the nave.
fn buttress(kit: &mut Kit, z: f32) {
    let lower = plank([NAVE - 0.2, -0.3, z - 0.42], [NAVE + 1.0, 4.4, z + 0.42]);
    let upper = plank([NAVE - 0.2, 4.3, z - 0.36], [NAVE + 0.62, 7.4, z + 0.36]);
    let cap = gabled(0.44, [4.38, 4.42, 4.75], 1.2).posed(Quat::from_rotation_y(FRAC_PI_2), [NAVE + 0.45, 0.0, z]);
    kit.add(Paint::Stone, lower.with(upper).and_mirrored());
    kit.add(Paint::Trim, cap.and_mirrored());
}

/// Adds a tall window with a round head to both walls of the nave.
fn window(kit: &mut Kit, z: f32) {
    let arch = Arch { width: 2.0, height: 5.4, depth: 0.4, radius: 0.72, spring: 4.2 };
    let turn = Quat::from_rotation_y(FRAC_PI_2);
    let frame = arch.solid(12).posed(turn, [NAVE + 0.02, 2.6, z]);
    kit.add(Paint::Stone, frame.and_mirrored());
    let glass = plank([NAVE - 0.1, 2.7, z - 0.8], [NAVE + 0.06, 7.7, z + 0.8]);
    let sill = plank([NAVE - 0.1, 2.4, z - 1.1], [NAVE + 0.36, 2.72, z + 1.1]);
    kit.add(Paint::Glass, glass.and_mirrored());
    kit.add(Paint::Trim, sill.and_mirrored());
}
