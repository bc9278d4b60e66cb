//! Which casters a shadow pass has to draw.
//!
//! The test is conservative: it may keep a caster that throws no visible shadow, but never culls
//! one that the map can store.

use glam::{Vec3, Vec4};

/// A convex volume that holds every caster of one map, as planes in world axes relative to the
/// fit's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CasterVolume {
    /// Planes (n, d) with unit normals that point inward: a point p, in metres relative to the
    /// fit's origin, is inside where n·p + d >= 0 for all of them. In the light's axes: -x, +x,
    /// -y, +y, far, near.
    pub planes: [Vec4; 6],
}

/// Rounding that the plane test allows for, as a share of its terms: 8 · 2⁻²⁴, for six operations
/// in f32 and the plane's own rounding.
const ROUNDING: f32 = 8.0 / 16_777_216.0;

impl CasterVolume {
    /// Whether an axis-aligned box may touch the volume. `min` and `max` are its corners in world
    /// axes **relative to the fit's origin**, in metres. Bounds that are NaN count as touching.
    ///
    /// Known false positives: boxes that lie outside near an edge or corner of the volume without
    /// being wholly behind one of its planes.
    pub fn intersects_aabb(&self, min: Vec3, max: Vec3) -> bool {
        !self.planes.iter().any(|plane| is_behind(*plane, min, max))
    }
}

/// Whether the whole box lies behind the plane: so does then its farthest corner along the normal.
fn is_behind(plane: Vec4, min: Vec3, max: Vec3) -> bool {
    let x = plane.x * if plane.x < 0.0 { min.x } else { max.x };
    let y = plane.y * if plane.y < 0.0 { min.y } else { max.y };
    let z = plane.z * if plane.z < 0.0 { min.z } else { max.z };
    let slack = (x.abs() + y.abs() + z.abs() + plane.w.abs()) * ROUNDING;
    x + y + z + plane.w < -slack
}
