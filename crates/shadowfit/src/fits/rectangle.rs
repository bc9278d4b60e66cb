//! The least rectangle around a convex polygon. It sets the map's turn about the light.
//!
//! One side of the least-area rectangle lies along an edge of the polygon (H. Freeman and R. Shapira,
//! "Determining the minimum-area encasing rectangle for an arbitrary closed curve", 1975). So only the edges'
//! directions are tried, with four calipers that turn with them (G. T. Toussaint, "Solving geometric problems
//! with the rotating calipers", 1983).
//!
//! This is not enough for the least square. Between two edges' directions the calipers touch the same
//! corners, and both sides are sinusoids of the angle (concave there). The longer side is least where the two
//! are equal or at an end of the interval.

use glam::DVec2;

/// A rectangle that may be turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rectangle {
    /// Unit direction of the first side. The second side is a quarter turn to the left.
    pub(crate) axis: DVec2,
    /// Least coordinates along the two sides.
    pub(crate) min: DVec2,
    /// Greatest coordinates along the two sides.
    pub(crate) max: DVec2,
}

impl Rectangle {
    /// Returns the rectangle around points, with sides along `axis` (of unit length) and across it.
    pub(crate) fn around(points: &[DVec2], axis: DVec2) -> Self {
        let across = axis.perp();
        let (mut min, mut max) = (DVec2::MAX, DVec2::MIN);
        for p in points {
            let q = DVec2::new(p.dot(axis), p.dot(across));
            min = min.min(q);
            max = max.max(q);
        }
        Self { axis, min, max }
    }

    pub(crate) fn size(&self) -> DVec2 {
        self.max - self.min
    }
}

/// Relative gain below which two rectangles count as equally good, so that rounding does not choose between
/// them.
const TIE: f64 = 1e-9;

/// Returns the rectangle of least area around a convex polygon (anticlockwise corners), with its first side
/// within 45 degrees of +x. Among equal ones it is the least turned.
pub(crate) fn min_area(hull: &[DVec2]) -> Rectangle {
    let mut best = Best::new(hull, |r| r.size().x * r.size().y);
    let longest = Calipers::turn(hull, |calipers| {
        best.keep(&calipers.rectangle());
    });
    best.keep(&Rectangle::around(hull, longest));
    upright(best.rectangle)
}

/// Returns the rectangle around a convex polygon with the least area after widening. `widened` returns
/// extents at which no texel is longer than `ratio` times its width.
///
/// The area of a widened rectangle depends only on its longer side. Between two edges' directions, the best
/// rectangle may therefore also be where the limit is just met. There one side is a fixed multiple of the
/// other, like the equal sides of the least square.
pub(crate) fn min_area_within(hull: &[DVec2], ratio: f64, widened: impl Fn(DVec2) -> DVec2) -> Rectangle {
    let mut best = Best::new(hull, |r| widened(upright(*r).size()).element_product());
    // At an eighth of a turn the sides swap their texel counts.
    let eighth = DVec2::splat(core::f64::consts::FRAC_1_SQRT_2);
    best.keep(&Rectangle::around(hull, eighth));
    best.keep(&Rectangle::around(hull, -eighth.perp()));
    // Multiples of a side at which its texels are as long as the other side's, in either position.
    let unit = widened(DVec2::X);
    let per_texel = unit.y * ratio;
    let longest = Calipers::turn(hull, |calipers| {
        best.keep(&calipers.rectangle());
        for even in [per_texel, 1.0 / per_texel] {
            for multiple in [even * ratio, even / ratio] {
                if let Some(axis) = calipers.balanced(multiple) {
                    best.keep(&Rectangle::around(hull, axis));
                }
            }
        }
    });
    best.keep(&Rectangle::around(hull, longest));
    upright(best.rectangle)
}

/// Returns the rectangle with the least longer side around a convex polygon. It makes the least square.
pub(crate) fn min_square(hull: &[DVec2]) -> Rectangle {
    let mut best = Best::new(hull, |r| r.size().max_element());
    let longest = Calipers::turn(hull, |calipers| {
        best.keep(&calipers.rectangle());
        if let Some(axis) = calipers.balanced(1.0) {
            best.keep(&Rectangle::around(hull, axis));
        }
    });
    let diagonal = (longest + longest.perp()) * core::f64::consts::FRAC_1_SQRT_2;
    best.keep(&Rectangle::around(hull, diagonal));
    upright(best.rectangle)
}

/// The best rectangle so far.
///
/// For a sliver as thin as rounding the calipers may find the wrong corners, so each rectangle is measured
/// again around the points before it is accepted. Such a sliver is nearly a line. So rectangles along its
/// longest edge, and rectangles with this edge as the diagonal of a square, are tried as well.
struct Best<'a, C> {
    hull: &'a [DVec2],
    cost: C,
    rectangle: Rectangle,
}

impl<'a, C: Fn(&Rectangle) -> f64> Best<'a, C> {
    fn new(hull: &'a [DVec2], cost: C) -> Self {
        Self { hull, cost, rectangle: Rectangle::around(hull, DVec2::X) }
    }

