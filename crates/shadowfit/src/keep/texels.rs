//! Rectangles of a map's texels, and their position in its texture.
//!
//! Storage wraps around: a map moves, while its texels stay where they are stored.
//!
//! Graphics APIs cannot copy a part of a depth texture within itself, so kept texels must not move. Texel t
//! of the map is stored at `t + texel_offset` modulo the map's size. When the map moves by a shift, the texel
//! offset moves by the same shift. The texels that come in on one side overwrite the texels that leave on the
//! other.
//!
//! ```text
//!   the map as it is looked up        as it is stored
//!   ┌───────┬───┐                     ┌───┬───────┐
//!   │   A   │ B │                     │ D │   C   │
//!   ├───────┼───┤   texel_offset = (3, 1)     ├───┼───────┤
//!   │   C   │ D │                     │ B │   A   │
//!   └───────┴───┘                     └───┴───────┘
//! ```
//!
//! Each of the up to four parts is drawn with the map's own projection. Its viewport has the map's size and
//! begins at [`StoredRect::viewport`], a whole number of texels away, so the raster is the same.

use glam::{DVec3, IVec2, UVec2};

use crate::base::{Aabb, moved};
use crate::projection::LightProjection;

/// A rectangle of texels. Texture rows count downward from the top, as in
/// [`uv_from_world`](LightProjection::uv_from_world).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TexelRect {
    /// Top left texel.
    pub min: UVec2,
    /// Width and height, in texels.
    pub size: UVec2,
}

impl TexelRect {
    /// Returns all texels of a map of this width and height.
    pub const fn all(size: UVec2) -> Self {
        Self { min: UVec2::ZERO, size }
    }

    /// Returns the number of texels.
    pub const fn area(&self) -> u64 {
        self.size.x as u64 * self.size.y as u64
    }

    /// Returns whether the rectangle has no texel.
    pub const fn is_empty(&self) -> bool {
        self.size.x == 0 || self.size.y == 0
    }

    /// Returns the texels that are in both rectangles.
    #[must_use]
    pub fn intersection(self, other: Self) -> Self {
        let min = self.min.max(other.min);
        let end = self.end().min(other.end());
        Self { min, size: end.saturating_sub(min) }
    }

    /// Returns the least rectangle that holds both. Both must have texels.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        let min = self.min.min(other.min);
        Self { min, size: self.end().max(other.end()) - min }
    }

    /// Returns the column and row after the last ones.
    fn end(self) -> UVec2 {
        self.min.saturating_add(self.size)
    }

    /// Returns the texels of a map that a box may be drawn into, with one texel around them for the
    /// rasteriser's rounding. The box is relative to `origin` (world space, metres). The result is empty if
    /// the box lies beside the map or is empty.
    pub fn of_box(fit: &LightProjection, aabb: &Aabb, origin: DVec3) -> Self {
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

/// A part of a map that is stored in one piece.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StoredRect {
    /// Texels of the map that belong to the part, as they are looked up.
    pub window: TexelRect,
    /// Texels of the texture that store the part. They are the scissor rectangle.
    pub stored: TexelRect,
}

impl StoredRect {
    /// Returns the top left corner of the viewport that draws the part, in texels. The viewport has the map's
    /// size, and may begin up to a map's size outside the texture.
    pub fn viewport(&self) -> IVec2 {
        self.stored.min.as_ivec2() - self.window.min.as_ivec2()
    }
}

impl TexelRect {
    /// Returns the pieces in which a part of a map is stored: up to four. `size` is the map's width and
    /// height, and `texel_offset` must be below it.
    pub fn stored(self, texel_offset: UVec2, size: UVec2) -> impl Iterator<Item = StoredRect> {
        let part = self.intersection(Self::all(size));
        let columns = runs(part.min.x, part.size.x, texel_offset.x, size.x);
        let rows = runs(part.min.y, part.size.y, texel_offset.y, size.y);
        let piece = move |(x, y): ([u32; 3], [u32; 3])| {
            let size = UVec2::new(x[2], y[2]);
            StoredRect {
                window: Self { min: UVec2::new(x[0], y[0]), size },
                stored: Self { min: UVec2::new(x[1], y[1]), size },
            }
        };
        let pieces = columns.into_iter().flat_map(move |x| rows.into_iter().map(move |y| (x, y)));
        pieces.map(piece).filter(|piece| !piece.window.is_empty())
    }
}

/// Cuts a run of texels at the end of the storage. Each piece has its first texel, the position where that is
/// stored, and its length.
fn runs(first: u32, length: u32, texel_offset: u32, size: u32) -> [[u32; 3]; 2] {
    if size == 0 {
        return [[0; 3]; 2];
    }
    let stored = (u64::from(first) + u64::from(texel_offset % size)) % u64::from(size);
    let until_end = length.min(size - stored as u32);
    [[first, stored as u32, until_end], [first + until_end, 0, length - until_end]]
}
