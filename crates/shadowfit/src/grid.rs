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

/// Steps of an extent in each octave.
pub(crate) const STEPS: f64 = 8.0;

/// What an extent may lie above a step and still be rounded down to it, as a share of a step: the
/// noise of f32 corners must not choose between two steps.
const NOISE: f64 = 1e-4;

/// The least of the extents 2^(k/8) that holds a length, and up to 1e-5 of it less; the lengths
/// are metres and positive.
pub(crate) fn quantised(length: f64) -> f64 {
    let steps = libm::ceil(libm::log2(length) * STEPS - NOISE);
    libm::exp2(steps / STEPS) * (1.0 + NOISE / STEPS)
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
    let texel = DVec2::new(quantised(size.x), quantised(size.y)) / usable;
    let first = first_line(volume.min.truncate() + anchor.truncate(), texel, kernel);
    let min = first * texel - anchor.truncate();
    let depth = quantised(size.z);
    let step = depth / DEPTH_STEPS;
    let z = libm::floor((volume.min.z + anchor.z) / step) * step - anchor.z;
    (volume.min, volume.max) = (min.extend(z), (min + texel * resolution).extend(z + depth + step));
}

/// The last grid line before a position that leaves the kernel's texels free.
fn first_line(position: DVec2, texel: DVec2, kernel: f64) -> DVec2 {
    let line = position / texel - kernel;
    DVec2::new(libm::floor(line.x), libm::floor(line.y))
}
