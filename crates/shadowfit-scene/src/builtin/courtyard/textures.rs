//! Images of the courtyard: paving with a metre grid, wall blocks, a lattice with holes.
//!
//! All images repeat without a seam. They are drawn from a fixed hash, so every machine draws the same
//! pixels.

use crate::Image;
use crate::parts::{NOISE_CELLS, Noise, draw, hash, numbered, shade};

numbered! {
    /// An image, by its index in the scene.
    Picture: Image {
        Paving = paving(),
        Blocks = blocks(),
        Lattice = lattice(),
    }
}

/// Size of the paving image in the scene, in metres: five tiles of a metre, with a stronger line around them.
pub(super) const PAVING_METRES: f32 = 5.0;
/// Size of the wall image in the scene, in metres.
pub(super) const BLOCKS_METRES: f32 = 2.4;
/// Size of the lattice image in the scene, in metres: one hole and the slats around it.
pub(super) const LATTICE_METRES: f32 = 0.15;

/// Pixels along a side of the paving image.
const PAVING_SIZE: u32 = 1024;
/// Pixels along a side of the wall image.
const BLOCKS_SIZE: u32 = 512;
/// Pixels along a side of the lattice image.
const LATTICE_SIZE: u32 = 64;

/// Draws warm stone tiles of a metre with joints, faint quarter-metre lines and a red line every 5 m.
fn paving() -> Image {
    let noise = Noise::new();
    let metre = PAVING_SIZE as f32 / PAVING_METRES;
    let cell = NOISE_CELLS as f32 / PAVING_SIZE as f32;
    // Distance in metres to the nearest multiple of `step` metres, for each row or column.
    let lines = |step: f32| -> Vec<f32> {
        let rest = |pixel: u32| ((pixel as f32 + 0.5) / metre).rem_euclid(step);
        (0..PAVING_SIZE).map(|pixel| rest(pixel).min(step - rest(pixel))).collect()
    };
    let [coarse, joints, fine] = &[PAVING_METRES, 1.0, 0.25].map(lines);
    let noise = &noise;
    draw("paving", PAVING_SIZE, |y| {
        let py = y as f32 + 0.5;
        let (clouds, grains) = (noise.row(py * cell), noise.row(py * cell * 8.0));
        move |x| {
            let px = x as f32 + 0.5;
            let edge = |lines: &[f32]| lines[x as usize].min(lines[y as usize]);
            let grain = grains.at(px * cell * 8.0);
            if edge(coarse) < 0.035 {
                return shade([138.0, 72.0, 52.0], 6.0 * grain);
            }
            let joint = edge(joints);
            if joint < 0.011 {
                return shade([108.0, 93.0, 75.0], 6.0 * grain);
            }
            let tile = hash((px / metre) as u32, 5 + (py / metre) as u32) - 0.5;
            let rim = if joint < 0.02 { -8.0 } else { 0.0 };
            let scratch = if edge(fine) < 0.005 { -11.0 } else { 0.0 };
            let light = 20.0 * tile + 5.0 * clouds.at(px * cell) + 4.0 * grain + rim + scratch;
            shade([178.0, 160.0, 133.0], light)
        }
    })
}

/// Draws courses of plastered blocks, each with its own tint, in half bond.
fn blocks() -> Image {
    let noise = &Noise::new();
    let cell = NOISE_CELLS as f32 / BLOCKS_SIZE as f32;
    // Six courses of three blocks.
    let course = BLOCKS_SIZE as f32 / 6.0;
    let length = BLOCKS_SIZE as f32 / 3.0;
    let joint = 0.012 * BLOCKS_SIZE as f32 / BLOCKS_METRES;
    draw("blocks", BLOCKS_SIZE, |y| {
        let py = y as f32 + 0.5;
        let (clouds, grains) = (noise.row(py * cell), noise.row(py * cell * 4.0));
        let row = (py / course) as u32;
        let dy = (py % course).min(course - py % course);
        move |x| {
            let px = x as f32 + 0.5;
            let along = px / length + if row % 2 == 1 { 0.5 } else { 0.0 };
            let across = (along - along.floor()) * length;
            let grain = grains.at(px * cell * 4.0);
            if across.min(length - across).min(dy) < joint {
                return shade([188.0, 172.0, 148.0], 5.0 * grain);
            }
            let tint = hash(along as u32 % 3, 40 + row) - 0.5;
            shade([222.0, 208.0, 184.0], 13.0 * tint + 5.0 * clouds.at(px * cell) + 3.0 * grain)
        }
    })
}

/// Draws white slats around a square hole, which is transparent.
fn lattice() -> Image {
    let size = LATTICE_SIZE as f32;
    let slat = size * 0.16;
    draw("lattice", LATTICE_SIZE, |y| {
        let py = y as f32 + 0.5;
        move |x| {
            let px = x as f32 + 0.5;
            let edge = px.min(size - px).min(py).min(size - py);
            // Alpha passes 0.5 at the edge of the slat, so that filtered cut-outs keep their size.
            let alpha = (127.5 + (slat - edge) * 40.0).clamp(0.0, 255.0);
            [235.0, 235.0, 235.0, alpha]
        }
    })
}