    fn keep(&mut self, candidate: &Rectangle) {
        let bound = (self.cost)(&self.rectangle) * (1.0 - TIE);
        if (self.cost)(candidate) < bound {
            let measured = Rectangle::around(self.hull, candidate.axis);
            if (self.cost)(&measured) < bound {
                self.rectangle = measured;
            }
        }
    }
}

/// Four lines that touch a convex polygon from all sides, one of them along an edge.
struct Calipers<'a> {
    hull: &'a [DVec2],
    /// Unit direction of the edge on the lower line.
    axis: DVec2,
    /// Corners that the lines touch when they turn further: lower (the edge's end), right, upper, left.
    touched: [usize; 4],
    /// Distance below which a difference may be rounding.
    noise: f64,
}

/// Rounding, as a share of a polygon's extent.
const NOISE: f64 = 1e-10;

impl<'a> Calipers<'a> {
    /// Turns the lines once around the polygon, stopping at each edge. Returns the direction of the longest edge.
    fn turn(hull: &'a [DVec2], mut stop: impl FnMut(&Self)) -> DVec2 {
        let n = hull.len();
        let noise = Rectangle::around(hull, DVec2::X).size().max_element() * NOISE;
        let mut calipers = Calipers { hull, axis: DVec2::X, touched: [0; 4], noise };
        let (mut longest, mut greatest) = (DVec2::X, 0.0);
        let mut is_first = true;
        for i in 0..n {
            let end = (i + 1) % n;
            let edge = hull[end] - hull[i];
            let length = libm::sqrt(edge.dot(edge));
            if length.is_nan() || length <= 0.0 {
                continue;
            }
            calipers.axis = edge / length;
            calipers.touched[0] = end;
            let directions = [calipers.axis, calipers.axis.perp(), -calipers.axis];
            for (side, direction) in directions.into_iter().enumerate() {
                // Each line touches at the corner of the line before it, or further on.
                let first = calipers.touched[side];
                let behind = if is_first { 0 } else { (calipers.touched[side + 1] + n - first) % n };
                calipers.touched[side + 1] = calipers.advance(first, behind, direction);
            }
            is_first = false;
            if length > greatest {
                (longest, greatest) = (calipers.axis, length);
            }
            stop(&calipers);
        }
        longest
    }

    /// Returns the farthest corner along `direction`, from corner `first` on. The search may skip `known`
    /// corners, which an earlier, less turned line has passed.
    fn advance(&self, first: usize, known: usize, direction: DVec2) -> usize {
        let n = self.hull.len();
        let at = |k: usize| self.hull[(first + k) % n].dot(direction);
        let (mut k, mut most) = if at(known) > at(0) { (known, at(known)) } else { (0, at(0)) };
        let mut next = k + 1;
        // Among corners that are equally far up to rounding, the last one counts: the line touches it when it
        // turns further. Outlines of views have parallel sides, so this case is common.
        while next < n && at(next) >= most - self.noise {
            (k, most) = (next, most.max(at(next)));
            next += 1;
        }
        (first + k) % n
    }

    fn rectangle(&self) -> Rectangle {
        let across = self.axis.perp();
        let [lower, right, upper, left] = self.touched.map(|i| self.hull[i]);
        Rectangle {
            axis: self.axis,
            min: DVec2::new(left.dot(self.axis), lower.dot(across)),
            max: DVec2::new(right.dot(self.axis), upper.dot(across)),
        }
    }

    /// Returns the direction at which the first side is `multiple` times the second, while the lines still
    /// touch these corners.
    ///
    /// The side along a unit axis a is (right - left)·a, and the other side is (upper - lower)·perp(a). The
    /// difference of one and a multiple of the other is linear in a, and zero across d below.
    fn balanced(&self, multiple: f64) -> Option<DVec2> {
        let [lower, right, upper, left] = self.touched.map(|i| self.hull[i]);
        let (along, across) = (right - left, (upper - lower) * multiple);
        let d = DVec2::new(along.x - across.y, along.y + across.x);
        let length = libm::sqrt(d.dot(d));
        if length > 0.0 { Some(d.perp() / length) } else { None }
    }
}

