//! How finely a map samples a visible point: pixels per texel.

use glam::DVec2;

/// Points with a smaller cosine toward the light are grazing; their pixels per texel are not
/// measured.
pub const MIN_FACING: f64 = 0.05;

/// Pixels per texel along the worse axis: one over the smaller singular value of the matrix with
/// these columns, texels for a pixel to the right and for one down. Infinite or not a number where
/// that value is 0.
pub fn pixels_per_texel([right, down]: [DVec2; 2]) -> f64 {
    // The singular values are half of the sum and the difference of these lengths, and their product
    // is the determinant, which keeps its digits where the difference loses them.
    let sum = DVec2::new(right.x + down.y, right.y - down.x).length();
    let difference = DVec2::new(right.x - down.y, right.y + down.x).length();
    0.5 * (sum + difference) / right.perp_dot(down).abs()
}
