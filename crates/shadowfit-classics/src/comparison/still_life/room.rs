//! The floor and the wall behind it.

use glam::Vec3;
use shadowfit_scene::parts::{Builder, CRISP, block};

use super::SUNK;
use super::palette::Paint;

/// Half of the floor's width and depth, in metres.
pub(super) const HALF: f32 = 6.0;
/// Height of the wall, in metres.
const HEIGHT: f32 = 5.4;

/// Adds floor, wall and skirting board.
pub(super) fn build(builder: &mut Builder, group: usize) {
    let mut add = |name: &str, low: Vec3, high: Vec3, paint: Paint, edge: f32| {
        let mesh = builder.solid(name, &block(low, high, edge), paint, CRISP);
        builder.place(group, mesh, Vec3::ZERO, 0.0);
    };
    add("floor", Vec3::new(-HALF, -0.2, -HALF), Vec3::new(HALF, 0.0, HALF), Paint::Floor, 0.01);
    let back = -HALF + 0.3;
    add("wall", Vec3::new(-HALF, -0.19, -HALF - 0.1), Vec3::new(HALF, HEIGHT, back), Paint::Plaster, 0.01);
    let (low, high) = (Vec3::new(-HALF + 0.01, -SUNK, back - 0.1), Vec3::new(HALF - 0.01, 0.24, back + 0.05));
    add("skirting board", low, high, Paint::Skirting, 0.02);
}
