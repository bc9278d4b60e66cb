//! Animation, skins and morph targets of small files, against values computed by hand.

use std::f32::consts::FRAC_1_SQRT_2;

use glam::{Quat, Vec3};
use shadowfit_scene::{Scene, SceneError};

use crate::build::{Build, TRIANGLE, U8, U16, refusal};

/// Loads a triangle at a node that one channel moves.
fn moving(
    path: &str,
    interpolation: &str,
    kind: &str,
    width: usize,
    times: &[f32],
    values: &[f32],
) -> Result<Scene, SceneError> {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    let target = build.floats("VEC3", 3, &[0.0, 0.0, 1.0].repeat(3));
    let input = build.floats("SCALAR", 1, times);
    let output = build.floats(kind, width, values);
    build.members(&format!(
        r#""scene":0,"scenes":[{{"nodes":[1]}}],"nodes":[{{}},{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"targets":[{{"POSITION":{target}}}]}}]}}],
        "animations":[{{"samplers":[{{"input":{input},"output":{output},"interpolation":"{interpolation}"}}],
        "channels":[{{"sampler":0,"target":{{"node":1,"path":"{path}"}}}},{{"sampler":0,"target":{{"node":0,"path":"{path}"}}}}]}}]"#
    ));
    build.load("moving")
}

fn translation(scene: &Scene, seconds: f32) -> Vec3 {
    scene.pose(Some(0), seconds).world_from_node[0].w_axis.truncate()
}

#[test]
fn channels_follow_their_node_to_its_new_index_and_others_are_left_out() {
    let scene = moving("translation", "LINEAR", "VEC3", 3, &[0.0, 1.0], &[0.0; 6]).unwrap();
    assert_eq!(scene.nodes.len(), 1);
    assert_eq!(scene.animations[0].channels.len(), 1);
    assert_eq!(scene.animations[0].channels[0].node, 0);
    assert_eq!(scene.animations[0].duration, 1.0);
}

