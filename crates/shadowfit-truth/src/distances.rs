//! Distance of each pixel to the nearest marked one, as exact squares in whole pixels.
//!
//! A. Meijster, J. Roerdink, W. Hesselink, "A general algorithm for computing distance transforms in
//! linear time", 2000: distances along the rows, then the lower envelope of parabolas down each column. All
//! arithmetic is in integers, so results are the same on every machine.

use rayon::prelude::*;

/// Value of a squared distance if no pixel is marked.
pub(crate) const NONE_MARKED: u32 = u32::MAX;

/// Computes the squared distance, in pixels, from each pixel's centre to the centre of the nearest marked
/// pixel, or [`NONE_MARKED`] if none is. Rows from the top.
pub(crate) fn squared_distances(size: [usize; 2], is_marked: impl Fn(usize, usize) -> bool + Sync) -> Vec<u32> {
    let [width, height] = size;
    if width == 0 || height == 0 {
        return Vec::new();
    }
    let mut along_row = vec![NONE_MARKED; width * height];
    along_row.par_chunks_mut(width).enumerate().for_each(|(y, row)| sweep_row(row, |x| is_marked(x, y)));
    let columns: Vec<Vec<u32>> = (0..width)
        .into_par_iter()
        .map(|x| column(&(0..height).map(|y| along_row[y * width + x]).collect::<Vec<_>>()))
        .collect();
    along_row.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
        for (distance, column) in row.iter_mut().zip(&columns) {
            *distance = column[y];
        }
    });
    along_row
}

/// Computes the distances along a row to the nearest marked pixel of that row.
fn sweep_row(row: &mut [u32], is_marked: impl Fn(usize) -> bool) {
    let mut last = NONE_MARKED;
    for (x, distance) in row.iter_mut().enumerate() {
        last = if is_marked(x) { 0 } else { last.saturating_add(1) };
        *distance = last;
    }
    last = NONE_MARKED;
    for distance in row.iter_mut().rev() {
        last = last.saturating_add(1).min(*distance);
        *distance = last;
    }
}

/// Computes the squared distances down a column from its pixels' distances along their rows.
fn column(along_row: &[u32]) -> Vec<u32> {
    let rows = along_row.len() as u32;
    let value = |row: u32, y: u32| {
        let (across, down) = (i64::from(along_row[row as usize]), i64::from(row) - i64::from(y));
        across * across + down * down
    };
    // Last row in which row `upper` is at least as good as the later row `lower`.
    let last_of = |upper: u32, lower: u32| (value(lower, 0) - value(upper, 0)).div_euclid(2 * i64::from(lower - upper));
    // Rows of the lower envelope, and the row where each of them starts.
    let mut envelope: Vec<(u32, i64)> = Vec::new();
    for row in (0..rows).filter(|row| along_row[*row as usize] != NONE_MARKED) {
        while envelope.last().is_some_and(|(top, start)| last_of(*top, row) < *start) {
            envelope.pop();
        }
        let start = envelope.last().map_or(0, |(top, _)| last_of(*top, row) + 1);
        if start < i64::from(rows) {
            envelope.push((row, start));
        }
    }
    let mut current = 0;
    (0..rows)
        .map(|y| {
            while envelope.get(current + 1).is_some_and(|(_, start)| *start <= i64::from(y)) {
                current += 1;
            }
            envelope
                .get(current)
                .map_or(NONE_MARKED, |(row, _)| u32::try_from(value(*row, y)).unwrap_or(NONE_MARKED - 1))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_equal_a_search_of_every_pixel() {
        let hash = |i: u64| i.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 54;
        for (size, one_in) in [([17, 11], 10), ([40, 3], 30), ([5, 60], 50), ([23, 23], 3), ([1, 9], 4)] {
            let is_marked = |x: usize, y: usize| hash((y * size[0] + x) as u64 + 7).is_multiple_of(one_in);
            let found = squared_distances(size, is_marked);
            for (index, found) in found.into_iter().enumerate() {
                let (x, y) = (index % size[0], index / size[0]);
                let every = (0..size[0] * size[1]).map(|i| (i % size[0], i / size[0]));
                let wanted = every
                    .filter(|(u, v)| is_marked(*u, *v))
                    .map(|(u, v)| (u.abs_diff(x).pow(2) + v.abs_diff(y).pow(2)) as u32)
                    .min();
                assert_eq!(found, wanted.unwrap_or(NONE_MARKED), "pixel {x}, {y} of {size:?}");
            }
        }
    }

    #[test]
    fn without_a_mark_no_pixel_has_a_distance() {
        assert!(squared_distances([3, 2], |_, _| false).iter().all(|square| *square == NONE_MARKED));
        assert!(squared_distances([0, 2], |_, _| true).is_empty());
    }
}
