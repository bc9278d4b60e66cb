//! Boxes: what an engine knows of its receivers and casters.

use glam::{DVec3, Vec3};

/// An axis-aligned box in world axes, in metres, relative to an origin that its user states.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Aabb {
    /// Corner with the least coordinates.
    pub min: Vec3,
    /// Corner with the greatest coordinates.
    pub max: Vec3,
}

impl Aabb {
    /// The box that holds nothing and changes nothing that it is joined to.
    pub const EMPTY: Self = Self { min: Vec3::MAX, max: Vec3::MIN };

    /// A box from its least and greatest corner, in metres.
    pub const fn new(min: Vec3, max: Vec3) -> Self {
        Self { min, max }
    }

    /// The least box that holds both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The least box that holds this one and a point, in metres.
    #[must_use]
    pub fn with_point(self, point: Vec3) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    /// Whether the box holds no point: a coordinate of `min` above that of `max`, or NaN.
    pub fn is_empty(&self) -> bool {
        !(self.min.x <= self.max.x && self.min.y <= self.max.y && self.min.z <= self.max.z)
    }
}

/// Boxes in world axes relative to an origin in f64, so that they stay exact far from the world's
/// own. Plain world-space boxes have the origin zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Boxes<'a> {
    /// World position that the boxes are relative to, in metres.
    pub origin: DVec3,
    /// The boxes. Empty ones are passed over.
    pub boxes: &'a [Aabb],
}
