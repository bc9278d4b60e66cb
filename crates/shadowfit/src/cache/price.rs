//! Cost of drawing parts of a map. It decides how rectangles are split and merged.

use crate::scroll::TexelRect;

/// Cost of a rectangle, in texels: a clear, a viewport, a scissor rectangle, and the casters that it shares
/// with other rectangles, such as the ground. It is an estimate of 3 µs at 0.29 ns per texel. Plans hardly
/// depend on it.
///
/// All costs are in texels. Redrawing four maps of 2048 × 2048 takes 4.8 ms on the GPU (zdm2, in
/// `docs/figures/gpu.md`), so a texel takes 0.29 ns, including 0.07 ns for the clear.
const RECT: f64 = 10_000.0;

/// Cost of a caster, in texels, in addition to the texels that it covers. A draw call takes 0.13 µs of
/// encoding and 0.05 µs on the GPU (40,000 calls against 3,755, same tables).
const CASTER: f64 = 600.0;

/// Cost of testing one listed caster against a rectangle, in texels: 70 µs for 10,000 boxes and four volumes.
const CULLED: f64 = 6.0;

/// Additional cost of a texel that is also restored from the static casters' layer, by a read and a second
/// write. It is an estimate between the costs of clearing and drawing a texel.
const RESTORED: f64 = 0.5;

/// Prices of a map's parts in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Price {
    /// Cost of a rectangle, independent of its size.
    pub(super) rect: f64,
    /// Cost of a texel, including the casters over it.
    pub(super) texel: f64,
    /// Cost of a texel if the whole map is redrawn.
    whole: f64,
}

impl Price {
    /// Returns the prices for a list of `listed` casters, of which `over` lie over a map of `texels` texels.
    /// `restores` says whether static casters have a separate layer.
    pub(super) fn new(listed: usize, over: usize, texels: u64, restores: bool) -> Self {
        // Assumes that casters are spread evenly. Their places are known only after culling.
        let each = over as f64 / texels.max(1) as f64;
        let whole = 1.0 + CASTER * each;
        let texel = if restores { whole + RESTORED } else { whole };
        Self { rect: RECT + CULLED * listed as f64, texel, whole }
    }

    pub(super) fn of(&self, texels: u64) -> f64 {
        self.rect + self.texel * texels as f64
    }

    /// Returns whether the rectangles cost less than the whole map, which needs no rectangle.
    pub(super) fn is_worth(&self, rects: &[TexelRect], whole: u64) -> bool {
        rects.iter().map(|rect| self.of(rect.area())).sum::<f64>() < self.whole * whole as f64
    }

    /// Returns whether this number of texels costs less than the whole map, apart from the cost of its
    /// rectangles.
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
