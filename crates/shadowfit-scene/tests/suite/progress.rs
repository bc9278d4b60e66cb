//! What is told while a file is loaded.

use std::cell::RefCell;

use shadowfit_scene::{Scene, SceneError, load_gltf, load_gltf_with_progress};

use crate::build::{Build, TRIANGLE, write};

/// A file of five nodes, of which three draw a mesh; the last of these the one of the given number, of two.
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

/// Loads a file; with all that is told meanwhile.
fn load(path: &std::path::Path) -> (Result<Scene, SceneError>, Vec<f32>) {
    let told = RefCell::new(Vec::new());
    let scene = load_gltf_with_progress(path, None, &|share| told.borrow_mut().push(share));
    (scene, told.into_inner())
}

#[test]
fn progress_never_falls_ends_at_one_and_changes_nothing_of_the_scene() {
    let path = write("whole", "whole.gltf", file(0).as_bytes());
    let (scene, told) = load(&path);
    assert!(told.len() > 3 && told.is_sorted(), "{told:?}");
    assert_eq!((told.first(), told.last()), (Some(&0.0), Some(&1.0)));
    let silent = load_gltf(&path).expect("five nodes");
    assert_eq!(format!("{:?}", scene.expect("five nodes")), format!("{silent:?}"));
}

#[test]
fn a_file_that_cannot_be_loaded_is_never_told_to_be_done() {
    let (scene, told) = load(&write("broken", "broken.gltf", file(7).as_bytes()));
    assert!(scene.is_err() && told.iter().all(|share| *share < 1.0), "{told:?}");
}
