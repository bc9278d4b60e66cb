//! Boxes of receivers and casters, and the depth ranges of clip spaces.
//!
//! Every matrix that this crate reads or writes names its depth range with [`DepthConvention`], because a fit
//! with the wrong one still looks right from most cameras.

use glam::{DVec3, Vec3};

/// An axis-aligned box in metres, relative to an origin that its user defines. Fits take boxes in world axes.
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
    /// The empty box. Its union with another box is that other box.
    pub const EMPTY: Self = Self { min: Vec3::MAX, max: Vec3::MIN };

    /// Creates a box from its least and greatest corner, in metres.
    pub const fn new(min: Vec3, max: Vec3) -> Self {
        Self { min, max }
    }

    /// Returns the least box that holds all `points`, which must be finite and in metres, or `None` without
    /// points.
    pub fn from_points(points: impl IntoIterator<Item = Vec3>) -> Option<Self> {
        let mut points = points.into_iter();
        let first = points.next()?;
        Some(points.fold(Self::new(first, first), Self::with_point))
    }

    /// Returns the least box that holds both boxes.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Returns the least box that holds this one and a point, in metres.
    #[must_use]
    pub fn with_point(self, point: Vec3) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    /// Returns the edge lengths along x, y and z, in metres. They are meaningless for an empty box.
    pub fn size(&self) -> Vec3 {
        self.max - self.min
    }

    /// Returns the eight corners: the four with the least z in order around, then the four with the greatest
    /// z.
    pub fn corners(&self) -> [Vec3; 8] {
        box_corners(self.min.as_dvec3(), self.max.as_dvec3()).map(DVec3::as_vec3)
    }

    /// Returns whether the box holds no point: a coordinate of `min` exceeds the one of `max`, or is NaN.
    pub fn is_empty(&self) -> bool {
        !(self.min.x <= self.max.x && self.min.y <= self.max.y && self.min.z <= self.max.z)
    }
}

/// Boxes in world axes relative to an origin in f64, so that they stay exact far from the world's
/// origin. Plain world-space boxes have the origin zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Boxes<'a> {
    /// World position that the boxes are relative to, in metres.
    pub origin: DVec3,
    /// The boxes. Empty ones are ignored.
    pub boxes: &'a [Aabb],
}

impl<'a> Boxes<'a> {
    /// Creates boxes in plain world space, in metres.
    pub const fn world(boxes: &'a [Aabb]) -> Self {
        Self { origin: DVec3::ZERO, boxes }
    }
}

/// Returns the corners of a box: the four with the least z in order around, then the four with the greatest
/// z.
pub(crate) fn box_corners(min: DVec3, max: DVec3) -> [DVec3; 8] {
    let (a, b) = (min, max);
    [
        DVec3::new(a.x, a.y, a.z),
        DVec3::new(b.x, a.y, a.z),
        DVec3::new(b.x, b.y, a.z),
        DVec3::new(a.x, b.y, a.z),
        DVec3::new(a.x, a.y, b.z),
        DVec3::new(b.x, a.y, b.z),
        DVec3::new(b.x, b.y, b.z),
        DVec3::new(a.x, b.y, b.z),
    ]
}

/// Returns the least and greatest corner of a box relative to another origin, in f64.
pub(crate) fn moved(aabb: &Aabb, offset: DVec3) -> (DVec3, DVec3) {
    let to = |v: Vec3| v.as_dvec3() + offset;
    (to(aabb.min), to(aabb.max))
}

/// Depth range of a clip space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum DepthConvention {
    /// Near is 0, far is 1 (wgpu, Direct3D, Vulkan, Metal).
    #[default]
    ZeroToOne,
    /// Near is 1, far is 0: 0..1 reversed, for float precision.
    Reversed,
    /// Near is -1, far is 1 (OpenGL).
    NegativeOneToOne,
}

impl DepthConvention {
    /// Returns the clip depth (after the division by w) of the near plane.
    pub const fn near(self) -> f32 {
        match self {
            Self::ZeroToOne => 0.0,
            Self::Reversed => 1.0,
            Self::NegativeOneToOne => -1.0,
        }
    }

    /// Returns the clip depth (after the division by w) of the far plane.
    pub const fn far(self) -> f32 {
        match self {
            Self::ZeroToOne | Self::NegativeOneToOne => 1.0,
            Self::Reversed => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_box_around_the_corners_of_a_box_is_that_box() {
        let aabb = Aabb::new(Vec3::new(-1.0, 2.0, 3.0), Vec3::new(4.0, 6.0, 8.0));
        let mut corners = aabb.corners();
        assert_eq!(Aabb::from_points(corners), Some(aabb));
        assert_eq!(aabb.size(), Vec3::new(5.0, 4.0, 5.0));
        corners.sort_by(|a, b| a.to_array().partial_cmp(&b.to_array()).unwrap());
        assert!(corners.windows(2).all(|pair| pair[0] != pair[1]), "{corners:?}");
    }

    #[test]
    fn a_single_point_has_a_box_without_size_and_no_points_have_none() {
        let point = Vec3::new(1.0, -2.0, 3.0);
        assert_eq!(Aabb::from_points([point]), Some(Aabb::new(point, point)));
        assert_eq!(Aabb::from_points([]), None);
    }
}
