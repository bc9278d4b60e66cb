//! Estimated map size for any run of depth bins.
//!
//! Each bin keeps the extent of its content along fixed directions in the light's plane. The extent of a run
//! is the union of its bins' extents. The best rectangle along those directions estimates the size of the
//! run's map without fitting it.
//!
//! A bin holds the corners of (box ∩ view ∩ bin) of each box. One pass over the box finds them for all bins.
//! Neighbouring bins share the plane between them, so each point on it is found once for both:
//!
//! ```text
//!    bin 0   bin 1     bin 2
//!  │   ┌───┼───────┼────────┐   ●  the box's corners, in one bin
//!  │   ●   ○       ○        ●   ○  its edges at the planes, for the bins on both sides
//!  │   └───┼───────┼────────┘
//! ```

use core::ops;

use glam::{DVec2, DVec3, Vec3};

use super::bins::{BINS, Bins, log2};
use crate::base::box_corners;
use crate::base::checks::{greater, lesser};
use crate::content::{Bounds, Content, Found, Query, Visit};
use crate::fits::{Covers, FitRule};
use crate::light::{LightAxes, grid};
use crate::technique::settings::RectangleKind;
use crate::view::{Depths, EDGES, Plane, Range, View, at, clip_to_box, inner_part};

/// Directions over half a turn. A rectangle's other side is along the direction a quarter turn further.
const DIRECTIONS: usize = 32;

/// Estimated map size of each run of bins, in metres per map, as a measure of the texel size.
pub(super) struct Sizes {
    /// log2 of metres, indexed by the first bin and by the number of bins minus one.
    log: [[f32; BINS]; BINS],
}

/// Returns the bin at which the slice of a map ends if the map is read up to `bin`. The first and the last
/// bin do not move.
pub(super) fn slice_bin(bins: &Bins, bin: usize, beyond: usize) -> usize {
    if bin == 0 || bin >= bins.count { bin } else { bin.saturating_sub(beyond).max(1) }
}

/// Input of the size estimate: the content, and the rule that the maps will be fitted by.
pub(super) struct Maps<'a, 'b> {
    pub(super) content: &'a Content<'b>,
    pub(super) axes: LightAxes,
    pub(super) rule: &'a FitRule,
    /// Whether the extents are rounded up to steps of the world's grid.
    pub(super) is_snapped: bool,
    /// View depths at which the first map begins and the last one ends, in metres.
    pub(super) near: f64,
    pub(super) end: f64,
}

impl Maps<'_, '_> {
    /// Estimates the map sizes of all runs.
    pub(super) fn sizes(&self, bins: &Bins) -> Sizes {
        if self.rule.form.covers == Covers::Sphere {
            Sizes::of_spheres(self, bins)
        } else {
            Sizes::of_rectangles(self, bins)
        }
    }
}

impl Sizes {
    /// Returns the sizes of maps that are read `beyond` bins past their slices, indexed by the bins in which
    /// they are read.
    pub(super) fn by_reading(&self, bins: &Bins, beyond: usize) -> Self {
        let mut log = self.log;
        for (first, row) in log.iter_mut().enumerate().take(bins.count) {
            for end in first + 1..=bins.count {
                let (from, to) = (slice_bin(bins, first, beyond), slice_bin(bins, end, beyond));
                row[end - first - 1] = self.log_extent(from, to.max(from + 1));
            }
        }
        Self { log }
    }

    /// Returns log2 of the extent of the bins `first..end`, in metres.
    pub(super) fn log_extent(&self, first: usize, end: usize) -> f32 {
        self.log[first][end - first - 1]
    }

    fn fill(bins: &Bins, mut extent: impl FnMut(usize, usize) -> f64) -> Self {
        let mut log = [[f32::MIN; BINS]; BINS];
        for (first, row) in log.iter_mut().enumerate().take(bins.count) {
            for end in first + 1..=bins.count {
                row[end - first - 1] = log2(extent(first, end));
            }
        }
        Self { log }
    }

    fn of_spheres(maps: &Maps, bins: &Bins) -> Self {
        let starts: [f64; BINS + 1] = core::array::from_fn(|bin| bins.start(bin));
        Self::fill(bins, |first, end| {
            // The first map reaches to the near plane.
            let near = if first == 0 { maps.near } else { starts[first] };
            let far = if end == bins.count { maps.end } else { starts[end] };
            let range = Range { near: near as f32, far: far as f32 };
            let radius = maps.content.enclosing_sphere(range).map_or(far, |sphere| sphere.radius);
            grid::quantised(2.0 * radius)
        })
    }

