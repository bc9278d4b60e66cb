//! Checks the guarantee of fits: an error, or only finite numbers.

use shadowfit::glam::{DVec3, Mat4, UVec2, Vec3};
use shadowfit::spot::SpotLight;
use shadowfit::{
    Aabb, Boxes, CasterVolume, DepthConvention, FitError, FitInput, FittedMaps, LightProjection, PerspectiveCamera,
    ShadowFitter, Technique,
};

/// Fits a frame, and checks its maps and caster volumes.
pub(crate) fn fit(fitter: &mut ShadowFitter, input: &FitInput) -> Result<(), FitError> {
    let technique = *fitter.technique();
    let maps = *fitter.fit(input)?;
    check_maps(&maps);
    let volumes = maps.caster_volumes(input.views, &technique)?;
    for plane in volumes.iter().flat_map(CasterVolume::active_planes) {
        assert!(plane.is_finite(), "{technique:?}: a plane of casters is {plane}");
    }
    Ok(())
}

/// Fits a simple scene, which works with any valid technique.
pub(crate) fn fit_simple_scene(technique: &Technique) {
    let objects = [
        Aabb::new(Vec3::new(-80.0, -0.1, -80.0), Vec3::new(80.0, 0.0, 80.0)),
        Aabb::new(Vec3::new(-4.0, 0.0, -12.0), Vec3::new(4.0, 6.0, -6.0)),
    ];
    let boxes = Boxes::world(&objects);
    let mut fitter = ShadowFitter::new(technique);
    for frame in 0..3 {
        let eye = DVec3::new(0.0, 1.7, 20.0 - 0.1 * f64::from(frame));
        let (forward, up) = (Vec3::NEG_Z, Vec3::Y);
        let camera = PerspectiveCamera { eye, forward, up, fov_y: 0.8, aspect: 16.0 / 9.0, near: 0.1, far: 200.0 };
        let views = [camera.frustum().expect("a camera")];
        let sun = Vec3::new(0.3, -0.8, 0.2);
        let input = FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, sun) };
        // A technique may have settings that cannot be fitted.
        let _ = fit(&mut fitter, &input);
    }
}

/// Checks all numbers of a frame's maps.
pub(crate) fn check_maps(maps: &FittedMaps) {
    for map in maps.iter() {
        check_fit(&map.projection);
        let bias = map.bias;
        let numbers = [bias.constant_depth, bias.slope_depth, bias.normal_offset, bias.receiver_plane];
        assert!(numbers.iter().all(|number| number.is_finite()), "{bias:?}");
        assert!(
            map.depths.is_none_or(|range| {
                let depths = [Some(range.near), range.far, range.covered_from];
                depths.iter().flatten().all(|depth| depth.is_finite())
            }),
            "{map:?}"
        );
        if let Some(grid_position) = map.grid_position {
            assert!(
                grid_position.texel.is_finite() && grid_position.depth.iter().all(|depth| depth.is_finite()),
                "{grid_position:?}"
            );
        }
    }
}

fn check_fit(fit: &LightProjection) {
    let matrices = [fit.light_from_world, fit.clip_from_light, fit.clip_from_world, fit.uv_from_world];
    let are_finite = matrices.iter().all(Mat4::is_finite)
        && [fit.direction, fit.box_min, fit.box_max].iter().all(|vector| vector.is_finite())
        && fit.origin.is_finite()
        && fit.texel_size.is_finite()
        && fit.depth_range.is_finite();
    assert!(are_finite && fit.texel_size.min_element() > 0.0 && fit.depth_range > 0.0, "{fit:?}");
}

/// Checks all numbers of a lamp's map.
pub(crate) fn check_spot(light: &SpotLight, resolution: UVec2) {
    let Ok(fit) = light.fit(resolution, DepthConvention::Reversed) else { return };
    let matrices = [fit.light_from_world, fit.clip_from_light, fit.clip_from_world, fit.uv_from_world];
    assert!(matrices.iter().all(Mat4::is_finite) && fit.texel_size.is_finite(), "{fit:?}");
}
