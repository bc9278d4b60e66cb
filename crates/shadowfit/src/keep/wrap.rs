//! Wrap-around storage: a map that moves, while its texels stay where they are stored.
//!
//! Graphics APIs cannot copy a part of a depth texture within itself, so texels that are kept must
//! not move. The window texel t is stored at (t + wrap) modulo the map's size: when the map moves by
//! a shift, so does the wrap, and what it leaves on one side is overwritten by what comes in on the
//! other.
//!
//! ```text
//!   the map as it is looked up        as it is stored
//!   ┌───────┬───┐                     ┌───┬───────┐
//!   │   A   │ B │                     │ D │   C   │
//!   ├───────┼───┤   wrap = (3, 1)     ├───┼───────┤
//!   │   C   │ D │                     │ B │   A   │
//!   └───────┴───┘                     └───┴───────┘
//! ```
//!
//! Each of the up to four parts is drawn with the map's own projection and a viewport of the map's
//! size that begins at [`StoredRect::viewport`], by whole texels, so the raster is the same.

use glam::{IVec2, UVec2};

use super::texel_rect::TexelRect;

/// A part of a map where it is stored in one piece.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StoredRect {
    /// The part as it is looked up.
    pub window: TexelRect,
    /// The texels in which it is stored: a scissor rectangle.
    pub stored: TexelRect,
}

impl StoredRect {
    /// Left top corner of the viewport, of the map's size, with which the part is drawn, in texels. It may lie up to
    /// a map's size outside the texture.
    pub fn viewport(&self) -> IVec2 {
        self.stored.min.as_ivec2() - self.window.min.as_ivec2()
    }
}

impl TexelRect {
    /// Where a part of a map of the given width and height is stored: up to four pieces, for a wrap below that size.
    pub fn stored(self, wrap: UVec2, size: UVec2) -> impl Iterator<Item = StoredRect> {
        let part = self.intersection(Self::all(size));
        let columns = runs(part.min.x, part.size.x, wrap.x, size.x);
        let rows = runs(part.min.y, part.size.y, wrap.y, size.y);
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

/// A run of texels, cut where it meets the end of what is stored: for each piece its first texel, where that is stored,
/// and its length.
fn runs(first: u32, length: u32, wrap: u32, size: u32) -> [[u32; 3]; 2] {
    if size == 0 {
        return [[0; 3]; 2];
    }
    let stored = (u64::from(first) + u64::from(wrap % size)) % u64::from(size);
    let until_end = length.min(size - stored as u32);
    [[first, stored as u32, until_end], [first + until_end, 0, length - until_end]]
}
