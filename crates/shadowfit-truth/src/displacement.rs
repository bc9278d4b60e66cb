//! Distance between the map's shadow edges and the true ones, on screen.
//!
//! An edge is the border between two neighbouring judged pixels with different verdicts. Its sign is the
//! direction toward the lit pixel, so that the two sides of a thin shadow are not compared with each other.

use crate::distances::{NONE_MARKED, squared_distances};

/// Greatest distance of a shadow edge, in pixels; longer ones are clamped to it. A true edge counts as this
/// far away if the map has no edge of the same sign.
pub const MAX_DISPLACEMENT: f64 = 32.0;

/// Sum of the distances of true transitions to the nearest transition of the same sign in the map,
/// in pixels, and the number of true transitions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Displacement {
    pub(crate) sum: f64,
    pub(crate) transitions: u64,
}

/// Compares the transitions of two pictures of verdicts (rows from the top, `None` where a pixel is not
/// judged). Only true transitions between two counted pixels are summed.
pub(crate) fn displacement(
    size: [usize; 2],
    truth: &(impl Fn(usize) -> Option<bool> + Sync),
    map: &(impl Fn(usize) -> Option<bool> + Sync),
    counts: impl Fn(usize) -> bool,
) -> Displacement {
    let mut found = Displacement::default();
    for axis in [0, 1] {
        // An axis has one border less than pixels.
        let borders = if axis == 0 { [size[0].max(1) - 1, size[1]] } else { [size[0], size[1].max(1) - 1] };
        let before = |x: usize, y: usize| y * size[0] + x;
        let after = |x: usize, y: usize| before(x, y) + if axis == 0 { 1 } else { size[0] };
        for toward_after in [false, true] {
            let is_transition = |verdict: &dyn Fn(usize) -> Option<bool>, x: usize, y: usize| {
                verdict(before(x, y)) == Some(!toward_after) && verdict(after(x, y)) == Some(toward_after)
            };
            let positions = (0..borders[0] * borders[1]).map(|index| (index % borders[0], index / borders[0]));
            let mut wanted = positions
                .filter(|(x, y)| is_transition(truth, *x, *y) && counts(before(*x, *y)) && counts(after(*x, *y)));
            let Some(first) = wanted.next() else { continue };
            let squares = squared_distances(borders, |x, y| is_transition(map, x, y));
            for (x, y) in std::iter::once(first).chain(wanted) {
                found.transitions += 1;
                found.sum += length(squares[y * borders[0] + x]);
            }
        }
    }
    found
}

/// Returns a distance from its square, clamped.
fn length(square: u32) -> f64 {
    if square == NONE_MARKED { MAX_DISPLACEMENT } else { f64::from(square).sqrt().min(MAX_DISPLACEMENT) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [usize; 2] = [50, 20];

    fn of(
        truth: impl Fn(i32, i32) -> Option<bool> + Sync,
        map: impl Fn(i32, i32) -> Option<bool> + Sync,
    ) -> Displacement {
        let position =
            |index: usize| [index % SIZE[0], index / SIZE[0]].map(|index| i32::try_from(index).expect("small"));
        displacement(
            SIZE,
            &|index| truth(position(index)[0], position(index)[1]),
            &|index| map(position(index)[0], position(index)[1]),
            |_| true,
        )
    }

    #[test]
    fn an_edge_that_is_shifted_by_k_pixels_is_displaced_by_k() {
        for k in [0, 1, 5, 20] {
            let found = of(|x, _| Some(x >= 25), |x, _| Some(x >= 25 + k));
            assert_eq!((found.sum, found.transitions), (f64::from(k) * 20.0, 20), "{k} across");
            let found = of(|_, y| Some(y < 3), |_, y| Some(y < 3 + k.min(15)));
            assert_eq!((found.sum, found.transitions), (f64::from(k.min(15)) * 50.0, 50), "{k} down");
        }
    }

    #[test]
    fn an_edge_of_the_other_sign_is_not_compared_and_a_missing_one_is_32_pixels_away() {
        let other = of(|x, _| Some(x >= 25), |x, _| Some(x < 25));
        let none = of(|x, _| Some(x >= 25), |_, _| Some(true));
        let far = of(|x, _| Some(x >= 5), |x, _| Some(x >= 45));
        for found in [other, none, far] {
            assert_eq!((found.sum, found.transitions), (32.0 * 20.0, 20));
        }
    }

    #[test]
    fn pixels_that_are_not_judged_make_no_edge() {
        let found = of(|x, _| (x != 25).then_some(x > 25), |_, _| Some(true));
        assert_eq!(found, Displacement::default());
    }

    #[test]
    fn displacements_equal_a_search_of_every_border() {
        let random = |seed: i32| {
            move |x: i32, y: i32| {
                let hash = ((y * 50 + x + seed) as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 58;
                (hash > 2).then_some(hash < 30 + u64::from(x.unsigned_abs() % 30))
            }
        };
        let (truth, map) = (random(3), random(400));
        let borders = |verdict: &dyn Fn(i32, i32) -> Option<bool>| {
            let mut borders = Vec::new();
            for index in 0..1000 {
                let (x, y) = (index % 50, index / 50);
                for (dx, dy) in [(1, 0), (0, 1)] {
                    let is_in = x + dx < 50 && y + dy < 20;
                    if is_in
                        && let (Some(a), Some(b)) = (verdict(x, y), verdict(x + dx, y + dy))
                        && a != b
                    {
                        borders.push((x, y, dx, b));
                    }
                }
            }
            borders
        };
        let counterparts = borders(&map);
        let (mut sum, mut transitions) = (0.0, 0);
        for (x, y, dx, sign) in borders(&truth) {
            let same = counterparts.iter().filter(|border| (border.2, border.3) == (dx, sign));
            let nearest = same.map(|border| f64::from((border.0 - x).pow(2) + (border.1 - y).pow(2)).sqrt());
            sum += nearest.fold(32.0, f64::min);
            transitions += 1;
        }
        let found = of(truth, map);
        assert_eq!(found.transitions, transitions);
        assert!(transitions > 300 && (found.sum - sum).abs() < 1e-9 * sum, "{found:?} {sum}");
    }
}
