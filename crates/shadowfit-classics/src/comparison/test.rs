//! The test of the comparison sampler's sample in Rust, as `test.wgsl` has it; a test compares the two. Its bias is the
//! core's [`acos_bias`](shadowfit::bias::acos_bias).

use glam::Vec2;

/// Whether a point is in the light's image; outside everything is lit. `depth` is that after the division by w.
pub fn is_inside(uv: Vec2, depth: f32) -> bool {
    uv.cmpge(Vec2::ZERO).all() && uv.cmple(Vec2::ONE).all() && depth > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outside_and_before_the_image_is_not_inside() {
        assert!(is_inside(Vec2::new(0.0, 1.0), 0.1));
        assert!(!is_inside(Vec2::new(0.5, 0.5), 0.0) && !is_inside(Vec2::new(1.01, 0.5), 0.5));
    }
}