    fn of_rectangles(maps: &Maps, bins: &Bins) -> Self {
        let directions = Directions::new(&maps.axes);
        let mut extents = [Dop::EMPTY; BINS];
        if maps.rule.form.covers == Covers::Receivers && maps.content.knows_receivers() {
            for part in maps.content.whole_views() {
                let slabs = Slabs::new(&part.view, bins);
                let mut collector = Collector { extents: &mut extents, slabs, directions: &directions };
                maps.content.visit(Query::Lit(&part), &mut collector);
            }
        } else {
            for (bin, dop) in extents.iter_mut().enumerate().take(bins.count) {
                let range = Range { near: bins.start(bin) as f32, far: bins.start(bin + 1) as f32 };
                maps.content.corners(range).for_each(|p| dop.add(&directions.along(p)));
            }
        }
        let mut log = [[f32::MIN; BINS]; BINS];
        for end in 1..=bins.count {
            let mut run = Dop::EMPTY;
            for first in (0..end).rev() {
                run = run.union(&extents[first]);
                let size = run.size(maps.rule);
                log[first][end - first - 1] = log2(if maps.is_snapped { grid::quantised(size) } else { size });
            }
        }
        Self { log }
    }
}

/// Collector of the extents of the receivers in a view, for each bin.
struct Collector<'a> {
    extents: &'a mut [Dop; BINS],
    slabs: Slabs,
    directions: &'a Directions,
}

impl Visit for Collector<'_> {
    fn wants(&self, bounds: &Bounds) -> bool {
        let (low, high) = self.directions.extent(bounds.min, bounds.max, HIERARCHY);
        self.slabs.reached(bounds.depths).any(|bin| !self.extents[bin].holds(&low, &high))
    }

    fn take(&mut self, Found { bounds, .. }: &Found) {
        let Self { extents, slabs, directions } = self;
        let reached = slabs.reached(bounds.depths);
        let (low, high) = directions.extent(bounds.min, bounds.max, 0.0);
        // Bins whose extent the box cannot widen. Bin 0 is at index 1.
        let mut is_held = [true; BINS + 2];
        let mut are_all_held = true;
        for bin in reached.clone() {
            is_held[bin + 1] = extents[bin].holds(&low, &high);
            are_all_held &= is_held[bin + 1];
        }
        if are_all_held {
            return;
        }
        slabs.clip(bounds.min, bounds.max, &reached, |bins, p| {
            if bins.clone().any(|bin| !is_held[bin]) {
                let along = directions.along(p);
                bins.filter(|bin| !is_held[*bin]).for_each(|bin| extents[bin - 1].add(&along));
            }
        });
    }
}

/// Least and greatest coordinates along the fixed directions.
#[derive(Clone, Copy)]
struct Dop {
    min: [f32; DIRECTIONS],
    max: [f32; DIRECTIONS],
}

impl Dop {
    const EMPTY: Self = Self { min: [f32::MAX; DIRECTIONS], max: [f32::MIN; DIRECTIONS] };

    fn union(&self, other: &Self) -> Self {
        Self {
            min: core::array::from_fn(|i| lesser(other.min[i], self.min[i])),
            max: core::array::from_fn(|i| greater(other.max[i], self.max[i])),
        }
    }

    /// Widens the extent to a point's coordinates along the directions.
    fn add(&mut self, along: &[f32; DIRECTIONS]) {
        for (i, along) in along.iter().enumerate() {
            self.min[i] = lesser(*along, self.min[i]);
            self.max[i] = greater(*along, self.max[i]);
        }
    }

    /// Returns whether another extent cannot widen this one.
    fn holds(&self, low: &[f32; DIRECTIONS], high: &[f32; DIRECTIONS]) -> bool {
        let mut is_inside = true;
        for i in 0..DIRECTIONS {
            // Both comparisons have no branch, and run for four directions at a time.
            is_inside &= high[i] <= self.max[i];
            is_inside &= low[i] >= self.min[i];
        }
        is_inside
    }

    /// Returns the longer side of the rectangle around this extent, in metres; tiny for an empty extent.
    fn size(&self, rule: &FitRule) -> f64 {
        const QUARTER: usize = DIRECTIONS / 2;
        let mut lengths = [0.0; DIRECTIONS];
        for (i, length) in lengths.iter_mut().enumerate() {
            *length = f64::from(self.max[i]) - f64::from(self.min[i]);
        }
        let (sides, others) = lengths.split_at(QUARTER);
        let mut costs = [0.0; QUARTER];
        for (i, cost) in costs.iter_mut().enumerate() {
            let (a, b) = (sides[i], others[i]);
            let longer = if b > a { b } else { a };
            let area = rule.max_texel_ratio.map_or(a * b, |ratio| (a * b).max(longer * longer / ratio));
            *cost = if rule.rectangle == RectangleKind::MinimumSquare { longer } else { area };
        }
        let count = if rule.rectangle == RectangleKind::AxisAligned { 1 } else { QUARTER };
        let least = costs[..count].iter().fold(f64::MAX, |least, cost| if *cost < least { *cost } else { least });
        let best = costs[..count].iter().position(|cost| *cost == least);
        best.map_or(0.0, |i| sides[i].max(others[i])).max(SMALLEST)
    }
}

