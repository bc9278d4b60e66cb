//! The wanderer's head: skull, brow, nose, jaw, eyes, ears, hair and cap.
//!
//! The head is one smooth surface. Rays from inside find the surface of bodies that are blended by the
//! polynomial smooth minimum of Inigo Quilez ("smooth minimum", 2013). Left and right are mirror images.

use std::f32::consts::{PI, TAU};

use glam::{Affine3A, Quat, Vec2, Vec3};

use super::rig::Joint;
use super::wear::{Part, Wear};
use crate::parts::build::SMOOTH;
use crate::parts::shapes::{capsule, ellipsoid, loft, section, torus, tube};
use crate::parts::solid::Solid;

/// Origin of the rays, in the head's axes: between the temples.
const CENTRE: Vec3 = Vec3::new(0.0, 0.14, 0.0);
/// Vertices around the head. An even number, so that it can be mirrored.
const AROUND: usize = 76;
/// Rings from chin to crown.
const RINGS: usize = 50;
/// Centre of the left eye.
const EYE: Vec3 = Vec3::new(0.0375, 0.125, 0.0735);
/// Radius of the eyes.
const EYE_RADIUS: f32 = 0.0215;

/// Builds the head with its fixed parts.
pub(super) fn mesh() -> Part {
    let piece = |solid: &Solid, paint: Wear| solid.primitive(paint.into(), SMOOTH);
    let primitives = vec![
        piece(&head().with(ears()).with(lids()), Wear::Skin),
        piece(&eyes(), Wear::EyeWhite),
        piece(&irises(), Wear::Iris),
        piece(&hair(), Wear::Hair),
        piece(&mouth(), Wear::Lip),
        piece(&cap(), Wear::Wool),
    ];
    (&[Joint::Head], "head", primitives)
}

/// Returns the smooth minimum of two distances, blended over `k` metres.
fn blend(a: f32, b: f32, k: f32) -> f32 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k * 0.25
}

/// Cuts the inside of `b` out of `a`, rounded over `k` metres.
fn carve(a: f32, b: f32, k: f32) -> f32 {
    -blend(-a, b, k)
}

/// Returns the distance to a ball.
fn ball(p: Vec3, centre: Vec3, radius: f32) -> f32 {
    p.distance(centre) - radius
}

/// Returns the approximate distance to an ellipsoid.
fn egg(p: Vec3, centre: Vec3, radii: Vec3) -> f32 {
    let q = (p - centre) / radii;
    let length = q.length();
    length * (length - 1.0) / (q / radii).length().max(1e-6)
}

/// Returns the distance to a round cone from `a` to `b`, without its end corrections.
fn cone(p: Vec3, a: Vec3, ra: f32, b: Vec3, rb: f32) -> f32 {
    let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    p.distance(a.lerp(b, t)) - (ra + (rb - ra) * t)
}

/// Returns a distance-like field of the head, negative inside. `p.x` must not be negative.
fn field(p: Vec3) -> f32 {
    let skull = egg(p, Vec3::new(0.0, 0.168, -0.014), Vec3::new(0.097, 0.112, 0.115));
    let jaw = egg(p, Vec3::new(0.0, 0.072, 0.028), Vec3::new(0.074, 0.088, 0.074));
    let mut d = blend(skull, jaw, 0.05);
    d = blend(d, ball(p, Vec3::new(0.0, 0.008, 0.071), 0.0265), 0.035);
    d = blend(d, ball(p, Vec3::new(0.047, 0.082, 0.058), 0.031), 0.03);
    // Sockets first, then the brow above them and the nose between.
    d = carve(d, ball(p, Vec3::new(0.039, 0.122, 0.112), 0.030), 0.022);
    let brow = cone(p, Vec3::new(0.012, 0.153, 0.094), 0.015, Vec3::new(0.062, 0.150, 0.068), 0.011);
    d = blend(d, brow, 0.016);
    let bridge = cone(p, Vec3::new(0.0, 0.142, 0.088), 0.011, Vec3::new(0.0, 0.094, 0.129), 0.0165);
    d = blend(d, bridge, 0.014);
    d = blend(d, ball(p, Vec3::new(0.015, 0.087, 0.109), 0.0115), 0.010);
    // Lips protrude a little around the mouth line.
    let lips = cone(p, Vec3::new(0.0, 0.051, 0.088), 0.013, Vec3::new(0.02, 0.051, 0.080), 0.007);
    blend(d, lips, 0.014)
}

/// Returns the distance from the centre to the surface along `direction`, by the Illinois variant of regula
/// falsi.
fn reach(direction: Vec3) -> f32 {
    let at = |r: f32| field(CENTRE + direction * r);
    let (mut low, mut high) = (0.05, 0.21);
    let (mut at_low, mut at_high) = (at(low), at(high));
    for _ in 0..12 {
        let middle = (low * at_high - high * at_low) / (at_high - at_low);
        let at_middle = at(middle);
        if at_middle.abs() < 2e-5 {
            return middle;
        }
        if at_middle > 0.0 {
            (high, at_high) = (middle, at_middle);
            at_low *= 0.5;
        } else {
            (low, at_low) = (middle, at_middle);
            at_high *= 0.5;
        }
    }
    f32::midpoint(low, high)
}

/// Returns the front-most point of the face at `x` and `y`.
fn on_face(x: f32, y: f32) -> Vec3 {
    let (mut inside, mut outside) = (0.03, 0.18);
    for _ in 0..16 {
        let middle = f32::midpoint(inside, outside);
        if field(Vec3::new(x, y, middle)) < 0.0 { inside = middle } else { outside = middle }
    }
    Vec3::new(x, y, inside)
}

