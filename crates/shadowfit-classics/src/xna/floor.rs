//! The floor: a square of pale stone with a grid for reading distances.

use shadowfit_scene::parts::{Builder, draw_noisy, ground, hash, matt, shade, tiled};
use shadowfit_scene::{Image, Material, Transform};

/// Half of the floor's side, in the sample's units.
const HALF: f32 = 130.0;
/// Side of a cell of the grid, in the sample's units.
const CELL: f32 = 10.0;
/// Cells along a side of the image. An even number, so that light and dark ones also alternate across its
/// edge.
const CELLS: u32 = 8;
/// Pixels along a side of the image: 13 per unit. The sample's camera shows fewer than 6 per unit.
const SIZE: u32 = 1024;
/// Half of the width of a grid line, in the sample's units: two pixels of a picture 480 high.
const LINE: f32 = 0.22;

/// Returns the floor's material, with the image of index 0.
pub(super) fn material() -> Material {
    tiled(matt("grid floor", [1.0; 3], 0.9), 0, [CELL * CELLS as f32; 2])
}

/// Draws pale cells with fine lines between. Every second cell is slightly darker, and each has its own tint.
pub(super) fn image() -> Image {
    let cell = (SIZE / CELLS) as f32;
    let line = LINE / CELL * cell;
    draw_noisy("grid", SIZE, [1.0, 4.0], |x, y, [cloud, grain]| {
        let away = |pixel: u32| {
            let rest = (pixel as f32 + 0.5) % cell;
            rest.min(cell - rest)
        };
        // The line's edge is spread over two pixels.
        let stone = ((away(x).min(away(y)) - line) / 2.0 + 0.5).clamp(0.0, 1.0);
        let [column, row] = [x, y].map(|pixel| (pixel as f32 / cell) as u32);
        let own = 9.0 * (hash(column, 60 + row) - 0.5);
        let is_dark = (column + row) % 2 == 1;
        let base = if is_dark { [190.0, 185.0, 174.0] } else { [216.0, 211.0, 199.0] };
        let color = base.map(|value| 100.0 + (value + own - 100.0) * stone);
        shade(color, 5.0 * cloud + 4.0 * grain)
    })
}

/// Adds the floor.
pub(super) fn build(builder: &mut Builder) {
    let line = [-HALF, HALF];
    let mut sheet = ground(0, [&line, &line], |_, _| 0.0, |_| glam::Vec3::ONE);
    sheet.colors.clear();
    let floor = builder.mesh("grid floor", vec![sheet]);
    builder.node("grid floor", None, Transform::default(), Some(floor));
}
