//! Progress reports during loading.

use std::cell::RefCell;

use shadowfit_scene::{LoadStep, Scene, SceneError, SceneSize, load_gltf, load_gltf_with_progress};

use crate::build::{Build, F32, TRIANGLE, write};

/// Returns a file of five nodes. Three of them draw a mesh, the last of these mesh number `mesh` of two.
fn file(mesh: usize) -> String {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    let triangle = format!(r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}}}}]}}"#);
    build.members(&format!(r#""meshes":[{triangle},{triangle}]"#));
    build.members(&format!(
        r#""nodes":[{{"mesh":0}},{{}},{{"mesh":1,"translation":[2,0,0]}},{{"mesh":{mesh},"scale":[2,2,2]}},{{}}]"#
    ));
    build.json()
}

type Told = Vec<(LoadStep, SceneSize)>;

/// Loads a file. Also returns the reported progress.
fn load(path: &std::path::Path) -> (Result<Scene, SceneError>, Told) {
    let told = RefCell::new(Vec::new());
    let scene = load_gltf_with_progress(path, None, &|step, size| told.borrow_mut().push((step, *size)));
    (scene, told.into_inner())
}

#[test]
fn each_step_is_told_once_with_what_is_known_of_the_size_and_changes_nothing_of_the_scene() {
    let text = file(0);
    let path = write("whole", "whole.gltf", text.as_bytes());
    let (scene, told) = load(&path);
    let (steps, sizes): (Vec<_>, Vec<_>) = told.into_iter().unzip();
    assert_eq!(steps, [LoadStep::Read, LoadStep::Parse, LoadStep::Decode]);
    let bytes = text.len() as u64;
    assert_eq!(sizes[0], SceneSize { file: bytes, ..SceneSize::default() });
    assert_eq!(sizes[1], SceneSize { json: bytes, ..sizes[0] });
    assert_eq!(sizes[2], SceneSize { nodes: 5, triangles: 2, drawn: 3, ..sizes[1] });
    let silent = load_gltf(&path).expect("five nodes");
    assert_eq!(format!("{:?}", scene.expect("five nodes")), format!("{silent:?}"));
}

#[test]
fn the_size_of_a_file_that_cannot_be_loaded_is_what_it_claims() {
    let (scene, told) = load(&write("broken", "broken.gltf", file(7).as_bytes()));
    let (step, size) = *told.last().expect("it was read");
    assert!(scene.is_err());
    assert_eq!((step, size.nodes, size.triangles, size.drawn), (LoadStep::Decode, 5, 2, 2));
}

#[test]
fn sizes_that_sum_to_more_than_a_number_holds_are_the_greatest_number() {
    let mut build = Build::default();
    let most = format!(r#"{{"componentType":{F32},"type":"VEC3","count":{}}}"#, u64::MAX);
    let most = build.push_accessor(&most);
    let mesh =
        format!(r#"{{"primitives":[{}]}}"#, vec![format!(r#"{{"attributes":{{"POSITION":{most}}}}}"#); 4].join(","));
    let table = format!(r#""extensions":{{"EXT_mesh_gpu_instancing":{{"attributes":{{"SCALE":{most}}}}}}}"#);
    let image = r#"{"bufferView":0,"mimeType":"image/png"}"#;
    build.members(&format!(
        r#""nodes":[{{"mesh":0}},{{"mesh":1,{table}}},{{"mesh":1}}],"meshes":[{mesh},{mesh}],"images":[{image},{image}]"#
    ));
    build.view(&[0]);
    let text = build.json().replace(r#""byteLength":1}]"#, &format!(r#""byteLength":{}}}]"#, u64::MAX));
    let (scene, told) = load(&write("most", "most.gltf", text.as_bytes()));
    assert!(scene.is_err());
    let size = told.last().expect("it was read").1;
    assert_eq!((size.triangles, size.drawn, size.images), (u64::MAX, u64::MAX, u64::MAX));
}
