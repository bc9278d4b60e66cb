//! Facts about the scenes of samples: the checks of every generated scene, and places and sizes of the
//! sources.

#[path = "../../../shadowfit-scene/src/builtin/tests/coplanar.rs"]
mod coplanar;
#[path = "../../../shadowfit-scene/src/builtin/tests/facts.rs"]
mod facts;
mod street_and_still_life;
#[path = "../../../shadowfit-scene/src/builtin/tests/surface.rs"]
mod surface;
mod terrain_scene;
mod xna_scene;

use shadowfit_scene::builtin::BuiltinScene;
use shadowfit_scene::{AlphaMode, Primitive, Scene, Triangle};

use crate::SAMPLES;

/// Builds the samples' own scenes, with their names.
fn every() -> impl Iterator<Item = (&'static str, Scene)> {
    let own = ["xna-shadow-mapping", "headlight-projective", "comparison-sampler", "terrain-vehicles"];
    let names = ["shadow-mapping", "street", "still-life", "terrain"];
    names.into_iter().zip(own.map(scene_of))
}

/// Builds the scene of a sample.
fn scene_of(id: &str) -> Scene {
    SAMPLES.iter().find(|sample| sample.id == id).expect("a sample").scene()
}

#[test]
fn scenes_have_names_of_their_own_a_camera_and_a_sun() {
    for (id, scene) in every() {
        assert_eq!(scene.name, id);
        assert_eq!(BuiltinScene::from_id(id), None);
        assert_eq!(scene.cameras.len(), 1, "{id}");
        let sun = scene.sun.expect("a sun").direction;
        assert!((sun.length() - 1.0).abs() < 1e-6 && sun.y < -0.3, "{id}");
    }
}

#[test]
fn every_sample_shows_a_scene_of_its_own_or_a_built_in_one() {
    for sample in &SAMPLES {
        let name = sample.scene().name;
        let is_own = every().any(|(id, _)| id == name);
        assert!(is_own || BuiltinScene::from_id(&name).is_some(), "{}: {name}", sample.id);
    }
}
