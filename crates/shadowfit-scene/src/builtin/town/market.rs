//! The market on the square: a fountain at the origin, stalls with striped roofs, crates and barrels.

use glam::{Quat, Vec3};

use super::kit::Kit;
use super::palette::Paint;
use crate::parts::{Builder, CRISP, Dice, SMOOTH, Solid, capsule, ellipsoid, lathe, pillar, plank, prism};

/// Stalls: place along x and z in metres, and turn in radians.
const STALLS: [(f32, f32, f32); 5] =
    [(-9.6, -9.0, 0.25), (-10.2, -14.6, 0.1), (-6.2, -27.5, -0.3), (8.3, -12.5, -0.2), (8.0, -27.2, 0.15)];

/// Adds the market and returns the node of the fountain.
pub(super) fn build(builder: &mut Builder) -> usize {
    let fountain = fountain(builder);
    let group = builder.group("market", Vec3::ZERO, 0.0);
    let kinds = [(Paint::Fruit, 5), (Paint::Apple, 6)].map(|(paint, seed)| stall(paint, seed).mesh(builder, "stall"));
    for (index, (x, z, yaw)) in STALLS.into_iter().enumerate() {
        builder.place(group, kinds[index % 2], [x, 0.0, z], yaw);
    }
    let barrel = barrel().mesh(builder, "barrel");
    for (x, z) in [(-12.3, -10.6), (-12.9, -11.5), (-12.2, -12.3), (10.2, -13.4), (-4.0, -28.9), (-17.6, 10.9)] {
        builder.place(group, barrel, [x, 0.0, z], x);
    }
    let case = wooden_case().mesh(builder, "case");
    for ([x, y, z], yaw) in [
        ([-7.6, 0.0, -11.1], 0.3),
        ([-8.4, 0.0, -11.3], 0.1),
        ([-8.0, 0.44, -11.2], 0.7),
        ([6.4, 0.0, -14.6], -0.4),
        ([-4.1, 0.0, -27.7], 0.5),
        ([10.0, 0.0, -26.0], 0.2),
        ([-18.5, 0.0, 11.0], 0.6),
    ] {
        builder.place(group, case, [x, y, z], yaw);
    }
    fountain
}

/// Adds the fountain: an eight-sided basin, a column with two bowls, and a gilded top.
fn fountain(builder: &mut Builder) -> usize {
    #[rustfmt::skip]
    let basin = [
        (2.5, -0.1), (2.5, 0.16), (2.26, 0.16), (2.2, 0.24), (2.2, 0.7), (2.3, 0.76), (2.34, 0.86), (2.3, 0.9),
        (1.96, 0.9), (1.92, 0.84), (1.92, 0.3),
    ];
    #[rustfmt::skip]
    let column = [
        (0.62, 0.2), (0.64, 0.72), (0.5, 0.8), (0.32, 0.95), (0.26, 1.2), (0.34, 1.5), (0.24, 1.62), (0.5, 1.72),
        (0.92, 1.9), (1.08, 2.05), (1.06, 2.1), (0.98, 2.08), (0.5, 1.95), (0.22, 1.94), (0.18, 2.2), (0.24, 2.45),
        (0.16, 2.55), (0.3, 2.62), (0.56, 2.78), (0.62, 2.86), (0.58, 2.88), (0.2, 2.78), (0.14, 2.8), (0.12, 3.1),
        (0.2, 3.16), (0.18, 3.24), (0.0, 3.26),
    ];
    let pane = pillar([0.4, 0.06], [0.3, 0.64], 0.012).moved(Vec3::Z * 2.04);
    let turn = std::f32::consts::TAU / 16.0;
    let stone = lathe(&basin, 8).posed(Quat::from_rotation_y(turn), Vec3::ZERO).with(pane.around(8));
    let top = ellipsoid([0.22, 0.3, 0.22], 16, 10).moved(Vec3::Y * 3.5);
    let leaf = capsule([0.0, 3.72, 0.0], 0.05, [0.0, 4.05, 0.0], 0.01, 8);
    let spout = capsule([0.0, 1.32, 0.28], 0.035, [0.0, 1.38, 0.66], 0.028, 8);
    let jet = |step: usize| {
        const PIECES: usize = 4;
        let at = |t: f32| Vec3::new(0.0, 1.37 + 0.25 * t - 1.06 * t * t, 0.66 + 0.72 * t);
        capsule(at(step as f32 / PIECES as f32), 0.02, at((step + 1) as f32 / PIECES as f32), 0.024, 5)
    };
    let water = lathe(&[(1.94, 0.25), (1.94, 0.6)], 8).posed(Quat::from_rotation_y(turn), Vec3::ZERO);
    let jets: Solid = (0..4).map(jet).collect();
    let parts = [
        (stone, Paint::Stone, CRISP),
        (lathe(&column, 24), Paint::Trim, 0.75),
        (top.with(leaf).with(spout.around(4)), Paint::Gold, SMOOTH),
        (water.with(jets.around(4)), Paint::Water, CRISP),
    ];
    let mesh = builder.solids("fountain", parts);
    builder.node("fountain", None, crate::Transform::default(), Some(mesh))
}

