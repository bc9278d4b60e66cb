//! Images of the plain: turf, stone, masonry, bark, and cut-outs of leaves and grass.

use glam::Vec3;

use crate::Image;
use crate::parts::{bark, draw_noisy, grass, hash, numbered, shade, twig};

numbered! {
    /// An image, by its index in the scene.
    Picture: Image {
        Land = turf(),
        Stone = stone(),
        Masonry = masonry(),
        Bark = bark(),
        Twig = twig(),
        Grass = grass(Vec3::new(0.20, 0.25, 0.06), Vec3::new(0.46, 0.37, 0.15)),
    }
}

/// Size of the land's image in the scene, in metres.
pub(super) const LAND_METRES: f32 = 3.2;
/// Pixels along a side of the land's image. A pixel is 6 mm wide.
const LAND_SIZE: u32 = 512;
/// Pixels along a side of the other images.
const SIZE: u32 = 256;

/// Draws short strokes of turf, near white, so that the land's vertex colours tint them.
fn turf() -> Image {
    draw_noisy("turf", LAND_SIZE, [0.5, 2.0, 8.0], |x, y, [clouds, tufts, grains]| {
        let stroke = hash(x / 2 + 7 * (y / 7), 90 + y / 7) - 0.5;
        shade([206.0, 206.0, 200.0], 14.0 * clouds + 16.0 * tufts + 14.0 * grains + 34.0 * stroke)
    })
}

/// Draws weathered stone with lichen.
fn stone() -> Image {
    draw_noisy("stone", SIZE, [0.25, 2.0], |_, _, [cloud, grain]| {
        let light = 12.0 * cloud + 15.0 * grain;
        if grain - 0.3 * cloud > 0.86 { [212.0, 190.0, 118.0, 255.0] } else { shade([194.0, 190.0, 180.0], light) }
    })
}

/// Draws courses of rough blocks.
fn masonry() -> Image {
    let (course, length) = (SIZE as f32 / 8.0, SIZE as f32 / 4.0);
    draw_noisy("masonry", SIZE, [2.0], |x, y, [grain]| {
        let row = (y as f32 / course) as u32;
        let dy = (y as f32 % course).min(course - y as f32 % course);
        let along = x as f32 / length + 0.37 * hash(row, 3) + if row % 2 == 1 { 0.5 } else { 0.0 };
        let across = along.fract().min(1.0 - along.fract()) * length;
        let own = hash(along as u32 % 4, 50 + row) - 0.5;
        if across.min(dy) < 1.3 {
            return shade([138.0, 128.0, 114.0], 8.0 * grain);
        }
        shade([196.0, 186.0, 168.0], 36.0 * own + 12.0 * grain)
    })
}
