//! Thin slabs on a curved surface: windows, seams.

use glam::{Vec2, Vec3};
use shadowfit_scene::parts::Solid;

/// Step of the parameters for the finite differences of a surface's normal.
const STEP: f32 = 1e-3;

/// Part of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Panel {
    /// Middle, in the surface's parameters.
    pub(super) middle: Vec2,
    /// Half extent along each parameter.
    pub(super) half: Vec2,
    /// Roundness of the corners: 0 is a rectangle, 1 an ellipse.
    pub(super) round: f32,
    /// Height above the surface. The slab extends twice this depth into the surface.
    pub(super) proud: f32,
}

impl Panel {
    /// Creates a panel between two corners in the surface's parameters.
    pub(super) fn between(low: Vec2, high: Vec2, round: f32, proud: f32) -> Self {
        Self { middle: (low + high) / 2.0, half: (high - low) / 2.0, round, proud }
    }

    /// Builds the slab on a surface, with a grid of `steps` cells along each parameter. The outer side points
    /// along the cross product of the first parameter's direction and the second's.
    pub(super) fn solid(self, surface: impl Fn(Vec2) -> Vec3, steps: [u32; 2]) -> Solid {
        let [columns, rows] = steps.map(|count| count + 1);
        let mut solid = Solid::default();
        for depth in [self.proud, -2.0 * self.proud] {
            for row in 0..rows {
                for column in 0..columns {
                    let at = Vec2::new(column as f32 / steps[0] as f32, row as f32 / steps[1] as f32) * 2.0 - 1.0;
                    let bow = (1.0 - self.round / 2.0 * Vec2::new(at.y * at.y, at.x * at.x)).map(f32::sqrt);
                    let at = self.middle + self.half * at * bow;
                    solid.positions.push(surface(at) + normal(&surface, at) * depth);
                }
            }
        }
        let inner = columns * rows;
        let id = |column: u32, row: u32| row * columns + column;
        for row in 0..steps[1] {
            for column in 0..steps[0] {
                let [a, b] = [id(column, row), id(column + 1, row)];
                let [c, d] = [id(column + 1, row + 1), id(column, row + 1)];
                solid.triangles.extend([[a, b, c], [a, c, d]]);
                solid.triangles.extend([[a, c, b], [a, d, c]].map(|t| t.map(|index| index + inner)));
            }
        }
        let rim = (0..steps[0]).map(|column| id(column, 0));
        let rim = rim.chain((0..steps[1]).map(|row| id(steps[0], row)));
        let rim = rim.chain((0..steps[0]).map(|column| id(steps[0] - column, steps[1])));
        let rim: Vec<u32> = rim.chain((0..steps[1]).map(|row| id(0, steps[1] - row))).collect();
        for (index, &a) in rim.iter().enumerate() {
            let b = rim[(index + 1) % rim.len()];
            solid.triangles.extend([[a, a + inner, b + inner], [a, b + inner, b]]);
        }
        solid
    }
}

/// Returns the unit normal of a surface.
fn normal(surface: impl Fn(Vec2) -> Vec3, at: Vec2) -> Vec3 {
    let along = |step: Vec2| surface(at + step) - surface(at - step);
    along(Vec2::X * STEP).cross(along(Vec2::Y * STEP)).normalize_or(Vec3::Y)
}
