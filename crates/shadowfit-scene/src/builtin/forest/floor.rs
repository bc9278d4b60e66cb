//! The forest floor: gentle waves, a trodden path, stones, a fallen trunk.

use glam::{Vec2, Vec3};

use super::palette::Paint;
use crate::parts::{Builder, Dice, Limbs, SMOOTH, egg, ellipsoid, graded, ground, modulated_lathe};

/// Half of the floor's side, in metres. The trees end before it.
const HALF: f32 = 60.0;
/// Cells along a side of the floor.
const CELLS: usize = 60;
/// Half of the path's width, in metres.
const PATH_HALF: f32 = 0.75;

/// Returns the height of the floor, in metres.
pub(super) fn height(x: f32, z: f32) -> f32 {
    let waves = 0.22 * (0.21 * x + 0.7).sin() * (0.17 * z).cos() + 0.10 * (0.53 * x + 0.41 * z).sin();
    // The floor rises away from the path, more at the back.
    let aside = path_distance(x, z);
    waves * (aside / 3.0).min(1.0)
        + 1.1 * (aside / 22.0).powi(2).min(2.0)
        + 2.2 * ((-z - 14.0) / 30.0).max(0.0).powi(2).min(1.0)
        - 0.05 * (1.0 - aside / PATH_HALF).max(0.0)
}

/// Returns the distance from the middle of the path, across the view, in metres.
pub(super) fn path_distance(x: f32, z: f32) -> f32 {
    (x - 1.5 * (0.17 * z + 0.55).sin()).abs()
}

/// Adds the floor and the objects on it, and returns the node of the old stump.
pub(super) fn build(builder: &mut Builder) -> usize {
    let lines = graded(HALF, CELLS, 3.4);
    let color = |at: Vec3| {
        let trodden = (1.0 - path_distance(at.x, at.z) / (PATH_HALF * 1.4)).max(0.0);
        let moss = 0.5 + 0.5 * (0.9 * at.x + 1.3).sin() * (0.7 * at.z).cos();
        Vec3::new(1.3, 1.27, 1.15)
            .lerp(Vec3::new(0.78, 1.2, 0.5), 0.75 * moss * (1.0 - trodden))
            .lerp(Vec3::new(2.1, 1.9, 1.6), trodden.sqrt())
    };
    let sheet = ground(Paint::Floor.into(), [&lines, &lines], height, color);
    builder.lay("forest floor", sheet);
    let group = builder.group("on the floor", Vec3::ZERO, 0.0);
    stones(builder, group);
    fallen_trunk(builder, group);
    mushrooms(builder, group);
    stump(builder, group)
}

/// Returns a point on the floor.
pub(super) fn on_floor(x: f32, z: f32) -> Vec3 {
    Vec3::new(x, height(x, z), z)
}

/// Adds an old stump by the path: round bark in the sun, roots, and a broken hollow top.
fn stump(builder: &mut Builder, group: usize) -> usize {
    #[rustfmt::skip]
    let outline = [
        (0.50, -0.15), (0.50, 0.0), (0.42, 0.05), (0.37, 0.13), (0.335, 0.28), (0.32, 0.5),
        (0.31, 0.72), (0.315, 0.9), (0.305, 1.0), (0.25, 1.02), (0.18, 0.84), (0.0, 0.80),
    ];
    let shape = |turn: f32, y: f32| {
        let roots = 0.36 * (-y.max(0.0) * 7.0).exp() * (5.0 * turn + 0.6).cos();
        1.0 + roots + 0.035 * (4.0 * turn + 5.0 * y).sin() + 0.02 * (11.0 * turn - 3.0 * y).sin()
    };
    let mut solid = modulated_lathe(&outline, 40, shape);
    for position in solid.positions.iter_mut().filter(|position| position.y > 0.86) {
        // Splinters: the rim of the break is ragged.
        let turn = position.x.atan2(position.z);
        position.y += 0.11 * (2.0 * turn + 0.8).sin() + 0.06 * (7.0 * turn).sin() + 0.035 * (13.0 * turn).cos();
    }
    let bark = solid.primitive_with(Paint::Bark.into(), SMOOTH, |vertex, _| {
        let at = solid.positions[vertex];
        // The coordinate runs around to the back and back again, as on other trunks.
        Vec2::new(at.x.atan2(at.z).abs() * 0.35, -at.y)
    });
    let stump = builder.mesh("stump", vec![bark]);
    builder.place(group, stump, on_floor(2.15, -0.55), 2.1)
}

/// Adds mossy stones, half sunk.
fn stones(builder: &mut Builder, group: usize) {
    let lump = |turn: f32, y: f32| 1.0 + 0.13 * (2.0 * turn + 4.0 * y).sin() + 0.07 * (5.0 * turn - 6.0 * y).cos();
    let stone = modulated_lathe(&egg(1.0, 0.62, 0.8), 18, lump);
    let stone = builder.solid("stone", &stone, Paint::Stone, 0.9);
    for (x, z, size, yaw) in [
        (-2.05, 0.9, 0.42, 0.4),
        (-2.75, 0.35, 0.26, 2.0),
        (3.55, -0.9, 0.42, 1.1),
        (0.62, -1.75, 0.24, 0.1),
        (-1.9, -6.5, 0.55, 2.6),
        (2.6, -9.0, 0.7, 0.9),
        (-4.6, -11.0, 0.8, 1.7),
    ] {
        builder.place_sized(group, stone, on_floor(x, z) + Vec3::Y * 0.12 * size, [size; 3], yaw);
    }
}

/// Adds a trunk that lies across, with a broken end.
fn fallen_trunk(builder: &mut Builder, group: usize) {
    let path: Vec<Vec3> = (0..=7)
        .map(|step| {
            let t = step as f32 / 7.0;
            Vec3::new(0.25 * (t * 3.0).sin(), 0.02 * (t * 9.0).sin(), 5.2 * t)
        })
        .collect();
    let mut limbs = Limbs::default();
    limbs.add(&path, 12, |turn, t| (0.24 - 0.10 * t) * (1.0 + 0.05 * (4.0 * turn + 5.0 * t).sin()));
    for (t, turn) in [(0.45_f32, 0.6_f32), (0.7, -0.9)] {
        let base = Vec3::new(0.25 * (t * 3.0).sin(), 0.0, 5.2 * t);
        let out = Vec3::new(turn.sin(), 0.9, 0.35);
        let stub = [base, base + out * 0.3, base + out * 0.52];
        limbs.add(&stub, 7, |_, t| 0.055 - 0.03 * t);
    }
    let trunk = builder.mesh("fallen trunk", vec![limbs.primitive(Paint::Bark)]);
    builder.place(group, trunk, on_floor(-6.3, -6.2) + Vec3::Y * 0.17, 0.95);
}

/// Adds mushrooms by the path.
fn mushrooms(builder: &mut Builder, group: usize) {
    let cap = ellipsoid([0.05, 0.028, 0.05], 16, 8).moved(Vec3::Y * 0.085);
    let stalk = ellipsoid([0.015, 0.06, 0.015], 10, 6).moved(Vec3::Y * 0.035);
    let mushroom = builder.solids("mushroom", [(cap, Paint::Cap, SMOOTH), (stalk, Paint::Stalk, SMOOTH)]);
    let mut dice = Dice::new(12);
    for _ in 0..9 {
        let (x, z) = (dice.between(-1.75, -1.2), dice.between(1.3, 2.2));
        let size = dice.between(0.6, 1.5);
        builder.place_sized(group, mushroom, on_floor(x, z), [size; 3], 0.0);
    }
}
