//! The world's texel grid: what keeps a map's texels in place while the camera moves.
//!
//! A grid has one texel size and one light direction; its lines are counted from the world's
//! origin in f64, so that they are the same lines wherever the eye is. Texel sizes step by eighths
//! of an octave: relative to the content and never by a world unit, so that a scene in centimetres
//! behaves like one in kilometres.

use glam::{DVec2, DVec3};

use crate::axes::LightAxes;
use crate::fits::Volume;
use crate::settings::FitSettings;

pub(crate) use crate::fits::ROUNDING;

/// What an extent may lie above a step and still be rounded down to it, as a share of it: the noise
/// of f32 corners must not choose between two steps.
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
pub(crate) fn quantised(length: f64) -> f64 {
    let (mantissa, exponent) = libm::frexp(length);
    let least = 2.0 * mantissa * (1.0 - NOISE);
    let step = OCTAVE.into_iter().find(|step| *step >= least).unwrap_or(2.0);
    libm::ldexp(step * (1.0 + NOISE), exponent - 1)
}

/// World position along the light's axes, in metres, in f64.
pub(crate) fn anchor(axes: &LightAxes, origin: DVec3) -> DVec3 {
    axes.project(origin)
}

/// Depth steps of a snapped map in its range: near and far plane stay where they are until what is
/// covered has moved by one of them.
pub(crate) const DEPTH_STEPS: f64 = 16.0;

/// Rounds a volume's extents up and moves it to the world's grid, so that it still holds what it
/// held. The near plane is left for the caster policy to place.
pub(crate) fn snap(volume: &mut Volume, origin: DVec3, settings: &FitSettings) {
    let anchor = anchor(&volume.axes, origin);
    let resolution = settings.resolution.as_dvec2();
    let kernel = f64::from(settings.kernel_margin);
    // One texel is lost to the shift onto the grid.
    let usable = resolution - (2.0 * kernel + 1.0);
    let size = volume.max - volume.min;
    // The three extents of a sphere are one.
    let width = quantised(size.x);
    let like_x = |length: f64| if length == size.x { width } else { quantised(length) };
    let texel = DVec2::new(width, like_x(size.y)) / usable;
    let first = first_line(volume.min.truncate() + anchor.truncate(), texel, kernel);
    let min = first * texel - anchor.truncate();
    let depth = like_x(size.z);
    let step = depth / DEPTH_STEPS;
    let z = libm::floor((volume.min.z + anchor.z) / step) * step - anchor.z;
    (volume.min, volume.max) = (min.extend(z), (min + texel * resolution).extend(z + depth + step));
}

/// The last grid line before a position that leaves the kernel's texels free.
fn first_line(position: DVec2, texel: DVec2, kernel: f64) -> DVec2 {
    let line = position / texel - kernel;
    DVec2::new(libm::floor(line.x), libm::floor(line.y))
}
