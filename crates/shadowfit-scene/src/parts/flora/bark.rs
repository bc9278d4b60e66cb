//! The image of bark.

use crate::Image;
use crate::parts::pixels::{NOISE_CELLS, Noise, draw};

/// Pixels along a side of the image.
const SIZE: u32 = 256;

/// Draws furrowed grey-brown bark with a hint of green.
pub fn bark() -> Image {
    let noise = &Noise::new();
    let cell = NOISE_CELLS as f32 / SIZE as f32;
    draw("bark", SIZE, |y| {
        let (furrows, wander) = (noise.row(y as f32 * cell * 0.5), noise.row(y as f32 * cell));
        let grains = noise.row(y as f32 * cell * 4.0);
        move |x| {
            let across = x as f32 * cell + 0.8 * wander.at(x as f32 * cell);
            let furrow = furrows.at((across * 2.0).max(0.0)).abs();
            let moss = 10.0 * wander.at(x as f32 * cell * 0.25).max(0.0);
            let light = -44.0 * (1.0 - furrow * 2.6).max(0.0) + 9.0 * grains.at(x as f32 * cell * 4.0);
            [146.0 + light - moss * 0.5, 132.0 + light + moss, 112.0 + light - moss * 0.5, 255.0]
        }
    })
}
