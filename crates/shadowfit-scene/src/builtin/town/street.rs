//! Furniture of street and square: lamps, railings with thin bars, bollards with chains, benches.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Quat, Vec3};

use super::kit::Kit;
use super::palette::Paint;
use super::plan::{KERB, NORTH, SOUTH};
use crate::parts::{Builder, CRISP, SMOOTH, Solid, lathe, plank, torus};

/// Length of a panel of railing, in metres.
const PANEL: f32 = 2.0;
/// Bars of a panel: 14 cm apart.
const BARS: usize = 14;
/// Radius of a bar, in metres.
const BAR: f32 = 0.009;
/// Height of a railing, in metres.
const HEIGHT: f32 = 1.15;

/// Adds the furniture.
pub(super) fn build(builder: &mut Builder) {
    let group = builder.group("street furniture", Vec3::ZERO, 0.0);
    lamps(builder, group);
    railings(builder, group);
    benches(builder, group);
    bollards(builder, group);
}

/// Adds lamps along both pavements and around the square.
fn lamps(builder: &mut Builder, group: usize) {
    let (iron, glass) = lamp();
    let lamp = builder.solids("lamp", [(iron, Paint::Iron, SMOOTH), (glass, Paint::Lamp, CRISP)]);
    let along = [-44.0, -64.0, -90.0, -118.0, 31.0].into_iter().enumerate();
    let street = along.flat_map(|(index, z)| {
        let side = if index % 2 == 0 { 1.0 } else { -1.0 };
        [(3.95 * side, z), (-3.95 * side, z - 9.0)]
    });
    let square = [(-6.6, 8.6), (7.2, 6.5), (-8.0, -20.0), (8.2, -20.5), (16.8, -6.0), (-18.0, -26.0), (-3.95, 27.5)];
    for (x, z) in street.chain(square) {
        let x: f32 = x;
        let height = if x.abs() < 4.5 { KERB } else { 0.0 };
        builder.place(group, lamp, [x, height, z], FRAC_PI_2);
    }
}

/// Builds the ironwork and the glass of a lamp.
fn lamp() -> (Solid, Solid) {
    let post = [
        (0.17, -0.05),
        (0.17, 0.1),
        (0.11, 0.16),
        (0.11, 0.55),
        (0.07, 0.7),
        (0.05, 1.4),
        (0.075, 1.44),
        (0.05, 1.5),
        (0.036, 2.95),
        (0.06, 3.0),
        (0.03, 3.05),
        (0.12, 3.24),
        (0.0, 3.25),
    ];
    let bar = plank([-0.32, 2.83, -0.015], [0.32, 2.86, 0.015]);
    let roof = lathe(&[(0.24, 3.66), (0.25, 3.69), (0.1, 3.85), (0.04, 3.9), (0.0, 4.02)], 6);
    let strut = |turn: f32| {
        let out = Vec3::new(turn.sin(), 0.0, turn.cos());
        let (from, to) = (out * 0.1 + Vec3::Y * 3.22, out * 0.215 + Vec3::Y * 3.68);
        let turn = Quat::from_rotation_arc(Vec3::Y, (to - from).normalize());
        plank([-0.01, 0.0, -0.01], [0.01, to.distance(from), 0.01]).posed(turn, from)
    };
    let struts: Solid = (0..6).map(|index| strut(index as f32 / 6.0 * TAU)).collect();
    let glass = lathe(&[(0.09, 3.23), (0.195, 3.67)], 6);
    let iron = lathe(&post, 8).with(bar).with(roof).with(struts);
    (iron, glass)
}

/// Builds a panel of railing along x from the origin: pointed bars between two rails, and a post.
fn panel() -> Solid {
    let bar = lathe(&[(BAR, 0.1), (BAR, HEIGHT - 0.07), (0.0, HEIGHT)], 4);
    let bars = (0..BARS).map(|index| bar.clone().moved(Vec3::X * ((index as f32 + 0.5) * PANEL / BARS as f32)));
    let rail = |y: f32| plank([0.0, y - 0.018, -0.012], [PANEL, y + 0.018, 0.012]);
    let post = lathe(&[(0.035, -0.1), (0.035, HEIGHT), (0.06, HEIGHT + 0.05), (0.0, HEIGHT + 0.14)], 8);
    bars.chain([rail(0.16), rail(HEIGHT - 0.16), post]).collect()
}

