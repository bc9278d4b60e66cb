//! Fuzz target: a scene file is refused, or it gives a scene with only finite triangles in every pose.

use std::collections::BTreeMap;

use shadowfit_scene::{Scene, decode_image, load_gltf_from_memory};

/// Longer files are skipped, since they show nothing new.
const MOST_BYTES: usize = 1 << 17;

/// Triangle limit, for time: a small file may draw millions of triangles.
const MOST_TRIANGLES: usize = 1 << 14;

/// Imports a `.gltf` or `.glb` file without external files, and poses it.
pub fn gltf_import(data: &[u8]) {
    if data.len() > MOST_BYTES {
        return;
    }
    let name = if data.starts_with(b"glTF") { "scene.glb" } else { "scene.gltf" };
    let files = BTreeMap::from([(name.to_owned(), data.to_vec())]);
    let Ok(scene) = load_gltf_from_memory(name, &files, &decode_image, None, &|_, _| ()) else { return };
    if triangles(&scene) > MOST_TRIANGLES {
        return;
    }
    for animation in [None, Some(0), Some(1)] {
        for seconds in [0.0, 0.3, 1e9, f32::NAN] {
            check_pose(&scene, animation, seconds);
        }
    }
}

fn triangles(scene: &Scene) -> usize {
    let instances = scene.instances();
    instances.iter().map(|i| scene.meshes[i.mesh].primitives[i.primitive].indices.len() / 3).sum()
}

fn check_pose(scene: &Scene, animation: Option<usize>, seconds: f32) {
    let pose = scene.pose(animation, seconds);
    let at = || format!("animation {animation:?} at {seconds} s");
    let bounds = scene.bounds(&pose);
    assert!(bounds.is_none_or(|bounds| bounds.min.is_finite() && bounds.max.is_finite()), "{}: {bounds:?}", at());
    for triangle in pose.triangles(scene) {
        assert!(triangle.vertices.iter().all(|vertex| vertex.is_finite()), "{}: {triangle:?}", at());
    }
}
