//! The picture with its wrong pixels marked, and a legend with the share of each kind of error.
//!
//! Right pixels are dimmed and grey, so that all colours mean errors.

use anyhow::{Result, ensure};
use image::{Rgba, RgbaImage};
use plotters::style::text_anchor::HPos;
use shadowfit_truth::Class;

use super::strip::{Strip, scale, width};
use crate::markdown::readable;

/// Kinds of wrong pixels with names and colours (sRGB).
const KINDS: [(Class, &str, [u8; 3]); 4] = [
    (Class::FalseShadow, "false shadow", [255, 64, 56]),
    (Class::FalseLight, "false light", [56, 132, 255]),
    (Class::Hole, "hole", [255, 64, 232]),
    (Class::Edge, "edge error", [255, 216, 0]),
];
/// Brightness of right pixels. Shapes stay readable, and every mark is brighter.
const DIM: f32 = 0.5;
/// Brightness of pixels that are not judged, such as the sky.
const UNJUDGED_DIM: f32 = 0.3;
/// Weights of sRGB's primaries in its luma (ITU-R BT.709).
const LUMA: [f32; 3] = [0.2126, 0.7152, 0.0722];
/// Side of a colour swatch, and gaps around its text, in pixels at scale 1.
const SWATCH: f32 = 14.0;
const GAP: f32 = 7.0;
const MARGIN: f32 = 10.0;

/// Marks the wrong pixels of a picture and adds the legend below. `classes` has one verdict per pixel, rows
/// from the top.
///
/// # Errors
///
/// If the numbers of pixels and verdicts differ.
pub fn overlay(picture: &RgbaImage, classes: &[Class]) -> Result<RgbaImage> {
    let pixels = picture.pixels().len();
    ensure!(pixels == classes.len(), "{pixels} pixels, but {} verdicts", classes.len());
    let mut marked = picture.clone();
    for (pixel, class) in marked.pixels_mut().zip(classes) {
        *pixel = mark(*pixel, *class);
    }
    legend(picture.width(), &texts(classes)).map(|strip| strip.below(&marked))
}

fn mark(pixel: Rgba<u8>, class: Class) -> Rgba<u8> {
    let dimmed = |share: f32| {
        let luma: f32 = LUMA.iter().zip(pixel.0).map(|(weight, part)| weight * f32::from(part)).sum();
        let grey = (luma * share).round() as u8;
        Rgba([grey, grey, grey, u8::MAX])
    };
    match KINDS.iter().find(|(kind, ..)| *kind == class) {
        Some((_, _, [r, g, b])) => Rgba([*r, *g, *b, u8::MAX]),
        None if class == Class::NotJudged => dimmed(UNJUDGED_DIM),
        None => dimmed(DIM),
    }
}

/// Returns the legend texts with the share of each kind among the judged pixels, as in the tables.
fn texts(classes: &[Class]) -> Vec<(String, [u8; 3])> {
    let judged = classes.iter().filter(|class| **class != Class::NotJudged).count();
    let share = |kind: Class| {
        let count = classes.iter().filter(|class| **class == kind).count();
        if judged == 0 { "-".to_owned() } else { format!("{} %", readable(100.0 * count as f64 / judged as f64)) }
    };
    KINDS.iter().map(|(kind, name, colour)| (format!("{name} {}", share(*kind)), *colour)).collect()
}

/// Draws the legend. A narrow picture needs more lines.
fn legend(picture_width: u32, texts: &[(String, [u8; 3])]) -> Result<Strip> {
    let scale = scale(picture_width);
    let [swatch, gap, margin] = [SWATCH, GAP, MARGIN].map(|length| length * scale);
    let (mut x, mut line) = (margin, 0u32);
    let mut places = Vec::new();
    for (text, colour) in texts {
        let needed = swatch + gap + width(text, scale);
        if x > margin && x + needed > picture_width as f32 - margin {
            (x, line) = (margin, line + 1);
        }
        places.push((x, line, text, *colour));
        x += needed + 3.0 * gap;
    }
    let mut strip = Strip::new(picture_width, line + 1);
    for (x, line, text, colour) in places {
        let middle = line as f32 + 0.5;
        strip.fill([x, x + swatch], [middle - 0.32, middle + 0.32], colour);
        strip.write(text, x + swatch + gap, middle, HPos::Left)?;
    }
    Ok(strip)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_pixels_have_their_colour_and_all_else_is_dim_and_grey() {
        let picture = RgbaImage::from_pixel(3, 2, Rgba([200, 100, 0, 77]));
        let wrong = KINDS.map(|(class, ..)| class);
        let marked = overlay(&picture, &[&wrong[..], &[Class::Right, Class::NotJudged]].concat()).expect("an overlay");
        let pixel = |index: u32| marked.get_pixel(index % 3, index / 3).0;
        let [red, blue, magenta, yellow] = [0, 1, 2, 3].map(pixel);
        assert!(red[0] > 200 && red[1] < 99 && red[2] < 99 && blue[2] > 200 && blue[0] < 99);
        assert!(magenta[0] > 200 && magenta[1] < 99 && magenta[2] > 200 && yellow[1] > 200 && yellow[2] < 99);
        assert_eq!((pixel(4), pixel(5)), ([57, 57, 57, 255], [34, 34, 34, 255]));
        assert!(marked.height() > 2);
    }

    #[test]
    fn shares_are_of_the_judged_pixels() {
        let mut classes = vec![Class::NotJudged; 100];
        classes.extend([Class::Right, Class::Right, Class::Edge, Class::Hole]);
        let texts: Vec<_> = texts(&classes).into_iter().map(|(text, _)| text).collect();
        assert_eq!(texts, ["false shadow 0 %", "false light 0 %", "hole 25 %", "edge error 25 %"]);
        assert_eq!(super::texts(&[Class::NotJudged])[0].0, "false shadow -");
    }

    #[test]
    fn narrow_pictures_get_the_legend_in_more_lines() {
        let height = |width: u32| {
            let picture = RgbaImage::new(width, 1);
            overlay(&picture, &vec![Class::Right; width as usize]).expect("an overlay").height()
        };
        assert!(height(160) > 2 * height(700));
    }

    #[test]
    fn a_wrong_number_of_verdicts_is_refused() {
        assert!(overlay(&RgbaImage::new(2, 2), &[Class::Right; 3]).is_err());
    }
}
