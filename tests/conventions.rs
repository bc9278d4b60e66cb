//! Conventions across the crates, from settings to uniforms: the output of one crate is valid input of the
//! next. Each crate's own tests check its own conventions.

use shadowfit::Preset;
use shadowfit::culling::Reader;
use shadowfit::glam::{DVec3, Mat4, Vec3, Vec4};
use shadowfit::settings::{BiasSettings, FitSettings, MapFormat};
use shadowfit::{Bias, DepthConvention, FittedMap, LightProjection, PerspectiveCamera, Technique, fit};
use shadowfit_params::tool::{CameraSettings, LightSettings};
use shadowfit_render::{Atmosphere, FlyCamera, FrameUniform, Line, box_lines};
use shadowfit_scene::builtin;
use shadowfit_study::NamedTechnique;
use shadowfit_truth::{Tracer, TruthSettings};
use shadowfit_viewer::Stage;
use shadowfit_wgpu::uniforms::{CasterUniform, MapUniform, ReceiverUniform};
use shadowfit_wgpu::{MAX_MAPS, RESOLUTIONS, ShadowMapDescriptor};

use crate::support::test_gpu;

/// The depth conventions that wgpu supports.
const DRAWABLE: [DepthConvention; 2] = [DepthConvention::ZeroToOne, DepthConvention::Reversed];

/// Tolerance: a few roundings of f32 coordinates of about 1.
const CLOSE: f32 = 1e-5;

fn fly() -> FlyCamera {
    FlyCamera::look_at(DVec3::new(3.0, 2.0, 5.0), DVec3::new(0.0, 1.0, 0.0))
}

fn camera() -> PerspectiveCamera {
    fly().perspective(&CameraSettings::default(), 1.6)
}

fn fitted(light: &LightSettings, depth: DepthConvention) -> LightProjection {
    let frustum = camera().frustum().expect("a good camera");
    fit(&frustum, light.direction(), &FitSettings::default().with_depth(depth)).expect("a good fit")
}

fn map(fit: &LightProjection) -> FittedMap {
    FittedMap::new(*fit, Bias::from_texels(&BiasSettings::default(), MapFormat::Depth32Float, fit))
}

fn matrix(columns: [[f32; 4]; 4]) -> Mat4 {
    Mat4::from_cols_array_2d(&columns)
}

#[test]
fn the_caster_and_the_receiver_uniform_of_a_fit_meet_in_the_same_texel_and_depth() {
    let origin = camera().eye + DVec3::new(0.5, -0.25, 2.0);
    for depth in DRAWABLE {
        let fit = fitted(&LightSettings::default(), depth);
        let clip_from_world = matrix(CasterUniform::new(&fit, origin).clip_from_world);
        let receiver =
            ReceiverUniform::new(&[map(&fit)], &Reader::from_eye(origin, Vec3::NEG_Z), &Technique::default().reading());
        let uv_from_world = matrix(receiver.maps[0].uv_from_world);
        for corner in fit.corners() {
            let point = (fit.origin + corner.as_dvec3() - origin).as_vec3();
            let clip = clip_from_world.transform_point3(point);
            let uv = uv_from_world.transform_point3(point);
            // wgpu's viewport: x right, y up in clip space, v down in the texture, depth unchanged.
            let expected = Vec3::new(clip.x * 0.5 + 0.5, 0.5 - clip.y * 0.5, clip.z);
            assert!(uv.abs_diff_eq(expected, CLOSE), "{depth:?}: {uv}, not {expected}");
        }
    }
}

#[test]
fn settings_uniforms_and_pictures_all_point_to_the_same_sun() {
    for (azimuth, elevation) in [(0.6, 0.75), (-2.0, 0.2), (0.0, core::f32::consts::FRAC_PI_2), (3.0, 1.2)] {
        let light = LightSettings { azimuth, elevation, ..Default::default() };
        let to_light = -light.direction();
        assert!(to_light.y > 0.0, "a sun above the horizon shines from above");
        let fit = fitted(&light, DepthConvention::ZeroToOne);
        let receiver = ReceiverUniform::new(
            &[map(&fit)],
            &Reader::from_eye(fit.origin, Vec3::NEG_Z),
            &Technique::default().reading(),
        );
        let frame = FrameUniform::new(camera(), to_light, true, &Atmosphere::default(), [16, 9]);
        assert!(Vec3::from(receiver.to_light).abs_diff_eq(to_light, CLOSE), "{light:?}: {:?}", receiver.to_light);
        assert_eq!(frame.to_light, to_light.to_array(), "{light:?}");
        // Moving toward the light lowers the depth of the plain convention.
        let depth_of = |point: Vec3| fit.uv_from_world.transform_point3(point).z;
        assert!(depth_of(to_light) < depth_of(Vec3::ZERO), "{light:?}");
    }
}