/// Extent of an empty run, in metres.
const SMALLEST: f64 = 1e-6;

/// Unit vectors across the light at even angles over half a turn, stored by coordinate.
struct Directions {
    x: [f32; DIRECTIONS],
    y: [f32; DIRECTIONS],
    z: [f32; DIRECTIONS],
}

impl Directions {
    fn new(axes: &LightAxes) -> Self {
        let (x, y) = (axes.x.as_dvec3(), axes.y.as_dvec3());
        // Turned step by step, which needs one sine and cosine for all of them.
        let (sin, cos) = libm::sincos(core::f64::consts::PI / DIRECTIONS as f64);
        let mut turned = DVec2::X;
        let world: [Vec3; DIRECTIONS] = core::array::from_fn(|_| {
            let direction = x * turned.x + y * turned.y;
            turned = DVec2::new(turned.x * cos - turned.y * sin, turned.x * sin + turned.y * cos);
            direction.as_vec3()
        });
        Self { x: world.map(|v| v.x), y: world.map(|v| v.y), z: world.map(|v| v.z) }
    }

    /// Returns the coordinates of a point along all directions.
    fn along(&self, p: DVec3) -> [f32; DIRECTIONS] {
        let p = p.as_vec3();
        let mut along = [0.0; DIRECTIONS];
        for (i, along) in along.iter_mut().enumerate() {
            *along = self.x[i] * p.x + self.y[i] * p.y + self.z[i] * p.z;
        }
        along
    }

    /// Returns the least and greatest coordinates of a box along all directions, widened by a share of its
    /// farthest coordinates.
    fn extent(&self, min: DVec3, max: DVec3, share: f32) -> ([f32; DIRECTIONS], [f32; DIRECTIONS]) {
        let (centre, half) = (((min + max) * 0.5).as_vec3(), ((max - min) * 0.5).as_vec3());
        let half = half + (centre.abs() + half).element_sum() * share;
        let (mut low, mut high) = ([0.0; DIRECTIONS], [0.0; DIRECTIONS]);
        for i in 0..DIRECTIONS {
            let along = self.x[i] * centre.x + self.y[i] * centre.y + self.z[i] * centre.z;
            let reach = self.x[i].abs() * half.x + self.y[i].abs() * half.y + self.z[i].abs() * half.z;
            (low[i], high[i]) = (along - reach, along + reach);
        }
        (low, high)
    }
}

/// Widening of a box, as a share of its coordinates, so that its extent surely holds the rounded extents of
/// the boxes in it.
const HIERARCHY: f32 = 32.0 * f32::EPSILON;

/// The planes between the bins in one view.
pub(super) struct Slabs {
    depth: Plane,
    sides: [Plane; 4],
    /// View depths of the planes, in metres, clamped to the view's range.
    pub(super) depths: [f64; BINS + 1],
    /// Corners of the view's cross-section at each plane.
    rectangles: [[DVec3; 4]; BINS + 1],
    /// The bins that hold a part of the view.
    filled: ops::Range<usize>,
}

/// A box in the bins that it may reach into.
struct Body<'a> {
    corners: [DVec3; 8],
    min: DVec3,
    max: DVec3,
    /// Whether the box crosses each side of the view.
    crossed: [bool; 4],
    /// Distances of the corners inside each crossed side.
    inside: [[f64; 8]; 4],
    /// Number of crossed sides.
    sides: usize,
    /// View depths of the corners, up to a constant.
    along: [f64; 8],
    /// Bins of the corners, plus one. 0 lies before all bins.
    bins: [usize; 8],
    slabs: &'a Slabs,
}

impl Slabs {
    pub(super) fn new(view: &View, bins: &Bins) -> Self {
        let depths = core::array::from_fn(|bin| f64::from(bins.start(bin) as f32).max(view.near).min(view.far));
        let is_filled = |bin: &usize| depths[*bin] < depths[bin + 1];
        let first = (0..BINS).find(is_filled).unwrap_or(BINS);
        let filled = first..(first..BINS).rev().find(is_filled).map_or(first, |last| last + 1);
        let rectangles = depths.map(|depth| view.rectangle(depth));
        Self { depth: view.depth, sides: view.sides, depths, rectangles, filled }
    }

    /// Returns the bins that a range of view depths may reach into.
    pub(super) fn reached(&self, Depths { near, far }: Depths) -> ops::Range<usize> {
        let first = self.depths[1..].partition_point(|plane| *plane < near);
        let end = self.depths[..BINS].partition_point(|plane| *plane <= far);
        first.max(self.filled.start)..end.min(self.filled.end)
    }

