//! The cells of need that windows are placed by, in the plane across the light.

use glam::{DVec2, DVec3, Vec2};

use crate::need::{LEVELS, NeedGrid, Plane, SIDE};

/// Most cells that are kept; those with the fewest points are left out where there are more.
pub(super) const MAX_CELLS: usize = 1024;

/// A square of the plane, and what the points in it ask for.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cell {
    /// Its middle, relative to the origin of the fit, in metres of the plane.
    pub(super) middle: Vec2,
    /// Half of its side, in metres.
    pub(super) half: f32,
    /// Number of points, or a share of it.
    pub(super) weight: f32,
    /// What a texel of one metre costs them.
    pub(super) cost: f32,
}

/// The cells of a frame.
pub(super) struct Cells {
    cells: [Cell; MAX_CELLS],
    len: usize,
    /// Cells with no more points than this are left out.
    least: f32,
}

impl Cells {
    pub(super) const fn new() -> Self {
        const NONE: Cell = Cell { middle: Vec2::ZERO, half: 0.0, weight: 0.0, cost: 0.0 };
        Self { cells: [NONE; MAX_CELLS], len: 0, least: 0.0 }
    }

    pub(super) fn as_slice(&self) -> &[Cell] {
        &self.cells[..self.len]
    }

    /// Adds points that lie in a square of the plane and ask for a texel, in metres.
    pub(super) fn add(&mut self, middle: Vec2, half: f32, weight: f32, texel: f32) {
        // NaN is no weight either.
        let counts = weight > self.least;
        if !counts {
            return;
        }
        if self.len == MAX_CELLS {
            self.thin();
            return self.add(middle, half, weight, texel);
        }
        let cost = weight * super::cost_of(1.0 / texel);
        self.cells[self.len] = Cell { middle, half, weight, cost };
        self.len += 1;
    }

    /// Leaves out the cells with the fewest points: half of them at least where all have as many.
    fn thin(&mut self) {
        let total: f32 = self.as_slice().iter().map(|cell| cell.weight).sum();
        self.least = (self.least * 2.0).max(total / MAX_CELLS as f32 * 0.25);
        let mut kept = 0;
        for i in 0..self.len {
            if self.cells[i].weight > self.least {
                self.cells[kept] = self.cells[i];
                kept += 1;
            }
        }
        self.len = kept;
    }

    /// Adds the cells of a grid.
    pub(super) fn add_grid(&mut self, grid: &NeedGrid, plane: &Plane, origin: DVec3) {
        let offset = plane.of(plane.axes.project(grid.space.origin - origin));
        for level in 0..LEVELS {
            let scale = (1_u32 << level) as f32;
            let (side, texel) = (f64::from(grid.space.cell * scale), grid.space.texel * scale * MIDDLE);
            let rows = grid.counts[level * SIDE * SIDE..(level + 1) * SIDE * SIDE].chunks(SIDE);
            for (y, row) in rows.enumerate() {
                if row.iter().fold(0, |all, count| all | count) == 0 {
                    continue;
                }
                for (x, count) in row.iter().enumerate().filter(|(_, count)| **count > 0) {
                    let cell = DVec2::new(x as f64, y as f64) + 0.5 - (SIDE / 2) as f64;
                    self.add((cell * side + offset).as_vec2(), (side * 0.5) as f32, *count as f32, texel);
                }
            }
        }
    }
}

/// Middle of an octave of texels, over its least one.
const MIDDLE: f32 = core::f32::consts::SQRT_2;
