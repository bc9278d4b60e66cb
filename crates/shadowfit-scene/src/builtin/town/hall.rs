//! The town hall on the western side of the square: an arcade with rooms above it, and a slender clock tower whose
//! shadow crosses the square.

use std::f32::consts::FRAC_PI_2;

use glam::{Affine3A, Vec3};

use super::front::{Finish, Openings, WALL, flat_window, pierced, window};
use super::kit::{Kit, across};
use super::palette::Paint;
use super::plan::WEST;
use super::roof::{Saddle, chimney, dormer, sideways};
use crate::parts::{Arch, Builder, Solid, ellipsoid, lathe, plank};

/// Middle of the front along z, in metres.
const MIDDLE: f32 = -8.25;
/// Half of the front's width, in metres: seven arches.
const HALF: f32 = 10.85;
/// Arches of the front.
const ARCHES: usize = 7;
/// Height of the arcade, in metres.
const ARCADE: f32 = 4.4;
/// Height of the eaves, in metres.
const EAVES: f32 = 10.6;
/// Depth of the building and of the arcade's walk, in metres.
const DEEP: [f32; 2] = [10.0, 3.2];
/// Middle and half of the side of the clock tower, along the front in metres.
const TOWER: [f32; 2] = [-13.6, 2.6];
/// Height of the tower's walls, in metres.
const TOP: f32 = 21.0;

/// Adds the town hall.
pub(super) fn build(builder: &mut Builder) {
    let group = builder.group("town hall", [WEST, 0.0, MIDDLE], FRAC_PI_2);
    let mut hall = Kit::default();
    arcade(&mut hall);
    rooms(&mut hall);
    roof(&mut hall);
    let hall = hall.mesh(builder, "town hall");
    builder.place(group, hall, Vec3::ZERO, 0.0);
    let mut tower = Kit::default();
    shaft(&mut tower);
    lantern(&mut tower);
    let tower = tower.mesh(builder, "clock tower");
    builder.place(group, tower, [TOWER[0], 0.0, -TOWER[1] + 0.3], 0.0);
}

/// Returns the middles of the arches along the front.
fn bays() -> impl Iterator<Item = f32> {
    (0..ARCHES).map(|index| (index as f32 + 0.5) / ARCHES as f32 * 2.0 * HALF - HALF)
}

/// Adds the arches, the walk behind them and its rear wall.
fn arcade(kit: &mut Kit) {
    let width = 2.0 * HALF / ARCHES as f32;
    let arch = Arch { width, height: ARCADE + 0.2, depth: 0.7, radius: 1.12, spring: 2.35 };
    for x in bays() {
        kit.add(Paint::Stone, arch.solid(14).moved([x, -0.2, -0.35]));
        let key = plank([x - 0.16, 3.2, -0.1], [x + 0.16, 3.75, 0.08]);
        kit.add(Paint::Trim, key);
    }
    for x in (0..=ARCHES).map(|index| index as f32 * width - HALF) {
        let [left, right] = [(x - 0.46).max(-HALF + 0.01), (x + 0.46).min(HALF - 0.01)];
        kit.plank(Paint::Granite, [left, -0.2, -0.74], [right, 0.45, 0.05]);
        kit.plank(Paint::Trim, [left, 2.02, -0.74], [right, 2.2, 0.07]);
    }
    let walk = DEEP[1];
    kit.plank(Paint::Slab, [-HALF + 0.02, -0.2, -walk - 0.1], [HALF - 0.02, 0.1, -0.1]);
    kit.plank(Paint::Cream, [-HALF, -0.3, -DEEP[0]], [HALF, ARCADE, -walk - 0.1]);
    kit.plank(Paint::Umber, [-HALF + 0.4, 0.0, -walk - 0.2], [HALF - 0.4, ARCADE + 0.02, -walk]);
    for side in [-1.0, 1.0] {
        let ends = [side * HALF, side * (HALF - 0.5)];
        kit.plank(Paint::Cream, [ends[0].min(ends[1]), -0.3, -walk], [ends[0].max(ends[1]), ARCADE, -0.7]);
    }
    for x in bays().step_by(2) {
        kit.plank(Paint::Oak, [x - 0.7, 0.05, -walk - 0.1], [x + 0.7, 2.6, -walk + 0.05]);
        kit.plank(Paint::Trim, [x - 0.95, 2.58, -walk - 0.1], [x + 0.95, 2.85, -walk + 0.14]);
    }
}

/// Adds two floors of windows above the arcade.
fn rooms(kit: &mut Kit) {
    let gaps = || bays().map(|x| [x - 0.62, x + 0.62]).collect::<Vec<_>>();
    let floors = [[5.35, 7.45], [8.2, 9.7]];
    let rows: Vec<Openings> = floors.iter().map(|&heights| Openings { heights, gaps: gaps() }).collect();
    kit.add(Paint::Cream, pierced(HALF, [ARCADE, EAVES], &rows));
    let body = [(-DEEP[0], ARCADE), (-WALL, ARCADE), (-WALL, EAVES), (-DEEP[0] / 2.0, EAVES + 4.6), (-DEEP[0], EAVES)];
    kit.add(Paint::Cream, across(&body, 2.0 * HALF));
    for heights in floors {
        for gap in gaps() {
            window(kit, gap, heights, Finish::Surround);
        }
    }
    for (y, tall, out) in
        [(ARCADE - 0.05, 0.3, 0.14), (7.9, 0.16, 0.08), (EAVES - 0.5, 0.26, 0.16), (EAVES - 0.25, 0.3, 0.34)]
    {
        kit.plank(Paint::Trim, [-HALF + 0.01, y, -0.1], [HALF - 0.01, y + tall, out]);
    }
    let mut flank = Kit::default();
    for z in [-3.0, 0.0, 3.0] {
        for heights in floors {
            flat_window(&mut flank, [z - 0.6, z + 0.6], heights);
        }
    }
    let place = Affine3A::from_translation(Vec3::new(HALF, 0.0, -DEEP[0] / 2.0));
    kit.add_all(flank, place * Affine3A::from_rotation_y(FRAC_PI_2));
}

