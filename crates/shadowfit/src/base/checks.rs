//! Checks of numbers that come from outside, and the limits that they use.
//!
//! They are kept in one place so that every input is checked by the same rule and errors name it.

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
