//! ꟻLIP: how different two pictures look to a person who flips between them.
//!
//! P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild, "ꟻLIP: A difference evaluator
//! for alternating images", 2020: the metric for pictures of low dynamic range. Tests compare it with numbers from the
//! authors' own program.

use std::f64::consts::PI;

use rayon::prelude::*;

/// Pixels per degree of the viewer's visual field: the paper's default, a screen 3840 pixels and 0.7 m wide at 0.7 m.
const PIXELS_PER_DEGREE: f64 = 0.7 * 3840.0 / 0.7 * PI / 180.0;

/// Exponent of the colour difference.
const COLOR_EXPONENT: f64 = 0.7;
/// Share of the largest colour difference below which errors are stretched.
const STRETCH_BELOW: f64 = 0.4;
/// Error at that share.
const STRETCH_TO: f64 = 0.95;
/// Exponent of the feature difference.
const FEATURE_EXPONENT: f64 = 0.5;
/// Width of the features that people notice, in degrees.
const FEATURE_WIDTH: f64 = 0.082;
/// The reference white, D65, as X, Y and Z.
const WHITE: [f64; 3] = [0.950_428_545, 1.0, 1.088_900_371];
/// X, Y and Z from linear sRGB, as rows.
const XYZ_FROM_RGB: [[f64; 3]; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];
/// Linear sRGB from X, Y and Z, as rows.
const RGB_FROM_XYZ: [[f64; 3]; 3] = [
    [3.241_003_275, -1.537_398_934, -0.498_615_861],
    [-0.969_224_334, 1.875_930_071, 0.041_554_224],
    [0.055_639_423, -0.204_011_202, 1.057_148_933],
];

/// A Gaussian of the contrast sensitivity: amplitude, and width in degrees squared.
type Gaussian = [f64; 2];
/// Contrast sensitivity of the luminance channel.
const LUMINANCE: [Gaussian; 1] = [[1.0, 0.0047]];
/// Contrast sensitivity between red and green.
const RED_GREEN: [Gaussian; 1] = [[1.0, 0.0053]];
/// Contrast sensitivity between blue and yellow.
const BLUE_YELLOW: [Gaussian; 2] = [[34.1, 0.04], [13.5, 0.025]];
/// The widest of these Gaussians, in degrees squared.
const WIDEST: f64 = 0.04;

/// A channel of a picture, rows from the top.
type Channel = Vec<f32>;

/// A picture that others are compared with.
#[derive(Clone, Debug, PartialEq)]
pub struct FlipReference {
    seen: Seen,
    size: [u32; 2],
}

impl FlipReference {
    /// Takes sRGB pixels of four bytes, alpha ignored, rows from the top, `size` pixels across and down, seen from the
    /// default distance.
    ///
    /// # Panics
    ///
    /// If the picture has another number of bytes than `size` needs.
    pub fn new(picture: &[u8], size: [u32; 2]) -> Self {
        Self { seen: Seen::new(picture, size), size }
    }

    /// Returns the ꟻLIP error of each pixel of another picture of the same size, 0 (equal) to 1.
    ///
    /// # Panics
    ///
    /// If the picture has another number of bytes than the reference.
    pub fn errors(&self, picture: &[u8]) -> Vec<f32> {
        let (reference, test) = (&self.seen, Seen::new(picture, self.size));
        let largest = largest_color_difference();
        let error = |pixel: usize| {
            let color = hyab(&reference.lab[pixel], &test.lab[pixel]).powf(COLOR_EXPONENT);
            let color = stretched(color, largest);
            let difference =
                |kind: usize| f64::from((reference.features[kind][pixel] - test.features[kind][pixel]).abs());
            let feature = (difference(0).max(difference(1)) / 2.0_f64.sqrt()).powf(FEATURE_EXPONENT);
            color.powf(1.0 - feature) as f32
        };
        (0..test.lab.len()).into_par_iter().map(error).collect()
    }

    /// Returns the mean ꟻLIP error of another picture: the figure of a pair of pictures.
    ///
    /// # Panics
    ///
    /// As [`Self::errors`].
    pub fn mean_error(&self, picture: &[u8]) -> f64 {
        let errors = self.errors(picture);
        errors.iter().map(|error| f64::from(*error)).sum::<f64>() / errors.len().max(1) as f64
    }
}

/// A picture as a person sees it.
#[derive(Clone, Debug, PartialEq)]
struct Seen {
    /// Filtered colours in CIELAB, with chroma scaled by lightness (Hunt effect).
    lab: Vec<[f64; 3]>,
    /// Strength of edges and of points.
    features: [Channel; 2],
}

