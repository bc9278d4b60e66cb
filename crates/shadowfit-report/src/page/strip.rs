//! Text and boxes in pictures. The font is built in, so that every system draws the same pixels.
//!
//! Legends are drawn into a strip below the picture, so that they stay with it wherever it is copied.

use anyhow::{Result, anyhow};
use image::{Rgba, RgbaImage, imageops};
use plotters::prelude::{BitMapBackend, DrawingBackend, IntoFont, RGBColor, TextStyle};
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::plotting::{FAMILY, register};

/// Background colour of legends.
const GROUND: RGBColor = RGBColor(24, 26, 30);
/// Text colour of legends.
const INK: RGBColor = RGBColor(232, 234, 238);
/// Line height of legends at scale 1, in pixels.
const LINE: u32 = 22;
/// Downward shift of text, as a share of a line: the middle of a text's box is above the middle of its
/// letters.
const BELOW_MIDDLE: f32 = 0.07;
/// Text height at scale 1, in pixels.
const TEXT: u32 = 14;
/// Width of a picture whose legend has scale 1, in pixels.
const WIDTH: u32 = 720;

/// A strip for a legend.
pub(crate) struct Strip {
    pixels: Vec<u8>,
    size: [u32; 2],
    /// Text size relative to the text of a picture with [`WIDTH`] pixels.
    pub(crate) scale: f32,
}

/// Returns the legend scale for a picture width in pixels. It is limited so that the text stays readable.
pub(crate) fn scale(width: u32) -> f32 {
    (width as f32 / WIDTH as f32).clamp(0.85, 3.0)
}

/// Returns the width of a text at a scale, in pixels.
pub(crate) fn width(text: &str, scale: f32) -> f32 {
    register();
    let style = (FAMILY, f64::from(TEXT as f32 * scale)).into_font();
    style.box_size(text).map_or(0.0, |(width, _)| width as f32)
}

impl Strip {
    /// Creates a strip of `width` pixels for this number of lines.
    pub(crate) fn new(width: u32, lines: u32) -> Self {
        register();
        let scale = scale(width);
        let size = [width, ((lines * LINE + LINE / 2) as f32 * scale) as u32];
        let pixels = [GROUND.0, GROUND.1, GROUND.2].repeat((size[0] * size[1]) as usize);
        Self { pixels, size, scale }
    }

    /// Fills a box. `edges` are its left and right edge in pixels, `lines` its top and bottom in lines.
    pub(crate) fn fill(&mut self, edges: [f32; 2], lines: [f32; 2], colour: [u8; 3]) {
        let [width, height] = self.size.map(|length| length as usize);
        let [left, right] = edges.map(|edge| (edge.round().max(0.0) as usize).min(width));
        let [top, bottom] = lines.map(|line| (self.line(line).max(0) as usize).min(height));
        for pixel in (top..bottom).flat_map(|row| row * width + left..row * width + right) {
            self.pixels[pixel * 3..pixel * 3 + 3].copy_from_slice(&colour);
        }
    }

    /// Draws text, vertically centred at a line. `align` tells whether `x`, in pixels, is its left edge,
    /// middle or right edge.
    pub(crate) fn write(&mut self, text: &str, x: f32, line: f32, align: HPos) -> Result<()> {
        let size = f64::from(TEXT as f32 * self.scale);
        let style = TextStyle::from((FAMILY, size).into_font()).color(&INK).pos(Pos::new(align, VPos::Center));
        let place = (x.round() as i32, self.line(line + BELOW_MIDDLE));
        let mut backend = BitMapBackend::with_buffer(&mut self.pixels, (self.size[0], self.size[1]));
        backend.draw_text(text, &style, place).map_err(|error| anyhow!("a legend cannot be written: {error}"))
    }

    /// Returns the picture with the strip below it.
    pub(crate) fn below(self, picture: &RgbaImage) -> RgbaImage {
        let [width, height] = self.size;
        let rgba = self.pixels.chunks_exact(3).flat_map(|rgb| [rgb[0], rgb[1], rgb[2], u8::MAX]).collect();
        let mut whole = RgbaImage::from_pixel(width, picture.height() + height, Rgba([0, 0, 0, u8::MAX]));
        imageops::replace(&mut whole, picture, 0, 0);
        if let Some(strip) = RgbaImage::from_raw(width, height, rgba) {
            imageops::replace(&mut whole, &strip, 0, i64::from(picture.height()));
        }
        whole
    }

    /// Converts a position in lines, which may be fractional, into pixels from the top of the strip.
    fn line(&self, line: f32) -> i32 {
        ((line * LINE as f32 + LINE as f32 / 4.0) * self.scale).round() as i32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_drawn_where_it_was_asked_for_below_the_picture() {
        let mut strip = Strip::new(200, 1);
        strip.write("Wrong pixels", 100.0, 0.5, HPos::Left).expect("drawn");
        strip.fill([0.0, 50.0], [0.0, 1.0], [255, 0, 0]);
        let whole = strip.below(&RgbaImage::from_pixel(200, 10, Rgba([9, 9, 9, 255])));
        let bright = |from: u32, to: u32| {
            whole.enumerate_pixels().filter(|(x, _, pixel)| (from..to).contains(x) && pixel[1] > 120).count()
        };
        assert!(bright(100, 200) > 60 && bright(0, 100) == 0, "{} {}", bright(100, 200), bright(0, 100));
        assert_eq!((whole.get_pixel(0, 0)[0], whole.get_pixel(25, 20).0), (9, [255, 0, 0, 255]));
        assert!(width("Wrong pixels", 2.0) > 1.8 * width("Wrong pixels", 1.0));
    }
}
