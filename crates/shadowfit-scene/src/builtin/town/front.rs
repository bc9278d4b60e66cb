//! Openings of fronts: walls with holes, windows with frames and sills, shutters, doors, shop windows.

use super::kit::Kit;
use super::palette::Paint;
use crate::parts::{Solid, ellipsoid, plank};

/// Thickness of a front wall, in metres: the depth of its recesses.
pub(super) const WALL: f32 = 0.24;
/// Distance of panes behind the front, in metres.
const PANE: f32 = 0.14;

/// A row of openings at one height. All lengths are in metres.
pub(super) struct Openings {
    /// Lower and upper end of all openings.
    pub(super) heights: [f32; 2],
    /// Left and right end of each opening, ascending.
    pub(super) gaps: Vec<[f32; 2]>,
}

/// Builds a front wall with its face at z = 0, from half its width, its lower and upper end, and rows of openings.
pub(super) fn pierced(half: f32, [foot, top]: [f32; 2], rows: &[Openings]) -> Solid {
    let slab = |[left, right]: [f32; 2], [low, high]: [f32; 2]| plank([left, low, -WALL], [right, high, 0.0]);
    let mut wall = Solid::default();
    let mut reached = foot;
    for row in rows {
        let [low, high] = row.heights;
        wall = wall.with(slab([-half, half], [reached, low]));
        let mut from = -half;
        for &[left, right] in row.gaps.iter().chain([&[half, half]]) {
            wall = wall.with(slab([from, left], row.heights));
            from = right;
        }
        reached = high;
    }
    wall.with(slab([-half, half], [reached, top]))
}

/// Finish of a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Finish {
    /// Stone on all four sides.
    Surround,
    /// Shutters at both sides, in a paint.
    Shutters(Paint),
    /// Timbers of the wall itself, with a sill.
    Timbers,
}

/// Adds a window into an opening.
pub(super) fn window(kit: &mut Kit, [left, right]: [f32; 2], [low, high]: [f32; 2], finish: Finish) {
    kit.plank(Paint::Frame, [left, low, -WALL - 0.02], [right, high, -PANE - 0.03]);
    let middle = f32::midpoint(left, right);
    for [from, to] in [[left + 0.06, middle - 0.03], [middle + 0.03, right - 0.06]] {
        kit.plank(Paint::Glass, [from, low + 0.08, -PANE - 0.05], [to, high - 0.06, -PANE - 0.015]);
    }
    let bar = low + 0.64 * (high - low);
    kit.plank(Paint::Frame, [left + 0.03, bar - 0.03, -PANE - 0.04], [right - 0.03, bar + 0.03, -PANE]);
    let sill = if finish == Finish::Timbers { Paint::Timber } else { Paint::Trim };
    kit.plank(sill, [left - 0.13, low - 0.09, -0.1], [right + 0.13, low + 0.02, 0.13]);
    match finish {
        Finish::Surround => {
            kit.plank(Paint::Trim, [left - 0.15, low + 0.01, -0.06], [left + 0.02, high - 0.01, 0.04]);
            kit.plank(Paint::Trim, [right - 0.02, low + 0.01, -0.06], [right + 0.15, high - 0.01, 0.04]);
            kit.plank(Paint::Trim, [left - 0.2, high - 0.02, -0.06], [right + 0.2, high + 0.17, 0.06]);
        }
        Finish::Shutters(paint) => {
            let wide = (right - left) / 2.0;
            for from in [left - wide - 0.03, right + 0.03] {
                kit.plank(paint, [from, low + 0.04, -0.02], [from + wide, high, 0.045]);
            }
        }
        Finish::Timbers => {}
    }
}

/// Adds a box of flowers before the sill of a window.
pub(super) fn flower_box(kit: &mut Kit, [left, right]: [f32; 2], low: f32) {
    kit.plank(Paint::Timber, [left - 0.04, low - 0.06, 0.125], [right + 0.04, low + 0.13, 0.3]);
    let step = (right - left) / 4.0;
    for index in 0..4 {
        let x = left + step * (index as f32 + 0.5);
        let paint = if index % 2 == 0 { Paint::Apple } else { Paint::Hedge };
        kit.add(paint, ellipsoid([0.15, 0.13, 0.12], 5, 3).moved([x, low + 0.16, 0.215]));
    }
}

