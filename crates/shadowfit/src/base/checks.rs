//! Checks of input numbers, bounds of rounding, and branch-free arithmetic.
//!
//! All inputs are checked here by the same rules, and errors name the input.

use glam::{DVec3, Vec3};

use crate::base::FitError;

/// Least accepted length, in metres (or of a direction). Its square is still a normal f32, so neither this
/// crate's matrices nor a shader that squares it loses all digits.
pub(crate) const MIN_LENGTH: f64 = 1e-18;

/// Greatest accepted length or coordinate, in metres. Its square still fits f32.
pub(crate) const MAX_LENGTH: f64 = 1e18;

/// Refuses NaN and infinity.
#[inline]
pub(crate) fn finite(input: &'static str, value: f64) -> Result<f64, FitError> {
    within(input, value, f64::MIN, f64::MAX)
}

/// Rounds a result to f32. Refuses results that are not finite in f32.
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

/// Returns the error for a value outside `min..=max`. It is separate from the checks, so that only a
/// comparison is inlined at the call.
#[cold]
fn refusal(input: &'static str, value: f64, min: f64, max: f64) -> FitError {
    if value.is_finite() {
        FitError::OutOfRange { input, value, min, max }
    } else {
        FitError::NotFinite { input, value }
    }
}

/// Allows a view to begin beyond the shadow distance, unless this distance is below [`MIN_LENGTH`].
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

/// Returns the unit vector along `value`, in f64.
#[inline]
pub(crate) fn unit(input: &'static str, value: Vec3) -> Result<DVec3, FitError> {
    let length = length(value.as_dvec3());
    if (MIN_LENGTH..=MAX_LENGTH).contains(&length) {
        Ok(value.as_dvec3() / length)
    } else {
        Err(bad_direction(input, value, length))
    }
}

/// Returns the error for a direction that is not finite, too short or too long.
#[cold]
fn bad_direction(input: &'static str, value: Vec3, length: f64) -> FitError {
    let bad = value.to_array().into_iter().find(|component| !component.is_finite());
    bad.map_or(FitError::BadDirection { input, length }, |bad| FitError::NotFinite { input, value: f64::from(bad) })
}

/// Computes the length of a vector. The square root is libm's, which is the same on every target.
#[inline]
pub(crate) fn length(v: DVec3) -> f64 {
    libm::sqrt(v.dot(v))
}

/// Greatest relative rounding of one operation in f32: 2⁻²⁴.
pub(crate) const UNIT: f64 = 1.0 / 16_777_216.0;

/// Enlargement of a box on each side, as a share of the sum of its greatest distance from the origin and its
/// extent.
///
/// The product of a shader's f32 matrix and an f32 position has an error of up to ten times [`UNIT`] of the
/// sum of its terms, as counted in [`prove`](crate::proof). The matrix's elements add two and the frustum's
/// corners two more. The terms of the position sum to at most its distance d. The translation is at most d
/// plus half the extent e, and an offset of the texture or clip coordinates adds another half: 14 d + 12 (d +
/// e), which is less than 28 (d + e).
pub(crate) const ROUNDING: f64 = 28.0 * UNIT;

/// Rounding of a view depth in a shader, as a share of the depth. It is nine times [`UNIT`] of the point's
/// distance, which is up to seven times its depth in the corner of a wide view.
pub(crate) const VIEW_DEPTH_ROUNDING: f32 = 64.0 * UNIT as f32;

/// Least extent, as a share of a map's longer side or of its distance from the origin. Smaller extents are
/// widened to it: a flat wall seen edge-on from the light has no width, but a matrix needs one.
pub(crate) const THINNEST: f64 = 1e-5;

/// Returns the lesser of two numbers in one instruction, or the second one if either is NaN. [`greater`]
/// likewise.
#[inline(always)]
pub(crate) const fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
pub(crate) const fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Computes the floor of a number. The bits equal libm's, without a function call in the common case.
#[inline]
pub(crate) fn floor(x: f64) -> f64 {
    // From here on all numbers are whole. Smaller ones lose their fraction when this is added.
    const WHOLE: f64 = 4_503_599_627_370_496.0;
    let whole = WHOLE.copysign(x);
    let near = x + whole - whole;
    // No branch, since the direction of rounding is unpredictable.
    let floor = near - f64::from(u8::from(near > x));
    if x.abs() < WHOLE { floor.copysign(x) } else { x }
}
