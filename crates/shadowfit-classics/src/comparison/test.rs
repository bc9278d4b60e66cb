//! The comparison sampler's shadow test in Rust. A test compares it with `test.wgsl`. Its bias is
//! [`acos_bias`](shadowfit::bias::acos_bias) of the core.

use glam::Vec2;

/// Returns whether a point is inside the light's image. All points outside are lit. `depth` is after the
/// division by w.
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
