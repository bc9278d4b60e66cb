//! The formulas of the classic techniques in Rust, as their WGSL has them; a test compares the two.
//!
//! Colours are display values, depths are those after the division by w. `n_l` and `r_v` are cosines between unit vectors,
//! `share` is that of the light, 0 in shadow to 1.

use glam::{Vec2, Vec3};
use shadowfit::SpotBias;

/// Cube of the mirrored light's cosine, the technique's gloss.
const GLOSS: i32 = 3;
/// Diffuse and specular light of [`comparison_colour`].
const DIFFUSE: Vec3 = Vec3::new(0.5, 0.5, 0.4);
const SPECULAR: Vec3 = Vec3::new(0.2, 0.2, 0.3);
/// Greatest value of [`comparison_epsilon`], in units of the stored depth.
const MOST_EPSILON: f32 = 0.1;
/// Arc cosines below this count as this, in radians.
const LEAST_ANGLE: f32 = 1e-6;
/// Light term of [`terrain_colour`] in shadow.
const IN_SHADOW: f32 = 0.3;

/// XNA Shadow Mapping (Microsoft, 2008): 0 in shadow, which is where `stored < depth - bias`.
pub fn xna_share(stored: f32, depth: f32, bias: f32) -> f32 {
    if stored < depth - bias { 0.0 } else { 1.0 }
}

/// XNA Shadow Mapping: texture times N·L, and an ambient term that the texture does not colour; half of it in shadow.
pub fn xna_colour(base: Vec3, n_l: f32, share: f32, ambient: f32) -> Vec3 {
    (base * n_l.clamp(0.0, 1.0) + ambient) * (0.5 + 0.5 * share)
}

/// Headlight street: 1 inside the light's image where `depth - bias <= stored`. `inside` is 1 inside and 0 outside.
pub fn real_shadow_share(inside: f32, stored: f32, depth: f32, bias: f32) -> f32 {
    if depth - bias <= stored { inside } else { 0.0 }
}

/// Headlight street: base times diffuse of a power, and ambient.
pub fn headlight_colour(base: Vec3, n_l: f32, share: f32, power: f32, ambient: f32) -> Vec3 {
    base * (n_l.clamp(0.0, 1.0) * power * share + ambient)
}

/// Where a point of clip space lies in the light's image: u right, v down, 0..1 inside.
pub fn image_uv(clip: glam::Vec4) -> Vec2 {
    Vec2::new(clip.x / clip.w / 2.0 + 0.5, -clip.y / clip.w / 2.0 + 0.5)
}

/// Depth testing with a comparison sampler: epsilon over the arc cosine of N·L, 0..=0.1.
pub fn comparison_epsilon(epsilon: f32, n_l: f32) -> f32 {
    (epsilon / n_l.clamp(0.0, 1.0).acos().max(LEAST_ANGLE)).clamp(0.0, MOST_EPSILON)
}

/// Depth testing with a comparison sampler: whether a point is in the light's image; outside everything is lit.
pub fn comparison_is_inside(uv: Vec2, depth: f32) -> bool {
    uv.cmpge(Vec2::ZERO).all() && uv.cmple(Vec2::ONE).all() && depth > 0.0
}

/// Depth testing with a comparison sampler: ambient light alone, or with diffuse and specular light, by the share.
pub fn comparison_colour(base: Vec3, n_l: f32, r_v: f32, share: f32, ambient: f32) -> Vec3 {
    let mirrored = r_v.clamp(0.0, 1.0).powi(GLOSS);
    let full = base * (Vec3::splat(ambient) + DIFFUSE * n_l.clamp(0.0, 1.0) + SPECULAR * mirrored);
    (base * ambient).lerp(full, share)
}

/// Our test of a lamp's map: how far a point is lifted along its normal, by its distance along the light's axis and the sine
/// of the angle between the two. Formula of [`SpotBias`].
pub fn ours_lift(bias: &SpotBias, distance: f32, sine: f32) -> f32 {
    bias.normal_offset * distance * sine + bias.constant_offset
}

/// Our test of a lamp's map: depth toward the light, by the lifted point's distance along the axis, that sine, and the
/// light's distance from the point's plane. Formula of [`SpotBias`], without its receiver-plane term.
pub fn ours_depth(bias: &SpotBias, distance: f32, sine: f32, height: f32) -> f32 {
    bias.constant_depth + bias.distance_depth / distance + bias.slope_depth * sine / height
}

