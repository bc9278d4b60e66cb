//! Broken and malicious files. Each loads or is refused with a readable error, within seconds, without
//! reading or allocating anything illegitimate.

use std::sync::mpsc;
use std::time::Duration;

use shadowfit_scene::{Scene, SceneError, load_gltf};

use crate::assets;

/// Timeout that detects hangs. It does not measure speed.
const PATIENCE: Duration = Duration::from_secs(20);

#[test]
fn every_hostile_file_loads_or_is_refused_in_words() {
    let Some(folder) = assets::folder() else { return };
    let files = assets::files_below(&folder.join("hostile_shared"));
    assert!(files.len() > 150, "{} files", files.len());
    for file in files {
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        let (sender, receiver) = mpsc::channel();
        std::thread::spawn(move || sender.send(load_gltf(&file).map(|scene| use_up(&scene))));
        let outcome = receiver.recv_timeout(PATIENCE);
        match outcome.unwrap_or_else(|_| panic!("{name}: panicked or took longer than {PATIENCE:?}")) {
            Ok(notes) => println!("{name}: loaded; {notes:?}"),
            Err(error) => {
                let message = error.to_string();
                println!("{message}");
                assert!(message.contains(&name), "{message}");
                assert!(message.len() > name.len() + 20, "{message}");
            }
        }
    }
}

/// Poses a scene and computes its bounds and triangles, like a renderer.
fn use_up(scene: &Scene) -> Vec<String> {
    for animation in 0..=scene.animations.len() {
        for seconds in [0.0, 0.37, 1e9, f32::NAN] {
            let pose = scene.pose(Some(animation), seconds);
            let finite = pose.triangles(scene).iter().all(|t| t.vertices.iter().all(|v| v.is_finite()));
            assert!(finite, "{}", scene.name);
            let _ = scene.bounds(&pose);
        }
    }
    scene.notes.clone()
}

#[test]
fn synthetic_attacks_meet_the_refusal_that_is_meant_for_them() {
    let Some(folder) = assets::folder() else { return };
    let load = |file: &str| load_gltf(&folder.join("hostile_shared/synthetic").join(file));
    let refusals = [
        ("accessor_count_u32max.gltf", "accessor 0"),
        ("buffer_claims_1TiB.gltf", "buffers[0]"),
        ("cycle_two_nodes.gltf", "reached twice"),
        ("glb_json_len_u32max.glb", "GLB"),
        ("huge_extent_1e30.gltf", "vertex 1"),
        ("index_u32max.gltf", "there are 3 vertices"),
        ("nan_positions.gltf", "not finite"),
        ("unknown_required_extension.gltf", "ACME_made_up"),
        ("uri_path_traversal.gltf", "leads out"),
        ("view_offset_wraps_u64.gltf", "bufferView 0"),
    ];
    for (file, part) in refusals {
        let message = load(file).map(|scene| scene.name).unwrap_err().to_string();
        assert!(message.contains(part), "{message}");
    }
    let bomb = load("png_bomb_16384.gltf").unwrap();
    assert!(bomb.notes.iter().any(|note| note.contains("placeholder")), "{:?}", bomb.notes);
    assert_eq!(load("deep_chain_20000.gltf").unwrap().nodes.len(), 20_001);
    assert!(load("zero_scale_node.gltf").is_ok());
}

#[test]
fn gltf_1_is_refused_by_its_version() {
    let Some(folder) = assets::folder() else { return };
    let error = load_gltf(&folder.join("hostile_shared/assimp/gltf1_TwoBoxes.gltf")).unwrap_err();
    assert!(matches!(&error, SceneError::Malformed { element, .. } if element == "asset.version"), "{error}");
}
