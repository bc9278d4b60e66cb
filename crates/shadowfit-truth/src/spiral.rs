//! Vogel's spiral (H. Vogel, "A better way to construct the sunflower head", 1979): points that are spread
//! evenly over a disc. They form no rows, so that no straight shadow edge fits between two rows.

use core::f64::consts::TAU;

/// Angle between consecutive points, in radians: the golden angle.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Returns sine and cosine of the angle of a point on the spiral, which is turned by `turn` radians.
pub(crate) fn sin_cos(index: u32, turn: f64) -> (f64, f64) {
    (f64::from(index) * GOLDEN_ANGLE + turn).sin_cos()
}

/// Returns the turn of a pixel's spiral, in radians. Neighbouring pixels differ, so that their errors do.
pub(crate) fn turn_of(pixel: usize) -> f64 {
    // Fibonacci hashing: takes the upper bits of the product with 2^64 over the golden ratio.
    let hash = (pixel as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let hash = (hash ^ (hash >> 32)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    (hash >> 11) as f64 / (1u64 << 53) as f64 * TAU
}
