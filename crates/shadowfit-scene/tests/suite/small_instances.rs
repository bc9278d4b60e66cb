//! `EXT_mesh_gpu_instancing`: tables of transforms.

use glam::Vec3;
use shadowfit_scene::{Scene, SceneError};

use crate::build::{Build, F32, TRIANGLE, U8, refusal};

const I8: u32 = 5120;
const I16: u32 = 5122;

/// Loads a file with a node under a moved parent that draws the triangle for each row of a table. `more` is
/// added to the file.
fn with_table(build: &mut Build, attributes: &str, node: &str, more: &str) -> Result<Scene, SceneError> {
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    build.members(&format!(
        r#""extensionsUsed":["EXT_mesh_gpu_instancing"],"extensionsRequired":["EXT_mesh_gpu_instancing"],
        "scenes":[{{"nodes":[0]}}],"nodes":[{{"children":[1],"translation":[0,0,100]}},{{"mesh":0{node},"extensions":
        {{"EXT_mesh_gpu_instancing":{{"attributes":{{{attributes}}}}}}}}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"targets":[{{"POSITION":{positions}}}]}}]}}]{more}"#
    ));
    build.load("instances")
}

/// Returns the first corner of each triangle, and the edge from it to the second.
fn placed(scene: &Scene, seconds: f32) -> Vec<[Vec3; 2]> {
    let triangles = scene.pose(Some(0), seconds).triangles(scene);
    triangles.iter().map(|triangle| [triangle.vertices[0], triangle.vertices[1] - triangle.vertices[0]]).collect()
}

