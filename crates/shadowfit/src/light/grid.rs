//! The world's texel grid, which keeps a map's texels in place while the camera moves.
//!
//! A grid has one texel size and one light direction. Its lines are counted from the world's origin in f64,
//! so they do not depend on the eye. Texel sizes step by eighths of an octave, relative to the extent of the
//! content instead of a world unit, so a scene in centimetres behaves like one in kilometres.

use glam::{DVec2, DVec3};

use crate::base::checks::{ROUNDING, floor};
use crate::light::LightAxes;

/// Tolerance for rounding an extent down to a step, as a share of the step. The noise of f32 corners must not
/// choose between two steps.
const NOISE: f64 = 1e-5;

/// 2^(k/8) for the steps of one octave and the first step of the next.
const OCTAVE: [f64; 9] = [
    1.0,
    1.090_507_732_665_257_7,
    1.189_207_115_002_721,
    1.296_839_554_651_009_6,
    core::f64::consts::SQRT_2,
    1.542_210_825_407_940_7,
    1.681_792_830_507_429,
    1.834_008_086_409_342_4,
    2.0,
];

/// Rounds a length up to the least extent 2^(k/8), with a tolerance of 1e-5, and adds 1e-5 to the result.
/// Lengths are metres, positive and normal.
#[inline]
pub(crate) fn quantised(length: f64) -> f64 {
    // The power of two below the length, and the ratio of the length to it.
    let octave = f64::from_bits(length.to_bits() & EXPONENT);
    let least = f64::from_bits(length.to_bits() & !EXPONENT | 1.0_f64.to_bits()) * (1.0 - NOISE);
    // The bits of positive numbers have the same order as the numbers, and are compared faster.
    let shorter = OCTAVE[..8].iter().filter(|step| step.to_bits() < least.to_bits()).count();
    OCTAVE[shorter] * (1.0 + NOISE) * octave
}

/// Computes 2^(steps/8), exact to rounding. The steps are limited so that the result is a normal number.
pub(crate) fn eighths(steps: i32) -> f64 {
    let octave = steps.div_euclid(8).clamp(-1022, 1023);
    OCTAVE[steps.rem_euclid(8) as usize] * f64::from_bits(((octave + 1023) as u64) << 52)
}

/// Returns the least number of steps whose [`eighths`] are at least a positive normal length.
pub(crate) fn eighths_above(length: f64) -> i32 {
    let octave = ((length.to_bits() >> 52) as i32 & 0x7ff) - 1023;
    let share = f64::from_bits(length.to_bits() & !EXPONENT | 1.0_f64.to_bits());
    octave * 8 + i32::from(OCTAVE[..8].iter().filter(|step| **step < share).count() as u8)
}

/// The bits of an f64's exponent.
const EXPONENT: u64 = f64::INFINITY.to_bits();

/// Returns a world position along the light's axes, in metres, in f64.
#[inline]
pub(crate) fn anchor(axes: &LightAxes, origin: DVec3) -> DVec3 {
    axes.project(origin)
}

/// Steps in the length of a map's depth range. The near and far plane stay in place until the content has
/// moved by about one step.
const DEPTH_STEPS: f64 = 16.0;

/// Returns a depth range that holds another, both along the light's z from the world's origin, in metres. It
/// is the held range, or a new one in steps of its length. A new range that replaces a held one has spare
/// room at both ends.
pub(crate) fn stabilised_depth(held: Option<(f64, f64)>, low: f64, high: f64, max_oversize: f64) -> (f64, f64) {
    let length = high - low;
    // A larger range rounds more.
    let rounding = 2.0 * ROUNDING * length;
    let around = |pad: f64| {
        let depth = quantised(length + 2.0 * pad);
        let step = depth / DEPTH_STEPS;
        let start = floor((low - pad) / step) * step;
        (start, start + depth + step)
    };
    let Some(held) = held else { return around(rounding) };
    let held_length = held.1 - held.0;
    let held_rounding = ROUNDING * held_length;
    let is_enough = held.0 <= low - held_rounding && held.1 >= high + held_rounding;
    // A new range would be longer than its content, so it need not be computed here.
    if is_enough && held_length <= length * max_oversize {
        return held;
    }
    let renewed = around(rounding + length * ROOM);
    let is_wasteful = held_length > (renewed.1 - renewed.0) * max_oversize * (1.0 + NOISE);
    if is_enough && !is_wasteful { held } else { renewed }
}

/// Free space on either side of a renewed depth range, as a share of its content. It costs about a third of a
/// bit of depth.
const ROOM: f64 = 0.125;

/// Position of a map on the world's grid. Lines are counted from the world's origin along the map's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grid {
    /// Grid line of the map's least corner.
    pub(crate) first: DVec2,
    /// Size of a texel, in metres.
    pub(crate) texel: DVec2,
    /// Far and near plane along the light's z from the world's origin, in metres. They are in steps once they
    /// have been [stabilised](stabilised_depth).
    pub(crate) z: (f64, f64),
}

impl Grid {
    /// Returns the least and greatest corner of a map across the light, given the origin's [`anchor`].
    #[inline(always)]
    pub(crate) fn across(&self, anchor: DVec3, resolution: DVec2) -> (DVec2, DVec2) {
        let corner = self.first * self.texel - anchor.truncate();
        (corner, corner + self.texel * resolution)
    }
}

/// Position of a map on the world's texel grid.
///
/// Grid lines run along the map's x and y axis (the rows of
/// [`light_from_world`](crate::LightProjection::light_from_world)) and are counted from the world's origin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GridPosition {
    /// Grid lines of the map's left and bottom side, in texels to the right of and above the world's origin.
    pub first: [i64; 2],
    /// Exact size of a texel along x and y, in metres;
    /// [`LightProjection::texel_size`](crate::LightProjection::texel_size) is this in f32.
    pub texel: DVec2,
    /// Far and near plane of the map along the direction **toward** the light, from the world's origin, in
    /// metres.
    pub depth: [f64; 2],
}

/// Grid lines beyond this are no longer whole numbers in f64.
pub(crate) const MAX_LINE: f64 = 4_503_599_627_370_496.0;

impl GridPosition {
    /// Returns the position of a map on the grid, if its grid lines are exact in f64.
    pub(crate) fn of(grid: &Grid) -> Option<Self> {
        let DVec2 { x, y } = grid.first;
        let is_whole = x.abs() < MAX_LINE && y.abs() < MAX_LINE;
        is_whole.then_some(Self { first: [x as i64, y as i64], texel: grid.texel, depth: [grid.z.0, grid.z.1] })
    }
}
