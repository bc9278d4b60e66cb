//! Small broken files. The error names the file, the element and the reason.

use std::path::Path;

use proptest::prelude::*;
use shadowfit_scene::{SceneError, load_gltf};

use crate::build::{Build, F32, TRIANGLE, U8, U16, U32, load_text, refusal, write};

/// Returns a triangle with indices.
fn triangle() -> Build {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    let indices = build.accessor(U16, "SCALAR", 3, &[0, 0, 1, 0, 2, 0]);
    build.one_primitive(&format!(r#"{{"attributes":{{"POSITION":{positions}}},"indices":{indices}}}"#));
    build
}

/// Replaces a part of the valid triangle file and expects these words in the error.
fn refused(from: &str, to: &str, words: &[&str]) {
    let text = triangle().json();
    assert!(text.contains(from), "{text}");
    let message = refusal(load_text("broken", &text.replacen(from, to, 1)));
    for word in ["broken.gltf"].iter().chain(words) {
        assert!(message.contains(word), "{word:?} is missing in: {message}");
    }
}

#[test]
fn the_file_that_the_other_tests_break_is_sound() {
    assert!(triangle().load("sound").unwrap().notes.len() == 1);
}

#[test]
fn missing_files_and_folders_are_unreadable() {
    for path in ["no/such/file.glb", "."] {
        let error = load_gltf(Path::new(path)).unwrap_err();
        assert!(matches!(error, SceneError::Unreadable { .. }), "{error}");
        assert_eq!(error.path(), Path::new(path));
    }
}

#[test]
fn text_that_is_no_gltf_is_malformed() {
    for text in
        ["", "{", "[]", "{}", "null", "\u{feff}{}", r#"{"asset":{"version":"1.0"}}"#, r#"{"asset":{"version":"3.0"}}"#]
    {
        let error = load_text("malformed", text).unwrap_err();
        assert!(matches!(error, SceneError::Malformed { .. }), "{text}: {error}");
    }
    let deep = "[".repeat(100_000);
    assert!(matches!(load_text("nested", &deep), Err(SceneError::Malformed { .. })));
}

#[test]
fn files_without_anything_to_draw_say_so() {
    let message = refusal(load_text("empty", r#"{"asset":{"version":"2.0"}}"#));
    assert!(message.contains("nothing to draw: the file has no meshes"), "{message}");
    let message = refusal(load_text("empty", &triangle().json().replace(r#""nodes":[{"mesh":0}]"#, r#""nodes":[{}]"#)));
    assert!(message.contains("no node of the scene has a mesh"), "{message}");
}

#[test]
fn required_extensions_are_refused_by_name_even_where_the_json_is_theirs() {
    let nodes = r#""nodes":[{"mesh":0}]"#;
    let required = r#""extensionsRequired":["KHR_texture_transform","KHR_draco_mesh_compression"]"#;
    let words = ["extensionsRequired[1]", "KHR_draco_mesh_compression", "gltf-transform cp"];
    refused(nodes, &format!("{nodes},{required}"), &words);
    refused(nodes, &format!(r#""nodes":"theirs",{required}"#), &words);
}

#[test]
fn indices_into_nothing_are_refused_wherever_they_stand() {
    refused(r#""mesh":0"#, r#""mesh":7"#, &["nodes[0].mesh", "no mesh 7"]);
    refused(r#""POSITION":0"#, r#""POSITION":9"#, &["attributes.POSITION, accessor 9", "no such accessor"]);
    refused(r#""indices":1"#, r#""indices":9"#, &["meshes[0].primitives[0].indices, accessor 9"]);
    refused(r#""indices":1"#, r#""indices":1,"material":3"#, &["primitives[0].material", "no material 3"]);
    refused(r#""bufferView":0"#, r#""bufferView":5"#, &["bufferView 5"]);
    refused(r#"{"buffer":0"#, r#"{"buffer":4"#, &["bufferView 0", "buffer 4"]);
    refused(r#""nodes":["#, r#""scene":2,"nodes":["#, &["scenes[2]", "0 scenes"]);
    refused(r#""nodes":["#, r#""scenes":[{"nodes":[8]}],"nodes":["#, &["scenes[0].nodes", "no node 8"]);
    refused(r#"{"mesh":0}"#, r#"{"mesh":0,"skin":0}"#, &["skins[0]", "no such skin"]);
    refused(r#"{"mesh":0}"#, r#"{"mesh":0,"camera":1}"#, &["nodes[0].camera", "no camera 1"]);
}

#[test]
fn vertex_indices_out_of_range_are_refused_by_position_and_value() {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    let indices = build.accessor(U8, "SCALAR", 3, &[0, 1, 3]);
    build.one_primitive(&format!(r#"{{"attributes":{{"POSITION":{positions}}},"indices":{indices}}}"#));
    let message = refusal(build.load("range"));
    assert!(message.contains("primitives[0].indices, accessor 1: index 2 is 3, there are 3 vertices"), "{message}");
}

#[test]
fn counts_beyond_the_data_are_refused_before_anything_is_allocated() {
    for count in ["4", "2147483648", "4294967295", "18446744073709551615"] {
        refused(r#""type":"VEC3","count":3"#, &format!(r#""type":"VEC3","count":{count}"#), &["accessor 0", "need"]);
        refused(
            r#""type":"SCALAR","count":3"#,
            &format!(r#""type":"SCALAR","count":{count}"#),
            &["accessor 1", "need"],
        );
        // Elements without a buffer view are zero, so the file's size does not limit their number.
        if count != "4" {
            let zero = format!(r#""componentType":{U16},"type":"SCALAR","count":{count}"#);
            refused(
                &format!(r#""bufferView":1,"componentType":{U16},"type":"SCALAR","count":3"#),
                &zero,
                &["accessor 1", "no data"],
            );
        }
    }
    refused(r#""byteLength":42"#, r#""byteLength":1099511627776"#, &["buffers[0]", "1099511627776"]);
    refused(r#""byteOffset":0"#, r#""byteOffset":18446744073709551615"#, &["bufferView 0", "exceed"]);
    refused(r#""buffer":0,"#, r#""buffer":0,"byteStride":4,"#, &["accessor 0", "stride"]);
}

#[test]
fn wrong_types_are_refused() {
    refused(r#""type":"VEC3""#, r#""type":"VEC2""#, &["POSITION, accessor 0", "2 components instead of 3"]);
    refused(r#""type":"VEC3""#, r#""type":"VEC9""#, &["POSITION, accessor 0", "type is unknown"]);
    refused(&format!(r#""componentType":{U16}"#), &format!(r#""componentType":{F32}"#), &["indices", "not unsigned"]);
    refused(&format!(r#""componentType":{U16}"#), r#""componentType":1"#, &["indices", "not unsigned"]);
    refused(r#""indices":1"#, r#""indices":1,"mode":7"#, &["primitives[0].mode"]);
}

#[test]
fn positions_that_are_not_finite_or_absurd_are_refused_by_vertex() {
    for (value, words) in
        [(f32::NAN, "vertex 1 is not finite"), (f32::INFINITY, "vertex 1 is not finite"), (2e12, "vertex 1 at")]
    {
        let mut build = Build::default();
        let mut positions = TRIANGLE;
        positions[3] = value;
        let positions = build.floats("VEC3", 3, &positions);
        build.one_primitive(&format!(r#"{{"attributes":{{"POSITION":{positions}}}}}"#));
        let message = refusal(build.load("positions"));
        assert!(message.contains("attributes.POSITION, accessor 0") && message.contains(words), "{message}");
    }
    refused(r#"{"mesh":0}"#, r#"{"mesh":0,"scale":[1e30,1,1]}"#, &["nodes[0]", "beyond"]);
    // If another crate of the build enables exact parsing of floats in serde_json, serde_json refuses the
    // file first.
    let text = triangle().json().replacen(r#"{"mesh":0}"#, r#"{"mesh":0,"translation":[1e39,0,0]}"#, 1);
    let message = refusal(load_text("infinite", &text));
    let ours = message.contains("nodes[0]") && message.contains("not finite");
    assert!(ours || message.contains("number out of range"), "{message}");
}

#[test]
fn attributes_of_another_length_are_refused() {
    for attribute in ["NORMAL", "TANGENT", "TEXCOORD_0", "COLOR_0"] {
        let mut build = Build::default();
        let positions = build.floats("VEC3", 3, &TRIANGLE);
        let (kind, width) = match attribute {
            "NORMAL" => ("VEC3", 3),
            "TEXCOORD_0" => ("VEC2", 2),
            _ => ("VEC4", 4),
        };
        let other = build.floats(kind, width, &vec![0.0; width * 2]);
        build.one_primitive(&format!(r#"{{"attributes":{{"POSITION":{positions},"{attribute}":{other}}}}}"#));
        let message = refusal(build.load("lengths"));
        assert!(message.contains(attribute) && message.contains("2 elements for 3 positions"), "{message}");
    }
}

#[test]
fn node_graphs_with_cycles_or_two_parents_are_refused() {
    let nodes = r#""nodes":[{"mesh":0}]"#;
    for graph in [
        r#""scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"children":[0]}]"#,
        r#""scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"children":[1]},{"children":[0]}]"#,
        r#""scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"children":[2]},{"children":[2]},{}]"#,
        r#""scenes":[{"nodes":[0,0]}],"nodes":[{"mesh":0}]"#,
    ] {
        refused(nodes, graph, &["reached twice"]);
    }
}

#[test]
fn joints_beyond_the_skin_are_refused() {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    let joints = build.accessor(U8, "VEC4", 3, &[0, 0, 0, 0, 1, 9, 0, 0, 0, 0, 0, 0]);
    let weights = build.floats("VEC4", 4, &[1.0, 0.0, 0.0, 0.0].repeat(3));
    build.members(&format!(
        r#""nodes":[{{"mesh":0,"skin":0}},{{}}],"skins":[{{"joints":[1]}}],"meshes":[{{"primitives":[{{"attributes":
        {{"POSITION":{positions},"JOINTS_0":{joints},"WEIGHTS_0":{weights}}}}}]}}]"#
    ));
    let message = refusal(build.load("joints"));
    // Joint 9 has no weight and is ignored.
    assert!(message.contains("nodes[0].skin: primitive 0 of its mesh uses joint 1, its skin has 1"), "{message}");
}

#[test]
fn missing_buffers_and_paths_out_of_the_folder_are_refused() {
    let text = triangle().json();
    let start = text.find("data:").unwrap();
    let end = start + text[start..].find('"').unwrap();
    write("buffers", "outside.bin", &[0; 64]);
    for (uri, word) in
        [("missing.bin", "cannot be read"), ("../buffers/outside.bin", "leads out"), ("ftp://a/b", "neither")]
    {
        let text = format!("{}{uri}{}", &text[..start], &text[end..]);
        let message = refusal(load_text("buffers", &text));
        assert!(message.contains("buffers[0]") && message.contains(word), "{message}");
    }
}

#[test]
fn a_small_file_cannot_ask_for_endless_geometry() {
    // 3000 nodes draw the same 100,000 vertices.
    let mut build = Build::default();
    let count = 100_000;
    let positions: Vec<f32> = (0..count * 3).map(|i| (i % 7) as f32).collect();
    let positions = build.floats("VEC3", 3, &positions);
    let primitive = format!(r#"{{"attributes":{{"POSITION":{positions}}}}}"#);
    let nodes = vec![r#"{"mesh":0}"#; 3000].join(",");
    build.members(&format!(r#""nodes":[{nodes}],"meshes":[{{"primitives":[{primitive}]}}]"#));
    let message = refusal(build.load("endless"));
    assert!(message.contains("draws more than"), "{message}");
    // 1000 nodes draw the same 3000 primitives without triangles.
    let mut build = Build::default();
    let none = build.push_accessor(&format!(r#"{{"componentType":{F32},"type":"VEC3","count":0}}"#));
    let primitives = vec![format!(r#"{{"attributes":{{"POSITION":{none}}}}}"#); 3000].join(",");
    let nodes = vec![r#"{"mesh":0}"#; 1000].join(",");
    build.members(&format!(r#""nodes":[{nodes}],"meshes":[{{"primitives":[{primitives}]}}]"#));
    let message = refusal(build.load("primitives"));
    assert!(message.contains("nodes[699]") && message.contains("more than 2097152 primitives"), "{message}");
}

#[test]
fn morph_targets_cannot_ask_for_endless_copies() {
    // A million vertices and 130 targets without positions, or one vertex and a million corners.
    let million = 1_048_575;
    for (vertices, corners, targets) in [(million, 0, 130), (1, million, 65)] {
        let mut build = Build::default();
        let positions = build.push_accessor(&format!(r#"{{"componentType":{F32},"type":"VEC3","count":{vertices}}}"#));
        let indices = build.push_accessor(&format!(r#"{{"componentType":{U8},"type":"SCALAR","count":{corners}}}"#));
        let indices = if corners > 0 { format!(r#","indices":{indices}"#) } else { String::new() };
        let targets = vec!["{}"; targets].join(",");
        build.one_primitive(&format!(r#"{{"attributes":{{"POSITION":{positions}}}{indices},"targets":[{targets}]}}"#));
        let message = refusal(build.load("targets"));
        assert!(message.contains("primitives[0].targets: the file decodes to more than"), "{message}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_bytes_never_panic(at in 0_usize..2000, byte in any::<u8>(), cut in 0_usize..4000) {
        let mut text = skinned_text().into_bytes();
        let at = at % text.len();
        text[at] = byte;
        text.truncate(cut.max(1));
        let path = write("damaged", "damaged.gltf", &text);
        if let Ok(scene) = load_gltf(&path) {
            let pose = scene.pose(Some(0), 0.3);
            let _ = (pose.triangles(&scene), scene.bounds(&pose));
        }
    }
}

/// Returns a file with a skin, a morph target, an animation, colours and a camera.
fn skinned_text() -> String {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    let joints = build.accessor(U8, "VEC4", 3, &[0; 12]);
    let weights = build.floats("VEC4", 4, &[1.0, 0.0, 0.0, 0.0].repeat(3));
    let indices = build.accessor(U32, "SCALAR", 3, &[0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0]);
    let times = build.floats("SCALAR", 1, &[0.0, 1.0]);
    build.members(&format!(
        r#""nodes":[{{"mesh":0,"skin":0,"children":[1]}},{{"camera":0}}],"skins":[{{"joints":[1]}}],
        "cameras":[{{"type":"perspective","perspective":{{"yfov":1,"znear":0.1}}}}],
        "animations":[{{"samplers":[{{"input":{times},"output":{times}}}],
        "channels":[{{"sampler":0,"target":{{"node":0,"path":"weights"}}}}]}}],
        "meshes":[{{"primitives":[{{"indices":{indices},"targets":[{{"POSITION":{positions}}}],"attributes":
        {{"POSITION":{positions},"COLOR_0":{weights},"JOINTS_0":{joints},"WEIGHTS_0":{weights}}}}}]}}]"#
    ));
    build.json()
}
