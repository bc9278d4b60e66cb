//! Facts about all built-in scenes: sound meshes, budgets, cameras that see their subject, animations that loop.

mod coplanar;
mod courtyard;
mod facts;
mod motion;
mod surface;
mod view;

use facts::{bounds_below, drawn};

use super::BuiltinScene;
use crate::{AlphaMode, Instance, Primitive, Scene, Triangle};

/// Builds every built-in scene.
fn all() -> impl Iterator<Item = (BuiltinScene, Scene)> {
    BuiltinScene::ALL.into_iter().map(|builtin| (builtin, builtin.build()))
}

/// Builds every built-in scene, with its id.
fn every() -> impl Iterator<Item = (&'static str, Scene)> {
    all().map(|(builtin, scene)| (builtin.id(), scene))
}

#[test]
fn every_scene_is_found_by_its_id_and_says_what_it_shows() {
    assert_eq!(BuiltinScene::default(), BuiltinScene::Courtyard);
    for (index, builtin) in BuiltinScene::ALL.into_iter().enumerate() {
        assert_eq!(BuiltinScene::from_id(builtin.id()), Some(builtin));
        assert_eq!(BuiltinScene::ALL.iter().position(|other| *other == builtin), Some(index));
        assert_eq!(builtin.label().to_lowercase(), builtin.id());
        assert!(builtin.help().ends_with('.') && builtin.help().len() > 40, "{}", builtin.help());
        assert_eq!(builtin.build().name, builtin.id());
    }
    for unknown in ["", "Courtyard", "courtyard ", "desert"] {
        assert_eq!(BuiltinScene::from_id(unknown), None, "{unknown}");
    }
}

#[test]
fn triangle_counts_keep_their_budget() {
    for (builtin, scene) in all() {
        let (low, high) = match builtin {
            BuiltinScene::Plain => (40_000, 60_000),
            BuiltinScene::Arcade => (60_000, 80_000),
            BuiltinScene::Courtyard | BuiltinScene::Forest => (100_000, 150_000),
            BuiltinScene::Town => (60_000, 120_000),
        };
        let count = drawn(&scene, None);
        assert!((low..=high).contains(&count), "{builtin:?}: {count}");
    }
}

#[test]
fn every_scene_lies_around_the_origin() {
    for (builtin, scene) in all() {
        let (side, tall) = match builtin {
            BuiltinScene::Courtyard => (120.0, 15.0),
            BuiltinScene::Plain => (2000.0, 60.0),
            BuiltinScene::Arcade => (120.0, 12.0),
            BuiltinScene::Forest => (120.0, 20.0),
            BuiltinScene::Town => (300.0, 45.0),
        };
        let bounds = scene.bounds(&scene.pose(None, 0.0)).expect("bounds");
        assert!(bounds.min.is_finite() && bounds.max.is_finite());
        assert!((bounds.max.x - bounds.min.x - side).abs() < 1.0, "{builtin:?}: {bounds:?}");
        assert!((bounds.max.x + bounds.min.x).abs() < 1.0, "{builtin:?}: {bounds:?}");
        assert!(bounds.min.y > -5.0 && bounds.max.y < tall, "{builtin:?}: {bounds:?}");
    }
}

#[test]
fn thousands_of_cut_out_leaves_make_the_forest() {
    let scene = BuiltinScene::Forest.build();
    let count = |wanted: &dyn Fn(&Primitive) -> bool| -> usize {
        let instances = scene.instances();
        let primitive = |instance: &Instance| &scene.meshes[instance.mesh].primitives[instance.primitive];
        instances.iter().map(primitive).filter(|p| wanted(p)).map(|p| p.indices.len() / 3).sum()
    };
    let leaves = count(&|primitive| surface::is_foliage(&scene, primitive));
    assert!(leaves > 20_000 && leaves < drawn(&scene, None), "{leaves}");
}
