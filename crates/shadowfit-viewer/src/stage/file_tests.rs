//! Cameras and suns of files: the initial view of a scene, motion with its animation, and lengths that follow
//! from its size.

use core::f32::consts::FRAC_PI_2;

use glam::{DQuat, DVec3, Quat, Vec2, Vec3};
use shadowfit_params as params;
use shadowfit_scene::{
    Animation, Channel, ChannelValues, Interpolation, Lens as FileLens, Node, SceneCamera, SceneSun, Sun, Transform,
};
use shadowfit_testing::renderer_gpu;
use shadowfit_truth::Class;

use super::*;

const SIZE: [u32; 2] = [160, 90];

fn quad(corners: [Vec3; 4]) -> Vec<[Vec3; 3]> {
    let [a, b, c, d] = corners;
    vec![[a, b, c], [a, c, d]]
}

/// Returns a floor of 10 by 10 units, a post, and a plate at a height of 0.005 units over the floor.
fn model(scale: f32) -> Scene {
    let level = |y: f32, low: Vec2, high: Vec2| {
        quad([[low.x, low.y], [low.x, high.y], [high.x, high.y], [high.x, low.y]].map(|[x, z]| Vec3::new(x, y, z)))
    };
    let wall = |from: [f32; 2], to: [f32; 2]| {
        let at = |[x, z]: [f32; 2], y: f32| Vec3::new(x, y, z);
        quad([at(from, 0.0), at(to, 0.0), at(to, 2.0), at(from, 2.0)])
    };
    let corners = [[-0.4, -0.4], [0.5, -0.4], [0.5, 0.4], [-0.4, 0.4]];
    let mut post = level(2.0, Vec2::splat(-0.4), Vec2::new(0.5, 0.4));
    post.extend((0..4).flat_map(|side| wall(corners[side], corners[(side + 1) % 4])));
    let objects =
        [level(0.0, Vec2::splat(-5.0), Vec2::splat(5.0)), post, level(0.005, Vec2::new(1.0, 1.0), Vec2::new(3.0, 3.0))];
    let scaled = objects.map(|triangles| triangles.into_iter().map(|corners| corners.map(|c| c * scale)).collect());
    Scene::from_objects("model", &scaled)
}

/// Adds a node and returns its index.
fn add_node(scene: &mut Scene, rest: Transform) -> usize {
    scene.nodes.push(Node { rest, ..Node::default() });
    scene.nodes.len() - 1
}

fn add_camera(scene: &mut Scene, rest: Transform, lens: FileLens) {
    let node = add_node(scene, rest);
    scene.cameras.push(SceneCamera { name: "camera".to_owned(), node, lens });
}

/// Adds suns of some intensities, which travel along -z turned by `pitch` about x.
fn add_suns(scene: &mut Scene, suns: &[(f32, f32)]) {
    for (intensity, pitch) in suns {
        let node =
            add_node(scene, Transform { rotation: DQuat::from_rotation_x(f64::from(-pitch)), ..Transform::default() });
        scene.suns.push(SceneSun { name: String::new(), node, color: Vec3::ONE, intensity: *intensity });
    }
    let taken = scene.strongest_sun().map(|index| &scene.suns[index]);
    let direction = taken.and_then(|sun| sun.direction(&scene.pose(None, 0.0)));
    scene.sun = direction.map(|direction| Sun { direction, color: Vec3::ONE, intensity: 1.0 });
}

/// Turns a node about y from 0 to a right angle in 2 s.
fn turn(scene: &mut Scene, node: usize) {
    let rest = scene.nodes[node].rest.rotation;
    let values = ChannelValues::Rotation(vec![rest.as_quat(), Quat::from_rotation_y(FRAC_PI_2) * rest.as_quat()]);
    let channel = Channel { node, times: vec![0.0, 2.0], interpolation: Interpolation::Linear, values };
    scene.animations.push(Animation { name: String::new(), duration: 2.0, channels: vec![channel] });
}

fn stage(scene: Scene) -> Stage {
    let mut stage = Stage::new(renderer_gpu(), scene, 1).expect("a scene");
    stage.wait_for_rays();
    stage
}

const PERSPECTIVE: FileLens = FileLens::Perspective { fov_y: 0.8, near: 0.1, far: None };

