//! The terrain sample's shading in Rust. A test compares it with `shade.wgsl`.
//!
//! Colours are display values. `n_l` is a cosine between unit vectors. `share` is the share of light, from 0
//! in shadow to 1.

use glam::Vec3;

/// Light term of [`colour`] in shadow.
const IN_SHADOW: f32 = 0.3;

/// Returns texture times light. The light is 0.3 in shadow, and 1 or more outside of it.
pub fn colour(base: Vec3, n_l: f32, share: f32, diffuse: f32, ambient: f32) -> Vec3 {
    let lit = 1.0 + diffuse * n_l.max(0.0);
    base * (IN_SHADOW + (lit - IN_SHADOW) * share + ambient)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: Vec3, b: [f32; 3]) -> bool {
        a.abs_diff_eq(Vec3::from(b), 1e-6)
    }

    #[test]
    fn shadow_on_the_terrain_has_three_tenths_of_the_light() {
        // N·L 0.5: 1 + 0.6 * 0.5 = 1.3, times 0.5 is 0.65; in shadow 0.3 * 0.5 = 0.15.
        let base = Vec3::splat(0.5);
        assert!(near(colour(base, 0.5, 1.0, 0.6, 0.0), [0.65; 3]));
        assert!(near(colour(base, 0.5, 0.0, 0.6, 0.0), [0.15; 3]));
    }
}
