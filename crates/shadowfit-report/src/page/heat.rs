//! Heat maps of pixels per texel, with a legend.
//!
//! The scale is logarithmic, since doubling the texel size is the same loss anywhere on it. The colour ramp
//! is viridis, which is perceptually uniform and readable for the colour-blind.

use anyhow::{Result, ensure};
use image::{Rgba, RgbaImage};
use plotters::style::colors::colormaps::ViridisRGB;
use plotters::style::text_anchor::HPos;

use super::strip::{Strip, width};

/// Ends of the scale, as log2 of pixels per texel. Texels below a quarter of a pixel are invisible, and
/// texels of 32 pixels are very coarse.
const OCTAVES: [f32; 2] = [-2.0, 5.0];
/// Colour of pixels that no map covers or that have no surface. The ramp contains no grey.
const NONE: [u8; 3] = [58, 60, 64];
/// Colour of the mark at one pixel per texel.
const MARK: [u8; 3] = [255, 255, 255];
/// Number of lines of the legend: title, ramp and ticks.
const LINES: u32 = 3;
/// Margin beside the ramp, in pixels at scale 1: half the width of its end labels.
const MARGIN: f32 = 24.0;
/// Half of the mark's width, in pixels at scale 1.
const HALF_MARK: f32 = 1.5;

/// Draws the heat map of pixels per texel with its legend below. Values are in rows from the top. Infinity or
/// NaN means that no map covers the pixel.
///
/// # Errors
///
/// If the numbers of values and pixels differ, or there are none.
pub fn heat(size: [u32; 2], pixels_per_texel: &[f32]) -> Result<RgbaImage> {
    let [columns, rows] = size;
    let pixels = columns as usize * rows as usize;
    ensure!(pixels == pixels_per_texel.len() && pixels > 0, "{pixels} pixels, but {} values", pixels_per_texel.len());
    let mut map = RgbaImage::new(columns, rows);
    for (pixel, &value) in map.pixels_mut().zip(pixels_per_texel) {
        let [r, g, b] = colour(value);
        *pixel = Rgba([r, g, b, u8::MAX]);
    }
    legend(columns).map(|strip| strip.below(&map))
}

/// Returns the colour of a value, sRGB.
fn colour(pixels_per_texel: f32) -> [u8; 3] {
    if !pixels_per_texel.is_finite() || pixels_per_texel < 0.0 {
        return NONE;
    }
    ramp(place(pixels_per_texel))
}

/// Returns the position of a value on the ramp, 0..=1.
fn place(pixels_per_texel: f32) -> f32 {
    let [low, high] = OCTAVES;
    ((pixels_per_texel.log2() - low) / (high - low)).clamp(0.0, 1.0)
}

fn ramp(place: f32) -> [u8; 3] {
    let colour = ViridisRGB::get_color_normalized(place, 0.0, 1.0);
    [colour.0, colour.1, colour.2]
}

fn legend(picture_width: u32) -> Result<Strip> {
    let mut strip = Strip::new(picture_width, LINES);
    let scale = strip.scale;
    let [left, right] = [MARGIN * scale, picture_width as f32 - MARGIN * scale];
    let x = |place: f32| left + (right - left) * place;
    let full = "screen pixels per shadow texel";
    let room = |text: &str| width(text, scale) < x(place(1.0)).max(picture_width as f32 - x(place(1.0)));
    let title = if room(full) { full } else { "pixels per texel" };
    strip.write(title, right + MARGIN * 0.6 * scale, 0.45, HPos::Right)?;
    for pixel in left as u32..right as u32 {
        let place = (pixel as f32 - left) / (right - left);
        strip.fill([pixel as f32, pixel as f32 + 1.0], [1.0, 1.85], ramp(place.clamp(0.0, 1.0)));
    }
    let one = x(place(1.0));
    strip.fill([one - HALF_MARK * scale, one + HALF_MARK * scale], [0.85, 2.0], MARK);
    strip.write("1: sharp", one, 0.45, HPos::Center)?;
    for octave in OCTAVES[0] as i32..=OCTAVES[1] as i32 {
        let text = match octave {
            0.. => (1 << octave).to_string(),
            _ => format!("1/{}", 1 << -octave),
        };
        strip.write(&text, x(place((octave as f32).exp2())), 2.45, HPos::Center)?;
    }
    Ok(strip)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_octave_is_as_wide_on_the_ramp_and_both_ends_hold() {
        let places = [0.25, 0.5, 1.0, 16.0, 32.0].map(place);
        assert_eq!(places.map(|place| (place * 7.0).round()), [0.0, 1.0, 2.0, 6.0, 7.0]);
        assert_eq!((place(0.0), place(1e9)), (0.0, 1.0));
    }

    #[test]
    fn what_no_map_covers_has_a_colour_that_the_ramp_has_not() {
        for none in [f32::INFINITY, f32::NAN, -1.0] {
            assert_eq!(colour(none), NONE);
        }
        assert!((0..=100).all(|step| ramp(step as f32 / 100.0) != NONE));
    }

    #[test]
    fn worse_is_brighter_everywhere_on_the_ramp() {
        let luma = |step: i32| {
            let [r, g, b] = ramp(step as f32 / 50.0).map(f32::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        assert!((0..50).all(|step| luma(step + 1) > luma(step)));
    }

    #[test]
    fn the_map_keeps_its_pixels_above_a_legend_with_the_mark() {
        let map = heat([400, 2], &[[0.25; 400], [f32::INFINITY; 400]].concat()).expect("a map");
        assert_eq!((map.get_pixel(7, 0).0, map.get_pixel(7, 1).0), ([68, 1, 84, 255], [58, 60, 64, 255]));
        let legend = || map.enumerate_pixels().filter(|(_, y, _)| *y >= 2).map(|(_, _, pixel)| pixel.0);
        assert!(legend().any(|pixel| pixel == [255; 4]) && legend().any(|pixel| pixel == [68, 1, 84, 255]));
        assert!(heat([2, 2], &[1.0]).is_err() && heat([0, 0], &[]).is_err());
    }
}
