//! The plane across the light, the windows in it, and the cost of their texels.

use glam::{DVec2, DVec3, Vec2};

use crate::base::checks;
use crate::demand::grid::Plane;
use crate::fits::FitRule;
use crate::light::grid;

/// Returns the cost of a point whose texel is too wide by this ratio: the ratio to the power of 3/2.
///
/// With the ratio itself, or its square, pictures are as good on average. The ratio leaves more points with
/// far too wide texels, and its square gives wider texels to most points.
pub(super) fn cost_of(ratio: f32) -> f32 {
    ratio * libm::sqrtf(ratio)
}

/// A rectangle of the plane: its least corner and its size, in metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Rect {
    pub(super) min: Vec2,
    pub(super) size: Vec2,
}

/// A window, in absolute world coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Window {
    /// Texel width, in eighths of an octave of a metre.
    pub(super) steps: i32,
    /// Grid lines of the window's left and bottom side.
    pub(super) first: DVec2,
    /// Far and near plane along the light's z from the world's origin, in metres, if they are known.
    pub(super) z: Option<(f64, f64)>,
}

/// The plane across the light, relative to the origin of a fit, and the sizes of its windows.
pub(super) struct Lattice {
    pub(super) plane: Plane,
    /// Position of the origin of the fit in the plane.
    anchor: DVec2,
    /// Free texels at the border of each window, and usable texels between the borders.
    border: f64,
    pub(super) usable: DVec2,
    /// Least texel width of a window, in eighths of an octave of a metre.
    pub(super) least: i32,
}

/// Greatest oversize of the last window's texels, in eighths of an octave: a factor of about one and a half.
/// A coarser window is replaced.
const LAST_WASTE: i32 = 5;

/// Share of the remaining way to its best place that a window moves beyond the least move. A smaller share
/// makes it move more often, a greater one farther.
pub(super) const MOVE_ON: f64 = 0.3;

impl Lattice {
    /// Creates the lattice of windows that are fitted by a rule.
    pub(super) fn new(plane: Plane, origin: DVec3, rule: &FitRule) -> Self {
        let anchor = plane.of(plane.axes.project(origin));
        // Along the plane's height, texels are shorter than wide.
        let is_limited = rule.least_texel > 0.0;
        let least = if is_limited { grid::eighths_above(rule.least_texel / plane.shape) } else { i32::MIN };
        Self { plane, anchor, border: rule.border, usable: rule.usable(), least }
    }

    /// Returns the size of a window's texels, in metres.
    pub(super) fn texel(&self, steps: i32) -> DVec2 {
        let width = grid::eighths(steps);
        DVec2::new(width, width * self.plane.shape)
    }

    /// Returns the rectangle of a window between its borders.
    pub(super) fn rect(&self, window: &Window) -> Rect {
        let texel = grid::eighths(window.steps);
        // One texel is lost to the shift onto the grid: half of it on either side.
        let min = (window.first + self.border + 0.5) * texel - self.anchor;
        Rect { min: min.as_vec2(), size: (self.usable * texel).as_vec2() }
    }

    /// Returns the window that holds a rectangle of its size between its borders.
    pub(super) fn window(&self, steps: i32, rect: &Rect) -> Window {
        self.at(steps, rect.min.as_dvec2(), checks::floor)
    }

    /// Returns the window whose least corner between the borders is near `min`.
    fn at(&self, steps: i32, min: DVec2, round: impl Fn(f64) -> f64) -> Window {
        let line = (min + self.anchor) / grid::eighths(steps) - self.border;
        Window { steps, first: DVec2::new(round(line.x), round(line.y)), z: None }
    }

    /// Returns the last window, which holds a rectangle of the plane. The held window is kept while it is
    /// large enough and not too large.
    pub(super) fn last(&self, index: usize, held: Option<&Window>, min: DVec2, max: DVec2) -> Window {
        let usable = self.usable;
        // Each finer window needs smaller texels than the next one.
        let least = self.least.saturating_add(i32::from(index as u8));
        let needed = grid::eighths_above(((max - min) / usable).max_element()).max(least);
        let is_wasteful = |held: &&Window| held.steps > needed.saturating_add(LAST_WASTE);
        let held = held.filter(|held| held.steps >= needed && !is_wasteful(held));
        let steps = held.map_or(needed, |held| held.steps);
        let size = (usable + 1.0) * grid::eighths(steps);
        let low = |window: &Window| (window.first + self.border) * grid::eighths(steps) - self.anchor;
        let holds = |window: &Window| low(window).cmple(min).all() && (low(window) + size).cmpge(max).all();
        let around = || self.at(steps, (min + max - usable * grid::eighths(steps)) * 0.5, checks::floor);
        let Some(held) = held else {
            return around();
        };
        if holds(held) {
            return *held;
        }
        // The least move, and a part of the remaining way to the middle.
        let least = low(held).clamp((max - size).min(min), min);
        let middle = (min + max - size) * 0.5;
        let moved = self.at(steps, least + (middle - least) * MOVE_ON, libm::ceil);
        if holds(&moved) { moved } else { around() }
    }

    /// Returns a window of another plane, with the same texels around the same region as seen from the origin
    /// of the fit. If the light turns a little, this region moves little.
    pub(super) fn turned(&self, window: &Window, from: &Plane, origin: DVec3) -> Window {
        let texel = grid::eighths(window.steps);
        let line = window.first + (self.anchor - from.of(from.axes.project(origin))) / texel;
        Window { first: DVec2::new(checks::floor(line.x), checks::floor(line.y)), z: None, ..*window }
    }
}