#[test]
fn gpu_a_scene_opens_with_the_picture_of_its_camera_whatever_lens_and_node_that_has() {
    let rolled = DQuat::from_rotation_y(0.3) * DQuat::from_rotation_x(-0.4) * DQuat::from_rotation_z(0.6);
    let down = DQuat::from_rotation_x(-f64::from(FRAC_PI_2));
    let node = |rotation, scale| Transform { translation: DVec3::new(3.0, 6.0, 7.0), rotation, scale, matrix: None };
    let nodes = [
        node(rolled, DVec3::ONE),
        node(rolled, DVec3::new(0.01, 40.0, 3.0)),
        node(down, DVec3::splat(5.0)),
        node(DQuat::IDENTITY, DVec3::new(-1.0, 1.0, 1.0)),
    ];
    let degrees = [0.2_f32, 5.0, 45.0, 150.0, 170.0, 178.0];
    let mut lenses: Vec<FileLens> =
        degrees.iter().map(|d| FileLens::Perspective { fov_y: d.to_radians(), near: 0.5, far: Some(50.0) }).collect();
    lenses.push(FileLens::Perspective { fov_y: 1.0, near: 0.01, far: None });
    lenses.push(FileLens::Orthographic { half_height: 4.0, near: 0.0, far: 30.0 });
    lenses.push(FileLens::Orthographic { half_height: 0.1, near: 2.0, far: 1e9 });
    for (lens, rest) in lenses.iter().flat_map(|lens| nodes.map(|rest| (*lens, rest))) {
        let mut scene = model(1.0);
        add_camera(&mut scene, rest, lens);
        let placed = scene.cameras[0].placement(&scene.pose(None, 0.0)).expect("a placement");
        let stage = stage(scene);
        let (settings, camera) = (stage.settings, stage.camera_of(SIZE));
        let clip = camera.clip_from_world(shadowfit::DepthConvention::Reversed);
        let right = placed.forward.cross(placed.up);
        for (x, y, depth) in [(0.0, 0.0, 5.0), (0.7, -0.4, 9.0), (-0.9, 0.9, 25.0)] {
            let half = match lens {
                FileLens::Perspective { fov_y, .. } => (fov_y * 0.5).tan() * depth,
                FileLens::Orthographic { half_height, .. } => half_height,
            };
            let aside = right * (x * half * 16.0 / 9.0) + placed.up * (y * half);
            let point = placed.eye + (placed.forward * depth + aside).as_dvec3();
            let found = clip * (point - camera.eye).as_vec3().extend(1.0);
            let found = found.truncate() / found.w;
            // A thousandth of half the picture. Angles in f32 use up some of that for a lens of 0.2 degrees.
            assert!((found.truncate() - Vec2::new(x, y)).length() < 3e-3, "{lens:?}, {rest:?}: {found} for {x}, {y}");
            assert!((0.0..=1.0).contains(&found.z), "{lens:?}: depth {}", found.z);
        }
        assert_eq!(settings.camera.file, Some(1));
    }
}

#[test]
fn gpu_a_camera_of_the_file_moves_with_the_animation_until_it_is_flown() {
    let mut scene = model(1.0);
    let rest = Transform { translation: DVec3::new(0.0, 2.0, 9.0), ..Transform::default() };
    add_camera(&mut scene, rest, PERSPECTIVE);
    add_camera(&mut scene, rest, FileLens::Orthographic { half_height: 3.0, near: 0.1, far: 40.0 });
    let node = scene.cameras[0].node;
    turn(&mut scene, node);
    let mut stage = stage(scene);
    assert_eq!(stage.camera.forward(), Vec3::NEG_Z);
    stage.update(&FlyInput::default(), 1.0);
    let turned = Quat::from_rotation_y(FRAC_PI_2 * 0.5) * Vec3::NEG_Z;
    assert!((stage.camera.forward() - turned).length() < 1e-5, "{:?}", stage.camera);
    stage.update(&FlyInput { wheel: 1.0, ..FlyInput::default() }, 0.0);
    assert_eq!(stage.settings.camera.file, Some(1), "the wheel flies nowhere");
    stage.update(&FlyInput { movement: Vec3::X, ..FlyInput::default() }, 0.01);
    let flown = stage.camera.forward();
    stage.update(&FlyInput::default(), 0.5);
    assert_eq!((stage.settings.camera.file, stage.camera.forward()), (None, flown));
    params::set_from_str(&mut stage.settings, "camera.file", "2").expect("a parameter");
    stage.update(&FlyInput::default(), 0.0);
    assert_eq!(stage.settings.camera.height, Some(6.0));
    assert!(stage.camera_of(SIZE).lens.is_orthographic());
    stage.reset_camera();
    stage.update(&FlyInput::default(), 0.0);
    assert_eq!((stage.settings.camera.file, stage.settings.camera.height), (Some(1), None));
    params::set_from_str(&mut stage.settings, "camera.file", "9").expect("a parameter");
    stage.update(&FlyInput::default(), 0.0);
    assert_eq!(stage.settings.camera.file, None, "the file has no ninth camera");
}