    /// Emits the corners of (box ∩ view) in each of the bins `reached`, each with the bins that it belongs
    /// to. The box must not lie outside a side of the view.
    pub(super) fn clip(
        &self,
        min: DVec3,
        max: DVec3,
        reached: &ops::Range<usize>,
        mut emit: impl FnMut(ops::Range<usize>, DVec3),
    ) {
        let body = Body::new(self, min, max, reached);
        body.add_corners(&mut emit);
        for (i, j) in EDGES {
            body.add_edge(i, j, &mut emit);
        }
        if body.crossed != [false; 4] {
            body.add_view(reached, &mut emit);
        }
    }

    /// Returns the distance beyond a plane, for a value of [`Body::along`].
    fn beyond(&self, plane: usize, along: f64) -> f64 {
        along + (self.depth.d - self.depths[plane])
    }

    /// Returns the bin of a point, plus one.
    fn bin(&self, along: f64, reached: &ops::Range<usize>) -> usize {
        let planes = &self.depths[reached.start..=reached.end];
        reached.start + planes.partition_point(|depth| along + (self.depth.d - depth) >= 0.0)
    }
}

impl<'a> Body<'a> {
    fn new(slabs: &'a Slabs, min: DVec3, max: DVec3, reached: &ops::Range<usize>) -> Self {
        let corners = box_corners(min, max);
        let (mut inside, mut crossed, mut sides) = ([[0.0; 8]; 4], [false; 4], 0);
        for (side, crossed) in slabs.sides.iter().zip(&mut crossed) {
            *crossed = side.nearest(min, max) < 0.0;
            if *crossed {
                inside[sides] = corners.map(|corner| side.distance(corner));
                sides += 1;
            }
        }
        let along = corners.map(|corner| slabs.depth.normal.dot(corner));
        let bins = along.map(|along| slabs.bin(along, reached));
        Self { corners, min, max, crossed, inside, sides, along, bins, slabs }
    }

    /// Returns the distances of the corners inside each crossed side.
    fn inside(&self) -> &[[f64; 8]] {
        &self.inside[..self.sides]
    }

    /// Emits the box's own corners.
    fn add_corners(&self, emit: &mut impl FnMut(ops::Range<usize>, DVec3)) {
        for (i, corner) in self.corners.into_iter().enumerate() {
            if self.inside().iter().all(|side| side[i] >= 0.0) {
                emit(self.bins[i]..self.bins[i] + 1, corner);
            }
        }
    }

    /// Emits the points where one of the box's edges crosses the sides and the planes.
    fn add_edge(&self, i: usize, j: usize, emit: &mut impl FnMut(ops::Range<usize>, DVec3)) {
        let Some((enter, leave)) = inner_part(self.inside(), i, j) else { return };
        let (a, b) = (self.corners[i], self.corners[j]);
        let (first, last) = (self.bins[i].min(self.bins[j]), self.bins[i].max(self.bins[j]));
        for plane in first..last {
            let (da, db) = (self.slabs.beyond(plane, self.along[i]), self.slabs.beyond(plane, self.along[j]));
            let t = da / (da - db);
            if t >= enter && t <= leave {
                emit(plane..plane + 2, at(a, b, t));
            }
        }
        for t in [enter, leave] {
            if t > 0.0 && t < 1.0 {
                let p = at(a, b, t);
                let along = self.slabs.depth.normal.dot(p);
                let bin = (first..last).find(|plane| self.slabs.beyond(*plane, along) < 0.0).unwrap_or(last);
                emit(bin..bin + 1, p);
            }
        }
    }

    /// Emits the points where the view's edges and the edges of its cross-sections enter and leave the box.
    fn add_view(&self, reached: &ops::Range<usize>, emit: &mut impl FnMut(ops::Range<usize>, DVec3)) {
        let mut add = |bins: ops::Range<usize>, a: DVec3, b: DVec3| {
            if let Some((a, b)) = clip_to_box(a, b, self.min, self.max) {
                emit(bins.clone(), a);
                emit(bins, b);
            }
        };
        let rectangles = &self.slabs.rectangles;
        let crossed_by = |side: usize| self.crossed[side % 4];
        let planes = self.bins.into_iter().fold((usize::MAX, 0), |(a, b), bin| (a.min(bin), b.max(bin)));
        for side in (0..4).filter(|side| crossed_by(*side)) {
            for (plane, rectangle) in rectangles.iter().enumerate().take(planes.1).skip(planes.0) {
                add(plane..plane + 2, rectangle[side], rectangle[(side + 1) % 4]);
            }
            // A corner of the view's cross-sections lies on the side with its number and on the one before.
            for bin in reached.clone().filter(|_| crossed_by(side + 3)) {
                add(bin + 1..bin + 2, rectangles[bin][side], rectangles[bin + 1][side]);
            }
        }
    }
}
