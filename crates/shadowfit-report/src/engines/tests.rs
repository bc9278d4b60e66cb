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

/// Greatest difference of two matrices' elements, relative where they exceed 1: one and a half texels of
/// 1/1024 of a map's half side. The engines compute in f32 and round to whole texels, so that a tie may go the other way.
const TOLERANCE: f64 = 1.5 / 1024.0;

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
                assert_eq!(found.resolution, wanted.resolution, "{name}");
                let off = |(a, b): (&f64, &f64)| (a - b).abs() / (TOLERANCE * b.abs().max(1.0));
                let off = found.view_proj.iter().zip(&wanted.view_proj).map(off).fold(0.0, f64::max);
                assert!(off <= 1.0, "{name}, map {index}: {off}\n{found:?}\n{wanted:?}");
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
