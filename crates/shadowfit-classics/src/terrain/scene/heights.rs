//! The terrain's height map: 256 × 256 texels of 8 bits, like the red channel of the source's image.
//!
//! Hills of smooth noise around a level valley floor with the vehicles.

use shadowfit_scene::parts::hash;

use super::vehicles::PLACES;

/// Texels along a side.
pub(super) const TEXELS: i32 = 256;
/// Height values per unit of the terrain.
const PER_UNIT: f32 = 5.0;
/// Radius of the level ground around each vehicle, in the terrain's units.
const LEVEL: f32 = 26.0;
/// Distance beyond that over which hills rise to their full height.
const RISE: f32 = 60.0;
/// Texels to each side for computing a slope: enough to hide the steps of 8-bit heights in the shading.
const REACH: i32 = 4;

/// The height map, rows along z.
pub(crate) struct HeightMap {
    /// Values of the red channel, 256 along x for each z.
    pub(crate) red: Vec<u8>,
}

impl HeightMap {
    /// Generates the map.
    pub(crate) fn new() -> Self {
        let texel = |index: i32| {
            let height = hills((index % TEXELS) as f32, (index / TEXELS) as f32);
            (height * PER_UNIT).round().clamp(0.0, 255.0) as u8
        };
        Self { red: (0..TEXELS * TEXELS).map(texel).collect() }
    }

    /// Returns the height at a texel, in the terrain's units. Outside the map, the height of its edge.
    pub(crate) fn height(&self, x: i32, z: i32) -> f32 {
        let [x, z] = [x, z].map(|texel| texel.clamp(0, TEXELS - 1));
        f32::from(self.red[(z * TEXELS + x) as usize]) / PER_UNIT
    }

    /// Returns the slope along x and z at a texel, from the least-squares plane through the heights around
    /// it.
    pub(super) fn slope(&self, x: i32, z: i32) -> [f32; 2] {
        let (mut along_x, mut along_z, mut squares) = (0.0, 0.0, 0.0);
        for dz in -REACH..=REACH {
            for dx in -REACH..=REACH {
                let height = self.height(x + dx, z + dz);
                along_x += dx as f32 * height;
                along_z += dz as f32 * height;
                squares += (dx * dx) as f32;
            }
        }
        [along_x / squares, along_z / squares]
    }
}

/// Rises smoothly from 0 to 1 as `x` goes from `from` to `to`.
pub(super) fn ease(x: f32, from: f32, to: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Returns smooth noise in -1..1 with a value at each whole number. It repeats after `period` numbers.
pub(super) fn noise(x: f32, y: f32, period: u32, seed: u32) -> f32 {
    let (left, top) = (x.floor(), y.floor());
    let fade = |t: f32| t * t * t * (t * (6.0 * t - 15.0) + 10.0);
    let (u, v) = (fade(x - left), fade(y - top));
    let value = |dx: u32, dy: u32| {
        let [column, row] = [left as u32 + dx, top as u32 + dy].map(|cell| cell % period);
        hash(column, seed + row) * 2.0 - 1.0
    };
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    mix(mix(value(0, 0), value(1, 0), u), mix(value(0, 1), value(1, 1), u), v)
}

/// Returns the height before rounding to 8 bits.
fn hills(x: f32, z: f32) -> f32 {
    let away = PLACES.iter().map(|place| place.at.distance(glam::Vec3::new(x, 0.0, z))).fold(f32::INFINITY, f32::min);
    // The valley continues from the level ground to the north edge and, narrower, to the south-west.
    let north = (x - 138.0 - 10.0 * (z / 40.0).sin()).abs() + (z - 100.0).max(0.0) + 6.0;
    let south = 0.88 * (x - 118.0 + 0.55 * (z - 150.0)).abs() + (140.0 - z).max(0.0) + 10.0;
    let rise = ease(away.min(north).min(south), LEVEL, LEVEL + RISE);
    let broad = noise(x / 52.0 + 0.3, z / 52.0 + 0.6, 64, 301);
    let middle = noise(x / 25.0, z / 25.0, 64, 402);
    let small = noise(x / 11.0, z / 11.0, 64, 503);
    let wall = 27.0 + 16.0 * broad + 8.0 * middle + 2.0 * small;
    // Hills toward the light stay low.
    rise * wall.max(3.0) * (0.45 + 0.55 * ease(z, 40.0, 130.0))
}