/// Adds railings before the church and around its yard, along the eastern side of the square, and around the garden.
fn railings(builder: &mut Builder, group: usize) {
    let panel = builder.solid("railing", &panel(), Paint::Iron, SMOOTH);
    let end = lathe(&[(0.034, -0.1), (0.034, HEIGHT), (0.058, HEIGHT + 0.05), (0.0, HEIGHT + 0.14)], 8);
    let end = builder.solid("railing post", &end, Paint::Iron, SMOOTH);
    let curb = plank([-0.1, -0.1, -0.12], [PANEL + 0.1, 0.1, 0.12]);
    let curb = builder.solid("railing curb", &curb, Paint::Granite, CRISP);
    // Corner, direction as a turn from +x, and number of panels.
    let runs = [
        ([-6.0, NORTH - 0.4], FRAC_PI_2, 9),
        ([10.9, -2.2], -FRAC_PI_2, 6),
        ([-20.0, SOUTH + 0.4], 0.0, 3),
        ([-11.8, SOUTH + 0.4], 0.0, 3),
        ([-5.8, SOUTH + 0.4], -FRAC_PI_2, 6),
    ];
    for ([x, z], yaw, count) in runs {
        let along = Quat::from_rotation_y(yaw) * Vec3::X;
        let at = |index: usize| Vec3::new(x, 0.0, z) + along * (PANEL * index as f32);
        for index in 0..count {
            builder.place(group, panel, at(index), yaw);
            let raised = at(index) + Vec3::Y * (0.002 * (index % 2) as f32);
            builder.place(group, curb, raised, yaw);
        }
        builder.place(group, end, at(count), yaw);
    }
}

/// Adds benches around the fountain and below the trees.
fn benches(builder: &mut Builder, group: usize) {
    let mut bench = Kit::default();
    for index in 0..4 {
        let z = -0.2 + 0.125 * index as f32;
        bench.plank(Paint::Oak, [-0.85, 0.42, z], [0.85, 0.455, z + 0.1]);
    }
    for index in 0..3 {
        let y = 0.58 + 0.13 * index as f32;
        let z = -0.24 - 0.03 * index as f32;
        bench.plank(Paint::Oak, [-0.85, y, z - 0.03], [0.85, y + 0.1, z]);
    }
    for x in [-0.65, 0.65] {
        bench.plank(Paint::Iron, [x - 0.03, -0.02, -0.27], [x + 0.03, 0.425, -0.2]);
        bench.plank(Paint::Iron, [x - 0.028, -0.02, 0.2], [x + 0.028, 0.425, 0.26]);
        bench.plank(Paint::Iron, [x - 0.025, 0.38, -0.25], [x + 0.025, 0.424, 0.28]);
        bench.plank(Paint::Iron, [x - 0.026, 0.4, -0.36], [x + 0.026, 0.93, -0.33]);
    }
    let bench = bench.mesh(builder, "bench");
    let round = [-2.2, -0.75, 0.75, 2.3].map(|turn: f32| (5.1 * turn.sin(), 5.1 * turn.cos(), turn));
    let trees = [
        (-13.2, 21.5, PI),
        (14.9, -26.5, -FRAC_PI_2),
        (14.9, 4.2, -FRAC_PI_2),
        (-19.2, -12.0, FRAC_PI_2),
        (-19.2, -4.0, FRAC_PI_2),
    ];
    for (x, z, yaw) in round.into_iter().chain(trees) {
        builder.place(group, bench, [x, 0.0, z], yaw);
    }
}

/// Adds bollards with chains between them where the street enters the square.
fn bollards(builder: &mut Builder, group: usize) {
    let body = [(0.12, -0.1), (0.12, 0.08), (0.09, 0.12), (0.08, 0.72), (0.11, 0.76), (0.11, 0.82), (0.0, 0.93)];
    let bollard = builder.solid("bollard", &lathe(&body, 12), Paint::Granite, CRISP);
    let links = 11;
    let link = |index: usize| {
        let t = (index as f32 + 0.5) / links as f32;
        let sag = 0.66 - 0.26 * (t * PI).sin();
        let turn = if index.is_multiple_of(2) { 0.0 } else { FRAC_PI_2 };
        torus(0.055, 0.013, 0.013, 6, 3)
            .transformed(glam::Affine3A::from_scale(Vec3::new(1.0, 1.0, 0.75)))
            .posed(Quat::from_rotation_z((t - 0.5) * -0.9) * Quat::from_rotation_x(turn), [t * 1.3, sag, 0.0])
    };
    let chain = builder.solid("chain", &(0..links).map(link).collect(), Paint::Iron, SMOOTH);
    for (z, count) in [(NORTH + 0.6, 4), (11.6, 3)] {
        for index in 0..=count {
            let x = 5.9 + 1.3 * index as f32;
            builder.place(group, bollard, [x, 0.0, z], 0.0);
            if index < count {
                builder.place(group, chain, [x, 0.0, z], 0.0);
            }
        }
    }
}
