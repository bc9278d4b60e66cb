//! Images of the town: cobbles, paving slabs, plaster, masonry, roof tiles, cloth, turf, bark and leaves.

use crate::Image;
use crate::parts::{bark, draw, draw_noisy, hash, numbered, shade, twig};

numbered! {
    /// An image, by its index in the scene.
    Picture: Image {
        Cobbles = cobbles(),
        Slabs = slabs(),
        Plaster = plaster(),
        Masonry = masonry(),
        Roof = roof(),
        Stripes = stripes(),
        Turf = turf(),
        Bark = bark(),
        Twig = twig(),
    }
}

/// Metres that the image of the cobbles spans.
pub(super) const COBBLE_METRES: f32 = 3.2;
/// Pixels along a side of the image of the cobbles: 6 mm each.
const COBBLE_SIZE: u32 = 512;
/// Rows of cobbles in their image: even, so that the half bond repeats.
const COBBLE_ROWS: f32 = 24.0;
/// Cobbles of a row in their image.
const COBBLES_ACROSS: f32 = 20.0;
/// Pixels along a side of the other images.
const SIZE: u32 = 256;

/// Draws rounded setts in half bond, each with its own grey.
fn cobbles() -> Image {
    let (tall, wide) = (COBBLE_SIZE as f32 / COBBLE_ROWS, COBBLE_SIZE as f32 / COBBLES_ACROSS);
    draw_noisy("cobbles", COBBLE_SIZE, [0.25, 4.0], |x, y, [cloud, grain]| {
        let row = (y as f32 / tall) as u32;
        let shift = 0.5 * (row % 2) as f32 + 0.3 * hash(row, 31);
        let along = x as f32 / wide + shift;
        let column = along as u32 % COBBLES_ACROSS as u32;
        let (dx, dy) = (along.fract() - 0.5, (y as f32 / tall).fract() - 0.5);
        // Distance from the stone's middle: 1 at its rim. The fourth power makes a rounded rectangle.
        let rim = ((2.1 * dx).powi(4) + (2.15 * dy).powi(4)).sqrt().sqrt();
        if rim > 0.95 {
            return shade([96.0, 90.0, 80.0], 8.0 * grain);
        }
        let [own, warm] = [51, 77].map(|seed| hash(column, seed + row) - 0.5);
        let light = 34.0 * own + 10.0 * cloud + 9.0 * grain - 26.0 * rim * rim * rim;
        shade([182.0 + 14.0 * warm, 176.0, 166.0 - 14.0 * warm], light)
    })
}

/// Draws square slabs of half a metre with joints.
fn slabs() -> Image {
    let side = SIZE as f32 / 4.0;
    draw_noisy("slabs", SIZE, [0.5, 4.0], |x, y, [cloud, grain]| {
        let edge = |value: f32| (value % side).min(side - value % side);
        if edge(x as f32 + 0.5).min(edge(y as f32 + 0.5)) < 1.2 {
            return shade([126.0, 118.0, 104.0], 6.0 * grain);
        }
        let own = hash((x as f32 / side) as u32, 21 + (y as f32 / side) as u32) - 0.5;
        shade([196.0, 188.0, 174.0], 20.0 * own + 8.0 * cloud + 6.0 * grain)
    })
}

/// Draws lime plaster with clouds and paler patches, near white so that materials tint it.
fn plaster() -> Image {
    draw_noisy("plaster", SIZE, [0.125, 0.5, 4.0], |_, _, [patches, clouds, grains]| {
        shade([232.0, 232.0, 232.0], 10.0 * patches + 7.0 * clouds + 4.0 * grains)
    })
}

/// Draws courses of cut blocks in half bond.
fn masonry() -> Image {
    let (course, length) = (SIZE as f32 / 6.0, SIZE as f32 / 3.0);
    draw_noisy("masonry", SIZE, [0.5, 3.0], |x, y, [cloud, grain]| {
        let row = (y as f32 / course) as u32;
        let dy = (y as f32 % course).min(course - y as f32 % course);
        let along = x as f32 / length + 0.5 * (row % 2) as f32;
        let across = along.fract().min(1.0 - along.fract()) * length;
        if across.min(dy) < 1.4 {
            return shade([168.0, 158.0, 142.0], 8.0 * grain);
        }
        let own = hash(along as u32 % 3, 50 + row) - 0.5;
        shade([212.0, 206.0, 196.0], 26.0 * own + 9.0 * cloud + 7.0 * grain)
    })
}

/// Draws rows of round roof tiles, four across and three along.
fn roof() -> Image {
    let size = SIZE as f32;
    draw("roof tiles", SIZE, |y| {
        move |x| {
            let (across, along) = (x as f32 / size * 4.0, y as f32 / size * 3.0);
            let hump = (across.fract() * std::f32::consts::PI).sin();
            let own = hash(across as u32, 80 + along as u32) - 0.5;
            let edge = if along.fract() > 0.9 { -46.0 } else { 16.0 * along.fract() };
            shade([214.0, 212.0, 208.0], 46.0 * (hump - 0.75) + 34.0 * own + edge)
        }
    })
}

/// Draws broad red and cream stripes of awnings.
fn stripes() -> Image {
    draw("stripes", SIZE, |_| |x| if x < SIZE / 2 { [158.0, 62.0, 50.0, 255.0] } else { [222.0, 212.0, 188.0, 255.0] })
}

/// Draws short strokes of turf.
fn turf() -> Image {
    draw_noisy("turf", SIZE, [0.5, 2.0, 8.0], |x, y, [clouds, tufts, grains]| {
        let stroke = hash(x / 2 + 7 * (y / 7), 90 + y / 7) - 0.5;
        shade([118.0, 136.0, 70.0], 12.0 * clouds + 14.0 * tufts + 10.0 * grains + 26.0 * stroke)
    })
}
