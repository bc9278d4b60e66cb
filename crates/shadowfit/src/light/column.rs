//! The depth range of a box over a rectangle of the light's plane.

use glam::{DVec2, DVec3};

use crate::light::LightAxes;

/// All points over a rectangle of the light's plane: a column without ends.
pub(crate) struct Column {
    /// Least and greatest corner of the rectangle along the light's x and y, in metres.
    pub(crate) min: DVec2,
    pub(crate) max: DVec2,
    /// Least and greatest world coordinates of the column's points at z = 0.
    foot: (DVec3, DVec3),
    /// Metres along z per metre along each world axis.
    per_metre: DVec3,
}

impl Column {
    pub(crate) fn new(axes: &LightAxes, min: DVec2, max: DVec2) -> Self {
        let (x, y) = (axes.x.as_dvec3(), axes.y.as_dvec3());
        let (a, b, c, d) = (x * min.x, x * max.x, y * min.y, y * max.y);
        let foot = (a.min(b) + c.min(d), a.max(b) + c.max(d));
        Self { min, max, foot, per_metre: axes.z.as_dvec3().recip() }
    }

    /// Returns the range of z, in metres along the light's axes, that holds the part of a box inside the
    /// column. Without such a part, the least z is above the greatest.
    ///
    /// A box is the intersection of three slabs along the world's axes. A point of the column at z lies in a
    /// slab only if foot + z · axis reaches into it, which bounds z. For level ground the bound is exact.
    #[inline]
    pub(crate) fn depths(&self, min: DVec3, max: DVec3) -> (f64, f64) {
        let (one, other) = ((min - self.foot.1) * self.per_metre, (max - self.foot.0) * self.per_metre);
        // If the axis is 0, the light runs along the slab. The bound is then infinite, or NaN, which min and
        // max skip.
        let (low, high) = (one.min(other), one.max(other));
        (low.x.max(low.y).max(low.z), high.x.min(high.y).min(high.z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::{Light, Roll};
    use crate::view::crossing;

    /// Returns a number of an evenly spread sequence in 0..1 (M. Roberts, "The unreasonable effectiveness of
    /// quasirandom sequences", 2018).
    fn spread(i: u32, dimension: usize) -> f64 {
        (f64::from(i + 1) * [0.819_172_5, 0.671_043_6, 0.549_700_5, 0.450_252_3, 0.368_8][dimension]).fract()
    }

    fn axes(direction: DVec3) -> LightAxes {
        Light::new(direction, DVec3::Y, Roll::ShortestArc).axes(Roll::ShortestArc)
    }

    /// Returns the least and greatest z at which rays of a column, including its edges, enter and leave a
    /// box.
    fn sampled(axes: &LightAxes, column: &Column, (min, max): (DVec3, DVec3)) -> Option<(f64, f64)> {
        let ends = |x: i32, y: i32| {
            let at = column.min + (column.max - column.min) * DVec2::new(f64::from(x), f64::from(y)) / 40.0;
            crossing(axes.unproject(at.extend(-1e5)), axes.z.as_dvec3() * 2e5, min, max)
        };
        let all = (0..=40).flat_map(|x| (0..=40).filter_map(move |y| ends(x, y)));
        all.map(|(enter, leave)| (-1e5 + 2e5 * enter, -1e5 + 2e5 * leave)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    }

    #[test]
    fn depths_hold_all_points_of_a_box_in_the_column_and_are_exact_for_level_ground() {
        let mut met = 0;
        for i in 0..400 {
            let is_axis = i % 8 == 0;
            let across = if is_axis { 0.0 } else { 1.0 };
            let direction = DVec3::new(spread(i, 0) - 0.5, -spread(i, 1) - 0.01, (spread(i, 2) - 0.5) * across);
            let axes = axes(direction.normalize());
            let is_ground = i % 2 == 0;
            let height = if is_ground { 0.1 } else { 50.0 * spread(i, 4) };
            let size = DVec3::new(10.0 + 1e4 * spread(i, 3), height, 10.0 + 1e4 * spread(i, 1));
            let (min, max) = (size * -spread(i, 2), size * (1.0 - spread(i, 2)));
            let middle = axes.project((min + max) * 0.5 + size * 0.4 * (spread(i, 0) - 0.5)).truncate();
            let half = DVec2::new(0.5 + 40.0 * spread(i, 2), 0.5 + 40.0 * spread(i, 0));
            let column = Column::new(&axes, middle - half, middle + half);
            let (low, high) = column.depths(min, max);
            let Some((least, greatest)) = sampled(&axes, &column, (min, max)) else { continue };
            met += 1;
            // Axes are rounded to f32, and rays start far away.
            let tolerance = 3e-7 * 1e5;
            assert!(
                low <= least + tolerance && high >= greatest - tolerance,
                "{i}: {low}..{high}, {least}..{greatest}"
            );
            let is_inside = size.x.min(size.z) > 500.0;
            if is_ground && is_inside && axes.z.y > 0.2 {
                assert!(low >= least - tolerance && high <= greatest + tolerance, "{i}: {low}..{high}");
            }
        }
        assert!(met > 200, "{met}");
    }

    #[test]
    fn a_box_beside_the_column_has_no_depths() {
        let axes = axes(DVec3::new(0.0, -1.0, 0.0));
        let column = Column::new(&axes, DVec2::ZERO, DVec2::ONE);
        for (min, is_over) in [(DVec3::splat(5.0), false), (DVec3::new(0.5, 5.0, -2.0), true)] {
            let (low, high) = column.depths(min, min + 1.5);
            assert_eq!(low <= high, is_over, "{min}: {low}..{high}");
        }
    }
}
