//! Near objects: slabs of the path, a dry wall, a fence, a hut, sheep, tufts of grass, a tree bent by the
//! wind.

use std::f32::consts::TAU;

use glam::{Affine3A, Quat, Vec3};

use super::land::{height, on_land, path};
use super::palette::Paint;
use super::tree;
use crate::Transform;
use crate::parts::{
    Builder, CRISP, Dice, Limbs, SMOOTH, Solid, Tuft, block, capsule, egg, ellipsoid, extrude, gabled, modulated_lathe,
    plank, slope_normal, turned,
};

/// Length of a piece of the dry wall, in metres.
const PIECE: f32 = 2.2;
/// Pieces of the dry wall.
const PIECES: usize = 8;
/// Tufts of grass to place.
const TUFTS: usize = 170;
/// Distance between the posts of the fence, in metres.
const POSTS: f32 = 2.3;

/// Adds everything near the start view and returns the hut's node.
pub(super) fn build(builder: &mut Builder) -> usize {
    let hut = hut(builder);
    let group = builder.group("near", Vec3::ZERO, 0.0);
    slabs(builder, group);
    dry_wall(builder, group);
    fence(builder, group);
    sheep(builder, group);
    tufts(builder, group);
    tree::build(builder, group);
    hut
}

/// Returns a rotation that sets objects perpendicular to a slope, turned by `yaw`.
fn on_slope(at: Vec3, yaw: f32) -> Quat {
    Quat::from_rotation_arc(Vec3::Y, slope_normal(height, at.x, at.z)) * Quat::from_rotation_y(yaw)
}

/// Builds a rough stone around the origin, about 1 m across, with fewer faces than a ball. Each seed gives
/// another shape.
fn rock(seed: u32, segments: usize) -> Solid {
    let mut dice = Dice::new(seed);
    let [a, b] = [dice.roll() * TAU, dice.roll() * TAU];
    let outline = [(0.30, -0.5), (0.47, -0.33), (0.5, 0.05), (0.44, 0.36), (0.26, 0.5)];
    modulated_lathe(&outline, segments, move |turn, y| {
        1.0 + 0.16 * (4.0 * turn + a).cos() + 0.08 * (3.0 * turn + b + 3.0 * y).sin()
    })
}

/// Adds flat stones along the path.
fn slabs(builder: &mut Builder, group: usize) {
    let slab = |seed: u32| rock(seed, 13).transformed(Affine3A::from_scale(Vec3::new(1.0, 0.12, 0.8)));
    let slabs = [51, 52, 53].map(|seed| builder.solid("slab", &slab(seed), Paint::Slab, 0.95));
    let mut dice = Dice::new(50);
    let mut z = 1.6;
    for index in 0..26 {
        let at = on_land(path(z) + dice.between(-0.22, 0.22), z) + Vec3::Y * 0.01;
        let size = Vec3::new(dice.between(0.75, 1.05), 1.0, dice.between(0.75, 1.0));
        let lie = Transform::new(at, on_slope(at, dice.roll() * TAU), size);
        builder.pose(group, slabs[index % 3], lie);
        z -= dice.between(0.85, 1.05);
    }
}

/// Adds a wall of field stones without mortar, beside the path.
fn dry_wall(builder: &mut Builder, group: usize) {
    let pieces = [60, 61].map(|seed| builder.solid("dry wall", &wall_piece(seed), Paint::Stone, 0.95));
    let (mut x, mut z) = (-2.5, 1.9);
    for index in 0..PIECES {
        let turn = 0.20 + 0.035 * index as f32;
        let (end_x, end_z) = (x - PIECE * turn.sin(), z - PIECE * turn.cos());
        let (start, end) = (on_land(x, z), on_land(end_x, end_z));
        let ahead = (end - start).normalize();
        // Turns -z along the wall, then tilts it down the slope.
        let yaw = Quat::from_rotation_arc(Vec3::NEG_Z, ahead.with_y(0.0).normalize());
        let rotation = yaw * Quat::from_rotation_x(ahead.y.asin());
        builder.pose(group, pieces[index % 2], Transform::new(start.midpoint(end), rotation, Vec3::ONE));
        (x, z) = (end_x, end_z);
    }
}