#[test]
fn pointers_to_transforms_and_weights_of_nodes_move_them_and_others_are_noted() {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    let times = build.floats("SCALAR", 1, &[0.0, 1.0]);
    let vectors = build.floats("VEC3", 3, &[0.0, 0.0, 0.0, 4.0, 4.0, 4.0]);
    let turns = build.floats("VEC4", 4, &[0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0]);
    let pointers = [
        ("/nodes/0/translation", 0),
        ("/nodes/0/scale", 0),
        ("/nodes/0/rotation", 1),
        ("/nodes/0/weights", 2),
        ("/nodes/0/weights/0", 2),
        ("/nodes/7/translation", 0),
        ("/nodes/-1/translation", 0),
        ("/meshes/0/weights", 2),
        ("/materials/0/alphaCutoff", 2),
    ];
    let channel = |(pointer, sampler): (&str, usize)| {
        let extension = format!(r#""extensions":{{"KHR_animation_pointer":{{"pointer":"{pointer}"}}}}"#);
        format!(r#"{{"sampler":{sampler},"target":{{"path":"pointer",{extension}}}}}"#)
    };
    let sampler = |output: usize| format!(r#"{{"input":{times},"output":{output}}}"#);
    build.members(&format!(
        r#""nodes":[{{"mesh":0}}],"extensionsUsed":["KHR_animation_pointer"],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"targets":[{{"POSITION":{positions}}}]}}]}}],
        "animations":[{{"samplers":[{}],"channels":[{}]}}]"#,
        [vectors, turns, times].map(sampler).join(","),
        pointers.map(channel).join(",")
    ));
    let scene = build.load("pointers").unwrap();
    assert_eq!(scene.animations[0].channels.len(), 4);
    let pose = scene.pose(Some(0), 0.5);
    assert_eq!((translation(&scene, 0.5), &pose.morph_weights[0][..]), (Vec3::splat(2.0), &[0.5][..]));
    let turned = pose.world_from_node[0].transform_vector3(Vec3::X);
    assert!(turned.abs_diff_eq(Vec3::NEG_Z * 2.0, 1e-5), "{turned}");
    let is_noted = |note: &String| note.contains("weights of meshes and single weights are not played");
    assert!(scene.notes.iter().any(is_noted), "{:?}", scene.notes);
}

/// The extension forbids a node, but the gltf crate accepts such a file.
#[test]
fn a_pointer_beside_a_node_moves_the_node_that_it_points_at() {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    let times = build.floats("SCALAR", 1, &[0.0, 1.0]);
    let vectors = build.floats("VEC3", 3, &[0.0, 0.0, 0.0, 4.0, 4.0, 4.0]);
    build.members(&format!(
        r#""nodes":[{{"mesh":0}},{{}}],"extensionsUsed":["KHR_animation_pointer"],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":{positions}}}}}]}}],
        "animations":[{{"samplers":[{{"input":{times},"output":{vectors}}}],"channels":[{{"sampler":0,"target":{{"node":1,
        "path":"pointer","extensions":{{"KHR_animation_pointer":{{"pointer":"/nodes/0/translation"}}}}}}}}]}}]"#
    ));
    assert_eq!(translation(&build.load("beside").unwrap(), 0.5), Vec3::splat(2.0));
}

#[test]
fn linear_translation_interpolates_clamps_at_the_start_and_loops() {
    let scene = moving("translation", "LINEAR", "VEC3", 3, &[1.0, 2.0], &[0.0, 0.0, 0.0, 4.0, 0.0, 8.0]).unwrap();
    for (seconds, x) in [(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (1.25, 1.0), (1.75, 3.0), (3.25, 1.0), (-0.75, 1.0)] {
        assert_eq!(translation(&scene, seconds), Vec3::new(x, 0.0, 2.0 * x), "{seconds}");
    }
    assert_eq!(translation(&scene, f32::NAN), Vec3::ZERO);
    assert_eq!(scene.pose(None, 1.5), scene.pose(Some(7), 1.5));
}

#[test]
fn step_holds_the_earlier_key() {
    let scene =
        moving("translation", "STEP", "VEC3", 3, &[0.0, 1.0, 2.0], &[1.0, 0., 0., 2.0, 0., 0., 3.0, 0., 0.]).unwrap();
    for (seconds, x) in [(0.0, 1.0), (0.999, 1.0), (1.0, 2.0), (1.999, 2.0), (2.0, 1.0)] {
        assert_eq!(translation(&scene, seconds).x, x, "{seconds}");
    }
}

#[test]
fn cubic_splines_pass_their_keys_and_take_tangents_per_second() {
    // Two seconds from 0 with slope 3 to 4 with slope 0. In the middle: (0 + 4) / 2 + 2 (3 - 0) / 8.
    let key = |inward: f32, value: f32, outward: f32| [inward, 0.0, 0.0, value, 0.0, 0.0, outward, 0.0, 0.0];
    let values = [key(9.0, 0.0, 3.0), key(0.0, 4.0, 9.0)].concat();
    let scene = moving("translation", "CUBICSPLINE", "VEC3", 3, &[0.0, 2.0], &values).unwrap();
    assert_eq!(translation(&scene, 0.0).x, 0.0);
    assert!((translation(&scene, 1.0).x - 2.75).abs() < 1e-6);
    assert!((translation(&scene, 1.999_999).x - 4.0).abs() < 1e-4);
}

#[test]
fn rotations_take_the_short_arc_with_constant_speed() {
    // A quarter turn about y, given as the negative quaternion.
    let values = [0.0, 0.0, 0.0, 1.0, 0.0, -FRAC_1_SQRT_2, 0.0, -FRAC_1_SQRT_2];
    let scene = moving("rotation", "LINEAR", "VEC4", 4, &[0.0, 3.0], &values).unwrap();
    let rotation = Quat::from_mat4(&scene.pose(Some(0), 1.0).world_from_node[0]);
    assert!(rotation.angle_between(Quat::from_rotation_y(30_f32.to_radians())) < 1e-3);
}

#[test]
fn morph_weights_play_and_flat_normals_follow() {
    let scene = moving("weights", "LINEAR", "SCALAR", 1, &[0.0, 1.0], &[0.0, 1.0]).unwrap();
    let instance = scene.instances()[0];
    let pose = scene.pose(Some(0), 0.5);
    assert_eq!(pose.morph_weights, [[0.5]]);
    let deformed = pose.deform(&scene, &instance).unwrap();
    assert_eq!(deformed.positions, [Vec3::Z * 0.5, Vec3::X + Vec3::Z * 0.5, Vec3::Y + Vec3::Z * 0.5]);
    assert_eq!(deformed.normals, [Vec3::Z; 3]);
    assert_eq!(scene.bounds(&pose).unwrap().max.z, 0.5);
    assert_eq!(pose.triangles(&scene)[0].vertices[0], Vec3::Z * 0.5);
    assert_eq!(scene.pose(None, 0.5).morph_weights, [[0.0]]);
}

#[test]
fn flat_normals_of_morphed_faces_are_exact_at_full_weight() {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    // Moves the corner on y to z, so the face turns from +z to -y.
    let target = build.floats("VEC3", 3, &[0., 0., 0., 0., 0., 0., 0., -1., 1.]);
    build.members(&format!(
        r#""nodes":[{{"mesh":0}}],"meshes":[{{"weights":[1],"primitives":[{{"attributes":{{"POSITION":{positions}}},"targets":[{{"POSITION":{target}}}]}}]}}]"#
    ));
    let scene = build.load("lifted").unwrap();
    let deformed = scene.pose(None, 0.0).deform(&scene, &scene.instances()[0]).unwrap();
    assert_eq!(deformed.normals, [Vec3::NEG_Y; 3]);
}

/// Loads an upright strip at heights 0, 1 and 2 on two bones. The second bone starts at height 1.
fn two_bones(rotation: &str, scale: &str) -> Scene {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &[0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 2., 0.]);
    let normals = build.floats("VEC3", 3, &[0.0, 0.0, 1.0].repeat(4));
    let indices = build.accessor(U16, "SCALAR", 6, &[0, 0, 1, 0, 2, 0, 1, 0, 3, 0, 2, 0]);
    let joints = build.accessor(U8, "VEC4", 4, &[[0; 4], [0; 4], [0, 1, 0, 0], [1, 0, 0, 0]].concat());
    let weights = build.accessor(U8, "VEC4", 4, &[[255, 0, 0, 0], [255, 0, 0, 0], [1, 1, 0, 0], [9, 0, 0, 0]].concat());
    let identity = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];
    let mut second = identity;
    second[13] = -1.0;
    let bind = build.floats("MAT4", 16, &[identity, second].concat());
    build.members(&format!(
        r#""nodes":[{{"mesh":0,"skin":0,"translation":[50,50,50]}},{{"name":"lower","scale":{scale},"children":[2]}},
        {{"name":"upper","translation":[0,1,0],"rotation":{rotation}}}],
        "skins":[{{"joints":[1,2],"inverseBindMatrices":{bind}}}],
        "meshes":[{{"primitives":[{{"indices":{indices},"attributes":
        {{"POSITION":{positions},"NORMAL":{normals},"JOINTS_0":{joints},"WEIGHTS_0":{weights}}}}}]}}]"#
    ));
    build.load("bones").unwrap()
}

#[test]
fn a_two_bone_bend_carries_the_upper_part_and_ignores_the_mesh_node() {
    // The upper bone rotates by 90° about z, so up becomes left.
    let scene = two_bones("[0,0,0.70710678,0.70710678]", "[1,1,1]");
    let (pose, instance) = (scene.pose(None, 0.0), scene.instances()[0]);
    let deformed = pose.deform(&scene, &instance).unwrap();
    let expected = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(-1.0, 1.0, 0.0)];
    for (got, expected) in deformed.positions.iter().zip(expected) {
        assert!((*got - expected).length() < 1e-6, "{got} {expected}");
    }
    assert_eq!(pose.world_from_instance(&scene, &instance), glam::Mat4::IDENTITY);
    assert_eq!(scene.bounds(&pose).unwrap().max.z, 0.0);
    assert!(!pose.is_mirrored(&scene, &instance));
}