#[test]
fn each_row_of_a_table_is_drawn_with_all_of_its_transforms_or_some() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    for (rotation, data) in [
        (
            F32,
            [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, half, half]]
                .concat()
                .iter()
                .flat_map(|v: &f32| v.to_le_bytes())
                .collect(),
        ),
        (I8, vec![0, 0, 0, 127, 0, 0, 90, 90]),
        (I16, [0_i16, 0, 0, 32_767, 0, 0, 23_170, 23_170].iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>()),
    ] {
        for has in 1..8 {
            let mut build = Build::default();
            let [moves, turns, scales] = [1, 2, 4].map(|bit| has & bit > 0);
            let translation = build.floats("VEC3", 3, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
            let turn = build.accessor_with(rotation, "VEC4", 2, &data, r#","normalized":true"#);
            let scale = build.floats("VEC3", 3, &[1.0, 1.0, 1.0, 2.0, 3.0, 4.0]);
            let given = [("TRANSLATION", moves, translation), ("ROTATION", turns, turn), ("SCALE", scales, scale)];
            let attributes: Vec<String> = given
                .iter()
                .filter(|(_, given, _)| *given)
                .map(|(name, _, index)| format!("\"{name}\":{index}"))
                .collect();
            let scene = with_table(&mut build, &attributes.join(","), "", "").unwrap();
            assert_eq!(scene.notes, ["primitives without normals given flat ones: 1"]);
            let at = |place: Vec3| Vec3::Z * 100.0 + if moves { place } else { Vec3::ZERO };
            let turned = if turns { Vec3::Y } else { Vec3::X };
            let wanted = [
                [at(Vec3::new(1.0, 2.0, 3.0)), Vec3::X],
                [at(Vec3::new(4.0, 5.0, 6.0)), turned * if scales { 2.0 } else { 1.0 }],
            ];
            let found = placed(&scene, 0.0);
            assert_eq!(found.len(), 2);
            for (found, wanted) in found.iter().flatten().zip(wanted.iter().flatten()) {
                assert!(found.abs_diff_eq(*wanted, 1e-4), "{has}: {found} for {wanted}");
            }
        }
    }
}

#[test]
fn instances_follow_the_animation_of_their_node_and_its_morph_weights() {
    let mut build = Build::default();
    let translation = build.floats("VEC3", 3, &[1.0, 0.0, 0.0, 2.0, 0.0, 0.0]);
    let times = build.floats("SCALAR", 1, &[0.0, 1.0]);
    let moves = build.floats("VEC3", 3, &[0.0, 0.0, 0.0, 0.0, 8.0, 0.0]);
    let weights = build.floats("SCALAR", 1, &[0.0, 1.0]);
    let animation = format!(
        r#","animations":[{{"samplers":[{{"input":{times},"output":{moves}}},{{"input":{times},"output":{weights}}}],
        "channels":[{{"sampler":0,"target":{{"node":1,"path":"translation"}}}},
        {{"sampler":1,"target":{{"node":1,"path":"weights"}}}}]}}]"#
    );
    let scene = with_table(&mut build, &format!(r#""TRANSLATION":{translation}"#), "", &animation).unwrap();
    let wanted = [1.0, 2.0].map(|x| [Vec3::new(x, 4.0, 100.0), Vec3::X * 1.5]);
    assert_eq!(placed(&scene, 0.5), wanted);
}

#[test]
fn rows_have_no_name_and_the_weights_of_the_targets_that_there_are() {
    let mut build = Build::default();
    let translation = build.floats("VEC3", 3, &[0.0; 6]);
    let node = r#","name":"long","weights":[0.5,0.25,0.125]"#;
    let scene = with_table(&mut build, &format!(r#""TRANSLATION":{translation}"#), node, "").unwrap();
    assert_eq!(scene.nodes[1].name, "long");
    for row in &scene.nodes[2..] {
        assert_eq!((row.name.as_str(), &row.morph_weights[..], row.parent), ("", &[0.5][..], Some(1)));
    }
    assert_eq!(scene.nodes.len(), 4);
}

#[test]
fn rows_of_morphed_meshes_and_copies_of_their_channels_are_limited() {
    let zeros = |count: usize| format!(r#"{{"componentType":{F32},"type":"VEC3","count":{count}}}"#);
    for (count, is_sound) in [(16_384, true), (16_385, false)] {
        let mut build = Build::default();
        let table = build.push_accessor(&zeros(count));
        let loaded = with_table(&mut build, &format!(r#""TRANSLATION":{table}"#), "", "");
        match loaded {
            Ok(scene) => assert!(is_sound && scene.instances().len() == count),
            Err(error) => assert!(!is_sound && error.to_string().contains("morph targets"), "{error}"),
        }
    }
    // 8192 keys for each of 16,384 rows.
    let mut build = Build::default();
    let table = build.push_accessor(&zeros(16_384));
    let keys = build.push_accessor(&format!(r#"{{"componentType":{F32},"type":"SCALAR","count":8192}}"#));
    let animation = format!(
        r#","animations":[{{"samplers":[{{"input":{keys},"output":{keys}}}],
        "channels":[{{"sampler":0,"target":{{"node":1,"path":"weights"}}}}]}}]"#
    );
    let message = refusal(with_table(&mut build, &format!(r#""TRANSLATION":{table}"#), "", &animation));
    assert!(message.contains("nodes[1]") && message.contains("decodes to more than"), "{message}");
}

#[test]
fn a_skinned_mesh_and_one_without_transforms_are_drawn_once() {
    let mut build = Build::default();
    let numbers = build.floats("SCALAR", 1, &[0.0; 5]);
    let scene = with_table(&mut build, &format!(r#""_ID":{numbers}"#), "", "").unwrap();
    assert_eq!(placed(&scene, 0.0), [[Vec3::Z * 100.0, Vec3::X]]);
    let noted = |note: &String| note.contains("attributes of instances other than their transforms are ignored");
    assert!(scene.notes.iter().any(noted), "{:?}", scene.notes);
    for (is_skinned, drawn) in [(true, 2), (false, 6)] {
        let mut build = Build::default();
        let [positions, translation] = [TRIANGLE, [0.0; 9]].map(|values| build.floats("VEC3", 3, &values));
        let joints = build.accessor(U8, "VEC4", 3, &[0; 12]);
        let weights = build.floats("VEC4", 4, &[1.0, 0.0, 0.0, 0.0].repeat(3));
        let joints = if is_skinned { format!(r#","JOINTS_0":{joints},"WEIGHTS_0":{weights}"#) } else { String::new() };
        build.members(&format!(
            r#""skins":[{{"joints":[0]}}],"nodes":[{{"mesh":0,"skin":0,"extensions":{{"EXT_mesh_gpu_instancing":
            {{"attributes":{{"TRANSLATION":{translation}}}}}}}}}],"meshes":[{{"primitives":[
            {{"attributes":{{"POSITION":{positions}{joints}}}}},{{"attributes":{{"POSITION":{positions}}}}}]}}]"#
        ));
        let scene = build.load("skinned").unwrap();
        assert_eq!(placed(&scene, 0.0).len(), drawn);
        let is_noted = |note: &String| note.contains("nodes[0]") && note.contains("once instead of 3 times");
        assert_eq!(scene.notes.iter().any(is_noted), is_skinned, "{:?}", scene.notes);
    }
}

#[test]
fn broken_tables_are_refused_by_node_and_attribute() {
    let huge = format!(r#"{{"componentType":{F32},"type":"VEC3","count":4000000000}}"#);
    let many = format!(r#"{{"componentType":{U8},"type":"VEC3","count":1000001,"normalized":true}}"#);
    for (attributes, words) in [
        (r#""TRANSLATION":0,"SCALE":1"#, "SCALE, accessor 1: it has 3 elements, TRANSLATION has 2"),
        (r#""TRANSLATION":77"#, "TRANSLATION, accessor 77: there is no such accessor"),
        (r#""TRANSLATION":-1"#, "TRANSLATION: -1 is not the index of an accessor"),
        (r#""ROTATION":0"#, "ROTATION, accessor 0: it has 3 components instead of 4"),
        (r#""SCALE":2"#, "SCALE, accessor 2: element 0 is not finite"),
        (r#""SCALE":3"#, "more than 1048576"),
    ] {
        let mut build = Build::default();
        build.floats("VEC3", 3, &[0.0; 6]);
        build.floats("VEC3", 3, &[0.0; 9]);
        build.floats("VEC3", 3, &[f32::NAN, 0.0, 0.0]);
        build.push_accessor(&huge);
        let message = refusal(with_table(&mut build, attributes, "", ""));
        assert!(message.contains("nodes[1].extensions.EXT_mesh_gpu_instancing"), "{message}");
        assert!(message.contains(words), "{words} is missing in {message}");
    }
    // Rows of zeros need no data. Primitives without triangles do not count toward the triangle limit.
    let mut build = Build::default();
    let none = build.push_accessor(&format!(r#"{{"componentType":{F32},"type":"VEC3","count":0}}"#));
    let table = build.push_accessor(&format!(r#"{{"componentType":{F32},"type":"VEC3","count":1048576}}"#));
    let primitives = vec![format!(r#"{{"attributes":{{"POSITION":{none}}}}}"#); 10_000].join(",");
    let node =
        format!(r#"{{"mesh":0,"extensions":{{"EXT_mesh_gpu_instancing":{{"attributes":{{"SCALE":{table}}}}}}}}}"#);
    build.members(&format!(r#""nodes":[{node}],"meshes":[{{"primitives":[{primitives}]}}]"#));
    let message = refusal(build.load("primitives"));
    assert!(message.contains("nodes[0]") && message.contains("more than 2097152 primitives"), "{message}");
    // The limit also applies to the sum over all nodes.
    let mut build = Build::default();
    let table = build.push_accessor(&many);
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    let node =
        format!(r#"{{"mesh":0,"extensions":{{"EXT_mesh_gpu_instancing":{{"attributes":{{"SCALE":{table}}}}}}}}}"#);
    build.members(&format!(
        r#""nodes":[{node},{node}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{positions}}}}}]}}]"#
    ));
    assert!(refusal(build.load("many")).contains("nodes[1].extensions.EXT_mesh_gpu_instancing"));
}
