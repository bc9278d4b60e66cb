//! The columns and the low wall below them.

use glam::Vec3;

use super::palette::Paint;
use super::plan::{BAY, ROW, SPRING, bay_middles, column_places};
use crate::parts::{Builder, CRISP, lathe, pillar};

/// Height of the low wall between the columns, in metres: the height of a seat.
const SEAT: f32 = 0.48;
/// Bays without a low wall, open toward the garden.
const OPEN: [usize; 2] = [4, 8];

/// Adds columns and low walls.
pub(super) fn build(builder: &mut Builder) {
    let group = builder.group("columns", Vec3::ZERO, 0.0);
    let column = column(builder, "column", 22);
    for z in column_places() {
        builder.place(group, column, [ROW, 0.0, z], 0.0);
    }
    let half = BAY / 2.0 - 0.3;
    let wall = pillar([0.2, half], [-0.02, SEAT - 0.05], 0.012).with(pillar([0.25, half], [SEAT - 0.07, SEAT], 0.02));
    let wall = builder.solid("low wall", &wall, Paint::Stone, CRISP);
    for (_, z) in bay_middles().enumerate().filter(|(bay, _)| !OPEN.contains(bay)) {
        builder.place(group, wall, [ROW, 0.0, z], 0.0);
    }
}

/// Adds the mesh of a column. Base, shaft and capital are round. The plinth, and the abacus that carries the
/// arches, are square.
pub(super) fn column(builder: &mut Builder, name: &str, segments: usize) -> usize {
    let base = [(0.30, 0.56), (0.328, 0.58), (0.335, 0.60), (0.328, 0.62), (0.30, 0.64), (0.27, 0.65)];
    let waist = [(0.275, 0.69), (0.29, 0.71), (0.25, 0.735)];
    let shaft = [(0.232, 0.76), (0.24, 1.2), (0.21, 2.02), (0.225, 2.03)];
    let capital = [(0.24, 2.045), (0.208, 2.065), (0.214, 2.13), (0.24, 2.21), (0.32, 2.33)];
    let top = [(0.335, 2.355), (0.33, 2.37), (0.30, 2.378)];
    let round = lathe(&[&base[..], &waist, &shaft, &capital, &top].concat(), segments);
    let stand = pillar([0.36; 2], [-0.02, SEAT + 0.09], 0.012);
    let square = stand.with(pillar([0.37, 0.41], [2.37, SPRING + 0.01], 0.02));
    builder.solids(name, [(round, Paint::Marble, 0.75), (square, Paint::Stone, CRISP)])
}
