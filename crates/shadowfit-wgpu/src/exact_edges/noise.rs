//! Blue noise: a square of ranks. The pixels below any rank are spread evenly, also across the sides of the
//! square.

use std::sync::LazyLock;

/// Width of the square, in pixels.
pub(super) const SIDE: usize = 64;

/// Variance of the Gaussian by which pixels repel each other, in square pixels. Ulichney uses 1.5², too.
const VARIANCE: f32 = 1.5 * 1.5;

/// Rank of each pixel, in rows, computed once per process.
pub(super) static RANKS: LazyLock<Vec<u32>> = LazyLock::new(ranks);

/// Returns the rank of each pixel, in rows. Each rank goes to the middle of the largest void between the pixels of lower
/// ranks (after R. Ulichney, "The void-and-cluster method for dither array generation", 1993, without its first pattern).
fn ranks() -> Vec<u32> {
    let repulsion: Vec<f32> = (0..SIDE * SIDE).map(|at| (-squared(at) / (2.0 * VARIANCE)).exp()).collect();
    let mut field = vec![0.0_f32; SIDE * SIDE];
    let mut ranks = vec![0; SIDE * SIDE];
    for rank in 0..(SIDE * SIDE) as u32 {
        let void = (0..field.len()).min_by(|a, b| field[*a].total_cmp(&field[*b])).unwrap_or(0);
        ranks[void] = rank;
        let [x, y] = [void % SIDE, void / SIDE];
        for (at, energy) in field.iter_mut().enumerate() {
            let [across, down] = [(at % SIDE + SIDE - x) % SIDE, (at / SIDE + SIDE - y) % SIDE];
            *energy += repulsion[down * SIDE + across];
        }
        field[void] = f32::INFINITY;
    }
    ranks
}

/// Returns the squared distance of a pixel to the first pixel, in square pixels, across the sides if that is
/// nearer.
fn squared(at: usize) -> f32 {
    let near = |place: usize| place.min(SIDE - place) as f32;
    near(at % SIDE).powi(2) + near(at / SIDE).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_rank_stands_once_and_the_lowest_are_spread_evenly() {
        let ranks = ranks();
        let mut sorted = ranks.clone();
        sorted.sort_unstable();
        assert!(sorted.iter().zip(0..).all(|(rank, wanted)| *rank == wanted));
        // Each square of 8 × 8 pixels contains its share of the lowest ranks ± 4. A random choice would
        // differ by up to 10.
        for few in [1, 2, 4].map(|part| (SIDE * SIDE / 16 * part) as u32) {
            let wanted = few as usize / 64;
            for square in 0..64 {
                let [left, top] = [square % 8 * 8, square / 8 * 8];
                let in_square =
                    |at: usize| (left..left + 8).contains(&(at % SIDE)) && (top..top + 8).contains(&(at / SIDE));
                let found = (0..SIDE * SIDE).filter(|at| in_square(*at) && ranks[*at] < few).count();
                assert!(found.abs_diff(wanted) <= 4, "{found} of {wanted}");
            }
        }
    }
}
