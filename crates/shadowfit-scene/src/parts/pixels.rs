//! Drawing of the scenes' images: fixed pseudo-random values, tileable noise, a loop over pixels.

use crate::Image;

/// Cells along a side of the noise, a power of two.
pub const NOISE_CELLS: u32 = 64;

/// Returns a fixed pseudo-random value in 0..1 for a lattice point.
pub fn hash(x: u32, y: u32) -> f32 {
    let mut h = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77);
    h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
    h = (h ^ (h >> 12)).wrapping_mul(0x297A_2D39);
    ((h ^ (h >> 15)) >> 8) as f32 / 16_777_216.0
}

/// Smooth tileable noise in -1..1, from a table of hashed values.
pub struct Noise(Vec<f32>);

impl Default for Noise {
    fn default() -> Self {
        let cells = 0..NOISE_CELLS * NOISE_CELLS;
        Self(cells.map(|cell| hash(cell, 17) * 2.0 - 1.0).collect())
    }
}

impl Noise {
    /// Fills the table.
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns the values along x at a height `y` in cells.
    pub fn row(&self, y: f32) -> NoiseRow {
        let top = y as u32;
        let values = |row: u32| {
            let start = ((row % NOISE_CELLS) * NOISE_CELLS) as usize;
            &self.0[start..start + NOISE_CELLS as usize]
        };
        let mix = |(a, b): (&f32, &f32)| a + (b - a) * (y - top as f32);
        NoiseRow(values(top).iter().zip(values(top + 1)).map(mix).collect())
    }
}

/// A row of [`Noise`].
pub struct NoiseRow(Vec<f32>);

impl NoiseRow {
    /// Returns the value at a position in cells.
    pub fn at(&self, x: f32) -> f32 {
        let column = x as u32;
        let left = self.0[(column % NOISE_CELLS) as usize];
        let right = self.0[((column + 1) % NOISE_CELLS) as usize];
        left + (right - left) * (x - column as f32)
    }
}

/// Draws a square image of `size` pixels. `row(y)` returns a function from x to an sRGB colour and an alpha,
/// 0..255.
pub fn draw<Row: Fn(u32) -> [f32; 4]>(name: &str, size: u32, row: impl Fn(u32) -> Row) -> Image {
    draw_oblong(name, [size; 2], row)
}

/// Draws like [`draw`], with a width and a height in pixels.
pub fn draw_oblong<Row: Fn(u32) -> [f32; 4]>(name: &str, [width, height]: [u32; 2], row: impl Fn(u32) -> Row) -> Image {
    let mut rgba = Vec::with_capacity((width * height * 4) as usize);
    for y in 0..height {
        let pixel = row(y);
        for x in 0..width {
            rgba.extend_from_slice(&pixel(x).map(|value| value as u8));
        }
    }
    Image { name: name.to_owned(), width, height, rgba }
}

/// Draws like [`draw`], with noise. `color` receives x, y and the noise values at the pixel, one for each of
/// `scales`, and returns a colour. At a scale of 1 the image spans [`NOISE_CELLS`].
pub fn draw_noisy<const N: usize>(
    name: &str,
    size: u32,
    scales: [f32; N],
    color: impl Fn(u32, u32, [f32; N]) -> [f32; 4],
) -> Image {
    let noise = Noise::new();
    let cell = NOISE_CELLS as f32 / size as f32;
    let color = &color;
    draw(name, size, |y| {
        let rows = scales.map(|scale| noise.row(y as f32 * cell * scale));
        move |x| color(x, y, std::array::from_fn(|index| rows[index].at(x as f32 * cell * scales[index])))
    })
}

/// Makes `color` lighter or darker by `light` of 0..255.
pub fn shade([r, g, b]: [f32; 3], light: f32) -> [f32; 4] {
    [r + light, g + light * 0.97, b + light * 0.9, 255.0]
}
