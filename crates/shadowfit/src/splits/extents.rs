//! Estimated size of the map for any run of depth bins.
//!
//! Each bin keeps the extent of what it holds along fixed directions in the light's plane; a run's
//! extent is the greatest of its bins', and the best of the rectangles along those directions gives
//! an estimate of its map's size, without fitting it.

use glam::{DVec2, DVec3, Vec3};

use super::bins::{BINS, Bins};
use crate::axes::LightAxes;
use crate::content::Content;
use crate::grid;
use crate::rule::{Covers, FitRule};
use crate::settings::RectangleKind;
use crate::view::Range;

/// Directions over half a turn; a rectangle's other side is along the direction a quarter turn
/// further on.
const DIRECTIONS: usize = 32;

/// Estimated texel size of the map of each run of bins, in map widths (metres per map).
pub(super) struct Sizes {
    /// By first bin and number of bins less one; log2 of metres.
    log: [[f32; BINS]; BINS],
}

/// The rule that the maps will be fitted by.
pub(super) struct Maps<'a, 'b> {
    pub(super) content: &'a Content<'b>,
    pub(super) axes: LightAxes,
    pub(super) rule: &'a FitRule,
    /// Whether their extents are rounded up to steps of the world's grid.
    pub(super) is_snapped: bool,
    /// View depths at which the first map begins and the last one ends, in metres.
    pub(super) near: f64,
    pub(super) end: f64,
}

impl Maps<'_, '_> {
    /// The sizes of the maps of all runs.
    pub(super) fn sizes(&self, bins: &Bins) -> Sizes {
        match self.rule.covers {
            Covers::Sphere => Sizes::of_spheres(self, bins),
            _ => Sizes::of_rectangles(self, bins),
        }
    }
}

impl Sizes {
    /// log2 of the extent of the bins `first..end`, in metres.
    pub(super) fn log_extent(&self, first: usize, end: usize) -> f32 {
        self.log[first][end - first - 1]
    }

    fn fill(mut extent: impl FnMut(usize, usize) -> f64) -> Self {
        let mut log = [[f32::MIN; BINS]; BINS];
        for (first, row) in log.iter_mut().enumerate() {
            for end in first + 1..=BINS {
                row[end - first - 1] = libm::log2(extent(first, end)) as f32;
            }
        }
        Self { log }
    }

    fn of_spheres(maps: &Maps, bins: &Bins) -> Self {
        let starts: [f64; BINS + 1] = core::array::from_fn(|bin| bins.start(bin));
        Self::fill(|first, end| {
            // The first map reaches to the near plane.
            let near = if first == 0 { maps.near } else { starts[first] };
            let far = if end == BINS { maps.end } else { starts[end] };
            let range = Range { near: near as f32, far: far as f32 };
            let radius = maps.content.enclosing_sphere(range).map_or(far, |sphere| sphere.radius);
            grid::quantised(2.0 * radius)
        })
    }

    fn of_rectangles(maps: &Maps, bins: &Bins) -> Self {
        let directions = Directions::new(&maps.axes);
        let mut extents = [Dop::EMPTY; BINS];
        for (bin, dop) in extents.iter_mut().enumerate() {
            let range = Range { near: bins.start(bin) as f32, far: bins.start(bin + 1) as f32 };
            dop.collect(maps, &directions, range);
        }
        let mut run = Dop::EMPTY;
        Self::fill(|first, end| {
            if end == first + 1 {
                run = Dop::EMPTY;
            }
            run = run.union(&extents[end - 1]);
            let size = run.size(maps.rule);
            if maps.is_snapped { grid::quantised(size) } else { size }
        })
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
            min: core::array::from_fn(|i| self.min[i].min(other.min[i])),
            max: core::array::from_fn(|i| self.max[i].max(other.max[i])),
        }
    }

    fn push(&mut self, directions: &Directions, p: DVec3) {
        let p = p.as_vec3();
        for (i, direction) in directions.world.iter().enumerate() {
            let along = direction.x * p.x + direction.y * p.y + direction.z * p.z;
            self.min[i] = self.min[i].min(along);
            self.max[i] = self.max[i].max(along);
        }
    }

    /// Whether a box cannot widen this extent.
    fn holds(&self, directions: &Directions, min: DVec3, max: DVec3) -> bool {
        let (centre, half) = (((min + max) * 0.5).as_vec3(), ((max - min) * 0.5).as_vec3());
        let mut is_inside = true;
        for (i, direction) in directions.world.iter().enumerate() {
            let along = direction.x * centre.x + direction.y * centre.y + direction.z * centre.z;
            let reach = direction.x.abs() * half.x + direction.y.abs() * half.y + direction.z.abs() * half.z;
            is_inside &= along + reach <= self.max[i] && along - reach >= self.min[i];
        }
        is_inside
    }

    /// Collects what a map of a range would hold.
    fn collect(&mut self, maps: &Maps, directions: &Directions, range: Range) {
        let content = maps.content;
        let Ok(()) = if maps.rule.covers == Covers::Receivers && content.receivers.is_some() {
            content.receivers_in(range, |_, slice, min, max| {
                if self.holds(directions, min, max) {
                    return Ok(());
                }
                slice.clip(min, max, &mut |p| {
                    self.push(directions, p);
                    Ok::<(), core::convert::Infallible>(())
                })
            })
        } else {
            content.corners(range).for_each(|p| self.push(directions, p));
            Ok(())
        };
    }

    /// Longer side of the rectangle around this extent, in metres; tiny where there is none.
    fn size(&self, rule: &FitRule) -> f64 {
        const QUARTER: usize = DIRECTIONS / 2;
        let length = |i: usize| f64::from(self.max[i]) - f64::from(self.min[i]);
        let mut best = (f64::MAX, 0.0);
        let last = if rule.rectangle == RectangleKind::AxisAligned { 1 } else { QUARTER };
        for i in 0..last {
            let (a, b) = (length(i), length(i + QUARTER));
            let area = rule.max_texel_ratio.map_or(a * b, |ratio| (a * b).max(a.max(b) * a.max(b) / ratio));
            let cost = if rule.rectangle == RectangleKind::MinimumSquare { a.max(b) } else { area };
            if cost < best.0 {
                best = (cost, a.max(b));
            }
        }
        best.1.max(SMALLEST)
    }
}

/// Extent of an empty run, in metres.
const SMALLEST: f64 = 1e-6;

/// Unit vectors across the light at even angles over half a turn.
struct Directions {
    world: [Vec3; DIRECTIONS],
}

impl Directions {
    fn new(axes: &LightAxes) -> Self {
        let (x, y) = (axes.x.as_dvec3(), axes.y.as_dvec3());
        // Turned step by step: two sines for all of them.
        let (sin, cos) = libm::sincos(core::f64::consts::PI / DIRECTIONS as f64);
        let mut turned = DVec2::X;
        let world = core::array::from_fn(|_| {
            let direction = x * turned.x + y * turned.y;
            turned = DVec2::new(turned.x * cos - turned.y * sin, turned.x * sin + turned.y * cos);
            direction.as_vec3()
        });
        Self { world }
    }
}
