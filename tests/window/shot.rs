//! Screenshots and their analysis.

use std::path::{Path, PathBuf};

use image::{Rgb, RgbImage};

/// A rectangle of the screen, in pixels from its upper left corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct Area {
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) width: u32,
    pub(super) height: u32,
}

impl Area {
    pub(super) const fn new(x: u32, y: u32, width: u32, height: u32) -> Self {
        Self { x, y, width, height }
    }
}

/// A screenshot of the whole screen, and its file.
#[derive(Clone)]
pub(super) struct Shot {
    pixels: RgbImage,
    path: PathBuf,
}

/// Level, of 255, above which a pixel is not the bare, black screen.
const BARE: u8 = 4;

impl Shot {
    pub(super) fn read(path: &Path) -> Self {
        let picture = image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        Self { pixels: picture.to_rgb8(), path: path.to_owned() }
    }

    /// Returns the file's path, for messages.
    pub(super) fn file(&self) -> std::path::Display<'_> {
        self.path.display()
    }

    /// Saves the screenshot to another file and returns it with that path.
    pub(super) fn saved_as(self, path: PathBuf) -> Self {
        self.pixels.save(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        Self { path, ..self }
    }

    /// Returns the mean absolute difference to `other` over `area` and the three channels, in levels of 255.
    pub(super) fn difference(&self, other: &Self, area: Area) -> f32 {
        let per_pixel = self.in_area(area).zip(other.in_area(area)).map(|(a, b)| {
            let channels = a.0.iter().zip(b.0);
            channels.map(|(&a, b)| u64::from(a.abs_diff(b))).sum::<u64>()
        });
        per_pixel.sum::<u64>() as f32 / (3 * area.width * area.height) as f32
    }

    /// Returns the mean absolute deviation from the mean brightness over `area`, in levels of 255: 0 for one
    /// flat colour.
    pub(super) fn spread(&self, area: Area) -> f32 {
        let brightness: Vec<f32> =
            self.in_area(area).map(|pixel| pixel.0.iter().map(|&level| f32::from(level)).sum::<f32>() / 3.0).collect();
        let count = brightness.len() as f32;
        let mean = brightness.iter().sum::<f32>() / count;
        brightness.iter().map(|level| (level - mean).abs()).sum::<f32>() / count
    }

    /// Returns whether most of `area` differs from the bare screen.
    pub(super) fn is_painted(&self, area: Area) -> bool {
        let painted = self.in_area(area).filter(|pixel| pixel.0.iter().any(|&level| level > BARE)).count();
        2 * painted > (area.width * area.height) as usize
    }

    fn in_area(&self, area: Area) -> impl Iterator<Item = &Rgb<u8>> {
        let rows = area.y..area.y + area.height;
        rows.flat_map(move |y| (area.x..area.x + area.width).map(move |x| self.pixels.get_pixel(x, y)))
    }
}
