//! Comparison of two maps of the same casters that allows for the differences between rasterisers.
//!
//! A rasteriser rounds a triangle's corners to a step of a texel and may interpolate depth between the
//! rounded corners. Two draws with matrices that round differently can thus place a corner one step apart.
//! That moves slopes everywhere, and edges where a texel's centre lies within a step of them. Any other
//! difference is a bug.

use core::fmt;

use shadowfit_testing::subpixel_step;

use crate::engine::Engine;

/// Greatest difference of depths that counts as equal on level ground: the rounding of matrices and
/// positions.
const DEPTH: f32 = 1e-5;

/// Greatest distance between the corners of two draws, in steps: one of rounding, and half of one for the
/// matrices.
const STEPS: f32 = 1.5;

/// Greatest ratio between the slopes of triangles at a texel without an edge.
const BENT: f32 = 2.5;

/// Differences that a map may have regardless of its number of edges: the ends of an edge, in all maps.
const FEW: usize = 8;

/// Two depth maps of the same size.
pub(crate) struct Compared<'a> {
    /// Depths in rows.
    maps: [&'a [f32]; 2],
    /// Width in texels.
    side: usize,
    /// Texels by which two draws may differ.
    moved: f32,
    adapter: String,
}

/// A texel whose depths differ by more than its slope allows.
pub(crate) struct Difference {
    /// Index of the texel, in rows.
    pub(crate) texel: usize,
    pub(crate) depths: [f32; 2],
    /// Difference that the slope of the surface allows.
    allowed: f32,
    /// Whether an edge passes the texel or a neighbour, so that the texel may show either side of it.
    is_at_edge: bool,
}

impl fmt::Debug for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { texel, depths: [a, b], allowed, is_at_edge } = self;
        let place = if *is_at_edge { "at an edge" } else { "at no edge" };
        write!(f, "texel {texel} {place}: {a} and {b} differ by {}, allowed are {allowed}", (a - b).abs())
    }
}

impl<'a> Compared<'a> {
    pub(crate) fn new(engine: &Engine, maps: [&'a [f32]; 2], side: u32) -> Self {
        let info = engine.adapter.get_info();
        Self { maps, side: side as usize, moved: STEPS * subpixel_step(&info), adapter: info.name }
    }

    /// Returns the texels that differ by more than their slopes allow.
    pub(crate) fn differences(&self) -> Vec<Difference> {
        let [a, b] = self.maps;
        let differ = (0..a.len()).filter(|texel| (a[*texel] - b[*texel]).abs() > DEPTH);
        differ.map(|texel| self.difference(texel)).filter(Difference::is_beyond_slope).collect()
    }

    /// Asserts that differences lie at edges, and that edges explain their number.
    pub(crate) fn assert_explained(&self, found: &[Difference], what: impl fmt::Display) {
        let adapter = &self.adapter;
        let faults: Vec<_> = found.iter().filter(|found| !found.is_at_edge).collect();
        assert!(
            faults.is_empty(),
            "{adapter}: {what}: {} texels differ: {:?}",
            faults.len(),
            &faults[..faults.len().min(5)]
        );
        if found.len() <= FEW {
            return;
        }
        let edges = (0..self.maps[0].len()).filter(|texel| self.is_at_edge(*texel)).count();
        // An edge has a band of three texels. The centre row shows the other side where the edge moves across
        // a texel's centre.
        let most = FEW + (edges as f32 * self.moved) as usize;
        assert!(
            found.len() <= most,
            "{adapter}: {what}: {} of {edges} texels at edges differ, allowed are {most}: {:?}",
            found.len(),
            &found[..5]
        );
    }

    fn difference(&self, texel: usize) -> Difference {
        let [a, b] = self.maps.map(|map| map[texel]);
        let slope = self.maps.map(|map| self.slope(map, texel));
        let allowed = DEPTH + BENT * slope[0].max(slope[1]) * self.moved;
        Difference { texel, depths: [a, b], allowed, is_at_edge: self.is_at_edge(texel) }
    }

    fn is_at_edge(&self, texel: usize) -> bool {
        self.maps.iter().any(|map| self.has_edge(map, texel))
    }

    /// Returns the change of depth over a texel, added up over both axes. The smaller change of each axis leaves edges out.
    fn slope(&self, map: &[f32], texel: usize) -> f32 {
        let (x, y) = (texel % self.side, texel / self.side);
        let axis = |at: usize, stride: usize| {
            let before = (at > 0).then(|| (map[texel] - map[texel - stride]).abs());
            let after = (at + 1 < self.side).then(|| (map[texel + stride] - map[texel]).abs());
            before.into_iter().chain(after).fold(f32::MAX, f32::min)
        };
        axis(x, 1) + axis(y, self.side)
    }

    /// Returns whether the depths around a texel differ by more than those on a plane.
    fn has_edge(&self, map: &[f32], texel: usize) -> bool {
        let (x, y) = (texel % self.side, texel / self.side);
        let last = self.side - 1;
        let (mut low, mut high) = (f32::MAX, f32::MIN);
        for row in y.saturating_sub(1)..=(y + 1).min(last) {
            for depth in &map[row * self.side..][x.saturating_sub(1)..=(x + 1).min(last)] {
                (low, high) = (low.min(*depth), high.max(*depth));
            }
        }
        // A plane changes by twice its slope over three texels.
        high - low > BENT * self.slope(map, texel) + DEPTH
    }
}

impl Difference {
    fn is_beyond_slope(&self) -> bool {
        (self.depths[0] - self.depths[1]).abs() > self.allowed
    }
}
