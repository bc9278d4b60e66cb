//! Thin slabs that lie on a curved surface: windows, seams.

use glam::{Vec2, Vec3};
use shadowfit_scene::parts::Solid;

/// Step of the parameters over which a surface's normal is taken.
const STEP: f32 = 1e-3;

/// Part of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Panel {
    /// Middle, in the surface's parameters.
    pub(super) middle: Vec2,
    /// Half extent along each parameter.
    pub(super) half: Vec2,
    /// How round the corners are: 0 has right angles, 1 is an ellipse.
    pub(super) round: f32,
    /// How far it stands out; it goes twice as deep into the surface.
    pub(super) proud: f32,
}

impl Panel {
    /// From one corner in the surface's parameters to the other.
    pub(super) fn between(low: Vec2, high: Vec2, round: f32, proud: f32) -> Self {
        Self { middle: (low + high) / 2.0, half: (high - low) / 2.0, round, proud }
    }

    /// The slab on a surface, whose outer side is where its first parameter's direction × its second's points, in a
    /// grid of `steps` cells along each.
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

/// Unit normal of a surface.
fn normal(surface: impl Fn(Vec2) -> Vec3, at: Vec2) -> Vec3 {
    let along = |step: Vec2| surface(at + step) - surface(at - step);
    along(Vec2::X * STEP).cross(along(Vec2::Y * STEP)).normalize_or(Vec3::Y)
}
