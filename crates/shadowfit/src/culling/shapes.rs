//! Shapes for tests against a caster volume. The tests use a shape's support: its greatest extent along a
//! direction.
//!
//! The single and the batched tests use the same operations in the same order, so that their results are
//! equal to the last bit.

use glam::{Mat4, Vec3};

use crate::base::Aabb;
use crate::base::checks::UNIT;

/// Rounding that the tests allow for, as a share of the coordinates of shape and plane: 16 · 2⁻²⁴. A test has
/// at most ten operations in f32. The planes' normals are rounded once, and have two more roundings along the
/// light.
pub(super) const TEST_ROUNDING: f32 = 16.0 * UNIT as f32;

/// Number of shapes that are tested together. Loops of this length are not unrolled, so every compiler can
/// vectorise them, and all lanes stay in the innermost cache.
pub(super) const LANES: usize = 64;

/// A bounding sphere of a caster, relative to an origin that its user defines.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Sphere {
    /// Centre in world axes, in metres.
    pub centre: Vec3,
    /// Radius in metres. A sphere with a negative radius is empty.
    pub radius: f32,
}

/// A bounding box of a caster that may be rotated (or sheared), relative to an origin that its user defines.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct OrientedBox {
    /// Centre in world axes, in metres.
    pub centre: Vec3,
    /// Vectors from the centre to the middles of three faces, in world axes, in metres.
    pub half_axes: [Vec3; 3],
}

impl OrientedBox {
    /// Returns a box in local space, moved by an affine transform. Perspective is not applied. An empty box
    /// becomes a box that touches everything.
    pub fn from_local(world_from_local: &Mat4, local: &Aabb) -> Self {
        if local.is_empty() {
            return Self { centre: Vec3::NAN, half_axes: [Vec3::NAN; 3] };
        }
        let (centre, half) = ((local.min + local.max) * 0.5, (local.max - local.min) * 0.5);
        let m = world_from_local;
        let axes = [m.x_axis.truncate(), m.y_axis.truncate(), m.z_axis.truncate()];
        Self {
            centre: axes[0] * centre.x + axes[1] * centre.y + axes[2] * centre.z + m.w_axis.truncate(),
            half_axes: [axes[0] * half.x, axes[1] * half.y, axes[2] * half.z],
        }
    }
}

/// A shape that [`cull`](super::cull) takes: [`Aabb`], [`Sphere`] or [`OrientedBox`].
pub trait Bounds: Shape {}

impl Bounds for Aabb {}
impl Bounds for Sphere {}
impl Bounds for OrientedBox {}

mod sealed {
    use glam::Vec3;

    use super::LANES;

    /// Operations of a shape that the tests need.
    pub trait Shape: Copy {
        /// Several shapes, as a structure of arrays.
        type Lanes: Lanes<Self>;

        /// Returns the greatest n·p of its points.
        fn support(&self, normal: Vec3) -> f32;

        /// Returns the greatest rounding error of the support. Negative infinity for an empty shape, NaN or
        /// infinite if one of the shape's numbers is.
        fn slack(&self) -> f32;
    }

    /// Operations on several shapes.
    pub trait Lanes<S>: Default {
        /// Fills the lanes.
        fn gather(&mut self, shapes: &[S; LANES]);

        /// Calls `put` with [`Shape::support`] of each lane.
        fn support(&self, normal: Vec3, put: impl FnMut(usize, f32));

        /// Calls `put` with [`Shape::slack`] of each lane.
        fn slack(&self, put: impl FnMut(usize, f32));
    }
}

pub(super) use sealed::{Lanes, Shape};

/// One number of each shape.
pub(super) type Lane = [f32; LANES];

/// Three numbers of each shape.
#[derive(Clone, Copy)]
struct Points {
    x: Lane,
    y: Lane,
    z: Lane,
}

impl Default for Points {
    fn default() -> Self {
        Self { x: [0.0; LANES], y: [0.0; LANES], z: [0.0; LANES] }
    }
}

impl Points {
    #[inline]
    fn set(&mut self, i: usize, p: Vec3) {
        (self.x[i], self.y[i], self.z[i]) = (p.x, p.y, p.z);
    }

    #[inline]
    fn get(&self, i: usize) -> Vec3 {
        Vec3::new(self.x[i], self.y[i], self.z[i])
    }
}

/// Computes the dot product, always in the same order of operations.
#[inline]
fn dot(n: Vec3, x: f32, y: f32, z: f32) -> f32 {
    n.x * x + n.y * y + n.z * z
}

/// Returns the sum of the absolute values of a vector's components.
#[inline]
fn sum(v: Vec3) -> f32 {
    v.x.abs() + v.y.abs() + v.z.abs()
}

/// Boxes in lanes.
#[derive(Default)]
pub struct AabbLanes {
    min: Points,
    max: Points,
}

#[inline]
fn box_slack(min: Vec3, max: Vec3) -> f32 {
    let is_empty = min.x > max.x || min.y > max.y || min.z > max.z;
    if is_empty { f32::NEG_INFINITY } else { (sum(min) + sum(max)) * TEST_ROUNDING }
}

impl Shape for Aabb {
    type Lanes = AabbLanes;

