//! Road, kerb, pavement and wall: one triangle strip of nine pairs of vertices.

use glam::{Vec2, Vec3};
use shadowfit_scene::Primitive;

use super::palette::Paint;

/// The pairs: x, y, u and the normal. Where faces meet at an edge, each has its own pair.
///
/// ```text
///                   +  8: top of the wall, y = 21
///                   |
///                   |
///            4 5    |
///            +-+----+ 6, 7: y = 1, the pavement, and the foot of the wall at x = 13
///   0        | 3
///   +--------+ 1, 2
///   x = -20    x = 2
/// ```
pub(super) const PAIRS: [(f32, f32, f32, Vec3); 9] = [
    (-20.0, 0.0, -0.25, Vec3::Y),
    (2.0, 0.0, 0.25, Vec3::Y),
    (2.0, 0.0, 0.25, Vec3::NEG_X),
    (2.0, 1.0, 0.375, Vec3::NEG_X),
    (2.0, 1.0, 0.375, Vec3::Y),
    (3.0, 1.0, 0.5, Vec3::Y),
    (13.0, 1.0, 0.75, Vec3::Y),
    (13.0, 1.0, 0.75, Vec3::NEG_X),
    (13.0, 21.0, 1.25, Vec3::NEG_X),
];

/// z and v of the two vertices of each pair.
const ENDS: [(f32, f32); 2] = [(10.0, 25.0), (-100.0, 0.0)];

/// Builds the strip as a list of triangles, without triangles of no area between coincident pairs.
pub(super) fn primitive() -> Primitive {
    let mut primitive = Primitive { material: Paint::Strip.into(), ..Primitive::default() };
    for (x, y, u, normal) in PAIRS {
        for (z, v) in ENDS {
            primitive.positions.push(Vec3::new(x, y, z));
            primitive.normals.push(normal);
            primitive.uvs.push(Vec2::new(u, v));
        }
    }
    for pair in 1..PAIRS.len() {
        let (from, to) = (PAIRS[pair - 1], PAIRS[pair]);
        if (from.0, from.1) != (to.0, to.1) {
            let near = 2 * pair as u32;
            let [a, b, c, d] = [near - 2, near, near + 1, near - 1];
            primitive.indices.extend([a, b, c, a, c, d]);
        }
    }
    primitive
}
