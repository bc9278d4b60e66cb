//! The places of a map that changed since it was drawn, and the rectangles that redraw them.
//!
//! One bit per tile records the changes, so memory does not depend on their number or on how long a map
//! waits. The rectangles are computed top-down: the bounding rectangle of all changes is cut in two where
//! this saves the most, and its parts again, until no cut saves anything.
//!
//! ```text
//!   ┌──────────────┐      ┌──────┐
//!   │ ▒▒▒          │      │ ▒▒▒  │
//!   │ ▒▒▒          │  ─▶  │ ▒▒▒  │        each is drawn as small as its changes are
//!   │            ▒ │      └──────┘┌──┐
//!   └──────────────┘              └──┘
//! ```

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use glam::UVec2;

use super::price::Price;
use crate::scroll::TexelRect;

/// Greatest number of tiles along a side. A row is then four words of bits, and a map takes 16 KiB.
const MAX_TILES: u32 = 256;

/// Least width and height of a tile, in texels. On average, tiles enlarge a caster's rectangle by half a tile
/// on each side.
const LEAST_TILE: u32 = 8;

/// Greatest number of rectangles of a map that are drawn in a frame.
const MAX_RECTS: usize = 64;

/// A bit for each tile of a row or a column.
type Line = [u64; 4];

/// The tiles that changed.
#[derive(Debug, Default)]
pub(super) struct ChangedTiles {
    /// Width and height of the map, in texels.
    size: UVec2,
    /// Width and height of a tile, in texels.
    side: u32,
    /// The changed tiles by row, and the same ones by column. Empty before the first change.
    rows: Vec<Line>,
    columns: Vec<Line>,
    is_changed: bool,
}

/// A rectangle of tiles.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Block {
    columns: Range<u32>,
    rows: Range<u32>,
}

/// A rectangle that may still be cut.
struct Leaf {
    block: Block,
    /// The best cut, and the cost that it saves.
    cut: Option<(f64, [Block; 2])>,
}

impl ChangedTiles {
    /// Forgets all changes.
    pub(super) fn clear(&mut self) {
        if self.is_changed {
            self.rows.fill([0; 4]);
            self.columns.fill([0; 4]);
            self.is_changed = false;
        }
    }

    /// Marks a rectangle as changed. `size` is the map's width and height in texels.
    pub(super) fn add(&mut self, rect: TexelRect, size: UVec2) {
        if rect.is_empty() {
            return;
        }
        if self.size != size || self.rows.is_empty() {
            let side = size.max_element().div_ceil(MAX_TILES).max(LEAST_TILE);
            let lines = |texels: u32| vec![[0; 4]; texels.div_ceil(side) as usize];
            *self = Self { size, side, rows: lines(size.y), columns: lines(size.x), is_changed: false };
        }
        self.is_changed = true;
        let tiles = |first: u32, texels: u32| first / self.side..(first + texels).div_ceil(self.side);
        let (columns, rows) = (tiles(rect.min.x, rect.size.x), tiles(rect.min.y, rect.size.y));
        set(&mut self.rows[as_usize(&rows)], &columns);
        set(&mut self.columns[as_usize(&columns)], &rows);
    }

    /// Returns the number of texels of all changed tiles, a lower bound for the area of the rectangles.
    pub(super) fn texels(&self) -> u64 {
        let tiles: u32 = self.rows.iter().flatten().map(|word| word.count_ones()).sum();
        u64::from(tiles) * u64::from(self.side).pow(2)
    }

    /// Returns rectangles around all changes, in texels.
    pub(super) fn rects(&self, price: &Price) -> Vec<TexelRect> {
        let all = Block { columns: 0..self.columns.len() as u32, rows: 0..self.rows.len() as u32 };
        let Some(all) = self.is_changed.then(|| self.tight(&all)).flatten() else { return Vec::new() };
        let mut leaves = vec![self.leaf(all, price)];
        while leaves.len() < MAX_RECTS {
            let saved = |leaf: &Leaf| leaf.cut.as_ref().map_or(0.0, |(saved, _)| *saved);
            let best = (0..leaves.len()).max_by(|a, b| saved(&leaves[*a]).total_cmp(&saved(&leaves[*b])));
            let Some((best, (_, [first, second]))) = best.and_then(|best| Some((best, leaves[best].cut.take()?)))
            else {
                break;
            };
            leaves[best] = self.leaf(first, price);
            leaves.push(self.leaf(second, price));
        }
        leaves.into_iter().map(|leaf| self.texels_of(&leaf.block)).collect()
    }