    fn support(&self, n: Vec3) -> f32 {
        let x = if n.x < 0.0 { self.min.x } else { self.max.x };
        let y = if n.y < 0.0 { self.min.y } else { self.max.y };
        let z = if n.z < 0.0 { self.min.z } else { self.max.z };
        dot(n, x, y, z)
    }

    fn slack(&self) -> f32 {
        box_slack(self.min, self.max)
    }
}

impl Lanes<Aabb> for AabbLanes {
    #[inline]
    fn gather(&mut self, shapes: &[Aabb; LANES]) {
        for (i, shape) in shapes.iter().enumerate() {
            self.min.set(i, shape.min);
            self.max.set(i, shape.max);
        }
    }

    #[inline]
    fn support(&self, n: Vec3, mut put: impl FnMut(usize, f32)) {
        // Uses the same corner of all boxes, so that the loop has no branch.
        let x = if n.x < 0.0 { &self.min.x } else { &self.max.x };
        let y = if n.y < 0.0 { &self.min.y } else { &self.max.y };
        let z = if n.z < 0.0 { &self.min.z } else { &self.max.z };
        for i in 0..LANES {
            put(i, dot(n, x[i], y[i], z[i]));
        }
    }

    #[inline]
    fn slack(&self, mut put: impl FnMut(usize, f32)) {
        for i in 0..LANES {
            put(i, box_slack(self.min.get(i), self.max.get(i)));
        }
    }
}

/// Spheres in lanes.
pub struct SphereLanes {
    centre: Points,
    radius: Lane,
}

impl Default for SphereLanes {
    fn default() -> Self {
        Self { centre: Points::default(), radius: [0.0; LANES] }
    }
}

#[inline]
fn sphere_slack(centre: Vec3, radius: f32) -> f32 {
    if radius < 0.0 { f32::NEG_INFINITY } else { (sum(centre) + radius) * TEST_ROUNDING }
}

impl Shape for Sphere {
    type Lanes = SphereLanes;

    fn support(&self, n: Vec3) -> f32 {
        dot(n, self.centre.x, self.centre.y, self.centre.z) + self.radius
    }

    fn slack(&self) -> f32 {
        sphere_slack(self.centre, self.radius)
    }
}

impl Lanes<Sphere> for SphereLanes {
    #[inline]
    fn gather(&mut self, shapes: &[Sphere; LANES]) {
        for (i, shape) in shapes.iter().enumerate() {
            self.centre.set(i, shape.centre);
            self.radius[i] = shape.radius;
        }
    }

    #[inline]
    fn support(&self, n: Vec3, mut put: impl FnMut(usize, f32)) {
        let Points { x, y, z } = &self.centre;
        for i in 0..LANES {
            put(i, dot(n, x[i], y[i], z[i]) + self.radius[i]);
        }
    }

    #[inline]
    fn slack(&self, mut put: impl FnMut(usize, f32)) {
        for i in 0..LANES {
            put(i, sphere_slack(self.centre.get(i), self.radius[i]));
        }
    }
}

/// Oriented boxes in lanes.
#[derive(Default)]
pub struct OrientedLanes {
    centre: Points,
    half_axes: [Points; 3],
}

#[inline]
fn oriented_support(n: Vec3, centre: Vec3, a: Vec3, b: Vec3, c: Vec3) -> f32 {
    let along = |v: Vec3| dot(n, v.x, v.y, v.z);
    along(centre) + (along(a).abs() + along(b).abs() + along(c).abs())
}

#[inline]
fn oriented_slack(centre: Vec3, a: Vec3, b: Vec3, c: Vec3) -> f32 {
    (sum(centre) + (sum(a) + sum(b) + sum(c))) * TEST_ROUNDING
}

impl Shape for OrientedBox {
    type Lanes = OrientedLanes;

    fn support(&self, n: Vec3) -> f32 {
        let [a, b, c] = self.half_axes;
        oriented_support(n, self.centre, a, b, c)
    }

    fn slack(&self) -> f32 {
        let [a, b, c] = self.half_axes;
        oriented_slack(self.centre, a, b, c)
    }
}

impl Lanes<OrientedBox> for OrientedLanes {
    #[inline]
    fn gather(&mut self, shapes: &[OrientedBox; LANES]) {
        for (i, shape) in shapes.iter().enumerate() {
            self.centre.set(i, shape.centre);
            self.half_axes[0].set(i, shape.half_axes[0]);
            self.half_axes[1].set(i, shape.half_axes[1]);
            self.half_axes[2].set(i, shape.half_axes[2]);
        }
    }

    #[inline]
    fn support(&self, n: Vec3, mut put: impl FnMut(usize, f32)) {
        let [a, b, c] = &self.half_axes;
        for i in 0..LANES {
            put(i, oriented_support(n, self.centre.get(i), a.get(i), b.get(i), c.get(i)));
        }
    }

    #[inline]
    fn slack(&self, mut put: impl FnMut(usize, f32)) {
        let [a, b, c] = &self.half_axes;
        for i in 0..LANES {
            put(i, oriented_slack(self.centre.get(i), a.get(i), b.get(i), c.get(i)));
        }
    }
}
