//! The world's texel grid: what keeps a map's texels in place while the camera moves.
//!
//! A grid has one texel size and one light direction; its lines are counted from the world's origin
//! in f64, so that they are the same lines wherever the eye is. Texel sizes step by eighths of an
//! octave: relative to the extent of the content and not to a world unit, so that a scene in
//! centimetres behaves like one in kilometres.

use glam::{DVec2, DVec3};

use crate::fits::{FitRule, Grid, ROUNDING, Volume};
use crate::light::LightAxes;

/// How far an extent may lie above a step and still be rounded down to it, as a share of the step:
/// the noise of f32 corners must not choose between two steps.
const NOISE: f64 = 1e-5;

/// 2^(k/8) for the steps of one octave and the next one's first.
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

/// The least of the extents 2^(k/8) that holds a length, or up to 1e-5 of it less, and 1e-5 more;
/// the lengths are metres, positive and normal.
#[inline]
pub(crate) fn quantised(length: f64) -> f64 {
    // The power of two below it, and the ratio to that.
    let octave = f64::from_bits(length.to_bits() & EXPONENT);
    let least = f64::from_bits(length.to_bits() & !EXPONENT | 1.0_f64.to_bits()) * (1.0 - NOISE);
    // The bits of positive numbers have the same order as the numbers, and are compared faster.
    let shorter = OCTAVE[..8].iter().filter(|step| step.to_bits() < least.to_bits()).count();
    OCTAVE[shorter] * (1.0 + NOISE) * octave
}

/// 2^(steps/8), exact to rounding; the steps are limited so that it is a normal number.
pub(crate) fn eighths(steps: i32) -> f64 {
    let octave = steps.div_euclid(8).clamp(-1022, 1023);
    OCTAVE[steps.rem_euclid(8) as usize] * f64::from_bits(((octave + 1023) as u64) << 52)
}

/// The least number of steps for which [`eighths`] is no less than a positive normal length.
pub(crate) fn eighths_above(length: f64) -> i32 {
    let octave = ((length.to_bits() >> 52) as i32 & 0x7ff) - 1023;
    let share = f64::from_bits(length.to_bits() & !EXPONENT | 1.0_f64.to_bits());
    octave * 8 + i32::from(OCTAVE[..8].iter().filter(|step| **step < share).count() as u8)
}

/// The bits of an f64's exponent.
const EXPONENT: u64 = f64::INFINITY.to_bits();

/// The floor of a number; the same bits as libm's, without a function call in the common case.
#[inline]
pub(crate) fn floor(x: f64) -> f64 {
    // Beyond this all numbers are whole, and those below it lose their fraction when it is added.
    const WHOLE: f64 = 4_503_599_627_370_496.0;
    let whole = WHOLE.copysign(x);
    let near = x + whole - whole;
    // No branch: the direction of rounding is unpredictable.
    let floor = near - f64::from(u8::from(near > x));
    if x.abs() < WHOLE { floor.copysign(x) } else { x }
}

/// World position along the light's axes, in metres, in f64.
#[inline]
pub(crate) fn anchor(axes: &LightAxes, origin: DVec3) -> DVec3 {
    axes.project(origin)
}

/// Steps in the length of a map's depth range: near and far plane stay where they are until the
/// content has moved by about one step.
const DEPTH_STEPS: f64 = 16.0;

/// Rounds a volume's extents across the light up and moves it to the world's grid, so that it still
/// holds its content, with the border's texels around it.
#[inline(always)]
pub(crate) fn snap(volume: &mut Volume, origin: DVec3, rule: &FitRule) -> Grid {
    let (grid, min, max) = snapped(&volume.axes, volume.min, volume.max, origin, rule);
    (volume.min, volume.max, volume.grid) = (min, max, Some(grid));
    grid
}

/// Texels that are left for the content of a map on the grid.
pub(crate) fn usable(rule: &FitRule) -> DVec2 {
    // One texel is lost to the shift onto the grid.
    rule.resolution.as_dvec2() - (2.0 * rule.border + 1.0)
}