    fn leaf(&self, block: Block, price: &Price) -> Leaf {
        let whole = self.price(&block, price);
        let [by_row, by_column] = [
            cut(&self.rows[as_usize(&block.rows)], &block.columns)
                .map(|parts| parts.map(|part| block.part(part.along, part.across, false))),
            cut(&self.columns[as_usize(&block.columns)], &block.rows)
                .map(|parts| parts.map(|part| block.part(part.along, part.across, true))),
        ];
        let saved = |parts: [Block; 2]| (whole - parts.iter().map(|part| self.price(part, price)).sum::<f64>(), parts);
        let cuts = by_row.into_iter().chain(by_column).map(saved);
        let cut = cuts.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(saved, _)| *saved > 0.0);
        Leaf { block, cut }
    }

    fn price(&self, block: &Block, price: &Price) -> f64 {
        price.of(self.texels_of(block).area())
    }

    /// Returns the texels of a block.
    fn texels_of(&self, block: &Block) -> TexelRect {
        let min = UVec2::new(block.columns.start, block.rows.start) * self.side;
        let end = (UVec2::new(block.columns.end, block.rows.end) * self.side).min(self.size);
        TexelRect { min, size: end - min }
    }

    /// Returns the smallest block around the changed tiles in another one.
    fn tight(&self, block: &Block) -> Option<Block> {
        let around = |lines: &[Line], across: &Range<u32>| {
            lines.iter().filter_map(|line| extent(line, across)).reduce(|a, b| a.start.min(b.start)..a.end.max(b.end))
        };
        let columns = around(&self.rows[as_usize(&block.rows)], &block.columns)?;
        let rows = around(&self.columns[as_usize(&columns)], &block.rows)?;
        Some(Block { columns, rows })
    }
}

impl Block {
    /// Returns a part of the block. `along` counts from the block's first line.
    fn part(&self, along: Range<u32>, across: Range<u32>, by_column: bool) -> Self {
        let moved = |first: u32| along.start + first..along.end + first;
        if by_column {
            Self { columns: moved(self.columns.start), rows: across }
        } else {
            Self { columns: across, rows: moved(self.rows.start) }
        }
    }
}

/// The changed tiles of some lines.
#[derive(Clone, Debug)]
struct Part {
    /// Lines from the first to the last one with a changed tile.
    along: Range<u32>,
    across: Range<u32>,
}

impl Part {
    const NONE: Self = Self { along: 0..0, across: 0..0 };

    fn add(&mut self, line: u32, tiles: &Range<u32>) {
        if tiles.is_empty() {
            return;
        }
        if self.across.is_empty() {
            *self = Self { along: line..line + 1, across: tiles.clone() };
        }
        self.along = self.along.start.min(line)..self.along.end.max(line + 1);
        self.across = self.across.start.min(tiles.start)..self.across.end.max(tiles.end);
    }

    fn area(&self) -> u32 {
        self.along.len() as u32 * self.across.len() as u32
    }
}

/// Returns the two parts of the cut between lines that leaves the least area, if both sides have changed
/// tiles.
fn cut(lines: &[Line], across: &Range<u32>) -> Option<[Part; 2]> {
    let extents: Vec<Range<u32>> = lines.iter().map(|line| extent(line, across).unwrap_or(0..0)).collect();
    let numbered = || extents.iter().enumerate().map(|(line, tiles)| (line as u32, tiles));
    let mut after = Part::NONE;
    let mut areas: Vec<u32> = numbered()
        .rev()
        .map(|(line, tiles)| {
            after.add(line, tiles);
            after.area()
        })
        .collect();
    areas.reverse();
    let mut before = Part::NONE;
    let mut best = (u32::MAX, 0);
    for ((line, tiles), after) in numbered().zip(areas.iter().skip(1)) {
        before.add(line, tiles);
        if before.area() > 0 && *after > 0 {
            best = best.min((before.area() + after, line + 1));
        }
    }
    let (area, first) = best;
    let part = |is_in: &dyn Fn(u32) -> bool| {
        let mut part = Part::NONE;
        numbered().filter(|(line, _)| is_in(*line)).for_each(|(line, tiles)| part.add(line, tiles));
        part
    };
    (area < u32::MAX).then(|| [part(&|line| line < first), part(&|line| line >= first)])
}