#[test]
fn biases_move_the_receiver_toward_the_light_in_both_depth_conventions() {
    let bias = BiasSettings { constant: 1.0, slope: 2.0, normal_offset: 3.0, receiver_plane: 4.0, depth_steps: 1.0 };
    for (depth, toward_light) in [(DepthConvention::ZeroToOne, -1.0), (DepthConvention::Reversed, 1.0)] {
        let fit = fitted(&LightSettings::default(), depth);
        let map = FittedMap::new(fit, Bias::from_texels(&bias, MapFormat::Depth32Float, &fit));
        let map = MapUniform::new(&map, fit.origin, &Technique::default().reading());
        let depth_of = |point: Vec3| matrix(map.uv_from_world).transform_point3(point).z;
        let lifted = depth_of(-fit.direction) - depth_of(Vec3::ZERO);
        assert!(lifted * toward_light > 0.0, "{depth:?}");
        assert!(map.constant_depth * toward_light > 0.0 && map.slope_depth * toward_light > 0.0, "{depth:?}: {map:?}");
        assert!(map.normal_offset > 0.0, "an offset along the normal leaves the surface: {map:?}");
        // One texel of constant bias equals one texel of height along the light.
        let texel = fit.texel_size.max_element();
        assert!((map.constant_depth - lifted * texel).abs() <= 1e-3 * map.constant_depth.abs(), "{depth:?}: {map:?}");
    }
}

#[test]
fn the_camera_s_uniform_has_reversed_depth_and_rays_through_its_pixels() {
    let camera = camera();
    let frame = FrameUniform::new(camera, Vec3::Y, true, &Atmosphere::default(), [160, 100]);
    let frustum = camera.frustum().expect("a good camera");
    let axis = |row: [f32; 4]| Vec4::from(row).truncate();
    let corners_xy = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
    for (index, corner) in frustum.corners.into_iter().enumerate() {
        let (x, y) = corners_xy[index % 4];
        let clip = matrix(frame.clip_from_world).project_point3(corner);
        let expected = Vec3::new(x, y, if index < 4 { 1.0 } else { 0.0 });
        assert!(clip.abs_diff_eq(expected, CLOSE), "{clip}, not {expected}: near is 1, far is 0");
        let ray = axis(frame.ray_right) * x + axis(frame.ray_up) * y + axis(frame.ray_forward);
        assert!(ray.normalize().abs_diff_eq(corner.normalize(), CLOSE), "the sky's ray misses corner {index}");
    }
    assert_eq!(frame.viewport, [160.0, 100.0], "the viewport is width, then height");
}

#[test]
fn without_a_fit_everything_is_lit_and_surplus_fits_are_left_out() {
    let none = ReceiverUniform::new(&[], &Reader::from_eye(DVec3::ZERO, Vec3::NEG_Z), &Technique::default().reading());
    assert_eq!(none.map_count, 0);
    assert_eq!(Vec3::from(none.to_light).length(), 1.0, "a direction that can be used");
    let fit = fitted(&LightSettings::default(), DepthConvention::ZeroToOne);
    let many = ReceiverUniform::new(
        &[map(&fit); MAX_MAPS + 3],
        &Reader::from_eye(DVec3::ZERO, Vec3::NEG_Z),
        &Technique::default().reading(),
    );
    assert_eq!(many.map_count as usize, MAX_MAPS);
}

/// Returns a technique with the distance and the resolution of another one, which depend on the scene and the
/// budget.
fn with_extent_of(technique: &Technique, other: &Technique) -> Technique {
    let fit = technique.fit.with_max_distance(other.fit.max_distance).with_resolution(other.fit.resolution);
    (*technique).with_fit(fit)
}

#[test]
fn the_core_the_shadow_map_and_the_list_of_techniques_recommend_the_same_one() {
    let recommended = Technique::default();
    assert_eq!(Technique::preset(Preset::RECOMMENDED), Some(recommended));
    assert_eq!(NamedTechnique::default().technique, recommended);
    assert_eq!(FitSettings::default().map, recommended.fit);
    assert_eq!(ShadowMapDescriptor::default(), ShadowMapDescriptor::from(&recommended));
    assert_eq!(recommended.border(), 3.0, "the reach of PCF 5×5");
}

