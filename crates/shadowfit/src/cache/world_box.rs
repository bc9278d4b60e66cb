//! Boxes in world space, for comparing casters from frame to frame.

use glam::DVec3;

use crate::Aabb;

/// An axis-aligned box in world space, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldBox {
    /// Its least corner.
    pub min: DVec3,
    /// Its greatest corner.
    pub max: DVec3,
}

/// Rounding of f32 coordinates, as a share of them. Boxes that differ by less are equal, because each change
/// of the origin rounds them again.
const ROUNDING: f32 = 1.0 / 4_194_304.0;

impl WorldBox {
    /// The empty box.
    pub const EMPTY: Self = Self { min: DVec3::MAX, max: DVec3::MIN };

    /// Returns the world box of a box that is relative to an origin (world space, metres). Boxes with NaN
    /// become empty.
    pub fn new(aabb: &Aabb, origin: DVec3) -> Self {
        // The comparison is also false for NaN.
        if !aabb.min.cmple(aabb.max).all() {
            return Self::EMPTY;
        }
        Self { min: origin + aabb.min.as_dvec3(), max: origin + aabb.max.as_dvec3() }
    }

    /// Returns whether the box is empty.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Returns the box relative to an origin (world space, metres), rounded to f32.
    pub fn relative_to(&self, origin: DVec3) -> Aabb {
        if self.is_empty() {
            return Aabb::EMPTY;
        }
        Aabb::new((self.min - origin).as_vec3(), (self.max - origin).as_vec3())
    }

    /// Returns the smallest box around both boxes, which must not be empty.
    pub(super) fn union(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Returns whether it equals another box, up to `rounding` metres in each coordinate.
    pub(super) fn is_same(&self, other: &Self, rounding: f64) -> bool {
        let near = |a: DVec3, b: DVec3| a == b || (a - b).abs().max_element() <= rounding;
        near(self.min, other.min) && near(self.max, other.max)
    }
}

/// Returns the greatest difference between a box and the same box relative to another origin, in metres.
pub(super) fn rounding(aabb: &Aabb) -> f64 {
    f64::from(aabb.min.abs().max(aabb.max.abs()).max_element() * ROUNDING)
}