#[test]
fn a_mirrored_skeleton_keeps_normals_and_winding_outward() {
    let scene = two_bones("[0,0,0,1]", "[-1,1,1]");
    let (pose, instance) = (scene.pose(None, 0.0), scene.instances()[0]);
    assert!(pose.is_mirrored(&scene, &instance));
    assert_eq!(pose.deform(&scene, &instance).unwrap().normals, [Vec3::Z; 4]);
    for triangle in pose.triangles(&scene) {
        let [a, b, c] = triangle.vertices;
        assert!((b - a).cross(c - a).z > 0.0);
    }
}

#[test]
fn rigid_instances_have_no_deformation() {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    build.one_primitive(&format!(r#"{{"attributes":{{"POSITION":{positions}}}}}"#));
    let scene = build.load("rigid").unwrap();
    assert!(scene.pose(None, 0.0).deform(&scene, &scene.instances()[0]).is_none());
}

#[test]
fn broken_keyframes_are_refused_by_channel() {
    let broken = [
        moving("translation", "LINEAR", "VEC3", 3, &[1.0, 0.0], &[0.0; 6]),
        moving("translation", "LINEAR", "VEC3", 3, &[0.0, f32::NAN], &[0.0; 6]),
        moving("translation", "LINEAR", "VEC3", 3, &[0.0, 1.0], &[f32::INFINITY; 6]),
        moving("translation", "LINEAR", "VEC3", 3, &[0.0, 1.0], &[0.0; 3]),
        moving("translation", "CUBICSPLINE", "VEC3", 3, &[0.0, 1.0], &[0.0; 6]),
        moving("rotation", "LINEAR", "VEC3", 3, &[0.0, 1.0], &[0.0; 6]),
    ];
    for result in broken {
        let message = refusal(result);
        assert!(message.contains("animations[0].channels[0]"), "{message}");
    }
}