/// Returns the same rectangle with the side nearest to +x as its first side.
fn upright(r: Rectangle) -> Rectangle {
    let DVec2 { x, y } = r.axis;
    let turns = if x.abs() >= y.abs() {
        if x > 0.0 { 0 } else { 2 }
    } else if y > 0.0 {
        3
    } else {
        1
    };
    let mut r = r;
    for _ in 0..turns {
        // A quarter turn to the left: the old second side becomes the first.
        r = Rectangle { axis: r.axis.perp(), min: DVec2::new(r.min.y, -r.max.x), max: DVec2::new(r.max.y, -r.min.x) };
    }
    r
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a convex polygon on an ellipse, from angles.
    fn polygon(turns: &[f64]) -> impl Iterator<Item = DVec2> + '_ {
        turns.iter().map(|t| DVec2::new(3.0 * libm::cos(*t), libm::sin(*t)) + DVec2::new(10.0, -4.0))
    }

    fn search(hull: &[DVec2], cost: impl Fn(DVec2) -> f64) -> f64 {
        let steps = 20_000;
        let angle = |i: i32| f64::from(i) / f64::from(steps) * core::f64::consts::FRAC_PI_2;
        (0..steps)
            .map(|i| cost(Rectangle::around(hull, DVec2::new(libm::cos(angle(i)), libm::sin(angle(i)))).size()))
            .fold(f64::MAX, f64::min)
    }

    #[test]
    fn no_angle_gives_less_than_the_calipers() {
        for turns in
            [&[0.1, 0.4, 2.0, 3.0, 4.1, 5.9][..], &[0.0, 1.1, 2.2], &[0.3, 0.35, 0.4, 3.3], &[1.0, 2.0, 2.5, 4.0, 4.2]]
        {
            let mut hull = [DVec2::ZERO; 8];
            for (p, q) in hull.iter_mut().zip(polygon(turns)) {
                *p = q;
            }
            let hull = &hull[..turns.len()];
            let area = min_area(hull).size();
            let least = search(hull, |size| size.x * size.y);
            assert!((area.x * area.y - least) / least < 1e-6, "{turns:?}: {area} and {least}");
            let square = min_square(hull).size().max_element();
            let least = search(hull, DVec2::max_element);
            assert!((square - least) / least < 1e-6, "{turns:?}: {square} and {least}");
            for r in [min_area(hull), min_square(hull)] {
                let around = Rectangle::around(hull, r.axis);
                assert!((r.min - around.min).abs().max_element() < 1e-12, "{r:?}");
                assert!((r.max - around.max).abs().max_element() < 1e-12, "{r:?}");
                assert!(r.axis.x > 0.7 && r.axis.y.abs() < 0.71, "{r:?}");
            }
        }
    }

    #[test]
    fn no_angle_gives_less_within_a_limit_of_the_texels() {
        for turns in [&[0.1, 0.4, 2.0, 3.0, 4.1, 5.9][..], &[0.0, 1.1, 2.2], &[0.3, 0.35, 0.4, 3.3]] {
            let mut hull = [DVec2::ZERO; 8];
            for (p, q) in hull.iter_mut().zip(polygon(turns)) {
                *p = q;
            }
            let hull = &hull[..turns.len()];
            for ratio in [1.0, 1.2, 1.5, 2.0, 3.0] {
                for texels in [DVec2::ONE, DVec2::new(2.0, 1.0), DVec2::new(1.0, 3.0)] {
                    let widened = |size: DVec2| size.max(texels * ((size / texels).max_element() / ratio));
                    let r = min_area_within(hull, ratio, widened);
                    let area = widened(r.size()).element_product();
                    let turned = |size: DVec2| widened(size).element_product();
                    // All directions within 45 degrees of +x, so each rectangle is tried once.
                    let least = (-10_000..=10_000)
                        .map(|i| f64::from(i) / 10_000.0 * core::f64::consts::FRAC_PI_4)
                        .map(|a| turned(Rectangle::around(hull, DVec2::new(libm::cos(a), libm::sin(a))).size()))
                        .fold(f64::MAX, f64::min);
                    assert!((area - least) / least < 1e-6, "{turns:?} {ratio} {texels}: {area} and {least}");
                }
            }
        }
    }

    #[test]
    fn corners_that_coincide_but_for_rounding_do_not_stop_the_calipers() {
        let square =
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1e-17), (1.0, 0.5), (1.0 - 1e-16, 0.5 + 1e-16), (1.0, 1.0), (0.0, 1.0)];
        let hull = square.map(|(x, y)| DVec2::new(x, y));
        assert!((min_area(&hull).size() - DVec2::ONE).abs().max_element() < 1e-12);
        assert!((min_square(&hull).size() - DVec2::ONE).abs().max_element() < 1e-12);
    }

    /// A wall seen edge-on, as thin as rounding, with the corners at its ends in any order.
    #[test]
    fn slivers_have_the_least_square_of_their_line() {
        for noise in [[0.0, 1e-17, 3e-17, 1e-17], [1e-16, 0.0, 1e-17, 2e-16], [0.0, 0.0, 1e-13, 1e-13]] {
            let hull = [(0.0, noise[0]), (3.0, noise[1]), (3.0, noise[2]), (0.0, noise[3])];
            let side = min_square(&hull.map(|(x, y)| DVec2::new(x, y))).size().max_element();
            assert!((side * core::f64::consts::SQRT_2 / 3.0 - 1.0).abs() < 1e-9, "{noise:?}: {side}");
        }
    }

    #[test]
    fn a_point_and_a_line_have_rectangles() {
        assert_eq!(min_area(&[DVec2::ONE]).size(), DVec2::ZERO);
        let line = [DVec2::ZERO, DVec2::new(3.0, 3.0)];
        assert!(min_area(&line).size().y.abs() < 1e-12);
        assert!((min_square(&line).size().max_element() - 3.0).abs() < 1e-12);
    }
}
