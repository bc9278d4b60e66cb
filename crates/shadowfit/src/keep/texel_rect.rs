//! Rectangles of a map's texels.

use glam::{DVec3, UVec2};

use crate::base::{Aabb, moved};
use crate::fits::LightFit;

/// A rectangle of texels. Texture rows count downward from the top, as in
/// [`uv_from_world`](LightFit::uv_from_world).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TexelRect {
    /// Its left top texel.
    pub min: UVec2,
    /// Its width and height, in texels.
    pub size: UVec2,
}

impl TexelRect {
    /// All texels of a map of this width and height.
    pub const fn all(size: UVec2) -> Self {
        Self { min: UVec2::ZERO, size }
    }

    /// Number of texels.
    pub const fn area(&self) -> u64 {
        self.size.x as u64 * self.size.y as u64
    }

    /// Whether it has no texel.
    pub const fn is_empty(&self) -> bool {
        self.size.x == 0 || self.size.y == 0
    }

    /// The texels that are in both.
    #[must_use]
    pub fn intersection(self, other: Self) -> Self {
        let min = self.min.max(other.min);
        let end = self.end().min(other.end());
        Self { min, size: end.saturating_sub(min) }
    }

    /// The least rectangle that holds both, none of which is empty.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        let min = self.min.min(other.min);
        Self { min, size: self.end().max(other.end()) - min }
    }

    /// One beyond its last column and row.
    fn end(self) -> UVec2 {
        self.min.saturating_add(self.size)
    }

    /// The texels of a map that a box may be drawn into, relative to `origin` (world space, metres), with one texel
    /// around them for the rasteriser's rounding. Without texels where the box lies beside the map, or is empty.
    pub fn of_box(fit: &LightFit, aabb: &Aabb, origin: DVec3) -> Self {
        if aabb.is_empty() {
            return Self::default();
        }
        let (min, max) = moved(aabb, origin - fit.origin);
        let (centre, half) = fit.project_box((min + max) * 0.5, (max - min) * 0.5);
        let texel = fit.texel_size.as_dvec2();
        let left = f64::from(fit.box_min.x);
        let top = f64::from(fit.box_max.y);
        let low = [(centre.x - half.x - left) / texel.x, (top - centre.y - half.y) / texel.y];
        let high = [(centre.x + half.x - left) / texel.x, (top - centre.y + half.y) / texel.y];
        let first = |value: f64, size: u32| (libm::floor(value) - 1.0).clamp(0.0, f64::from(size)) as u32;
        let end = |value: f64, size: u32| (libm::ceil(value) + 1.0).clamp(0.0, f64::from(size)) as u32;
        let size = fit.resolution;
        let min = UVec2::new(first(low[0], size.x), first(low[1], size.y));
        let max = UVec2::new(end(high[0], size.x), end(high[1], size.y));
        Self { min, size: max.saturating_sub(min) }
    }
}
