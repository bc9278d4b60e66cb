//! The comparison sampler's shading in Rust. A test compares it with `shade.wgsl`.
//!
//! Colours are display values. `n_l` and `r_v` are cosines between unit vectors. `share` is the share of
//! light, from 0 in shadow to 1.

use glam::Vec3;

/// Exponent of the cosine of the mirrored light: the gloss of the technique.
const GLOSS: i32 = 3;
/// Diffuse and specular light of [`colour`].
const DIFFUSE: Vec3 = Vec3::new(0.5, 0.5, 0.4);
const SPECULAR: Vec3 = Vec3::new(0.2, 0.2, 0.3);

/// Returns ambient light plus `share` of the diffuse and specular light.
pub fn colour(base: Vec3, n_l: f32, r_v: f32, share: f32, ambient: f32) -> Vec3 {
    let mirrored = r_v.clamp(0.0, 1.0).powi(GLOSS);
    let full = base * (Vec3::splat(ambient) + DIFFUSE * n_l.clamp(0.0, 1.0) + SPECULAR * mirrored);
    (base * ambient).lerp(full, share)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: Vec3, b: [f32; 3]) -> bool {
        a.abs_diff_eq(Vec3::from(b), 1e-6)
    }

    #[test]
    fn the_comparison_samplers_light_is_ambient_diffuse_and_specular() {
        // Ambient 0.25, N·L 0.5, R·V 0.5 (cubed 0.125): red and green 0.25 + 0.25 + 0.025 = 0.525,
        // blue 0.25 + 0.2 + 0.0375 = 0.4875; times 0.8: 0.42, 0.42, 0.39. In shadow 0.8 * 0.25 = 0.2.
        let base = Vec3::splat(0.8);
        assert!(near(colour(base, 0.5, 0.5, 1.0, 0.25), [0.42, 0.42, 0.39]));
        assert!(near(colour(base, 0.5, 0.5, 0.0, 0.25), [0.2; 3]));
        // At a share of 0.5, halfway: 0.31, 0.31, 0.295.
        assert!(near(colour(base, 0.5, 0.5, 0.5, 0.25), [0.31, 0.31, 0.295]));
    }
}