/// The same for the corners of a box: returns its position on the grid and its new corners.
#[inline(always)]
fn snapped(axes: &LightAxes, min: DVec3, max: DVec3, origin: DVec3, rule: &FitRule) -> (Grid, DVec3, DVec3) {
    let anchor = anchor(axes, origin);
    let resolution = rule.resolution.as_dvec2();
    let border = rule.border;
    let usable = usable(rule);
    // A map that is larger than its content is rounded by its own extent.
    let size = (max - min).truncate();
    let pad = ROUNDING * (size * resolution / usable).max_element();
    let size = size + 2.0 * pad;
    let width = quantised(size.x);
    let mut size = DVec2::new(width, if size.y == size.x { width } else { quantised(size.y) });
    if rule.max_texel_ratio.is_some() {
        let limited = rule.limited(size, usable);
        let stepped = size.max(DVec2::new(quantised(limited.x), quantised(limited.y)));
        // The step above the limit may be too long the other way. The limit itself follows from a step too.
        size = if rule.limited(stepped, usable) == stepped { stepped } else { limited };
    }
    let texel = size / usable;
    let line = (min.truncate() - pad + anchor.truncate()) / texel - border;
    let first = DVec2::new(floor(line.x), floor(line.y));
    let corner = first * texel - anchor.truncate();
    let grid = Grid { first, texel, z: (min.z + anchor.z, max.z + anchor.z) };
    (grid, corner.extend(min.z), (corner + texel * resolution).extend(max.z))
}

/// Puts the near and far plane of a volume on the grid to a range that holds them: the range held
/// from an earlier frame as long as it still holds them and is at most `waste` times as long as a
/// new one.
#[inline(always)]
pub(crate) fn stabilise_depth(volume: &mut Volume, origin: DVec3, held: Option<(f64, f64)>, waste: f64) {
    let anchor = anchor(&volume.axes, origin).z;
    if let Some(grid) = &mut volume.grid {
        grid.z = stabilised_depth(held, (volume.min.z + anchor, volume.max.z + anchor), waste);
        (volume.min.z, volume.max.z) = (grid.z.0 - anchor, grid.z.1 - anchor);
        volume.light_at_near_plane();
    }
}

/// A depth range that holds another, both along the light's z from the world's origin, in metres:
/// the held one, or a new one in steps of its length. A new range that replaces a held one has spare
/// room at both ends.
pub(crate) fn stabilised_depth(held: Option<(f64, f64)>, (low, high): (f64, f64), waste: f64) -> (f64, f64) {
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
    if is_enough && held_length <= length * waste {
        return held;
    }
    let renewed = around(rounding + length * ROOM);
    let is_wasteful = held_length > (renewed.1 - renewed.0) * waste * (1.0 + NOISE);
    if is_enough && !is_wasteful { held } else { renewed }
}

/// Free space on either side of a renewed depth range, as a share of its content: it costs about a
/// third of a bit of depth.
const ROOM: f64 = 0.125;

/// Where a map lies on the world's texel grid.
///
/// Its lines run along the map's x and y axis (the rows of
/// [`light_from_world`](crate::LightFit::light_from_world)) and are counted from the world's origin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GridAnchor {
    /// Grid lines of the map's left and bottom side: they lie this many texels to the right of and
    /// above the world's origin.
    pub first: [i64; 2],
    /// Exact size of a texel along x and y, in metres;
    /// [`LightFit::texel_size`](crate::LightFit::texel_size) is this in f32.
    pub texel: DVec2,
    /// Far and near plane of the map along the direction **toward** the light, from the world's
    /// origin, in metres.
    pub depth: [f64; 2],
}

/// Grid lines beyond this are not whole numbers in f64 any more.
pub(crate) const MAX_LINE: f64 = 4_503_599_627_370_496.0;

impl GridAnchor {
    /// The anchor of a map on the grid, if its grid lines are exact in f64.
    pub(crate) fn of(grid: &Grid) -> Option<Self> {
        let DVec2 { x, y } = grid.first;
        let is_whole = x.abs() < MAX_LINE && y.abs() < MAX_LINE;
        is_whole.then_some(Self { first: [x as i64, y as i64], texel: grid.texel, depth: [grid.z.0, grid.z.1] })
    }
}
