//! The shading of the street's second stage in Rust. A test compares it with `shade.wgsl`.
//!
//! Colours are display values. `n_l` is a cosine between unit vectors. `share` is the share of light, from 0
//! in shadow to 1.

use glam::Vec3;

/// Returns `base` times the sum of diffuse light of a power and ambient light.
pub fn colour(base: Vec3, n_l: f32, share: f32, power: f32, ambient: f32) -> Vec3 {
    base * (n_l.clamp(0.0, 1.0) * power * share + ambient)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: Vec3, b: [f32; 3]) -> bool {
        a.abs_diff_eq(Vec3::from(b), 1e-6)
    }

    #[test]
    fn the_headlight_lights_inside_its_image_alone() {
        // (0.5, 0.4, 0.2) * (0.6 * 2 + 0.5) = (0.85, 0.68, 0.34); without light * 0.5.
        let base = Vec3::new(0.5, 0.4, 0.2);
        assert!(near(colour(base, 0.6, 1.0, 2.0, 0.5), [0.85, 0.68, 0.34]));
        assert!(near(colour(base, 0.6, 0.0, 2.0, 0.5), [0.25, 0.2, 0.1]));
    }
}
