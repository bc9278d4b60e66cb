//! The image of the strip: asphalt, kerb, paving and bricks side by side along u.
//!
//! It repeats mirrored. Along v it spans 4.4 units, and mirroring continues the pattern at both ends. Along u
//! it is mirrored at 0, the middle of the road, and at 1, half the height of the wall.

use shadowfit_scene::Image;
use shadowfit_scene::parts::{NOISE_CELLS, Noise, draw_oblong, hash, shade};

/// Width and height in pixels, with similar pixels per unit along the strip and across road, pavement and
/// wall.
const SIZE: [u32; 2] = [1024, 128];
/// Units that the image spans along v. It repeats 25 times on the strip of 110 units.
const LENGTH: f32 = 4.4;

/// Noise at a pixel: clouds of one or two units, and grains.
#[derive(Clone, Copy)]
struct Grit {
    cloud: f32,
    grain: f32,
}

/// Draws the image.
pub(super) fn image() -> Image {
    let noise = &Noise::new();
    let cell = NOISE_CELLS as f32 / SIZE[0] as f32;
    draw_oblong("street", SIZE, |y| {
        let py = y as f32 + 0.5;
        let along = py / SIZE[1] as f32 * LENGTH;
        let (clouds, grains) = (noise.row(py * cell), noise.row(py * cell * 9.0 + 20.0));
        move |x| {
            let px = x as f32 + 0.5;
            let u = px / SIZE[0] as f32;
            let grit = Grit { cloud: clouds.at(px * cell), grain: grains.at(px * cell * 9.0) };
            // Position across each face in units, from its start.
            match u {
                ..0.25 => asphalt(u * 44.0, along, grit),
                ..0.375 => kerb_face((u - 0.25) * 8.0, along, grit),
                ..0.5 => kerb_top((u - 0.375) * 8.0, along, grit),
                ..0.75 => paving((u - 0.5) * 40.0, along, grit),
                _ => wall((u - 0.75) * 40.0, along, grit),
            }
        }
    })
}

/// Returns the colour of half of the road, from its middle: a broken white line, worn tracks, and a gutter of
/// stone at the kerb.
fn asphalt(across: f32, along: f32, grit: Grit) -> [f32; 4] {
    if across < 0.32 && along < LENGTH / 2.0 {
        return shade([196.0, 194.0, 184.0], 9.0 * grit.grain + 8.0 * grit.cloud);
    }
    if across > 10.1 {
        let joint = if across < 10.17 { -26.0 } else { 0.0 };
        return shade([104.0, 102.0, 98.0], 8.0 * grit.grain + 5.0 * grit.cloud + joint);
    }
    // Wheels run at two distances from the middle.
    let track = [3.0, 8.0].map(|at| (1.0 - (across - at).abs() / 1.3).max(0.0));
    shade([82.0, 82.0, 85.0], 11.0 * grit.grain + 4.0 * grit.cloud + 9.0 * track[0].max(track[1]))
}

/// Returns the colour of the kerb's upright face, darker toward the gutter.
fn kerb_face(up: f32, along: f32, grit: Grit) -> [f32; 4] {
    let joint = if along < 0.04 { -50.0 } else { 0.0 };
    shade([142.0, 138.0, 130.0], 9.0 * grit.grain + 5.0 * grit.cloud + joint - 30.0 * (1.0 - up).powi(2))
}

/// Returns the colour of the kerb's top, with a pale edge toward the road.
fn kerb_top(across: f32, along: f32, grit: Grit) -> [f32; 4] {
    let joint = if along < 0.04 || across > 0.95 { -50.0 } else { 0.0 };
    let edge = if across < 0.08 { 14.0 } else { 0.0 };
    shade([166.0, 161.0, 151.0], 8.0 * grit.grain + 5.0 * grit.cloud + joint + edge)
}

/// Returns the colour of six rows of slabs in half bond.
fn paving(across: f32, along: f32, grit: Grit) -> [f32; 4] {
    let (row, from_row) = cell(across, 10.0 / 6.0, 0.0);
    let bond = if row % 2 == 0 { 0.0 } else { 0.5 };
    let (slab, from_slab) = cell(along, LENGTH / 2.0, bond);
    if from_row.min(from_slab) < 0.035 {
        return shade([92.0, 87.0, 80.0], 6.0 * grit.grain);
    }
    let tint = hash(slab, 11 + row) - 0.5;
    shade([152.0, 146.0, 135.0], 16.0 * tint + 7.0 * grit.grain + 5.0 * grit.cloud)
}

/// Returns the colour of the lower half of the wall: a course of stone at its foot, and bricks in half bond
/// up to the middle of a course, which the mirrored half completes.
fn wall(up: f32, along: f32, grit: Grit) -> [f32; 4] {
    const FOOT: f32 = 1.2;
    if up < FOOT {
        let (_, from_stone) = cell(along, LENGTH / 2.0, 0.5);
        let joint = if from_stone.min(FOOT - up) < 0.045 { -44.0 } else { 0.0 };
        return shade([150.0, 140.0, 124.0], 8.0 * grit.grain + 6.0 * grit.cloud + joint);
    }
    let (course, from_course) = cell(up - FOOT, (10.0 - FOOT) / 16.5, 0.0);
    let bond = if course % 2 == 0 { 0.0 } else { 0.5 };
    let (brick, from_brick) = cell(along, LENGTH / 4.0, bond);
    if from_course.min(from_brick) < 0.04 {
        return shade([158.0, 148.0, 134.0], 6.0 * grit.grain);
    }
    let [tint, burnt] = [hash(brick, 40 + course), hash(brick, 90 + course)];
    let color = if burnt > 0.86 { [122.0, 72.0, 62.0] } else { [148.0, 90.0, 72.0] };
    shade(color, 26.0 * (tint - 0.5) + 7.0 * grit.grain + 5.0 * grit.cloud)
}

/// Returns the cell of length `length` that contains a position, and the distance from its ends. The cells
/// are shifted by a share of their length.
fn cell(position: f32, length: f32, shift: f32) -> (u32, f32) {
    let cells = position / length + shift;
    let within = cells.fract() * length;
    (cells as u32, within.min(length - within))
}