/// Builds the skin of the head: rings about y, denser over the face than at the back.
fn head() -> Solid {
    let half = AROUND / 2;
    let ring = |ring: usize| {
        let height = ring as f32 / RINGS as f32;
        // Denser at brow, eyes and nose, which are slightly below the centre's height.
        let height = height + 0.055 * (TAU * height).sin() * 0.9;
        let (up, flat) = (-(PI * height).cos(), (PI * height).sin());
        let point = |index: usize| {
            let turn = index as f32 / half as f32;
            let turn = PI * (turn - 0.12 * (PI * turn).sin());
            let direction = Vec3::new(flat * turn.sin(), up, flat * turn.cos());
            let direction = if index == half { Vec3::new(0.0, up, -flat) } else { direction };
            CENTRE + direction * reach(direction)
        };
        let left: Vec<Vec3> = (0..=half).map(point).collect();
        let right = left[1..half].iter().rev().map(|p| Vec3::new(-p.x, p.y, p.z));
        left.iter().copied().chain(right).collect::<Vec<_>>()
    };
    let rings: Vec<_> = (1..RINGS).map(ring).collect();
    let pole = |direction: Vec3| CENTRE + direction * reach(direction);
    tube(&rings, pole(Vec3::NEG_Y), pole(Vec3::Y))
}

fn eyes() -> Solid {
    ellipsoid(Vec3::splat(EYE_RADIUS), 24, 14).moved(EYE).and_mirrored()
}

/// Builds the upper lids: balls slightly larger than the eyes, higher and farther back.
fn lids() -> Solid {
    let lid = ellipsoid(Vec3::splat(EYE_RADIUS + 0.0012), 22, 12);
    lid.moved(EYE + Vec3::new(0.0005, 0.0105, -0.0015)).and_mirrored()
}

/// Builds the irises: flat lenses on the eyeballs, facing forward.
fn irises() -> Solid {
    let lens = ellipsoid([0.0105, 0.012, 0.004], 24, 12);
    lens.moved(EYE + Vec3::new(-0.001, -0.001, EYE_RADIUS - 0.0022)).and_mirrored()
}

/// Builds the ears: cups that lean forward from the head.
fn ears() -> Solid {
    let rim = torus(0.021, 0.0065, 0.008, 22, 8).transformed(Affine3A::from_scale(Vec3::new(0.8, 1.0, 1.25)));
    let bowl = ellipsoid([0.017, 0.006, 0.024], 24, 10);
    let turn = Quat::from_rotation_y(0.45) * Quat::from_rotation_x(-0.12) * Quat::from_rotation_z(-PI / 2.0);
    let turn = turn * Quat::from_rotation_y(PI / 2.0);
    let flat = Affine3A::from_rotation_translation(turn, Vec3::new(0.094, 0.118, -0.004));
    rim.with(bowl).transformed(flat).and_mirrored()
}

/// Builds the hair around the back and the temples, and the eyebrows.
fn hair() -> Solid {
    let sections = [
        section(0.062, 0.072, 0.062, -0.058),
        section(0.10, 0.091, 0.094, -0.034),
        section(0.16, 0.101, 0.111, -0.022),
        section(0.215, 0.097, 0.108, -0.016),
    ];
    let points = [(0.015, 0.163, 0.0045), (0.034, 0.1675, 0.0062), (0.059, 0.1605, 0.0035)];
    let [inner, middle, outer] = points.map(|(x, y, _)| on_face(x, y));
    let brow = capsule(inner, points[0].2, middle, points[1].2, 12);
    let brow = brow.with(capsule(middle, points[1].2, outer, points[2].2, 12)).and_mirrored();
    loft(&sections, 2.1, 3, 36).with(brow)
}

/// Builds the line of the mouth.
fn mouth() -> Solid {
    let corner = |x: f32| on_face(x, 0.0485 + 7.0 * x * x);
    let mut mouth = Solid::default();
    for step in 0..3 {
        let x = step as f32 * 0.0085;
        let piece = capsule(corner(x), 0.0034, corner(x + 0.0085), 0.0034 - 0.0004 * step as f32, 10);
        mouth = mouth.with(piece);
    }
    mouth.and_mirrored()
}

/// Builds a knitted cap: ribbed crown, rolled rim and bobble.
fn cap() -> Solid {
    let sections = [
        section(0.197, 0.091, 0.104, -0.013),
        section(0.217, 0.1, 0.114, -0.014),
        section(0.25, 0.090, 0.102, -0.017),
        section(0.279, 0.066, 0.076, -0.023),
        section(0.296, 0.04, 0.046, -0.028),
    ];
    let mut crown = loft(&sections, 2.0, 2, 72);
    for position in &mut crown.positions {
        let flat = Vec2::new(position.x, position.z + 0.015);
        let rib = 1.0 + 0.013 * (18.0 * flat.x.atan2(flat.y)).cos();
        (position.x, position.z) = (flat.x * rib, flat.y * rib - 0.015);
    }
    let tilt = Affine3A::from_rotation_translation(Quat::from_rotation_x(-0.08), Vec3::new(0.0, 0.197, -0.013));
    let stretch = Affine3A::from_scale(Vec3::new(1.0, 1.0, 1.14));
    let rim = torus(0.0985, 0.0135, 0.0225, 44, 12).transformed(tilt * stretch);
    let bobble = ellipsoid(Vec3::splat(0.033), 20, 12).moved([0.0, 0.325, -0.036]);
    crown.with(rim).with(bobble)
}