#[test]
fn gpu_a_followed_camera_that_flies_away_sees_the_scene_all_the_way() {
    for lens in [PERSPECTIVE, FileLens::Orthographic { half_height: 3.0, near: 0.1, far: 1e9 }] {
        let mut scene = model(1.0);
        let rest = Transform { translation: DVec3::new(0.0, 2.0, 9.0), ..Transform::default() };
        add_camera(&mut scene, rest, lens);
        let values = ChannelValues::Translation(vec![Vec3::new(0.0, 2.0, 9.0), Vec3::new(0.0, 2.0, 5e3)]);
        let node = scene.cameras[0].node;
        let channel = Channel { node, times: vec![0.0, 2.0], interpolation: Interpolation::Linear, values };
        scene.animations.push(Animation { name: String::new(), duration: 2.0, channels: vec![channel] });
        let mut stage = stage(scene);
        let first = stage.settings.camera;
        stage.update(&FlyInput::default(), 1.9);
        let camera = stage.camera_of(SIZE);
        assert!(camera.eye.z > 4e3 && f64::from(camera.far) > camera.eye.z, "{camera:?}");
        assert_eq!(stage.settings.camera, first, "lens and planes stay");
    }
}

#[test]
fn gpu_a_chosen_camera_keeps_its_lens_after_a_reset_and_gives_it_back_to_the_first_view() {
    let mut scene = model(1.0);
    let rest = Transform { translation: DVec3::new(0.0, 2.0, 9.0), ..Transform::default() };
    add_camera(&mut scene, rest, PERSPECTIVE);
    add_camera(&mut scene, rest, FileLens::Orthographic { half_height: 3.0, near: 0.1, far: 40.0 });
    let mut stage = stage(scene);
    let first = stage.settings.camera;
    // As for the arguments of a start.
    let mut settings = stage.settings;
    let parameters = [("camera.near", "0.5"), ("camera.file", "2")];
    stage.choose_camera(parameters, &mut settings);
    params::set_from_str(&mut settings, "camera.near", "0.5").expect("a parameter");
    stage.restore_settings(&settings);
    stage.set_home();
    for _ in 0..2 {
        stage.reset();
        stage.update(&FlyInput::default(), 0.0);
        let camera = stage.settings.camera;
        assert_eq!((camera.file, camera.height, camera.near), (Some(2), Some(6.0), 0.5));
        stage.update(&FlyInput { movement: Vec3::X, ..FlyInput::default() }, 0.1);
        stage.settings.camera.far = 7.0;
    }
    stage.reset_camera();
    stage.update(&FlyInput::default(), 0.0);
    assert_eq!(stage.settings.camera, settings.camera);
    params::set_from_str(&mut stage.settings, "camera.file", "1").expect("a parameter");
    stage.update(&FlyInput::default(), 0.0);
    assert_eq!(stage.settings.camera, first);
}

#[test]
fn gpu_the_strongest_sun_moves_with_the_animation_until_a_person_takes_it() {
    let mut scene = model(1.0);
    add_suns(&mut scene, &[(0.0, 0.5), (3.0, 0.9), (1.0, 1.2)]);
    let node = scene.suns[1].node;
    turn(&mut scene, node);
    let mut stage = stage(scene);
    let sun = |stage: &Stage, index: usize| {
        let prepared = stage.prepared_scene();
        prepared.scene().suns[index].direction(prepared.pose()).expect("a direction")
    };
    let is_at = |stage: &Stage, index| (stage.settings.light.direction() - sun(stage, index)).length() < 1e-5;
    assert_eq!(stage.settings.light.file, Some(2));
    let first = stage.settings.light.direction();
    for _ in 0..3 {
        stage.update(&FlyInput::default(), 0.4);
        assert!(is_at(&stage, 1));
    }
    assert!((stage.settings.light.direction() - first).length() > 0.3, "it moved");
    params::set_from_str(&mut stage.settings, "light.file", "3").expect("a parameter");
    stage.update(&FlyInput::default(), 0.1);
    assert!(is_at(&stage, 2));
    params::set_from_str(&mut stage.settings, "light.azimuth", "40").expect("a parameter");
    stage.update(&FlyInput::default(), 0.1);
    assert_eq!((stage.settings.light.file, stage.settings.light.azimuth), (None, 40_f32.to_radians()));
    stage.reset();
    stage.update(&FlyInput::default(), 0.1);
    assert!(is_at(&stage, 1) && stage.settings.light.file == Some(2));
    stage.settings.light.hour = Some(12.0);
    stage.update(&FlyInput::default(), 0.1);
    assert!(!is_at(&stage, 1), "the time of day wins while it is set");
    stage.settings.light.hour = None;
    stage.update(&FlyInput::default(), 0.1);
    assert!(is_at(&stage, 1));
}

