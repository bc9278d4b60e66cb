//! The formulas of screen-space ambient occlusion. `formula.wgsl` has the same in WGSL.
//!
//! With normals: José María Méndez, "A Simple and Practical Approach to SSAO", 2010. Deviations: directions 5
//! and 6 of the level of detail, which the source reads past the end of its four, are diagonals here. The
//! random vectors are a fixed square of 4×4 pixels instead of a noise texture, so that a box of that size
//! averages all of them.
//!
//! By depth alone: Martin Mittring, "Finding Next Gen: `CryEngine` 2", 2007. The source gives no numbers, so
//! offsets, range and fall-off are ours.
//!
//! View space is right-handed and looks along -z. View depth is -z. Texture coordinates run to the right and
//! down.

use glam::{UVec2, Vec2, Vec3};

/// Directions in texture coordinates in which neighbours are looked up. Only the level of detail uses the
/// last two.
pub const DIRECTIONS: [Vec2; 6] = [
    Vec2::X,
    Vec2::NEG_X,
    Vec2::Y,
    Vec2::NEG_Y,
    Vec2::splat(core::f32::consts::FRAC_1_SQRT_2),
    Vec2::splat(-core::f32::consts::FRAC_1_SQRT_2),
];

/// Directions without level of detail.
pub const PLAIN_DIRECTIONS: u32 = 4;

/// Neighbours along each direction, in each position buffer.
pub const NEIGHBOURS: u32 = 4;

/// Points of the sphere that the depth-only method samples: eight, and the opposite eight.
pub const SPHERE_POINTS: u32 = 16;

