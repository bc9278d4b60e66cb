//! Open surfaces: grounds that follow a height function, on grids that are finest in the middle.

use glam::{Vec2, Vec3, Vec4};

use crate::Primitive;

/// Half of the distance over which a ground's slope is measured, in metres: less than a footstep.
const SLOPE: f32 = 0.2;

/// Returns `count + 1` coordinates from `-half` to `half` metres. Their spacing is about e^`growth` times as
/// large at the ends as in the middle.
pub fn graded(half: f32, count: usize, growth: f32) -> Vec<f32> {
    let at = |index: usize| (index as f32 / count as f32 * 2.0 - 1.0) * growth;
    (0..=count).map(|index| half * at(index).sinh() / growth.sinh()).collect()
}

/// Returns the unit normal of the surface y = `height(x, z)`.
pub fn slope_normal(height: impl Fn(f32, f32) -> f32, x: f32, z: f32) -> Vec3 {
    let dx = height(x + SLOPE, z) - height(x - SLOPE, z);
    let dz = height(x, z + SLOPE) - height(x, z - SLOPE);
    Vec3::new(-dx, 2.0 * SLOPE, -dz).normalize()
}

/// Builds the surface y = `height(x, z)`, which faces up. It has a vertex with a linear colour at each
/// crossing of the coordinates `xs` and `zs` (ascending). Texture coordinates are in metres.
pub fn ground(
    material: usize,
    [xs, zs]: [&[f32]; 2],
    height: impl Fn(f32, f32) -> f32,
    color: impl Fn(Vec3) -> Vec3,
) -> Primitive {
    let mut primitive = Primitive { material, ..Primitive::default() };
    for &z in zs {
        for &x in xs {
            let position = Vec3::new(x, height(x, z), z);
            primitive.positions.push(position);
            primitive.normals.push(slope_normal(&height, x, z));
            primitive.uvs.push(Vec2::new(x, z));
            primitive.colors.push(color(position).extend(1.0).max(Vec4::ZERO));
        }
    }
    let row = xs.len() as u32;
    for z in 0..zs.len() as u32 - 1 {
        for x in 0..row - 1 {
            let a = z * row + x;
            let [b, c, d] = [a + row, a + row + 1, a + 1];
            primitive.indices.extend([a, b, c, a, c, d]);
        }
    }
    primitive
}
