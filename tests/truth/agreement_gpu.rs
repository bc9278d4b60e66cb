//! The GPU's classes compared with the CPU's, on the built-in scene and on every scene of the collection.

use std::path::Path;

use shadowfit::glam::Vec3;
use shadowfit::{Aabb, Camera, Lens, PerspectiveCamera, Technique};
use shadowfit_scene::builtin::default_scene;
use shadowfit_scene::{Scene, load_gltf};
use shadowfit_study::{Agreement, Comparison, Judging, LiveTruth, SharedTruth, View};

use super::shapes::NO_BIAS;
use crate::support::{assets, test_gpu};

/// Size of the judged pictures, in pixels.
const SIZE: [u32; 2] = [240, 135];
/// Guaranteed shares of pixels of equal class: off edges, and of all pixels that face the light.
const PROMISED: [f64; 2] = [0.999, 0.995];
/// Scenes of the collection: one with cut-outs, one that morphs, and one of many instances.
const SCENES: [&str; 3] =
    ["mask_fence/mask_fence.glb", "morph_stress/MorphStressTest.gltf", "kenney_town/kenney_town.glb"];
/// The other scenes of the collection.
const MORE_SCENES: [&str; 8] = [
    "zdm2/zdm2.glb",
    "dutch_ship/dutch_ship_medium_1k.gltf",
    "kaykit_graveyard/kaykit_graveyard.glb",
    "fox/Fox.glb",
    "flight_helmet/FlightHelmet.gltf",
    "plastic_chair/plastic_monobloc_chair_01_1k.gltf",
    "truck_vehicles/meshes.glb",
    "bevy_terrain/Mountains.gltf",
];

/// Returns views of the middle of a scene from two sides, and an orthographic one.
fn views(bounds: Aabb) -> [View; 3] {
    let (centre, radius) = ((bounds.min + bounds.max) * 0.5, (bounds.size().length() * 0.5).max(1e-3));
    let views = [Vec3::new(0.6, 0.5, 0.7), Vec3::new(-0.5, 0.25, 0.4)].map(|away| {
        let eye = centre + away * radius;
        let camera = PerspectiveCamera {
            eye: eye.as_dvec3(),
            forward: (centre - eye).normalize(),
            up: Vec3::Y,
            fov_y: 1.0,
            aspect: SIZE[0] as f32 / SIZE[1] as f32,
            near: radius * 1e-3,
            far: radius * 6.0,
        };
        View { camera: camera.into(), direction: Vec3::new(-0.5, -0.7, -0.4).normalize(), is_first: true }
    });
    let lens = Lens::Orthographic { half_height: radius * 0.5 };
    let flat = View { camera: Camera { lens, ..views[0].camera }, ..views[0] };
    [views[0], views[1], flat]
}

/// Returns a technique with few errors, and one with all kinds of errors.
fn techniques() -> [Technique; 2] {
    let preset = |name| Technique::preset(name).expect("a preset").with_resolution(512, 512);
    let (good, poor) = (preset("focused-4"), Technique { bias: NO_BIAS, ..preset("xna-1") });
    [good, poor]
}

fn assert_agreement(scene: Scene) {
    let name = scene.name.clone();
    let judging = Judging { size: SIZE, crawl: false, ..Judging::default() };
    let mut comparison = Comparison::new(test_gpu(), scene, judging).expect("a scene");
    for technique in techniques() {
        comparison.add(technique).expect("a technique");
    }
    let mut live = LiveTruth::new(comparison.gpu(), comparison.scene()).expect("a scene that fits");
    let mut agreement = Agreement::default();
    for view in views(comparison.scene().bounds()) {
        let outcomes = comparison.frame(&view, &mut SharedTruth::default()).expect("a frame");
        for (number, outcome) in outcomes.iter().enumerate() {
            let (gpu, evaluator, scene) = comparison.evaluator(number);
            let pixels = evaluator.judge_live(gpu, scene, &view, &outcome.maps, &mut live).expect("judged");
            agreement.add(&outcome.judged, &pixels);
        }
    }
    println!("{name}: {} pixels, {} off edges, {} of all", agreement.pixels(), agreement.off_edges(), agreement.all());
    assert!(agreement.pixels() > 1000, "{name}: {} pixels", agreement.pixels());
    assert!(agreement.off_edges() >= PROMISED[0] && agreement.all() >= PROMISED[1], "{name}: {agreement:?}");
    assert!(agreement.edge_zone() >= PROMISED[0], "{name}: {agreement:?}");
}

#[test]
fn the_built_in_scene_is_judged_alike() {
    assert_agreement(default_scene());
}

#[test]
fn scenes_of_the_collection_are_judged_alike() {
    assert_files_agree(&SCENES);
}

#[test]
#[ignore = "eight more scenes, judged by the CPU: cargo xtask test --all"]
fn the_other_scenes_of_the_collection_are_judged_alike() {
    assert_files_agree(&MORE_SCENES);
}

fn assert_files_agree(files: &[&str]) {
    let Some(folder) = assets() else { return };
    for file in files {
        assert_agreement(load_gltf(&folder.join(Path::new(file))).unwrap_or_else(|error| panic!("{error}")));
    }
}