/// Order of the random vectors in a square of 4×4 pixels (the dither matrix of Bayer, 1973): adjacent pixels
/// differ strongly.
const ORDER: [[u32; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];

/// Angle from one random vector to the next, in radians: 45° and a sixteenth of that. A reflection rotates by
/// twice the angle, and four directions repeat after a quarter turn, so the vectors give 16 different
/// crosses.
const TURN: f32 = core::f32::consts::FRAC_PI_4 * 17.0 / 16.0;

/// The golden angle, in radians.
const GOLDEN_ANGLE: f32 = 2.399_963_2;

/// Returns the occlusion of a point by a neighbour, before the intensity: max(0, N·V - bias) / (1 + d). V is
/// the direction to the neighbour and d its distance multiplied by `scale`.
///
/// Positions are in view space, in the scene's units. `normal` is unit. A neighbour at the point itself does
/// not occlude if the bias is at least 0.
pub fn term(normal: Vec3, position: Vec3, neighbour: Vec3, scale: f32, bias: f32) -> f32 {
    let difference = neighbour - position;
    let distance = difference.length();
    let cosine = normal.dot(difference) / distance.max(1e-6);
    (cosine - bias).max(0.0) / (1.0 + distance * scale)
}

/// Returns the unit vector that reflects the directions of a pixel (column and row from the top left).
pub fn random_vector(pixel: UVec2) -> Vec2 {
    Vec2::from_angle(order(pixel) as f32 * TURN)
}

/// Returns the unit vector that reflects the sphere's points.
pub fn random_vector_3d(pixel: UVec2) -> Vec3 {
    let index = order(pixel) as f32;
    let z = 1.0 - (index + 0.5) / 8.0;
    (Vec2::from_angle(index * GOLDEN_ANGLE) * (1.0 - z * z).sqrt()).extend(z)
}

fn order(pixel: UVec2) -> u32 {
    ORDER[(pixel.y % 4) as usize][(pixel.x % 4) as usize]
}

/// Returns the step of a direction in texture coordinates: the direction reflected at the pixel's random unit
/// vector, multiplied by radius / view depth. [`offset`] computes a neighbour's offset from it.
pub fn step(direction: Vec2, random: Vec2, radius: f32, view_depth: f32) -> Vec2 {
    (direction - random * (2.0 * direction.dot(random))) * (radius / view_depth)
}

/// Returns the offset of a neighbour (0 to 3) in texture coordinates: 0.25 c1, 0.5 c2, 0.75 c1 and c2, where
/// c1 is the [`step`] and c2 is c1 rotated by 45°. Back faces add an eighth to each factor.
pub fn offset(step: Vec2, neighbour: u32, is_back: bool) -> Vec2 {
    let turned = Vec2::new(step.x - step.y, step.x + step.y) * core::f32::consts::FRAC_1_SQRT_2;
    let share = 0.25 * (neighbour + 1) as f32 + if is_back { 0.125 } else { 0.0 };
    share * if neighbour.is_multiple_of(2) { step } else { turned }
}

/// Returns the number of directions at a view depth: 4, or with level of detail the integer part of lerp(6,
/// 2, depth / far).
pub fn directions(view_depth: f32, far: f32, level_of_detail: bool) -> u32 {
    if !level_of_detail {
        return PLAIN_DIRECTIONS;
    }
    let share = (view_depth / far).clamp(0.0, 1.0);
    (6.0 - 4.0 * share) as u32
}

/// Returns the occlusion, 0..=1, from the sums of the terms of both position buffers. The intensity applies
/// to front faces only. The sum is divided by the number of front neighbours, with and without back faces.
pub fn sum(front: f32, back: f32, intensity: f32, directions: u32) -> f32 {
    ((front * intensity + back) / (NEIGHBOURS * directions) as f32).clamp(0.0, 1.0)
}

/// Returns a point inside the unit sphere, 0 to 15, distributed evenly by volume. An odd point is opposite to
/// the previous one.
pub fn sphere_point(index: u32) -> Vec3 {
    let pair = (index / 2) as f32;
    let z = 1.0 - (pair + 0.5) / 4.0;
    // Lengths have another order than heights, so that they are independent.
    let length = (((index / 2) * 5 % 8) as f32 + 0.5) / 8.0;
    let point = (Vec2::from_angle(pair * GOLDEN_ANGLE) * (1.0 - z * z).sqrt()).extend(z) * length.cbrt();
    if index.is_multiple_of(2) { point } else { -point }
}

/// Returns the occlusion by the visible surface at a point of the sphere, 0 to 1: 1 if it is nearer than the
/// point by up to the sphere's radius, then falling to 0 at twice the radius. Depths are view depths.
pub fn behind(point_depth: f32, surface_depth: f32, radius: f32) -> f32 {
    let nearer = point_depth - surface_depth;
    if nearer > 0.0 { (2.0 - nearer / radius).clamp(0.0, 1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_near(a: f32, b: f32) {
        assert!((a - b).abs() < 1e-5, "{a} is not {b}");
    }

    #[test]
    fn a_neighbour_hides_by_its_angle_and_distance() {
        // The neighbour is (3, 4, 0) away, so 5 units: N·V = 4/5, d = 5 · 0.2 = 1, (0.8 - 0.3) / (1 + 1) =
        // 0.25.
        let at = Vec3::new(1.0, -2.0, -9.0);
        assert_near(term(Vec3::Y, at, at + Vec3::new(3.0, 4.0, 0.0), 0.2, 0.3), 0.25);
        // No occlusion below the horizon, in the plane, and at the point itself.
        for difference in [Vec3::new(3.0, -4.0, 0.0), Vec3::X, Vec3::ZERO] {
            assert_eq!(term(Vec3::Y, at, at + difference, 0.2, 0.0), 0.0, "{difference}");
        }
    }

    #[test]
    fn neighbours_lie_on_the_step_and_on_the_step_turned() {
        // (1, 0) reflected at (0.6, 0.8): (1, 0) - 1.2 (0.6, 0.8) = (0.28, -0.96); times 0.5 / 2 = (0.07, -0.24).
        let step = step(Vec2::X, Vec2::new(0.6, 0.8), 0.5, 2.0);
        assert!((step - Vec2::new(0.07, -0.24)).length() < 1e-6, "{step}");
        // Turned by 45°: (0.07 + 0.24, 0.07 - 0.24) / √2 = (0.219203, -0.120208).
        let turned = Vec2::new(0.219_203, -0.120_208);
        for (neighbour, is_back, expected) in [
            (0, false, step * 0.25),
            (1, false, turned * 0.5),
            (2, false, step * 0.75),
            (3, false, turned),
            (0, true, step * 0.375),
            (1, true, turned * 0.625),
            (2, true, step * 0.875),
            (3, true, turned * 1.125),
        ] {
            let found = offset(step, neighbour, is_back);
            assert!((found - expected).length() < 1e-5, "{neighbour} {is_back}: {found}, not {expected}");
        }
    }

    #[test]
    fn directions_fall_from_six_to_two_toward_the_far_plane() {
        // lerp(6, 2, t): 6 at 0, 5.6 at 0.1, 5 at 0.25, 4.96 at 0.26, 4 at 0.5, 3.2 at 0.7, 2 at 1 and beyond.
        for (depth, count) in [(0.0, 6), (10.0, 5), (25.0, 5), (26.0, 4), (50.0, 4), (70.0, 3), (100.0, 2), (300.0, 2)]
        {
            assert_eq!(directions(depth, 100.0, true), count, "{depth}");
            assert_eq!(directions(depth, 100.0, false), 4);
        }
    }

    #[test]
    fn the_sum_is_divided_by_the_front_neighbours_and_back_faces_have_no_intensity() {
        // (3 · 2 + 1) / 16 = 0.4375. Six directions: 7 / 24 = 0.291667. Larger sums are clamped to 1.
        assert_near(sum(3.0, 1.0, 2.0, 4), 0.4375);
        assert_near(sum(3.0, 1.0, 2.0, 6), 0.291_667);
        assert_eq!(sum(16.0, 16.0, 2.0, 4), 1.0);
    }

    #[test]
    fn random_vectors_are_unit_and_give_sixteen_different_crosses() {
        let mut turns = Vec::new();
        for pixel in (0..16).map(|index| UVec2::new(index % 4 + 8, index / 4 + 4)) {
            let vector = random_vector(pixel);
            assert_near(vector.length(), 1.0);
            assert_near(random_vector_3d(pixel).length(), 1.0);
            let cross = step(Vec2::X, vector, 1.0, 1.0).to_angle();
            turns.push((cross.to_degrees().rem_euclid(90.0) / 5.625).round() as u32 % 16);
        }
        turns.sort_unstable();
        assert_eq!(turns, (0..16).collect::<Vec<_>>());
        // Column 1, row 0 is number 8: 8 · 47.8125° = 382.5°, so (cos 22.5°, sin 22.5°).
        assert!((random_vector(UVec2::new(1, 0)) - Vec2::new(0.923_880, 0.382_683)).length() < 1e-5);
    }

    #[test]
    fn half_of_the_sphere_lies_behind_any_wall() {
        for pixel in (0..16).map(|index| UVec2::new(index % 4, index / 4)) {
            let normal = random_vector_3d(pixel);
            let points = (0..SPHERE_POINTS).map(sphere_point);
            assert!(points.clone().all(|point| point.length() < 1.0));
            assert_eq!(points.filter(|point| point.dot(normal) < 0.0).count(), 8, "{normal}");
        }
    }

    #[test]
    fn a_surface_far_in_front_hides_nothing() {
        // Radius 0.5. Nearer by 0.3: 1. By 0.75: 2 - 1.5 = 0.5. By 1.2, or farther away: 0.
        for (surface, hidden) in [(9.7, 1.0), (9.25, 0.5), (8.8, 0.0), (10.0, 0.0), (11.0, 0.0)] {
            assert_near(behind(10.0, surface, 0.5), hidden);
        }
    }
}
