//! Georeferenced files: transforms of millions of metres.

use glam::{DMat4, DQuat, DVec3, Vec3};
use shadowfit_scene::Scene;

use crate::build::{Build, TRIANGLE, U8};

/// A place on the globe, at survey coordinates.
const PLACE: DVec3 = DVec3::new(-2_694_044.411_163, 4_266_352.873_251, 3_888_310.602_734);

fn turn() -> DQuat {
    DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -1.1, 2.2)
}

/// Returns JSON numbers with all digits.
fn json(values: &[f64]) -> String {
    format!("{values:?}")
}

fn file(nodes: &str, more: &str) -> Scene {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    let times = build.floats("SCALAR", 1, &[0.0, 1.0]);
    let moves = build.floats("VEC3", 3, &[0.0, 0.0, 0.0, 0.0, 0.25, 0.0]);
    build.members(&format!(
        r#""scene":0,"scenes":[{{"nodes":[0,1,2]}}],"nodes":[{nodes}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":{positions}}}}}]}}]{}"#,
        more.replace("TIMES", &times.to_string()).replace("MOVES", &moves.to_string())
    ));
    build.load("far").unwrap()
}

/// Returns three parts of a place: as a matrix, nested in a rotated and scaled root, and with its own long
/// translation.
fn nodes(offset: DVec3) -> String {
    let part = DMat4::from_scale_rotation_translation(DVec3::ONE, turn(), PLACE + turn() * offset);
    let inner = DVec3::new(5.0, 0.25, 1.125) * 1e-3;
    [
        format!(r#"{{"mesh":0,"matrix":{}}}"#, json(&part.to_cols_array())),
        format!(
            r#"{{"children":[3],"translation":{},"rotation":{},"scale":[1000,1000,1000]}}"#,
            json(&PLACE.to_array()),
            json(&turn().to_array())
        ),
        format!(r#"{{"mesh":0,"translation":{},"rotation":{}}}"#, json(&PLACE.to_array()), json(&turn().to_array())),
        format!(r#"{{"mesh":0,"translation":{},"scale":[0.001,0.001,0.001]}}"#, json(&inner.to_array())),
    ]
    .join(",")
}

#[test]
fn parts_on_the_globe_stay_within_a_millimetre_of_each_other_however_they_are_nested() {
    let offset = DVec3::new(12.062_5, -3.501, 0.007);
    let scene = file(&nodes(offset), "");
    assert!(scene.notes.iter().any(|note| note.contains("moved near the origin")), "{:?}", scene.notes);
    let corners: Vec<Vec3> =
        scene.pose(None, 0.0).triangles(&scene).iter().map(|triangle| triangle.vertices[1]).collect();
    let exact = [offset, DVec3::new(5.0, 0.25, 1.125), DVec3::ZERO].map(|at| PLACE + turn() * (at + DVec3::X));
    assert_eq!(corners.len(), exact.len());
    for (corner, exact) in corners.iter().zip(exact) {
        let error = (corner.as_dvec3() + scene.origin - exact).length();
        assert!(error < 1e-3, "{error} m");
    }
    let bounds = scene.bounds(&scene.pose(None, 0.0)).unwrap();
    assert!(bounds.min.abs().max(bounds.max.abs()).max_element() < 30.0, "{bounds:?}");
}

#[test]
fn what_moves_below_a_root_on_the_globe_moves_exactly() {
    let channel = r#","animations":[{"samplers":[{"input":TIMES,"output":MOVES}],
        "channels":[{"sampler":0,"target":{"node":3,"path":"translation"}}]}]"#;
    let scene = file(&nodes(DVec3::ZERO), channel);
    for (seconds, moved) in [(0.25, 62.5), (0.75, 187.5)] {
        let pose = scene.pose(Some(0), seconds);
        let node = scene.nodes.iter().position(|node| node.parent.is_some()).unwrap();
        let at = pose.world_from_node[node].w_axis.truncate().as_dvec3() + scene.origin;
        let exact = PLACE + turn() * DVec3::Y * moved;
        assert!((at - exact).length() < 1e-3, "{} m", (at - exact).length());
    }
}

#[test]
fn a_stray_part_does_not_keep_a_place_on_the_globe_coarse_and_is_noted() {
    let place = format!(r#"{{"mesh":0,"translation":{}}}"#, json(&PLACE.to_array()));
    let scene = file(&[place.as_str(), r#"{"mesh":0}"#, &place].join(","), "");
    assert!((scene.origin - PLACE).abs().max_element() < 2.0, "{}", scene.origin);
    let note = "parts that lie up to 4266353 m from the origin, where positions are 0.500 m apart: 1 of 3";
    assert!(scene.notes.iter().any(|found| found == note), "{:?}", scene.notes);
    let near = file(&[place.as_str(), "{}", "{}"].join(","), "");
    assert!(!near.notes.iter().any(|found| found.contains("apart")), "{:?}", near.notes);
}

#[test]
fn joints_without_weights_have_no_part_in_the_origin() {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    let joints = build.accessor(U8, "VEC4", 3, &[0, 1, 1, 1].repeat(3));
    let weights = build.floats("VEC4", 4, &[1.0, 0.0, 0.0, 0.0].repeat(3));
    build.members(&format!(
        r#""nodes":[{{"mesh":0,"skin":0}},{{}},{{"translation":[1e13,0,0]}}],"skins":[{{"joints":[1,2]}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":{positions},"JOINTS_0":{joints},"WEIGHTS_0":{weights}}}}}]}}]"#
    ));
    assert_eq!(build.load("joints").unwrap().origin, DVec3::ZERO);
}

#[test]
fn scenes_near_their_origin_and_those_around_it_stay() {
    for (place, is_moved) in [(DVec3::new(4000.0, 0.0, 0.0), false), (DVec3::new(0.0, -9000.0, 0.0), true)] {
        let node = format!(r#"{{"mesh":0,"translation":{}}}"#, json(&place.to_array()));
        let scene = file(&[node.as_str(), "{}", "{}"].join(","), "");
        assert_eq!(scene.origin != DVec3::ZERO, is_moved, "{place}");
    }
    // Two triangles near the origin, and a backdrop of three.
    let far = r#""mesh":0,"translation":[50000,0,0]"#;
    let backdrop =
        format!(r#"{{"mesh":0,"children":[3]}},{{{far},"children":[4]}},{{{far}}},{{"mesh":0}},{{"mesh":0}}"#);
    assert_eq!(file(&backdrop, "").origin, DVec3::ZERO);
    let wide = r#"{"mesh":0,"translation":[-1000000,0,0]},{"mesh":0,"translation":[1010000,0,0]},{}"#;
    assert_eq!(file(wide, "").origin, DVec3::ZERO);
}
