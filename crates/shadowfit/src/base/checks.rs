//! Checks of numbers that come from outside and the limits that they use, how far rounding may move numbers, and
//! arithmetic without a branch.
//!
//! Checks are kept in one place so that every input is checked by the same rule and errors name it.

use glam::{DVec3, Vec3};

use crate::base::FitError;

/// Shortest length that is accepted, in metres (or of a direction): its square is still a normal
/// f32, so neither this crate's matrices nor a shader that squares it loses all digits.
pub(crate) const MIN_LENGTH: f64 = 1e-18;

/// Greatest length or coordinate that is accepted, in metres: its square still fits f32.
pub(crate) const MAX_LENGTH: f64 = 1e18;

/// Refuses NaN and infinity.
#[inline]
pub(crate) fn finite(input: &'static str, value: f64) -> Result<f64, FitError> {
    within(input, value, f64::MIN, f64::MAX)
}

/// A result rounded to f32; refuses results that are not finite in f32.
#[inline]
pub(crate) fn rounded(output: &'static str, value: f64) -> Result<f32, FitError> {
    let rounded = value as f32;
    finite(output, f64::from(rounded)).map(|_| rounded)
}

/// Refuses numbers that are not finite or outside `min..=max`.
#[inline]
pub(crate) fn within(input: &'static str, value: f64, min: f64, max: f64) -> Result<f64, FitError> {
    if (min..=max).contains(&value) { Ok(value) } else { Err(refusal(input, value, min, max)) }
}

/// The error for a value outside `min..=max`. Separate from the checks themselves, so that only a
/// comparison is inlined at the call.
#[cold]
fn refusal(input: &'static str, value: f64, min: f64, max: f64) -> FitError {
    if value.is_finite() {
        FitError::OutOfRange { input, value, min, max }
    } else {
        FitError::NotFinite { input, value }
    }
}

/// Allows a view to begin where shadows have ended, unless they end at no distance at all.
pub(crate) fn may_begin_beyond(near: f32, distance: f32) -> Result<(), FitError> {
    let is_distance = f64::from(distance) >= MIN_LENGTH;
    if is_distance { Ok(()) } else { Err(FitError::NearNotBelowFar { near, far: distance }) }
}

/// Refuses a point with a coordinate that is not finite or beyond [`MAX_LENGTH`].
#[inline]
pub(crate) fn point(input: &'static str, value: DVec3) -> Result<DVec3, FitError> {
    for coordinate in value.to_array() {
        within(input, coordinate, -MAX_LENGTH, MAX_LENGTH)?;
    }
    Ok(value)
}

/// The unit vector along `value`, in f64.
#[inline]
pub(crate) fn unit(input: &'static str, value: Vec3) -> Result<DVec3, FitError> {
    let length = length(value.as_dvec3());
    if (MIN_LENGTH..=MAX_LENGTH).contains(&length) {
        Ok(value.as_dvec3() / length)
    } else {
        Err(bad_direction(input, value, length))
    }
}

/// The error for a direction that is not finite, or too short or too long to be one.
#[cold]
fn bad_direction(input: &'static str, value: Vec3, length: f64) -> FitError {
    let bad = value.to_array().into_iter().find(|component| !component.is_finite());
    bad.map_or(FitError::BadDirection { input, length }, |bad| FitError::NotFinite { input, value: f64::from(bad) })
}

/// Length of a vector; the square root is libm's, the same on every target.
#[inline]
pub(crate) fn length(v: DVec3) -> f64 {
    libm::sqrt(v.dot(v))
}

/// Greatest relative rounding of one operation in f32: 2⁻²⁴.
pub(crate) const UNIT: f64 = 1.0 / 16_777_216.0;

/// What a box is enlarged by on each side, as a share of the greatest distance from the origin and
/// the box's own extent together.
///
/// A shader's f32 matrix times an f32 position is off by ten times [`UNIT`] of the sum of its terms, as
/// [`prove`](crate::proof) counts, the matrix's elements by two and the frustum's corners by two
/// more. The terms of the position sum to no more than its distance d, the translation is no more
/// than d and half the extent e, and an offset of the texture or clip coordinates adds another
/// half: 14 d + 12 (d + e), which is less than 28 (d + e).
pub(crate) const ROUNDING: f64 = 28.0 * UNIT;

/// Rounding of a view depth in a shader, as a share of it: nine times [`UNIT`] of a point's distance, which in the
/// corner of a wide view is up to seven times its depth.
pub(crate) const VIEW_DEPTH_ROUNDING: f32 = 64.0 * UNIT as f32;

/// Extents below this share of a map's longer side, or of its distance from the origin, are widened
/// to it: a flat wall seen edge-on from the light has no width, but a matrix needs one.
pub(crate) const THINNEST: f64 = 1e-5;

/// The lesser and the greater one of two numbers, in one instruction each; the second one where one is NaN.
#[inline(always)]
pub(crate) const fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
pub(crate) const fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

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
