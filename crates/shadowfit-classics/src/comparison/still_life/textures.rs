//! Images of the still life: boards, plaster, stone, the squares of the chess board.

use shadowfit_scene::Image;
use shadowfit_scene::parts::{NOISE_CELLS, Noise, draw, draw_noisy, hash, numbered, shade};

numbered! {
    /// An image, by its index in the scene.
    Picture: Image {
        Floor = floor(),
        Plaster = plaster(),
        Stone = stone(),
        Squares = squares(),
    }
}

/// Size of the floor's image in the scene, in metres.
pub(super) const FLOOR_METRES: f32 = 4.0;
/// Size of the wall's image in the scene, in metres.
pub(super) const PLASTER_METRES: f32 = 3.3;
/// Size of the stone's image in the scene, in metres.
pub(super) const STONE_METRES: f32 = 1.6;
/// Size of the squares' image in the scene, in metres. It shows two by two squares.
pub(super) const SQUARES_METRES: f32 = 1.0;
/// Boards across the floor's image.
const BOARDS: f32 = 10.0;
/// Pixels along a side of the floor's image.
const FLOOR_SIZE: u32 = 512;
/// Pixels along a side of the other images.
const SIZE: u32 = 256;

/// Draws boards along u, two in a row. Each row's joint is at another place. The image is mirrored at its
/// ends, and grain runs along the boards.
fn floor() -> Image {
    let noise = &Noise::new();
    let cell = NOISE_CELLS as f32 / FLOOR_SIZE as f32;
    let width = FLOOR_SIZE as f32 / BOARDS;
    let length = FLOOR_SIZE as f32 / 2.0;
    draw("boards", FLOOR_SIZE, |y| {
        let py = y as f32 + 0.5;
        let row = (py / width) as u32;
        let from_edge = (py % width).min(width - py % width);
        // Each row has its own grain: noise compressed across the board.
        let (veins, fine) = (noise.row(py * cell * 3.0 + 7.0 * row as f32), noise.row(py * cell * 8.0));
        let start = hash(row, 3);
        move |x| {
            let px = x as f32 + 0.5;
            let along = px / length + start * 2.0;
            let from_end = along.fract().min(1.0 - along.fract()) * length;
            if from_edge < 0.9 || from_end < 0.9 {
                return shade([66.0, 42.0, 26.0], 0.0);
            }
            let tint = hash(along as u32 % 2, 20 + row) - 0.5;
            let vein = veins.at(px * cell * 0.25);
            shade([158.0, 110.0, 68.0], 34.0 * tint + 12.0 * vein + 6.0 * fine.at(px * cell))
        }
    })
}

/// Draws lime plaster in a warm grey.
fn plaster() -> Image {
    draw_noisy("plaster", SIZE, [0.125, 0.5, 4.0], |_, _, [patches, clouds, grains]| {
        shade([206.0, 196.0, 178.0], 7.0 * patches + 5.0 * clouds + 4.0 * grains)
    })
}

/// Draws limestone: soft clouds, fine grain and pits.
fn stone() -> Image {
    draw_noisy("stone", SIZE, [0.25, 4.0], |_, _, [cloud, grain]| {
        let pit = if grain > 0.8 { -18.0 } else { 0.0 };
        shade([204.0, 194.0, 174.0], 9.0 * cloud + 7.0 * grain + pit)
    })
}

/// Draws two by two squares of maple and walnut.
fn squares() -> Image {
    draw_noisy("squares", SIZE, [1.0, 4.0], |x, y, [cloud, grain]| {
        let color = if x / (SIZE / 2) == y / (SIZE / 2) { [206.0, 176.0, 128.0] } else { [92.0, 56.0, 34.0] };
        shade(color, 8.0 * cloud + 6.0 * grain)
    })
}
