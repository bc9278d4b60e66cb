//! The XNA sample's shading in Rust. A test compares it with `shade.wgsl`.
//!
//! Colours are display values. `n_l` is a cosine between unit vectors. `share` is the share of light, from 0
//! in shadow to 1.

use glam::Vec3;

/// Returns texture times N·L plus an ambient term that the texture does not colour. Shadow halves the sum.
pub fn colour(base: Vec3, n_l: f32, share: f32, ambient: f32) -> Vec3 {
    (base * n_l.clamp(0.0, 1.0) + ambient) * (0.5 + 0.5 * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: Vec3, b: [f32; 3]) -> bool {
        a.abs_diff_eq(Vec3::from(b), 1e-6)
    }

    #[test]
    fn the_xna_sample_halves_the_whole_sum_in_shadow() {
        // (0.8, 0.4, 0.2) * 0.5 + 0.15 = (0.55, 0.35, 0.25), and half of it.
        let base = Vec3::new(0.8, 0.4, 0.2);
        assert!(near(colour(base, 0.5, 1.0, 0.15), [0.55, 0.35, 0.25]));
        assert!(near(colour(base, 0.5, 0.0, 0.15), [0.275, 0.175, 0.125]));
        // Away from the light only the ambient term remains, without the texture.
        assert!(near(colour(base, -0.3, 1.0, 0.15), [0.15; 3]));
    }
}
