//! Numbers: how far rounding may move them, and comparisons without a branch.

/// Greatest relative rounding of one operation in f32: 2⁻²⁴.
pub(crate) const UNIT: f64 = 1.0 / 16_777_216.0;

/// What a box is enlarged by on each side, as a share of the greatest distance from the origin and
/// the box's own extent together.
///
/// A shader's f32 matrix times an f32 position is off by ten times [`UNIT`] of the sum of its terms, as
/// [`verify`](crate::verify) counts, the matrix's elements by two and the frustum's corners by two
/// more. The terms of the position sum to no more than its distance d, the translation is no more
/// than d and half the extent e, and an offset of the texture or clip coordinates adds another
/// half: 14 d + 12 (d + e), which is less than 28 (d + e).
pub(crate) const ROUNDING: f64 = 28.0 * UNIT;

/// Rounding of a view depth in a shader, as a share of it: nine times [`UNIT`] of a point's distance, which in the
/// corner of a wide view is up to seven times its depth.
pub(crate) const VIEW_DEPTH_ROUNDING: f32 = 64.0 / 16_777_216.0;

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
