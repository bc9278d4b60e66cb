//! What drawing a part of a map costs, so that rectangles are split and merged by it.

use crate::scroll::TexelRect;

/// A rectangle's own cost, in texels: a clear, a viewport and a scissor rectangle, and those of its casters that lie in
/// other rectangles too, such as the ground. An estimate, 3 µs, in texels of 0.29 ns: plans hardly depend on it.
///
/// A texel is what all others are counted in: four maps of 2048 × 2048 take 4.8 ms on the GPU when drawn anew (zdm2, in
/// the tables of `docs/BENCHMARKS.md`), so it takes 0.29 ns, of which the clear is 0.07.
const RECT: f64 = 10_000.0;

/// A caster's cost, in texels, beyond those that it covers: a draw call is 0.13 µs of encoding and 0.05 µs on the GPU
/// (40,000 of them against 3,755, there).
const CASTER: f64 = 600.0;

/// The cost of testing one caster of the list against a rectangle, in texels: 70 µs for 10,000 boxes and four volumes.
const CULLED: f64 = 6.0;

/// What a texel costs that is also restored from the static casters' layer: read, and written once more. An estimate:
/// less than drawing it, more than clearing it.
const RESTORED: f64 = 0.5;

/// Prices of a map's parts in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Price {
    /// Of a rectangle, whatever its size.
    pub(super) rect: f64,
    /// Of a texel, with the casters over it.
    pub(super) texel: f64,
    /// Of a texel of a map that is drawn as a whole.
    whole: f64,
}

impl Price {
    /// Prices where so many casters are listed, and so many of them lie over a map of so many texels. `restores`: whether
    /// static casters have a layer of their own.
    pub(super) fn new(listed: usize, over: usize, texels: u64, restores: bool) -> Self {
        // Casters are taken as spread evenly: what lies where is known only after culling.
        let each = over as f64 / texels.max(1) as f64;
        let whole = 1.0 + CASTER * each;
        let texel = if restores { whole + RESTORED } else { whole };
        Self { rect: RECT + CULLED * listed as f64, texel, whole }
    }

    pub(super) fn of(&self, texels: u64) -> f64 {
        self.rect + self.texel * texels as f64
    }

    /// Whether rectangles cost less than the map as a whole, which needs no rectangle.
    pub(super) fn is_worth(&self, rects: &[TexelRect], whole: u64) -> bool {
        rects.iter().map(|rect| self.of(rect.area())).sum::<f64>() < self.whole * whole as f64
    }

    /// Whether so many texels cost less than the map as a whole, in as few rectangles as there are.
    pub(super) fn may_be_worth(&self, texels: u64, whole: u64) -> bool {
        self.texel * (texels as f64) < self.whole * whole as f64
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use glam::UVec2;

    use super::*;

    #[test]
    fn rectangles_are_worth_it_until_they_cost_what_the_map_costs() {
        let price = Price::new(1000, 500, 1 << 22, false);
        let rects = |count, side| vec![TexelRect { min: UVec2::ZERO, size: UVec2::splat(side) }; count];
        assert!(price.is_worth(&[], 1 << 22));
        assert!(price.is_worth(&rects(64, 64), 1 << 22));
        assert!(price.is_worth(&rects(1, 2000), 1 << 22));
        assert!(!price.is_worth(&rects(1, 2048), 1 << 22));
        assert!(!price.is_worth(&rects(64, 256), 1 << 22));
        assert!(!price.is_worth(&rects(2, 64), 128 * 128), "small maps are drawn as a whole");
        let restored = Price::new(1000, 500, 1 << 22, true);
        assert!(!restored.is_worth(&rects(1, 2000), 1 << 22));
        assert!(restored.is_worth(&rects(1, 1500), 1 << 22));
    }
}