/// Builds a stall: posts, a counter with crates of fruit, and a roof of cloth with hems.
fn stall(fruit: Paint, seed: u32) -> Kit {
    let mut kit = Kit::default();
    let (wide, deep) = (1.5, 0.95);
    for x in [-wide, wide] {
        for z in [-deep, deep] {
            kit.plank(Paint::Oak, [x - 0.035, -0.02, z - 0.035], [x + 0.035, 2.14, z + 0.035]);
        }
        kit.plank(Paint::Oak, [x - 0.03, 2.04, -deep], [x + 0.03, 2.1, deep]);
    }
    for z in [-deep, deep] {
        kit.plank(Paint::Oak, [-wide, 2.05, z - 0.03], [wide, 2.11, z + 0.03]);
    }
    kit.plank(Paint::Oak, [-wide - 0.05, 0.82, -0.35], [wide + 0.05, 0.88, 0.9]);
    kit.plank(Paint::Canvas, [-wide + 0.04, 0.1, 0.86], [wide - 0.04, 0.821, 0.88]);
    for x in [-wide + 0.1, wide - 0.17] {
        kit.plank(Paint::Oak, [x, -0.02, -0.3], [x + 0.07, 0.83, -0.23]);
    }
    let (reach, low, ridge) = (1.3, 2.06, 2.72);
    let cloth = [(0.0, ridge), (reach, low), (reach, low + 0.02), (0.0, ridge + 0.02)];
    kit.add(Paint::Stripe, super::roof::sideways(prism(&cloth, 3.5).and_mirrored(), 0.0));
    for z in [-reach, reach] {
        kit.plank(Paint::Stripe, [-1.75, low - 0.2, z - 0.012], [1.75, low + 0.012, z + 0.012]);
    }
    let mut dice = Dice::new(seed);
    for column in 0..4 {
        let x = -1.08 + 0.72 * column as f32;
        kit.add(Paint::Oak, tray().moved([x, 0.88, 0.42]));
        for index in 0..8 {
            let (i, j) = (index % 4, index / 4);
            let at = [x - 0.2 + 0.135 * i as f32, 0.98 + dice.between(0.0, 0.05), 0.33 + 0.17 * j as f32];
            let paint = if column % 2 == 0 { fruit } else { Paint::Hedge };
            kit.add(paint, ellipsoid([0.085; 3], 6, 3).moved(at));
        }
    }
    kit
}

/// Builds a flat tray about the origin.
fn tray() -> Solid {
    let bottom = plank([-0.29, -0.01, -0.22], [0.29, 0.02, 0.22]);
    let long = plank([-0.3, -0.005, 0.2], [0.3, 0.12, 0.23]);
    let short = plank([0.28, -0.006, -0.21], [0.301, 0.121, 0.21]);
    let turn = Quat::from_rotation_y(std::f32::consts::PI);
    bottom.with(long.clone()).with(long.posed(turn, Vec3::ZERO)).with(short.and_mirrored())
}

/// Builds a barrel with hoops.
fn barrel() -> Kit {
    let mut kit = Kit::default();
    kit.add(
        Paint::Oak,
        lathe(&[(0.24, -0.02), (0.27, 0.15), (0.3, 0.42), (0.27, 0.7), (0.24, 0.85), (0.21, 0.83)], 14),
    );
    for y in [0.16, 0.62] {
        kit.add(Paint::Iron, lathe(&[(0.298, y), (0.298, y + 0.05)], 14));
    }
    kit
}

/// Builds a slatted wooden case.
fn wooden_case() -> Kit {
    let mut kit = Kit::default();
    kit.plank(Paint::Timber, [-0.27, 0.0, -0.2], [0.27, 0.4, 0.2]);
    for level in 0..3 {
        let y = 0.02 + 0.14 * level as f32;
        kit.plank(Paint::Oak, [-0.3, y, -0.23], [0.3, y + 0.11, 0.23]);
    }
    for (x, z) in [(-0.29, -0.22), (0.29, -0.22), (-0.29, 0.22), (0.29, 0.22)] {
        kit.plank(Paint::Oak, [x - 0.028, -0.005, z - 0.028], [x + 0.028, 0.44, z + 0.028]);
    }
    kit
}