/// Terrain: 0 in shadow, which is where `stored - off_stored > from - depth`; the map stores 1 - z/w.
pub fn terrain_share(stored: f32, depth: f32, off_stored: f32, from: f32) -> f32 {
    if stored - off_stored > from - depth { 0.0 } else { 1.0 }
}

/// Terrain: texture times its light, which is 0.3 in shadow and 1 and more outside of it.
pub fn terrain_colour(base: Vec3, n_l: f32, share: f32, diffuse: f32, ambient: f32) -> Vec3 {
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
    fn the_xna_sample_halves_the_whole_sum_in_shadow() {
        // (0.8, 0.4, 0.2) * 0.5 + 0.15 = (0.55, 0.35, 0.25), and half of that.
        let base = Vec3::new(0.8, 0.4, 0.2);
        assert!(near(xna_colour(base, 0.5, 1.0, 0.15), [0.55, 0.35, 0.25]));
        assert!(near(xna_colour(base, 0.5, 0.0, 0.15), [0.275, 0.175, 0.125]));
        // Away from the light the ambient term alone is left, without the texture.
        assert!(near(xna_colour(base, -0.3, 1.0, 0.15), [0.15; 3]));
        // 0.5 < 0.502 - 0.001 = 0.501, but not 0.5 < 0.5005 - 0.001 = 0.4995.
        assert_eq!((xna_share(0.5, 0.502, 0.001), xna_share(0.5, 0.5005, 0.001)), (0.0, 1.0));
    }

    #[test]
    fn the_headlight_lights_inside_its_image_alone() {
        // (0.5, 0.4, 0.2) * (0.6 * 2 + 0.5) = (0.85, 0.68, 0.34); without light * 0.5.
        let base = Vec3::new(0.5, 0.4, 0.2);
        assert!(near(headlight_colour(base, 0.6, 1.0, 2.0, 0.5), [0.85, 0.68, 0.34]));
        assert!(near(headlight_colour(base, 0.6, 0.0, 2.0, 0.5), [0.25, 0.2, 0.1]));
        // 0.91 - 0.01 = 0.9 <= 0.9001; 0.92 - 0.01 = 0.91 > 0.9001.
        assert_eq!(real_shadow_share(1.0, 0.9001, 0.91, 0.01), 1.0);
        assert_eq!(real_shadow_share(1.0, 0.9001, 0.92, 0.01), 0.0);
        assert_eq!(real_shadow_share(0.0, 0.9001, 0.5, 0.01), 0.0);
        // x: 3/4/2 + 1/2 = 0.875; y: -(-2)/4/2 + 1/2 = 0.75.
        assert_eq!(image_uv(glam::Vec4::new(3.0, -2.0, 1.0, 4.0)), Vec2::new(0.875, 0.75));
    }

    #[test]
    fn the_comparison_samplers_epsilon_is_largest_head_on_and_least_at_grazing_light() {
        // acos 1 = 0: at the limit. cos 0.1 = 0.9950042: 0.001 / 0.1 = 0.01. acos 0 = 1.5707964: 0.001 / 1.5708 = 0.00063662.
        assert_eq!(comparison_epsilon(0.001, 1.0), 0.1);
        assert!((comparison_epsilon(0.001, 0.995_004_2) - 0.01).abs() < 1e-5);
        assert!((comparison_epsilon(0.001, 0.0) - 0.000_636_62).abs() < 1e-8);
        assert!((comparison_epsilon(0.0005, -0.5) - 0.000_318_31).abs() < 1e-8);
        assert!(comparison_is_inside(Vec2::new(0.0, 1.0), 0.1));
        assert!(!comparison_is_inside(Vec2::new(0.5, 0.5), 0.0) && !comparison_is_inside(Vec2::new(1.01, 0.5), 0.5));
    }

    #[test]
    fn the_core_has_the_same_epsilon() {
        for cosine in [-1.0, 0.0, 0.2, 0.7, 0.995, 1.0] {
            for epsilon in [0.001, 0.0005] {
                let core = shadowfit::bias::acos_bias(epsilon, cosine).expect("finite numbers");
                assert!((comparison_epsilon(epsilon, cosine) - core).abs() < 1e-6, "{epsilon} {cosine}");
            }
        }
    }

    #[test]
    fn the_comparison_samplers_light_is_ambient_diffuse_and_specular() {
        // Ambient 0.25, N·L 0.5, R·V 0.5 (cubed 0.125): red and green 0.25 + 0.25 + 0.025 = 0.525,
        // blue 0.25 + 0.2 + 0.0375 = 0.4875; times 0.8: 0.42, 0.42, 0.39. In shadow 0.8 * 0.25 = 0.2.
        let base = Vec3::splat(0.8);
        assert!(near(comparison_colour(base, 0.5, 0.5, 1.0, 0.25), [0.42, 0.42, 0.39]));
        assert!(near(comparison_colour(base, 0.5, 0.5, 0.0, 0.25), [0.2; 3]));
        // A fraction of a half lies between: 0.31, 0.31, 0.295.
        assert!(near(comparison_colour(base, 0.5, 0.5, 0.5, 0.25), [0.31, 0.31, 0.295]));
    }

    #[test]
    fn shadow_on_the_terrain_has_three_tenths_of_the_light() {
        // N·L 0.5: 1 + 0.6 * 0.5 = 1.3, times 0.5 is 0.65; in shadow 0.3 * 0.5 = 0.15.
        let base = Vec3::splat(0.5);
        assert!(near(terrain_colour(base, 0.5, 1.0, 0.6, 0.0), [0.65; 3]));
        assert!(near(terrain_colour(base, 0.5, 0.0, 0.6, 0.0), [0.15; 3]));
        // Stored 1 - 0.5 = 0.5: 0.47 > 0.98 - 0.52 = 0.46 is shadow, 0.47 > 0.98 - 0.505 = 0.475 is not.
        assert_eq!((terrain_share(0.5, 0.52, 0.03, 0.98), terrain_share(0.5, 0.505, 0.03, 0.98)), (0.0, 1.0));
    }

    #[test]
    fn a_lamps_bias_grows_with_distance_and_slope() {
        // 0.002 * 30 * 0.5 + 0.01 = 0.04; 0.0001 + 0.003 / 30 + 0.006 * 0.5 / 10 = 0.0001 + 0.0001 + 0.0003 = 0.0005.
        let bias = SpotBias {
            constant_depth: 0.0001,
            distance_depth: 0.003,
            slope_depth: 0.006,
            normal_offset: 0.002,
            constant_offset: 0.01,
            receiver_plane: 0.0,
        };
        assert!((ours_lift(&bias, 30.0, 0.5) - 0.04).abs() < 1e-8);
        assert!((ours_depth(&bias, 30.0, 0.5, 10.0) - 0.000_5).abs() < 1e-9);
    }

    #[test]
    fn the_core_has_the_same_bias_of_a_lamp() {
        use shadowfit::glam::{DVec3, UVec2};
        use shadowfit::{DepthConvention, SpotLight};
        let lamp = SpotLight::toward(DVec3::new(1.0, 6.0, 2.0), DVec3::new(0.0, 0.0, -1.0), 1.2, 1.0, 0.5, 40.0);
        let fit = lamp.fit(UVec2::splat(512), DepthConvention::ZeroToOne).expect("a lamp");
        let automatic = SpotBias::automatic(2.0, shadowfit::settings::MapFormat::Depth32Float, &fit).expect("a bias");
        let bias = SpotBias { slope_depth: 0.01, ..automatic };
        for (point, normal) in [
            (DVec3::new(0.5, 0.0, -1.0), Vec3::Y),
            (DVec3::new(-1.0, 1.0, 0.3), Vec3::new(0.4, 0.8, 0.6)),
            (DVec3::new(2.0, 0.2, -2.0), Vec3::new(-0.9, 0.2, 0.3)),
        ] {
            let core = bias.on_plane(&fit, point, normal).expect("a point before the lamp");
            let (normal, away) = (normal.normalize(), (lamp.position - point).as_vec3());
            let normal = if normal.dot(away) < 0.0 { -normal } else { normal };
            let sine = normal.cross(fit.direction).length();
            let lift = ours_lift(&bias, -away.dot(fit.direction), sine);
            assert!((lift - core.offset).abs() < 1e-6, "{lift} {core:?}");
            let lifted = (normal * lift - away).dot(fit.direction);
            let depth = ours_depth(&bias, lifted, sine, normal.dot(away));
            assert!((depth - core.depth).abs() < 1e-6 * core.depth.max(1.0), "{depth} {core:?}");
        }
    }
}