/// Returns the range of tiles from the first to the last one that is set within a range.
fn extent(line: &Line, within: &Range<u32>) -> Option<Range<u32>> {
    let set = core::array::from_fn::<u64, 4, _>(|word| line[word] & mask(within, word));
    let first = set.iter().position(|word| *word != 0)?;
    let last = set.iter().rposition(|word| *word != 0)?;
    let [first_bit, last_bit] = [set[first].trailing_zeros(), 64 - set[last].leading_zeros()];
    Some(first as u32 * 64 + first_bit..last as u32 * 64 + last_bit)
}

/// Returns the bits of a range in one word of a line.
fn mask(range: &Range<u32>, word: usize) -> u64 {
    let below = |end: u32| match end.saturating_sub(word as u32 * 64) {
        bits @ 0..64 => (1 << bits) - 1,
        _ => u64::MAX,
    };
    below(range.end) & !below(range.start)
}

fn set(lines: &mut [Line], range: &Range<u32>) {
    let bits: Line = core::array::from_fn(|word| mask(range, word));
    for line in lines {
        for (word, bits) in line.iter_mut().zip(bits) {
            *word |= bits;
        }
    }
}

fn as_usize(range: &Range<u32>) -> Range<usize> {
    range.start as usize..range.end as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: UVec2 = UVec2::new(2048, 1024);

    fn rect(x: u32, y: u32, width: u32, height: u32) -> TexelRect {
        TexelRect { min: UVec2::new(x, y), size: UVec2::new(width, height) }
    }

    fn tiles(rects: &[TexelRect]) -> ChangedTiles {
        let mut tiles = ChangedTiles::default();
        for rect in rects {
            tiles.add(*rect, SIZE);
        }
        tiles
    }

    fn price() -> Price {
        Price::new(1000, 500, 1 << 21, false)
    }

    #[test]
    fn a_change_is_a_rectangle_of_whole_tiles_around_it() {
        assert_eq!(tiles(&[]).rects(&price()), []);
        assert_eq!(tiles(&[rect(17, 30, 1, 3)]).rects(&price()), [rect(16, 24, 8, 16)]);
        assert_eq!(tiles(&[rect(0, 0, 2048, 1024)]).rects(&price()), [rect(0, 0, 2048, 1024)]);
        assert_eq!(tiles(&[rect(2047, 1023, 1, 1)]).rects(&price()), [rect(2040, 1016, 8, 8)]);
        let mut cleared = tiles(&[rect(17, 30, 1, 3)]);
        cleared.clear();
        assert_eq!(cleared.rects(&price()), []);
        cleared.add(rect(5, 5, 4, 1), UVec2::splat(12));
        assert_eq!(cleared.rects(&price()), [rect(0, 0, 12, 8)], "tiles at the end of a map are cut");
    }

    #[test]
    fn changes_far_apart_are_drawn_apart_and_near_ones_together() {
        let far = [rect(64, 64, 40, 40), rect(1800, 64, 40, 40), rect(64, 800, 40, 40), rect(960, 480, 8, 8)];
        let mut rects = tiles(&far).rects(&price());
        rects.sort_by_key(|rect| (rect.min.x, rect.min.y));
        assert_eq!(rects, [far[0], far[2], far[3], far[1]]);
        let near = [rect(64, 64, 16, 16), rect(96, 80, 16, 16), rect(80, 104, 16, 8)];
        assert_eq!(tiles(&near).rects(&price()), [rect(64, 64, 48, 48)]);
    }

    #[test]
    fn rectangles_hold_every_change_and_do_not_overlap() {
        // Low-discrepancy places. The greater counts exceed the number of rectangles.
        let place = |i: u32, step: f64, size: u32| ((f64::from(i) * step).fract() * f64::from(size - 30)) as u32;
        for count in [1, 7, 33, 200, 3000] {
            let changes: Vec<TexelRect> = (0..count)
                .map(|i| rect(place(i, 0.754_877_67, 2048), place(i, 0.569_840_3, 1024), 1 + i % 30, 9))
                .collect();
            let rects = tiles(&changes).rects(&price());
            assert!(rects.len() <= MAX_RECTS);
            for change in changes {
                let held: u64 = rects.iter().map(|rect| rect.intersection(change).area()).sum();
                assert_eq!(held, change.area(), "{change:?} of {count}");
            }
            for (i, a) in rects.iter().enumerate() {
                assert!(rects[..i].iter().all(|b| a.intersection(*b).is_empty()));
            }
        }
    }
}