impl Seen {
    fn new(picture: &[u8], [width, height]: [u32; 2]) -> Self {
        let size = [width as usize, height as usize];
        assert_eq!(picture.len(), size[0] * size[1] * 4, "four bytes for each pixel");
        assert!(!picture.is_empty(), "a picture has pixels");
        let linear: [f64; 256] = std::array::from_fn(|byte| linear(byte as u8));
        let opponent = |pixel: &[u8]| opponent_color(&[0, 1, 2].map(|channel| linear[usize::from(pixel[channel])]));
        let opponent: Vec<[f32; 3]> = picture.par_chunks_exact(4).map(opponent).collect();
        let [luminance, red_green, blue_yellow] =
            [0, 1, 2].map(|channel| opponent.par_iter().map(|color| color[channel]).collect::<Channel>());
        let filter = |channel: &Channel, sensitivity: &[Gaussian]| contrast_filtered(channel, size, sensitivity);
        let filtered =
            [filter(&luminance, &LUMINANCE), filter(&red_green, &RED_GREEN), filter(&blue_yellow, &BLUE_YELLOW)];
        let lab = |pixel: usize| hunt_lab(&[0, 1, 2].map(|channel| f64::from(filtered[channel][pixel])));
        let achromatic: Channel = luminance.iter().map(|value| (value + 16.0) / 116.0).collect();
        Self { lab: (0..size[0] * size[1]).into_par_iter().map(lab).collect(), features: features(&achromatic, size) }
    }
}

/// Linear light from an sRGB byte.
fn linear(byte: u8) -> f64 {
    let value = f64::from(byte) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

fn product(rows: &[[f64; 3]; 3], vector: &[f64; 3]) -> [f64; 3] {
    rows.map(|row| row[0] * vector[0] + row[1] * vector[1] + row[2] * vector[2])
}

/// `YCxCz`, the linear opponent space of the contrast sensitivity, from linear sRGB.
fn opponent_color(rgb: &[f64; 3]) -> [f32; 3] {
    let xyz = product(&XYZ_FROM_RGB, rgb);
    let [x, y, z] = [0, 1, 2].map(|axis| xyz[axis] / WHITE[axis]);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)].map(|value| value as f32)
}

/// CIELAB with chroma scaled by lightness, from `YCxCz`. Colours out of the range of sRGB are clamped.
fn hunt_lab(opponent: &[f64; 3]) -> [f64; 3] {
    let y = (opponent[0] + 16.0) / 116.0;
    let xyz = [opponent[1] / 500.0 + y, y, y - opponent[2] / 200.0];
    let xyz = [0, 1, 2].map(|axis| xyz[axis] * WHITE[axis]);
    hunt_lab_of_rgb(&product(&RGB_FROM_XYZ, &xyz).map(|value| value.clamp(0.0, 1.0)))
}

fn hunt_lab_of_rgb(rgb: &[f64; 3]) -> [f64; 3] {
    let xyz = product(&XYZ_FROM_RGB, rgb);
    let curve = |value: f64| {
        let delta: f64 = 6.0 / 29.0;
        if value > delta.powi(3) { value.cbrt() } else { value / (3.0 * delta * delta) + 4.0 / 29.0 }
    };
    let [x, y, z] = [0, 1, 2].map(|axis| curve(xyz[axis] / WHITE[axis]));
    let lightness = 116.0 * y - 16.0;
    [lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)]
}

/// The `HyAB` distance of two colours: city block in lightness, Euclidean in chroma.
fn hyab(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

/// The colour difference of green and blue, the largest one in sRGB.
fn largest_color_difference() -> f64 {
    let [green, blue] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|rgb| hunt_lab_of_rgb(&rgb));
    hyab(&green, &blue).powf(COLOR_EXPONENT)
}

/// Maps colour differences to 0..=1, so that small ones, which are most, take most of the range.
fn stretched(difference: f64, largest: f64) -> f64 {
    let limit = STRETCH_BELOW * largest;
    if difference < limit {
        STRETCH_TO / limit * difference
    } else {
        STRETCH_TO + (difference - limit) / (largest - limit) * (1.0 - STRETCH_TO)
    }
}

/// A channel filtered by the contrast sensitivity, a sum of Gaussians whose integral is 1.
fn contrast_filtered(channel: &Channel, size: [usize; 2], sensitivity: &[Gaussian]) -> Channel {
    let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE).ceil() as i64;
    let kernels: Vec<(f64, Vec<f64>)> = sensitivity
        .iter()
        .map(|[amplitude, width]| {
            let at = |step: i64| (-(PI * step as f64 / PIXELS_PER_DEGREE).powi(2) / width).exp();
            (amplitude * (PI / width).sqrt(), (-radius..=radius).map(at).collect())
        })
        .collect();
    let total: f64 = kernels.iter().map(|(weight, kernel)| weight * kernel.iter().sum::<f64>().powi(2)).sum();
    let mut sum = vec![0.0; channel.len()];
    for (weight, kernel) in &kernels {
        let kernel: Vec<f32> = kernel.iter().map(|value| *value as f32).collect();
        add_scaled(&mut sum, (weight / total) as f32, &convolved(channel, size, &kernel, &kernel));
    }
    sum
}

