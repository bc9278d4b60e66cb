//! Images of the arcade: floor tiles, plaster, stone, roof tiles, leaves.

use crate::Image;
use crate::parts::{NOISE_CELLS, Noise, draw, draw_noisy, hash, numbered, shade, twig};

numbered! {
    /// An image, by its index in the scene.
    Picture: Image {
        Tiles = tiles(),
        Plaster = plaster(),
        Stone = stone(),
        Roof = roof(),
        Twig = twig(),
    }
}

/// Size of the floor's image in the scene, in metres.
pub(super) const TILES_METRES: f32 = 2.4;
/// Pixels along a side of the floor's image. A pixel is 5 mm wide.
const TILES_SIZE: u32 = 512;
/// Pixels along a side of the other images.
const SIZE: u32 = 256;
/// Tiles along each diagonal of the floor's image. An even number, so that the image repeats without a seam.
const DIAGONALS: f32 = 4.0;

/// Draws cream and terracotta tiles set diagonally, with dark joints.
fn tiles() -> Image {
    let noise = &Noise::new();
    let cell = NOISE_CELLS as f32 / TILES_SIZE as f32;
    let size = TILES_SIZE as f32 / DIAGONALS;
    let joint = 0.007 * TILES_SIZE as f32 / TILES_METRES;
    draw("floor tiles", TILES_SIZE, |y| {
        let (clouds, grains) = (noise.row(y as f32 * cell), noise.row(y as f32 * cell * 8.0));
        move |x| {
            let (px, py) = (x as f32 + 0.5, y as f32 + 0.5);
            let [a, b] = [(px + py) / size, (px - py) / size + DIAGONALS];
            let edge = |value: f32| (value.fract().min(1.0 - value.fract())) * size;
            let grain = grains.at(px * cell * 8.0);
            if edge(a).min(edge(b)) < joint * std::f32::consts::SQRT_2 {
                return shade([112.0, 98.0, 82.0], 5.0 * grain);
            }
            let [column, row] = [a as u32 % 8, b as u32 % 8];
            // The image repeats after the same number of tiles along x and along y.
            let id = |a: u32, b: u32| (a.midpoint(b) % 4, a.midpoint(8 - b) % 4);
            let own = hash(id(column, row).0, 60 + id(column, row).1) - 0.5;
            let light = 13.0 * own + 5.0 * clouds.at(px * cell) + 3.0 * grain;
            if (column + row) % 2 == 0 {
                shade([208.0, 190.0, 160.0], light)
            } else {
                shade([160.0, 92.0, 66.0], light)
            }
        }
    })
}

/// Draws lime plaster: soft clouds with a few paler patches, near white so that materials tint it.
fn plaster() -> Image {
    draw_noisy("plaster", SIZE, [0.125, 0.5, 4.0], |_, _, [patches, clouds, grains]| {
        shade([236.0, 236.0, 236.0], 7.0 * patches + 5.0 * clouds + 4.0 * grains)
    })
}

/// Draws limestone: coarse grain with pits.
fn stone() -> Image {
    draw_noisy("stone", SIZE, [0.25, 3.0], |_, _, [cloud, grain]| {
        let pit = if grain > 0.78 { -22.0 } else { 0.0 };
        shade([206.0, 198.0, 184.0], 10.0 * cloud + 9.0 * grain + pit)
    })
}

/// Draws rows of round roof tiles, four across and two along.
fn roof() -> Image {
    let size = SIZE as f32;
    draw("roof tiles", SIZE, |y| {
        move |x| {
            let (across, along) = (x as f32 / size * 4.0, y as f32 / size * 2.0);
            let hump = (across.fract() * std::f32::consts::PI).sin();
            let own = hash(across as u32, 80 + along as u32) - 0.5;
            let edge = if along.fract() < 0.08 { -46.0 } else { 14.0 * along.fract() };
            shade([168.0, 92.0, 62.0], 62.0 * (hump - 0.75) + 26.0 * own + edge)
        }
    })
}
