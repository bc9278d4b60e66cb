//! The formulas of the comparison sampler's sample in Rust, as `test.wgsl` and `shade.wgsl` have them; a test compares
//! the two.
//!
//! Colours are display values, depths those after the division by w; `n_l` and `r_v` are cosines between unit vectors,
//! `share` is that of the light, 0 in shadow to 1.

use glam::{Vec2, Vec3};

/// Cube of the mirrored light's cosine, the technique's gloss.
const GLOSS: i32 = 3;
/// Diffuse and specular light of [`colour`].
const DIFFUSE: Vec3 = Vec3::new(0.5, 0.5, 0.4);
const SPECULAR: Vec3 = Vec3::new(0.2, 0.2, 0.3);

/// Epsilon of [`acos_bias`] for one comparison, in units of the stored depth times radians.
pub const EPSILON: f32 = 0.001;
/// The same with the hardware's linear filtering.
pub const LINEAR_EPSILON: f32 = 0.0005;
/// Greatest value of [`acos_bias`], in units of the stored depth.
pub const ACOS_BIAS_LIMIT: f32 = 0.1;

/// `epsilon / acos(saturate(N·L))` within 0..=[`ACOS_BIAS_LIMIT`], in units of the stored depth.
///
/// A formula from the early days of comparison samplers, kept to show its flaw: it is meant to approximate `epsilon ·
/// tan(acos N·L)`, but it is *largest* head-on (the limit at 0°, 0.01 at 0.1 rad) and *least* at grazing light (0.00064
/// at 90°), where acne is worst. Its source adds it to the depth of a map that holds back faces; with front faces it
/// has to be subtracted. [`Bias::slope_depth`](shadowfit::Bias::slope_depth) is the correct form.
pub fn acos_bias(epsilon: f32, n_l: f32) -> f32 {
    // Head-on the angle is 0; any epsilon but 0 is at the limit there.
    (epsilon / n_l.clamp(0.0, 1.0).acos().max(f32::MIN_POSITIVE)).min(ACOS_BIAS_LIMIT)
}

/// Whether a point is in the light's image; outside everything is lit.
pub fn is_inside(uv: Vec2, depth: f32) -> bool {
    uv.cmpge(Vec2::ZERO).all() && uv.cmple(Vec2::ONE).all() && depth > 0.0
}

/// Ambient light alone, or with diffuse and specular light, by the share.
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
    fn outside_and_before_the_image_is_not_inside() {
        assert!(is_inside(Vec2::new(0.0, 1.0), 0.1));
        assert!(!is_inside(Vec2::new(0.5, 0.5), 0.0) && !is_inside(Vec2::new(1.01, 0.5), 0.5));
    }

    #[test]
    fn epsilon_over_acos_is_largest_head_on_and_least_at_grazing_light() {
        let at = |radians: f32| acos_bias(EPSILON, radians.cos());
        assert_eq!(at(0.0), ACOS_BIAS_LIMIT);
        assert!((at(0.1) / 0.01 - 1.0).abs() < 1e-4, "{}", at(0.1));
        assert!((at(std::f32::consts::FRAC_PI_2) - 0.000_637).abs() < 1e-6);
        assert!((0..90).map(|i| (i as f32).to_radians()).all(|a| at(a) >= at(a + 0.01)), "it falls with the angle");
        // Saturated on both sides.
        assert_eq!(acos_bias(0.001, 2.0), ACOS_BIAS_LIMIT);
        assert_eq!(acos_bias(0.001, -0.7), acos_bias(0.001, 0.0));
        assert_eq!(acos_bias(0.0, 1.0), 0.0);
    }

    #[test]
    fn the_comparison_samplers_light_is_ambient_diffuse_and_specular() {
        // Ambient 0.25, N·L 0.5, R·V 0.5 (cubed 0.125): red and green 0.25 + 0.25 + 0.025 = 0.525,
        // blue 0.25 + 0.2 + 0.0375 = 0.4875; times 0.8: 0.42, 0.42, 0.39. In shadow 0.8 * 0.25 = 0.2.
        let base = Vec3::splat(0.8);
        assert!(near(colour(base, 0.5, 0.5, 1.0, 0.25), [0.42, 0.42, 0.39]));
        assert!(near(colour(base, 0.5, 0.5, 0.0, 0.25), [0.2; 3]));
        // A fraction of a half lies between: 0.31, 0.31, 0.295.
        assert!(near(colour(base, 0.5, 0.5, 0.5, 0.25), [0.31, 0.31, 0.295]));
    }
}
