//! Pixels per texel at a visible point: how finely a map samples it.

use glam::DVec2;

/// Cosine toward the light below which a point is grazing. Pixels per texel of grazing points are not
/// measured.
pub const MIN_FACING: f64 = 0.05;

/// Returns pixels per texel along the worse axis: one over the smaller singular value of the matrix with
/// these columns, the texels for a pixel to the right and for a pixel down. Infinite or NaN if that value is
/// 0.
pub fn pixels_per_texel([right, down]: [DVec2; 2]) -> f64 {
    // The singular values are half of the sum and of the difference of these lengths. Their product is the
    // determinant, which keeps the digits that the difference loses.
    let sum = DVec2::new(right.x + down.y, right.y - down.x).length();
    let difference = DVec2::new(right.x - down.y, right.y + down.x).length();
    0.5 * (sum + difference) / right.perp_dot(down).abs()
}
