//! Projection of a point to the light's image in Rust. A test compares it with `point.wgsl`.

use glam::{Vec2, Vec4};

/// Returns the position of a clip-space point in the light's image: u right, v down, 0..1 inside.
pub fn image_uv(clip: Vec4) -> Vec2 {
    Vec2::new(clip.x / clip.w / 2.0 + 0.5, -clip.y / clip.w / 2.0 + 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clip_space_is_divided_by_w_and_turned_over() {
        // x: 3/4/2 + 1/2 = 0.875; y: -(-2)/4/2 + 1/2 = 0.75.
        assert_eq!(image_uv(Vec4::new(3.0, -2.0, 1.0, 4.0)), Vec2::new(0.875, 0.75));
    }
}
