//! The fits compared with numbers from the engines' own code: three.js and Babylon.js run by `peers/fit.mjs`, Bevy by its
//! own system in a `World`.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::*;

#[derive(Deserialize)]
struct Vectors {
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Case {
    aabb: [f64; 6],
    frame: Frame,
    fits: BTreeMap<String, Vec<FitMap>>,
}

fn cases() -> Vec<Case> {
    let vectors: Vectors = serde_json::from_str(include_str!("vectors.json")).expect("JSON");
    vectors.cases
}

fn scene(aabb: [f64; 6]) -> Scene {
    let name = "vectors".to_owned();
    Scene { name, file: None, scale: 1.0, ground: None, triangles: 0, objects: vec![aabb], aabb }
}

#[test]
fn maps_are_those_of_the_engines_own_code() {
    for case in cases() {
        let scene = scene(case.aabb);
        for engine in ENGINES {
            let wanted = &case.fits[engine.name];
            let name = format!("{} {}", engine.name, case.frame.id);
            let found = engine.fit(&case.frame, &scene, 2048);
            assert_eq!(found.len(), wanted.len(), "{name}");
            for (index, (found, wanted)) in found.iter().zip(wanted).enumerate() {
                assert!(is_same_map(wanted, found), "{name}, map {index}: {found:?}, not {wanted:?}");
                let split = (found.split_far / wanted.split_far - 1.0).abs();
                assert!(split <= 1e-6, "{name}, map {index}: {} {}", found.split_far, wanted.split_far);
            }
        }
    }
}

#[test]
fn engines_are_found_by_name_and_named_once() {
    for engine in ENGINES {
        assert_eq!(Engine::find(engine.name).map(|found| found.what), Some(engine.what));
    }
    assert!(Engine::find("unity").is_none());
    let names: std::collections::BTreeSet<&str> = ENGINES.iter().map(|engine| engine.name).collect();
    assert_eq!(names.len(), ENGINES.len());
}

#[test]
fn a_map_that_is_moved_by_two_texels_is_another_map() {
    let map = &cases()[0].fits["bevy"][0];
    let mut moved = map.clone();
    moved.view_proj[12] += 2.0 / 1024.0 * map.view_proj[12].abs().max(1.0);
    assert!(is_same_map(map, map) && !is_same_map(map, &moved));
}