#[test]
fn gpu_the_viewer_starts_with_the_recommended_technique() {
    let stage = Stage::new(test_gpu(), builtin::default_scene(), 1).expect("the default scene");
    let start = stage.settings.technique;
    assert_eq!(start, with_extent_of(&Technique::default(), &start));
}

#[test]
fn every_resolution_of_the_panel_is_one_that_a_map_can_have() {
    use shadowfit_params::{Kind, Number, parameter};
    for id in ["map.resolution", "map.height"] {
        let Kind::Number(Number { min, max, .. }) = parameter(id).expect(id).kind else {
            panic!("{id} is a number");
        };
        let range = (min, max);
        assert_eq!(range, (f64::from(*RESOLUTIONS.start()), f64::from(*RESOLUTIONS.end())), "{id}");
    }
}

/// Compares rays and map for the same floor under the same caster: the light's direction must have the same
/// sign in both.
#[test]
fn rays_and_the_map_put_a_shadow_on_the_same_side() {
    // A square metre, 2 m above the ground at the origin.
    let corner = |x: f32, z: f32| Vec3::new(x, 2.0, z);
    let caster = [
        [corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5)],
        [corner(-0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)],
    ];
    let tracer = Tracer::new(caster);
    // Sun in +x at 45 degrees: the shadow falls 2 m toward -x.
    let light = LightSettings {
        azimuth: core::f32::consts::FRAC_PI_2,
        elevation: core::f32::consts::FRAC_PI_4,
        ..Default::default()
    };
    let to_light = -light.direction();
    let settings = TruthSettings::new(to_light.as_dvec3());
    let fit = fitted(&light, DepthConvention::ZeroToOne).relative_to(DVec3::ZERO);
    let center = fit.uv_from_world.transform_point3(Vec3::new(0.0, 2.0, 0.0));
    for (x, shadowed) in [(-2.0, true), (0.0, false), (2.0, false)] {
        let floor = Vec3::new(x, 0.0, 0.0);
        assert_eq!(tracer.is_occluded(floor + Vec3::Y * settings.ray_offset as f32, to_light), shadowed, "x = {x}");
        let uv = fit.uv_from_world.transform_point3(floor);
        let same_texel = (uv - center).truncate().length() < CLOSE;
        assert_eq!(same_texel && uv.z > center.z, shadowed, "x = {x}: {uv} against {center}");
    }
}

#[test]
fn the_box_drawn_around_a_fit_has_its_corners_and_edges() {
    let fit = fitted(&LightSettings::default(), DepthConvention::Reversed);
    let lines: [Line; 12] = box_lines(fit.origin, &fit.corners(), Vec4::ONE);
    let size = fit.box_max - fit.box_min;
    let sides = [size.x, size.y, fit.depth_range];
    for side in sides {
        let count =
            lines.iter().filter(|line| (line.ends[0].distance(line.ends[1]) as f32 - side).abs() < 1e-4 * side).count();
        assert!(count >= 4, "{count} edges of {side} m");
    }
    assert!(lines.iter().all(|line| line.ends.iter().all(|end| fit.covers(*end))), "the ends lie on the map's box");
}

#[test]
fn the_built_in_scene_is_in_metres_with_y_up_and_a_sun_above() {
    let scene = builtin::default_scene();
    let pose = scene.pose(None, 0.0);
    let bounds = scene.bounds(&pose).expect("triangles");
    let subject = scene.subject.and_then(|subject| scene.node_bounds(&pose, subject)).expect("a figure");
    let (height, width) = (subject.size().y, subject.size().x.max(subject.size().z));
    assert!((1.0..3.0).contains(&height) && height > width, "a figure of a person's size stands upright: {subject:?}");
    assert!(bounds.size().y < bounds.size().x.max(bounds.size().z), "the ground is level: {bounds:?}");
    let sun = scene.sun.expect("a sun").direction;
    assert!(sun.y < 0.0, "light travels downward: {sun}");
    let light = LightSettings::from_direction(sun).expect("a good direction");
    assert!(light.direction().abs_diff_eq(sun.normalize(), CLOSE));
    let (eye, target) = builtin::default_camera();
    assert!(FlyCamera::look_at(eye.as_dvec3(), target.as_dvec3()).forward().dot(target - eye) > 0.0);
}