/// Returns the shares of the classes of the initial view among the facing pixels.
fn classes(stage: &mut Stage) -> [f64; 6] {
    let judged = stage.judge(SIZE, false).expect("a judged picture");
    assert_eq!(stage.problem(), None);
    let facing = judged.tally.all.facing as f64;
    assert!(facing > 1000.0, "{facing}");
    let all = [Class::NotJudged, Class::Right, Class::FalseShadow, Class::FalseLight, Class::Hole, Class::Edge];
    all.map(|class| judged.classes.iter().filter(|other| **other == class).count() as f64 / facing)
}

#[test]
fn gpu_a_scene_of_any_size_opens_with_the_same_picture_and_the_same_classes() {
    let mut usual = stage(model(1.0));
    let expected = classes(&mut usual);
    assert!(expected[2] < 1e-3 && expected[3] < 1e-3, "{expected:?}");
    for scale in [1e-4_f32, 1e-3, 1e-2, 1e2, 1e4, 1e5] {
        let mut stage = stage(model(scale));
        let found = classes(&mut stage);
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 5e-3, "{scale}: {found:?} for {expected:?}");
        }
        let (camera, other) = (stage.camera_of(SIZE), usual.camera_of(SIZE));
        for (found, expected) in [(camera.near, other.near), (camera.far, other.far)] {
            assert!((found / scale / expected - 1.0).abs() < 1e-3, "{scale}: {found} m for {expected} m");
        }
        assert!((stage.camera.forward() - usual.camera.forward()).length() < 1e-3);
        let speed = stage.settings.camera.speed;
        stage.update(&FlyInput { movement: Vec3::X, ..FlyInput::default() }, 0.01);
        assert_eq!(stage.settings.camera.speed, speed, "{scale}: within the range");
    }
}

#[test]
fn gpu_rays_start_where_the_setting_says_and_pictures_are_judged_anew() {
    let mut stage = stage(model(1.0));
    assert_eq!(stage.ray_offset(), 1e-3);
    let right = classes(&mut stage);
    params::set_from_str(&mut stage.settings, "view.ray_offset", "2.5").expect("a parameter");
    assert_eq!(stage.ray_offset(), 2.5);
    // Rays from the floor start above the post, and find its shadow lit.
    let [_, _, false_shadow, ..] = classes(&mut stage);
    assert!(right[2] < 1e-3 && false_shadow > 0.01, "{right:?}, {false_shadow}");
}

#[test]
fn gpu_an_orthographic_view_is_fitted_and_judged_like_any_other() {
    let mut scene = model(1.0);
    let eye = Vec3::new(6.0, 5.0, 7.0);
    let rotation = Quat::from_mat4(&glam::Mat4::from_mat3(glam::Mat3::from_quat(Quat::from_rotation_arc(
        Vec3::NEG_Z,
        -eye.normalize(),
    ))));
    let rest = Transform { translation: eye.as_dvec3(), rotation: rotation.as_dquat(), ..Transform::default() };
    add_camera(&mut scene, rest, FileLens::Orthographic { half_height: 4.0, near: 0.0, far: 30.0 });
    let mut stage = stage(scene);
    for preset in ["windows-4", "stable-4", "calm-4", "xna-1"] {
        stage.settings.technique =
            shadowfit::Technique::preset(preset).expect("a preset").with_lengths_of(&stage.settings.technique);
        let [_, _, false_shadow, false_light, hole, edge] = classes(&mut stage);
        assert!(
            false_shadow < 2e-3 && false_light < 2e-3 && hole < 2e-3,
            "{preset}: {false_shadow} {false_light} {hole}"
        );
        assert!(edge < 0.05, "{preset}: {edge}");
    }
    // A pick returns the point where the ray of its pixel meets the scene.
    let at = [0.5 + 0.5 / SIZE[0] as f32, 0.5 + 0.5 / SIZE[1] as f32];
    stage.scene.rays();
    let picked = stage.pick(at, SIZE).expect("the post");
    let camera = stage.camera_of(SIZE);
    let clip =
        camera.clip_from_world(shadowfit::DepthConvention::Reversed) * (picked - camera.eye).as_vec3().extend(1.0);
    let pixel = Vec2::new((clip.x / clip.w) * 0.5 + 0.5, 0.5 - (clip.y / clip.w) * 0.5);
    assert!((pixel - Vec2::from(at)).abs().max_element() < 1.0 / SIZE[0] as f32, "{pixel}");
    assert!(picked.distance(DVec3::ZERO) < 4.0);
}