/// Builds a piece of wall along z: three courses and a row of flat stones on top.
fn wall_piece(seed: u32) -> Solid {
    let mut dice = Dice::new(seed);
    let mut wall = Solid::default();
    for course in 0..4 {
        let top = course == 3;
        let count = if top { 5 } else { 6 };
        let length = PIECE / count as f32;
        for index in 0..count {
            let z = (index as f32 + 0.5 + if course % 2 == 1 { 0.35 } else { 0.0 }) * length - PIECE / 2.0;
            let size = if top { Vec3::new(0.52, 0.14, 1.25 * length) } else { Vec3::new(0.50, 0.30, 1.32 * length) };
            let size = size * Vec3::new(dice.between(0.85, 1.1), dice.between(0.9, 1.1), 1.0);
            let y = if top { 0.72 } else { 0.06 + 0.235 * course as f32 };
            let lean =
                Quat::from_rotation_z(dice.between(-0.1, 0.1)) * Quat::from_rotation_x(dice.between(-0.08, 0.08));
            let at = Vec3::new(dice.between(-0.03, 0.03), y + dice.between(-0.02, 0.02), z);
            let place = Affine3A::from_scale_rotation_translation(size, lean, at);
            wall = wall.with(rock(seed * 40 + course * 8 + index, 6).transformed(place));
        }
    }
    wall
}

/// Adds a fence of rough posts with two rails, down the slope.
fn fence(builder: &mut Builder, group: usize) {
    let line = |index: usize| {
        let along = POSTS * index as f32;
        on_land(2.3 + 0.10 * along + 0.006 * along * along, 0.8 - 0.97 * along)
    };
    let mut post = Limbs::default();
    let middle = [Vec3::Y * -0.3, Vec3::new(0.01, 0.3, 0.0), Vec3::new(-0.01, 0.8, 0.01), Vec3::new(0.0, 1.18, 0.0)];
    post.add(&middle, 9, |turn, t| (0.068 - 0.012 * t) * (1.0 + 0.07 * (3.0 * turn + 4.0 * t).sin()));
    let post = builder.mesh("post", vec![post.primitive(Paint::Weathered)]);
    let mut dice = Dice::new(70);
    for index in 0..19 {
        let yaw = Quat::from_rotation_y(dice.roll() * TAU);
        let lean = Quat::from_rotation_z(dice.between(-0.07, 0.07)) * Quat::from_rotation_x(dice.between(-0.07, 0.07));
        builder.pose(group, post, Transform::new(line(index), yaw * lean, Vec3::ONE));
        if index == 18 {
            break;
        }
        // The rails have the length of their gap, so each pair needs its own mesh.
        let (start, end) = (line(index), line(index + 1));
        let ahead = (end - start).normalize();
        let mut rails = Limbs::default();
        for (height, sag) in [(0.48, 0.02), (0.92, 0.035)] {
            let from = Vec3::Y * (height + dice.between(-0.04, 0.04)) - ahead * 0.12;
            let to = end - start + Vec3::Y * (height + dice.between(-0.04, 0.04)) + ahead * 0.12;
            rails.add(&[from, from.midpoint(to) - Vec3::Y * sag, to], 6, |_, t| 0.034 - 0.006 * t);
        }
        let rails = builder.mesh("rails", vec![rails.primitive(Paint::Weathered)]);
        builder.place(group, rails, start, 0.0);
    }
}