/// Adds a window on a wall without an opening: a raised frame with two panes.
pub(super) fn flat_window(kit: &mut Kit, [left, right]: [f32; 2], [low, high]: [f32; 2]) {
    kit.plank(Paint::Frame, [left, low, -0.05], [right, high, 0.02]);
    let middle = f32::midpoint(left, right);
    for [from, to] in [[left + 0.07, middle - 0.035], [middle + 0.035, right - 0.07]] {
        kit.plank(Paint::Glass, [from, low + 0.07, -0.03], [to, high - 0.07, 0.03]);
    }
    kit.plank(Paint::Trim, [left - 0.1, low - 0.1, -0.04], [right + 0.1, low + 0.01, 0.12]);
    kit.plank(Paint::Trim, [left - 0.12, high - 0.01, -0.04], [right + 0.12, high + 0.13, 0.06]);
}

/// Adds the window of a far house: panes in a frame above a sill, or a pane alone.
pub(super) fn far_window(kit: &mut Kit, [left, right]: [f32; 2], [low, high]: [f32; 2], is_framed: bool) {
    if !is_framed {
        kit.plank(Paint::Glass, [left, low, -0.05], [right, high, 0.03]);
        return;
    }
    kit.plank(Paint::Frame, [left, low, -0.05], [right, high, 0.03]);
    let panes = ((right - left) / 1.1).round().max(1.0);
    let wide = (right - left - 0.09) / panes;
    for index in 0..panes as usize {
        let from = left + 0.09 + wide * index as f32;
        kit.plank(Paint::Glass, [from, low + 0.09, -0.03], [from + wide - 0.09, high - 0.09, 0.04]);
    }
    kit.plank(Paint::Trim, [left - 0.1, low - 0.1, -0.04], [right + 0.1, low + 0.01, 0.12]);
}

/// Adds a panelled door with a light above it, a stone surround and a step.
pub(super) fn door(kit: &mut Kit, [left, right]: [f32; 2], high: f32, leaf: Paint) {
    let head = high - 0.45;
    kit.plank(leaf, [left, 0.0, -WALL - 0.02], [right, head, -PANE]);
    let middle = f32::midpoint(left, right);
    for [from, to] in [[left + 0.1, middle - 0.05], [middle + 0.05, right - 0.1]] {
        for [foot, head] in [[0.2, 0.85], [0.98, head - 0.12]] {
            kit.plank(leaf, [from, foot, -0.2], [to, head, -PANE + 0.03]);
        }
    }
    kit.plank(Paint::Frame, [left, head + 0.01, -WALL - 0.02], [right, high, -PANE - 0.03]);
    kit.plank(Paint::Glass, [left + 0.06, head + 0.07, -0.2], [right - 0.06, high - 0.06, -PANE]);
    for [from, to] in [[left - 0.2, left + 0.02], [right - 0.02, right + 0.2]] {
        kit.plank(Paint::Trim, [from, -0.02, -0.06], [to, high - 0.01, 0.06]);
    }
    kit.plank(Paint::Trim, [left - 0.27, high - 0.02, -0.06], [right + 0.27, high + 0.2, 0.09]);
    kit.plank(Paint::Trim, [left - 0.33, high + 0.19, -0.06], [right + 0.33, high + 0.27, 0.24]);
    kit.plank(Paint::Granite, [left - 0.3, -0.3, -0.12], [right + 0.3, 0.09, 0.34]);
}

/// Adds a shop window with three panes, and a painted board above it.
pub(super) fn shop_window(kit: &mut Kit, [left, right]: [f32; 2], [low, high]: [f32; 2], paint: Paint) {
    kit.plank(paint, [left, low, -WALL - 0.02], [right, high, -PANE - 0.03]);
    let pane = (right - left) / 3.0;
    for index in 0..3 {
        let from = left + pane * index as f32;
        kit.plank(Paint::Glass, [from + 0.06, low + 0.12, -0.2], [from + pane - 0.06, high - 0.5, -PANE]);
        kit.plank(Paint::Glass, [from + 0.06, high - 0.42, -0.2], [from + pane - 0.06, high - 0.08, -PANE]);
    }
    kit.plank(paint, [left - 0.12, low - 0.1, -0.1], [right + 0.12, low + 0.02, 0.12]);
    kit.plank(paint, [left - 0.12, high + 0.04, -0.05], [right + 0.12, high + 0.46, 0.07]);
    kit.plank(paint, [left - 0.18, high + 0.45, -0.05], [right + 0.18, high + 0.53, 0.16]);
}
