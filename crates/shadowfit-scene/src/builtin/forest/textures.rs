//! Images of the forest: litter, moss, bark, and cut-outs of leaves.

use glam::{Vec2, Vec3};

use crate::Image;
use crate::parts::{Dice, NOISE_CELLS, Noise, bark, draw, draw_noisy, fern, grass, numbered, twig};

numbered! {
    /// An image, by its index in the scene.
    Picture: Image {
        Floor = floor(),
        Stone = stone(),
        Bark = bark(),
        Birch = birch(),
        Twig = twig(),
        Fern = fern(),
        Grass = grass(Vec3::new(0.10, 0.24, 0.035), Vec3::new(0.25, 0.33, 0.07)),
    }
}

/// Pixels along a side of the floor's image. A pixel is 6 mm wide.
const FLOOR_SIZE: u32 = 512;
/// Pixels along a side of the images of bark and stone.
const BARK_SIZE: u32 = 256;
/// Fallen leaves on the floor's image, enough to hide most of the earth.
const LITTER: usize = 1500;

/// Draws earth under brown leaves.
fn floor() -> Image {
    let mut image = draw_noisy("floor", FLOOR_SIZE, [0.25, 4.0], |_, _, [cloud, grain]| {
        let light = 8.0 * cloud + 12.0 * grain;
        [96.0 + light, 76.0 + light * 0.9, 54.0 + light * 0.7, 255.0]
    });
    let mut dice = Dice::new(31);
    for _ in 0..LITTER {
        fallen_leaf(&mut image, &mut dice);
    }
    image
}

/// Draws a leaf at a random place. It wraps around at the edges of the image.
fn fallen_leaf(image: &mut Image, dice: &mut Dice) {
    let size = FLOOR_SIZE.cast_signed();
    let middle = Vec2::new(dice.roll(), dice.roll()) * FLOOR_SIZE as f32;
    let ahead = Vec2::from_angle(dice.between(0.0, std::f32::consts::TAU));
    let half_length = dice.between(5.0, 10.5);
    let tint = dice.roll();
    let mut color = Vec3::new(136.0, 97.0, 58.0).lerp(Vec3::new(188.0, 152.0, 98.0), tint) * dice.between(0.72, 1.12);
    if dice.roll() < 0.10 {
        color = Vec3::new(104.0, 112.0, 54.0);
    }
    let reach = half_length as i32 + 1;
    for dy in -reach..=reach {
        for dx in -reach..=reach {
            let offset = Vec2::new(dx as f32, dy as f32);
            let (along, across) = (offset.dot(ahead) / half_length, offset.perp_dot(ahead));
            let half_width = 0.42 * half_length * (1.0 - along * along);
            if along.abs() >= 1.0 || across.abs() > half_width {
                continue;
            }
            // A dark line at one side separates the leaf from its background.
            let light = if across.abs() < 0.6 {
                0.8
            } else if across > half_width - 1.0 {
                0.62
            } else {
                1.0
            };
            let x = (middle.x as i32 + dx).rem_euclid(size);
            let y = (middle.y as i32 + dy).rem_euclid(size);
            let at = ((y * size + x) * 4) as usize;
            for (channel, value) in (color * light).to_array().into_iter().enumerate() {
                image.rgba[at + channel] = value as u8;
            }
        }
    }
}

/// Draws grey stone with patches of moss.
fn stone() -> Image {
    draw_noisy("stone", BARK_SIZE, [0.25, 2.0], |_, _, [cloud, grain]| {
        let light = 14.0 * grain;
        if cloud + 0.25 * grain > 0.05 {
            [84.0 + light, 102.0 + light, 46.0 + light * 0.6, 255.0]
        } else {
            [134.0 + light, 130.0 + light, 120.0 + light, 255.0]
        }
    })
}

/// Draws white bark with dark dashes across.
fn birch() -> Image {
    let noise = &Noise::new();
    let cell = NOISE_CELLS as f32 / BARK_SIZE as f32;
    draw("birch", BARK_SIZE, |y| {
        let (dashes, clouds) = (noise.row(y as f32 * cell), noise.row(y as f32 * cell * 0.25));
        move |x| {
            let dash = dashes.at(x as f32 * cell * 0.125);
            let cloud = clouds.at(x as f32 * cell * 0.25);
            let light = 9.0 * cloud;
            if dash > 0.46 - 0.25 * cloud {
                [62.0, 56.0, 52.0, 255.0]
            } else if dash > 0.36 - 0.2 * cloud {
                [168.0 + light, 160.0 + light, 148.0 + light, 255.0]
            } else {
                [222.0 + light, 216.0 + light, 204.0 + light, 255.0]
            }
        }
    })
}