/// Adds a shepherd's hut of stone under thatch.
fn hut(builder: &mut Builder) -> usize {
    let (half, length, eaves, ridge) = (1.9, 4.6, 2.1, 3.5);
    let walls = gabled(half, [-1.2, eaves, ridge], length);
    #[rustfmt::skip]
    let thatch = [
        (-half - 0.42, eaves - 0.34), (-half - 0.30, eaves - 0.50), (0.0, ridge - 0.02), (half + 0.30, eaves - 0.50),
        (half + 0.42, eaves - 0.34), (0.25, ridge + 0.30), (-0.25, ridge + 0.30),
    ];
    let faces = [[0, 1, 2], [0, 2, 6], [2, 5, 6], [2, 3, 4], [2, 4, 5]];
    let thatch = extrude(&thatch, &faces, length + 0.5);
    let chimney = block([-0.3, 2.6, -2.0], [0.3, 4.35, -1.4], 0.02);
    let chimney = chimney.with(block([-0.36, 4.3, -2.06], [0.36, 4.45, -1.34], 0.02));
    let lintel = plank([-0.65, 1.82, 2.2], [0.65, 2.02, 2.38]);
    let door = plank([-0.45, -0.3, 2.2], [0.45, 1.85, 2.34]);
    let window = plank([-1.93, 0.9, -0.4], [-1.8, 1.5, 0.4]);
    let shutter = |z: f32| plank([-1.97, 0.85, z - 0.24], [-1.85, 1.55, z + 0.24]);
    let hut = [
        (walls.with(chimney), Paint::Masonry, CRISP),
        (thatch, Paint::Thatch, CRISP),
        (door.with(lintel).with(shutter(-0.68)).with(shutter(0.68)), Paint::Timber, CRISP),
        (window, Paint::Dark, CRISP),
    ];
    let mesh = builder.solids("hut", hut);
    builder.node("hut", None, turned(on_land(8.3, -11.4) + Vec3::Y * 0.25, -0.55), Some(mesh))
}

/// Adds sheep on the slope.
fn sheep(builder: &mut Builder, group: usize) {
    let wool = |turn: f32, y: f32| 1.0 + 0.05 * (9.0 * turn + 14.0 * y).sin() + 0.04 * (6.0 * turn - 21.0 * y).cos();
    let body = modulated_lathe(&egg(0.26, 0.48, 0.7), 12, wool).posed(Quat::from_rotation_x(TAU / 4.0), Vec3::Y * 0.62);
    let head = capsule([0.0, 0.80, 0.42], 0.095, [0.0, 0.66, 0.66], 0.06, 10);
    let ears = ellipsoid([0.15, 0.025, 0.04], 8, 4).moved([0.0, 0.82, 0.44]);
    let leg = |(x, z): (f32, f32)| capsule([x, 0.5, z], 0.045, [x, 0.02, z], 0.032, 8);
    let legs = [(-0.12, -0.26), (0.12, -0.26), (-0.12, 0.26), (0.12, 0.26)].map(leg);
    let dark = legs.into_iter().fold(head.with(ears), Solid::with);
    let sheep = builder.solids("sheep", [(body, Paint::Wool, SMOOTH), (dark, Paint::Face, SMOOTH)]);
    #[rustfmt::skip]
    let flock = [
        (1.9, -8.3, 0.9), (3.5, -9.4, 2.3), (-8.5, -62.0, -1.1), (4.0, -66.0, 1.6), (-2.5, -58.0, -2.2),
        (9.6, -60.0, 0.2), (13.8, -67.0, -0.4), (-1.5, -71.0, 2.1),
    ];
    for (x, z, yaw) in flock {
        builder.place(group, sheep, on_land(x, z), yaw);
    }
}

/// Adds tufts of dry grass by the wall, the fence and the path.
fn tufts(builder: &mut Builder, group: usize) {
    let mut dice = Dice::new(80);
    let wind = Vec3::X * 0.12;
    let tuft = Tuft { cards: 5, height: [0.30, 0.46], sunk: 0.03, spread: 0.06, wind, bend: 0.08, lean: 0.6 };
    let tuft = builder.mesh("tuft", vec![tuft.primitive(Paint::Grass, &mut dice)]);
    for index in 0..TUFTS {
        let z = 1.4 - 15.0 * dice.roll();
        // Places: the foot of the wall, the foot of the fence, the sides of the path, and scattered.
        let (line, spread) = match index % 4 {
            0 => (-2.15 + 0.28 * z.min(0.0), 0.35),
            1 => (2.45 - 0.13 * z, 0.4),
            2 => (path(z) + if dice.roll() < 0.5 { 0.95 } else { -0.95 }, 0.25),
            _ => (1.0, 6.0),
        };
        let x = line + dice.between(-spread, spread);
        let (size, yaw) = (dice.between(0.45, 1.05), dice.between(-0.6, 0.6));
        if (x - path(z)).abs() > 0.65 {
            builder.place_sized(group, tuft, on_land(x, z), [size; 3], yaw);
        }
    }
}