/// Strengths of edges and of points: lengths of the first and of the second derivatives of a Gaussian.
fn features(achromatic: &Channel, size: [usize; 2]) -> [Channel; 2] {
    let deviation = 0.5 * FEATURE_WIDTH * PIXELS_PER_DEGREE;
    let radius = (3.0 * deviation).ceil() as i64;
    let gaussian = |step: i64| (-(step as f64).powi(2) / (2.0 * deviation * deviation)).exp();
    let smooth: Vec<f64> = (-radius..=radius).map(gaussian).collect();
    let first = |step: i64| -(step as f64) * gaussian(step);
    let second = |step: i64| ((step as f64 / deviation).powi(2) - 1.0) * gaussian(step);
    let derivatives: [Vec<f64>; 2] =
        [(-radius..=radius).map(first).collect(), (-radius..=radius).map(second).collect()];
    let smooth = scaled_by_sign(&smooth);
    derivatives.map(|derivative| {
        let derivative = scaled_by_sign(&derivative);
        let across = convolved(achromatic, size, &derivative, &smooth);
        let down = convolved(achromatic, size, &smooth, &derivative);
        across.iter().zip(&down).map(|(x, y)| x.hypot(*y)).collect()
    })
}

/// A kernel whose positive weights sum to 1 and whose negative weights sum to -1.
fn scaled_by_sign(kernel: &[f64]) -> Vec<f32> {
    let sum = |sign: f64| kernel.iter().map(|weight| (sign * weight).max(0.0)).sum::<f64>();
    let [positive, negative] = [sum(1.0), sum(-1.0)];
    kernel.iter().map(|weight| (weight / if *weight < 0.0 { negative } else { positive }) as f32).collect()
}

/// A channel convolved with one kernel along rows and one along columns. Beyond the border the nearest pixel is repeated.
fn convolved(channel: &Channel, [width, height]: [usize; 2], across: &[f32], down: &[f32]) -> Channel {
    let mut along_rows = vec![0.0; channel.len()];
    along_rows.par_chunks_exact_mut(width).zip(channel.par_chunks_exact(width)).for_each(|(sums, row)| {
        let reach = across.len() / 2;
        let mut padded = vec![row[0]; reach];
        padded.extend_from_slice(row);
        padded.extend(std::iter::repeat_n(row[width - 1], reach));
        for (step, weight) in across.iter().enumerate() {
            add_scaled(sums, *weight, &padded[step..step + width]);
        }
    });
    let mut sums = vec![0.0; channel.len()];
    sums.par_chunks_exact_mut(width).enumerate().for_each(|(y, sums)| {
        for (step, weight) in down.iter().enumerate() {
            let row = (y + step).saturating_sub(down.len() / 2).min(height - 1);
            add_scaled(sums, *weight, &along_rows[row * width..(row + 1) * width]);
        }
    });
    sums
}

fn add_scaled(sums: &mut [f32], weight: f32, values: &[f32]) {
    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [64, 48];

    /// A picture with hard edges, thin lines, gradients and colours; `change` alters pixels.
    fn picture(change: impl Fn(u32, u32, [u8; 3]) -> [u8; 3]) -> Vec<u8> {
        let pixel = |index: u32| {
            let (x, y) = (index % SIZE[0], index / SIZE[0]);
            let color = match (x / 16, y / 16) {
                (0, _) => [40, 90, 200],
                (1, 0) => [(x * 4 % 256) as u8, 128, 60],
                (1, _) => [230; 3],
                (2, _) if x % 4 == 0 => [10, 10, 10],
                (2, _) => [200, 180, 90],
                _ => [(y * 5 % 256) as u8; 3],
            };
            let [r, g, b] = change(x, y, color);
            [r, g, b, 255]
        };
        (0..SIZE[0] * SIZE[1]).flat_map(pixel).collect()
    }

    fn same(_: u32, _: u32, color: [u8; 3]) -> [u8; 3] {
        color
    }

    #[test]
    fn equal_pictures_have_no_error() {
        let picture = picture(same);
        assert!(FlipReference::new(&picture, SIZE).errors(&picture).iter().all(|error| *error == 0.0));
    }

    /// The means of `flip_evaluator` 1.7, the authors' program, for the same pictures.
    #[test]
    fn means_are_those_of_the_authors_program() {
        let reference = picture(same);
        let darker = |_: u32, _: u32, color: [u8; 3]| color.map(|value| (f64::from(value) * 0.8) as u8);
        let shadow = |x: u32, y: u32, color: [u8; 3]| if x + y < 40 { color.map(|value| value / 2) } else { color };
        let speck = |x: u32, y: u32, color: [u8; 3]| if (x, y) == (24, 24) { [0, 0, 0] } else { color };
        let green = |x: u32, _: u32, color: [u8; 3]| if x > 50 { [0, 255, 0] } else { color };
        let cases: [(&str, Vec<u8>, f64); 4] = [
            ("darker", picture(darker), 0.468_189),
            ("shadow", picture(shadow), 0.230_230),
            ("speck", picture(speck), 0.000_821_5),
            ("green", picture(green), 0.249_582),
        ];
        for (name, test, wanted) in cases {
            let found = FlipReference::new(&reference, SIZE).mean_error(&test);
            assert!((found - wanted).abs() <= 1e-4 * wanted.max(0.01), "{name}: {found}, not {wanted}");
        }
    }
}
