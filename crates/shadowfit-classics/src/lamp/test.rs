//! Our test of a lamp's map in Rust. Tests compare it with `test.wgsl`, and both with the core.

use glam::{Mat4, Vec2, Vec3};
use shadowfit::bias::MIN_COSINE;
use shadowfit::spot::SpotBias;

/// Returns the change of the stored depth over a texel along u and along v, on a plane with a unit normal
/// toward the light.
///
/// `light_from_world` is the matrix to the clip space of the lamp's image. `rise` is the change per texel of
/// a plane at unit distance. `to_light` is the vector from the point to the lamp.
pub fn gradient(light_from_world: Mat4, rise: Vec2, to_light: Vec3, normal: Vec3) -> Vec2 {
    // Rows of x and y are the light's axes, scaled by the lens.
    let [right, up] = [0, 1].map(|row| light_from_world.row(row).truncate().normalize());
    let height = normal.dot(to_light).max(MIN_COSINE * to_light.length());
    rise * Vec2::new(normal.dot(right), -normal.dot(up)) / height
}

/// Returns the depth that the middle look-up compares. `depth` and `distance` (along the light's axis) belong
/// to the point after its offset by [`SpotBias::constant_offset`]. `gradient` is the [`gradient`] of its
/// plane.
pub fn compared_depth(depth: f32, distance: f32, bias: &SpotBias, gradient: Vec2) -> f32 {
    let rise = bias.receiver_plane * (gradient.x.abs() + gradient.y.abs());
    depth - bias.constant_depth - bias.distance_depth / distance - rise
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, UVec2};
    use shadowfit::DepthConvention;
    use shadowfit::bias::FilterRadius;
    use shadowfit::diagnostics::DepthStorage;
    use shadowfit::spot::SpotLight;
    use shadowfit::spot::depth_gradient;

    use super::*;

    #[test]
    fn the_core_has_the_same_gradient_and_the_same_bias_of_a_lamp() {
        let lamp = SpotLight::toward(DVec3::new(1.0, 6.0, 2.0), DVec3::new(0.0, 0.0, -1.0), 1.2, 1.5, 0.5, 40.0);
        let fit = lamp.fit(UVec2::new(512, 256), DepthConvention::ZeroToOne).expect("a lamp");
        let bias = SpotBias::automatic_receiver_plane(FilterRadius::HARDWARE_2X2, DepthStorage::Float32, &fit);
        let bias = bias.expect("a bias");
        let fit = fit.relative_to(DVec3::ZERO);
        let rise = fit.texel_size * fit.depth_scale() as f32;
        for (point, normal) in [
            (DVec3::new(0.5, 0.0, -1.0), Vec3::Y),
            (DVec3::new(-1.0, 1.0, 0.3), Vec3::new(0.4, 0.8, 0.6).normalize()),
            (DVec3::new(2.0, 0.2, -2.0), Vec3::new(-0.9, 0.2, 0.3).normalize()),
        ] {
            let to_light = (lamp.position - point).as_vec3();
            let normal = if normal.dot(to_light) < 0.0 { -normal } else { normal };
            let found = gradient(fit.clip_from_world, rise, to_light, normal);
            let core = depth_gradient(&fit, point, normal).expect("a point before the lamp");
            assert!((found - core).length() < 1e-5 * core.length(), "{found} {core}");
            let core = bias.on_plane(&fit, point, normal).expect("a point before the lamp");
            assert_eq!(core.offset, bias.constant_offset, "the shader lifts every point by the same");
            let lifted = (normal * core.offset - to_light).dot(fit.direction);
            let moved = -compared_depth(0.0, lifted, &bias, found);
            assert!((moved - core.depth).abs() < 1e-5 * core.depth, "{moved} {core:?}");
        }
    }

    #[test]
    fn depths_move_toward_the_light_by_all_parts_of_the_bias() {
        // 0.5 - 0.0001 - 0.003 / 30 - 1.5 * (0.002 + 0.001) = 0.5 - 0.0001 - 0.0001 - 0.0045 = 0.4953.
        let bias =
            SpotBias { constant_depth: 0.0001, distance_depth: 0.003, receiver_plane: 1.5, ..SpotBias::default() };
        let found = compared_depth(0.5, 30.0, &bias, Vec2::new(0.002, -0.001));
        assert!((found - 0.4953).abs() < 1e-6, "{found}");
    }
}