/// Adds the roof with dormers and chimneys.
fn roof(kit: &mut Kit) {
    let half = DEEP[0] / 2.0;
    let roof = Saddle { half, eaves: EAVES, ridge: EAVES + 4.6, over: 0.5 };
    kit.add(Paint::Tile, sideways(roof.slopes(2.0 * HALF + 0.3), half));
    kit.add(Paint::Tile, sideways(roof.ridge_tiles(2.0 * HALF + 0.4), half));
    for x in bays().skip(1).step_by(2) {
        dormer(kit, x, roof, [Paint::Cream, Paint::Tile]);
    }
    for x in [-4.6, 4.6] {
        chimney(kit, [x, -half - 1.2], [roof.ridge - 2.0, roof.ridge + 1.1], Paint::Brick);
    }
}

/// Adds the tower's walls with bands, windows and a clock on each side.
fn shaft(kit: &mut Kit) {
    let half = TOWER[1];
    kit.plank(Paint::Cream, [-half, -0.3, -half], [half, TOP, half]);
    kit.plank(Paint::Stone, [-half - 0.1, -0.3, -half - 0.1], [half + 0.1, 1.1, half + 0.1]);
    for (y, out) in [(ARCADE + 0.3, 0.1), (10.9, 0.12), (16.4, 0.12), (TOP - 0.3, 0.3)] {
        kit.plank(Paint::Trim, [-half - out, y, -half - out], [half + out, y + 0.32, half + out]);
    }
    let corner = |high: f32| plank([-half - 0.07, 1.0, half - 0.5], [-half + 0.5, high, half + 0.07]);
    kit.add(Paint::Stone, corner(TOP - 0.2).around(4));
    let mut side = Kit::default();
    for heights in [[5.6, 7.3], [8.2, 9.8], [12.4, 14.4]] {
        flat_window(&mut side, [-0.5, 0.5], heights);
    }
    let upright = Affine3A::from_translation(Vec3::new(0.0, 18.7, 0.0)) * Affine3A::from_rotation_x(FRAC_PI_2);
    let rim = lathe(&[(1.2, -0.1), (1.24, 0.1), (1.12, 0.14), (1.06, 0.06), (0.0, 0.06)], 20);
    side.add(Paint::Gold, rim.transformed(upright));
    side.add(Paint::Frame, lathe(&[(1.07, 0.0), (1.07, 0.085)], 20).transformed(upright));
    let hand = |turn: f32, length: f32, out: f32| {
        let at = Affine3A::from_translation(Vec3::new(0.0, 18.7, 0.0));
        plank([-0.05, -0.18, 0.05], [0.05, length, out]).transformed(at * Affine3A::from_rotation_z(turn))
    };
    side.add(Paint::Dark, hand(-0.9, 0.9, 0.14).with(hand(1.15, 0.6, 0.13)));
    for quarter in 0..4 {
        let turn = Affine3A::from_rotation_y(f32::from(quarter as u8) * FRAC_PI_2);
        kit.add_all(side.clone(), turn * Affine3A::from_translation(Vec3::Z * half));
    }
}

/// Adds the open lantern above the walls and its two roofs.
fn lantern(kit: &mut Kit) {
    let half = TOWER[1];
    let turn = Affine3A::from_rotation_y(std::f32::consts::FRAC_PI_4);
    let square = |outline: &[(f32, f32)]| -> Solid {
        let wide: Vec<_> = outline.iter().map(|&(out, y)| (out * std::f32::consts::SQRT_2, y)).collect();
        lathe(&wide, 4).transformed(turn)
    };
    let skirt = [(half + 0.45, TOP), (half + 0.4, TOP + 0.15), (1.75, TOP + 1.9), (1.5, TOP + 2.2), (0.0, TOP + 2.2)];
    kit.add(Paint::Slate, square(&skirt));
    let post = plank([1.15, TOP + 2.1, 1.15], [1.42, TOP + 4.6, 1.42]);
    let rail = plank([-1.2, TOP + 2.9, 1.24], [1.2, TOP + 3.0, 1.32]);
    kit.add(Paint::Frame, post.with(rail).around(4));
    let cap = [(1.85, TOP + 4.5), (1.8, TOP + 4.65), (0.75, TOP + 5.6), (0.4, TOP + 6.6), (0.0, TOP + 8.3)];
    kit.add(Paint::Slate, square(&cap));
    kit.add(Paint::Gold, ellipsoid([0.2; 3], 12, 7).moved(Vec3::Y * (TOP + 8.2)));
    kit.add(Paint::Iron, lathe(&[(0.03, TOP + 8.2), (0.02, TOP + 9.4), (0.0, TOP + 9.5)], 6));
}
