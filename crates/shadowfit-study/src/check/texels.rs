//! Texel-by-texel comparison of the depths of two maps with the same casters.

/// The depths of a map, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Texels {
    /// Texels per row.
    pub(super) width: u32,
    pub(super) depths: Vec<f32>,
}

/// Greatest distance between the edges of two drawings of a triangle, as a share of a texel. A rasteriser
/// snaps each vertex to the nearest 1/256 of a texel (the subpixel precision of Direct3D, Metal and Vulkan's
/// drivers), 1/512 to either side.
const SNAP: f32 = 1.0 / 256.0;

/// Greatest share of the texels at edges for which the snap moves the edge across the texel's centre. This is
/// the probability that an edge at a random place crosses a centre within [`SNAP`] on either side.
const AT_EDGES: f64 = 2.0 / 256.0;

/// Smallest bend of a texel at an edge, as a share of the difference between the smallest and the greatest
/// depth around it. A plane has no bend. The edge of a surface before another one bends by half of the
/// difference.
const EDGE: f32 = 1.0 / 16.0;

/// Rounding of a depth of 0..=1 in f32: eight operations on terms of at most 2, each rounded by 2⁻²⁴.
const ROUNDING: f32 = 16.0 / 16_777_216.0;

/// Differences between two sets of maps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Difference {
    /// Texels that were compared.
    pub(super) texels: u64,
    /// Texels whose neighbours lie on several surfaces.
    pub(super) at_edges: u64,
    /// Texels at edges that hold a neighbour's surface instead.
    pub(super) moved: u64,
    /// Texels whose depth does not occur beside them in either map.
    pub(super) wrong: u64,
}

impl Difference {
    /// Adds the differences of a map from a reference. `precision` is the greatest rounding of a stored
    /// depth, 0..=1.
    pub(super) fn add(&mut self, map: &Texels, reference: &Texels, precision: f32) {
        let precision = precision + ROUNDING;
        for (index, (found, expected)) in map.depths.iter().zip(&reference.depths).enumerate() {
            let around = reference.around(index);
            let spread = around.high - around.low;
            self.texels += 1;
            self.at_edges += u64::from(around.bend > precision + spread * EDGE);
            // On a plane the nine texels span twice the change between two neighbours.
            let tolerance = precision + spread * SNAP;
            if (found - expected).abs() <= tolerance {
                continue;
            }
            if found.is_nan() {
                self.wrong += 1;
                continue;
            }
            // A caster that is thinner than a texel may cover the centre in one of the maps only. The other
            // map's depth is then beside it.
            if around.holds(*found, tolerance) || map.around(index).holds(*expected, tolerance) {
                self.moved += 1;
            } else {
                self.wrong += 1;
            }
        }
    }

    /// Adds the differences of maps of the same format.
    pub(super) fn add_all(&mut self, maps: &[Texels], references: &[Texels]) {
        for (map, reference) in maps.iter().zip(references) {
            self.add(map, reference, 0.0);
        }
    }

    /// Returns whether snapped vertices and rounding explain all differences.
    pub(super) fn is_explained(&self) -> bool {
        self.wrong == 0 && self.moved as f64 <= (self.at_edges as f64 * AT_EDGES).ceil()
    }
}

/// A texel and its eight neighbours.
struct Around {
    low: f32,
    high: f32,
    /// Greatest difference of the texel from the mean of two opposite neighbours; 0 on a plane.
    bend: f32,
}

impl Around {
    fn holds(&self, depth: f32, tolerance: f32) -> bool {
        depth >= self.low - tolerance && depth <= self.high + tolerance
    }
}

impl Texels {
    /// Returns the neighbourhood of an index. Beyond the border, the border texel repeats.
    fn around(&self, index: usize) -> Around {
        let width = self.width as usize;
        let [x, y] = [index % width, index / width];
        let last = [width - 1, self.depths.len() / width - 1];
        let at = |dx: usize, dy: usize| {
            let [x, y] = [(x + dx).saturating_sub(1).min(last[0]), (y + dy).saturating_sub(1).min(last[1])];
            self.depths[y * width + x]
        };
        let mut around = Around { low: f32::INFINITY, high: f32::NEG_INFINITY, bend: 0.0 };
        for (dx, dy) in (0..9).map(|place| (place % 3, place / 3)) {
            let (depth, opposite) = (at(dx, dy), at(2 - dx, 2 - dy));
            around.low = around.low.min(depth);
            around.high = around.high.max(depth);
            around.bend = around.bend.max((f32::midpoint(depth, opposite) - at(1, 1)).abs());
        }
        around
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: u32 = 64;

    /// Returns a slope with a board of 20 texels before it, moved by a fraction of a texel.
    fn map(shift: f32) -> Texels {
        let depth = |index: u32| {
            let [x, y] = [(index % WIDTH) as f32 + shift, (index / WIDTH) as f32];
            let is_board = (20.0..40.0).contains(&(x + 0.3 * y)) && (10.0..30.0).contains(&y);
            if is_board { 0.25 } else { 0.5 + 0.001 * x + 0.002 * y }
        };
        Texels { width: WIDTH, depths: (0..WIDTH * WIDTH).map(depth).collect() }
    }

    fn difference(map: &Texels, reference: &Texels) -> Difference {
        let mut difference = Difference::default();
        difference.add(map, reference, 0.0);
        difference
    }

    #[test]
    fn what_a_snap_moves_is_explained_and_what_a_texel_moves_is_not() {
        let reference = map(0.0);
        for shift in [0.0, SNAP, -SNAP] {
            let difference = difference(&map(shift), &reference);
            assert!(difference.is_explained(), "{shift}: {difference:?}");
        }
        for shift in [1.0, 0.25, -0.1] {
            let difference = difference(&map(shift), &reference);
            assert!(!difference.is_explained(), "{shift}: {difference:?}");
        }
    }

    #[test]
    fn texels_without_their_caster_are_wrong_and_those_beside_another_surface_are_not() {
        let reference = map(0.0);
        let mut texels = reference.clone();
        for (x, y) in (0..9).map(|place| (25 + place % 3, 20 + place / 3)) {
            texels.depths[(y * WIDTH + x) as usize] = 1.0;
        }
        let hole = difference(&texels, &reference);
        assert_eq!((hole.wrong, hole.moved), (1, 8), "the middle of a hole has no edge beside it");
        // A thread on a single texel, in one of the maps and then in the other.
        texels = reference.clone();
        texels.depths[(50 * WIDTH + 50) as usize] = 0.1;
        for difference in [difference(&texels, &reference), difference(&reference, &texels)] {
            assert_eq!((difference.wrong, difference.moved), (0, 1), "{difference:?}");
        }
        let mut texels = reference.clone();
        // The slope beside the board's left edge.
        let edge = (20 * WIDTH + 14) as usize;
        texels.depths[edge] = texels.depths[edge - 1];
        let difference = difference(&texels, &reference);
        assert_eq!((difference.wrong, difference.moved), (0, 1), "{difference:?}");
        assert!(difference.is_explained());
        texels.depths[edge] = f32::NAN;
        assert_eq!(self::difference(&texels, &reference).wrong, 1);
    }
}
