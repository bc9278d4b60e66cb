//! Every scene of the collection next to the workspace: loaded, drawn and judged, with its artefacts shown
//! and fixed.

use std::path::{Path, PathBuf};

use shadowfit_params::tool::InsetMaps;
use shadowfit_scene::{Scene, SceneError, load_gltf};
use shadowfit_study::PrepareError;
use shadowfit_truth::PictureTally;
use shadowfit_viewer::{Artefact, Stage, StageError};

use crate::support::{assets, files_below, test_gpu};

/// Size of the pictures, in pixels: small, since the driver draws on the CPU.
const SIZE: [u32; 2] = [64, 36];

/// Scenes whose three artefacts are shown and fixed: one textured and animated, one of many nodes, one with
/// cut-outs, one of an unusual size, one that morphs.
const WITH_ARTEFACTS: [&str; 5] = [
    "fox/Fox.glb",
    "kenney_city/building-garage.glb",
    "mask_fence/mask_fence.glb",
    "truck_vehicles/meshes.glb",
    "edge_shared/simple_morph/glTF/SimpleMorph.gltf",
];

/// Returns every glTF file that must load. Files that must be refused are in separate folders.
fn scenes(folder: &Path) -> Vec<PathBuf> {
    let is_scene = |path: &PathBuf| {
        let is_gltf = path.extension().is_some_and(|extension| extension == "glb" || extension == "gltf");
        let refused = path.iter().any(|part| part == "hostile_shared" || part == "refuse");
        is_gltf && !refused
    };
    files_below(folder).into_iter().filter(is_scene).collect()
}

fn load(path: &Path) -> Scene {
    load_gltf(path).unwrap_or_else(|error| panic!("{error}"))
}

fn is_sound(tally: &PictureTally) -> bool {
    let classes = tally.all.false_shadow + tally.all.false_light + tally.all.hole + tally.all.edge;
    // NaN means that a value could not be measured, such as crawl in a single picture.
    let possible = tally.columns().iter().all(|(_, value)| value.is_nan() || (value.is_finite() && *value >= 0.0));
    possible
        && classes == tally.all.wrong
        && tally.all.wrong <= tally.all.facing
        && tally.error <= tally.all.facing as f64
}

/// Draws and judges the current view.
fn draw_and_judge(stage: &mut Stage, name: &str) {
    let picture = stage.target(SIZE);
    stage.draw(&picture);
    assert_eq!(stage.problem(), None, "{name}");
    let pixels = picture.read(stage.gpu()).expect("pixels");
    let first = &pixels[..4];
    assert!(pixels.chunks_exact(4).any(|pixel| pixel != first), "{name}: the picture is one flat colour");
    let judged = stage.judge(SIZE, false).unwrap_or_else(|| panic!("{name}: {:?}", stage.problem()));
    assert!(is_sound(&judged.tally), "{name}: {:?}", judged.tally.columns());
    assert!(judged.tally.all.facing > 0, "{name}: nothing that the light reaches is in its own first view");
}

#[test]
fn every_scene_of_the_collection_is_drawn_and_judged() {
    let Some(folder) = assets() else { return };
    let files = scenes(&folder);
    assert!(files.len() > 40, "{} scenes", files.len());
    let mut stage = Stage::new(test_gpu(), load(&folder.join(WITH_ARTEFACTS[0])), 1).expect("a scene");
    let (mut drawn, mut empty) = (0, Vec::new());
    for file in files {
        let name = file.strip_prefix(&folder).unwrap_or(&file).display().to_string();
        let scene = match load_gltf(&file) {
            Ok(scene) => scene,
            // Files that contain only a light, points or lines.
            Err(SceneError::Empty { .. }) => {
                empty.push(name);
                continue;
            }
            Err(error) => panic!("{error}"),
        };
        match stage.set_scene(scene) {
            Ok(()) => {
                stage.settings.view.inset = InsetMaps::Off;
                draw_and_judge(&mut stage, &name);
                drawn += 1;
            }
            Err(StageError::Scene(PrepareError::NothingToDraw(_))) => empty.push(name),
            Err(error) => panic!("{name}: {error}"),
        }
    }
    println!("{drawn} scenes drawn; nothing to draw in {empty:?}");
    assert!(empty.iter().all(|name| name.starts_with("edge_shared")), "no triangles in {empty:?}");
}

#[test]
fn artefacts_of_real_scenes_are_shown_and_fixed_without_a_problem() {
    let Some(folder) = assets() else { return };
    let mut stage = Stage::new(test_gpu(), load(&folder.join(WITH_ARTEFACTS[0])), 1).expect("a scene");
    for name in WITH_ARTEFACTS {
        stage.set_scene(load(&folder.join(name))).unwrap_or_else(|error| panic!("{name}: {error}"));
        // Advance animations first.
        stage.set_time(0.3);
        for artefact in [Artefact::Acne, Artefact::Aliasing, Artefact::ClippingHole] {
            stage.show_artefact(artefact);
            draw_and_judge(&mut stage, &format!("{name}, {artefact:?}"));
            stage.fix_artefact(artefact);
            draw_and_judge(&mut stage, &format!("{name}, {artefact:?} fixed"));
        }
        stage.reset();
        assert_eq!(stage.shown(), None, "{name}");
    }
}

/// Returns whether the picture at a time of the animation differs from its start.
fn moves(stage: &mut Stage, seconds: f32) -> bool {
    stage.settings.view.inset = InsetMaps::Off;
    let picture = stage.target(SIZE);
    let mut draw_at = |time| {
        stage.set_time(time);
        stage.draw(&picture);
        picture.read(stage.gpu()).expect("pixels")
    };
    draw_at(0.0) != draw_at(seconds)
}

#[test]
fn the_default_scene_walks_and_stands_still_when_stopped() {
    let mut stage = Stage::new(test_gpu(), shadowfit_scene::builtin::default_scene(), 1).expect("a scene");
    assert!(moves(&mut stage, 1.0) && !moves(&mut stage, 0.0));
    stage.animation = usize::MAX;
    assert!(!moves(&mut stage, 1.0), "an animation that the scene lacks moves it");
}

#[test]
fn skins_and_morph_targets_of_real_scenes_move_the_picture() {
    let Some(folder) = assets() else { return };
    let mut stage = Stage::new(test_gpu(), load(&folder.join(WITH_ARTEFACTS[0])), 1).expect("a scene");
    for (name, seconds) in [
        ("fox/Fox.glb", 0.3),
        ("morph_stress/MorphStressTest.gltf", 0.7),
        ("edge_shared/simple_skin/SimpleSkin.gltf", 1.5),
        ("edge_shared/simple_morph/glTF/SimpleMorph.gltf", 1.5),
    ] {
        stage.set_scene(load(&folder.join(name))).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(moves(&mut stage, seconds), "{name}");
    }
}
