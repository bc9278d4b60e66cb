//! Cameras and suns of small files: which ones are used, and how animations move them.

use glam::{DVec3, Vec3};
use shadowfit_scene::{Lens, Scene};

use crate::build::{Build, TRIANGLE, load_text};

/// Loads a triangle, and these nodes after its own. `members` are further members of the file.
fn scene(name: &str, nodes: &str, members: &str) -> Scene {
    with_motion(name, nodes, members, "")
}

/// Loads the same scene with an animation. The keys 0 s and 2 s are accessor 1, `rotations`, two quaternions,
/// are accessor 2.
fn with_motion(name: &str, nodes: &str, members: &str, animation: &str) -> Scene {
    let mut build = Build::default();
    build.floats("VEC3", 3, &TRIANGLE);
    build.floats("SCALAR", 1, &[0.0, 2.0]);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    build.floats("VEC4", 4, &[-half, 0.0, 0.0, half, 0.0, 0.0, 0.0, 1.0]);
    build.members(&format!(
        r#""scene":0,"scenes":[{{"nodes":[0,1,2,3]}}],"nodes":[{{"mesh":0}},{nodes}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}]{members}{animation}"#
    ));
    load_text(name, &build.json()).expect(name)
}

/// Nodes 1 to 3 with a light each. The first light travels along -z, the second down, the third along -x.
const LIT: &str = r#"{"name":"a","extensions":{"KHR_lights_punctual":{"light":0}}},
    {"name":"b","rotation":[-0.70710678,0,0,0.70710678],"scale":[3,3,3],"extensions":{"KHR_lights_punctual":{"light":1}}},
    {"name":"c","rotation":[0,0.70710678,0,0.70710678],"scale":[-2,1,1],"extensions":{"KHR_lights_punctual":{"light":2}}}"#;

fn lights(lights: &str) -> String {
    format!(r#","extensions":{{"KHR_lights_punctual":{{"lights":[{lights}]}}}}"#)
}

/// Nodes 1 to 3 with a camera each.
const SEEN: &str = r#"{"name":"a","camera":0,"translation":[1,2,3]},
    {"name":"b","camera":1,"rotation":[0,0,0.38268343,0.92387953],"scale":[2,5,0.1]},
    {"name":"c","camera":2,"rotation":[-0.70710678,0,0,0.70710678]}"#;

fn cameras(cameras: &str) -> String {
    format!(r#","cameras":[{cameras}]"#)
}

fn perspective(lens: &str) -> String {
    format!(r#"{{"type":"perspective","perspective":{{{lens}}}}}"#)
}

fn orthographic(lens: &str) -> String {
    format!(r#"{{"type":"orthographic","orthographic":{{{lens}}}}}"#)
}

#[test]
fn the_strongest_directional_light_is_the_sun_and_all_are_listed() {
    let table: [(&str, Option<usize>, &str); 6] = [
        // Intensity counts. Green light is brighter than blue light of the same intensity.
        (
            r#"{"type":"directional","intensity":0},{"type":"directional","intensity":5},{"type":"directional"}"#,
            Some(1),
            "2 of 3",
        ),
        (
            r#"{"type":"directional","color":[0,0,1],"intensity":9},{"type":"directional","color":[0,1,0],"intensity":4},{"type":"directional"}"#,
            Some(1),
            "2 of 3",
        ),
        (r#"{"type":"directional"},{"type":"directional"},{"type":"directional"}"#, Some(0), "1 of 3"),
        (
            r#"{"type":"directional","intensity":-7},{"type":"directional","color":[0,0,0]},{"type":"directional","intensity":0}"#,
            None,
            "emits no light",
        ),
        (
            r#"{"type":"point","intensity":900},{"type":"spot","spot":{}},{"type":"directional"}"#,
            Some(0),
            "2 point or spot",
        ),
        (r#"{"type":"point"},{"type":"spot","spot":{}},{"type":"point"}"#, None, "3 point or spot"),
    ];
    for (json, strongest, note) in table {
        let scene = scene("suns", LIT, &lights(json));
        assert_eq!(scene.strongest_sun(), strongest, "{json}");
        assert_eq!(scene.suns.len(), json.matches("directional").count());
        assert_eq!(scene.sun.is_some(), strongest.is_some());
        assert!(scene.notes.iter().any(|line| line.contains(note)), "{json}: {:?}", scene.notes);
    }
    let scene = scene(
        "one_sun",
        LIT,
        &lights(
            r#"{"type":"point"},{"type":"directional","name":"day","intensity":3,"color":[1,0.5,0]},{"type":"point"}"#,
        ),
    );
    let sun = scene.sun.expect("a sun");
    assert!((sun.direction - Vec3::NEG_Y).length() < 1e-6, "{sun:?}");
    assert_eq!((sun.color, sun.intensity), (Vec3::new(1.0, 0.5, 0.0), 3.0));
    assert_eq!((scene.suns[0].name.as_str(), scene.suns[0].node), ("day", 2));
}

#[test]
fn scaled_mirrored_and_sizeless_nodes_keep_the_direction_of_their_light_or_are_noted() {
    let scaled =
        scene("scaled_suns", LIT, &lights(r#"{"type":"directional"},{"type":"directional"},{"type":"directional"}"#));
    let rest = scaled.pose(None, 0.0);
    let directions: Vec<Vec3> = scaled.suns.iter().map(|sun| sun.direction(&rest).expect("a direction")).collect();
    for (found, expected) in directions.iter().zip([Vec3::NEG_Z, Vec3::NEG_Y, Vec3::NEG_X]) {
        assert!((*found - expected).length() < 1e-6, "{directions:?}");
    }
    let flat = LIT.replace(r#""name":"a","#, r#""name":"a","scale":[0,0,0],"#);
    let flat = scene("flat_sun", &flat, &lights(r#"{"type":"directional"},{"type":"point"},{"type":"point"}"#));
    assert!(flat.sun.is_none());
    assert!(flat.notes.iter().any(|note| note.contains("no size")), "{:?}", flat.notes);
}

#[test]
fn a_strongest_light_that_cannot_be_used_leaves_the_sun_to_the_next_one() {
    let flat = LIT.replace(r#""name":"a","#, r#""name":"a","scale":[0,0,0],"#);
    let bright = r#""color":[1e20,1e20,1e20],"intensity":1e30"#;
    for (nodes, first, fault) in
        [(flat.as_str(), r#""intensity":9"#, "its node has no size"), (LIT, bright, "its brightness")]
    {
        let json =
            format!(r#"{{"type":"directional",{first}}},{{"type":"directional","intensity":2}},{{"type":"point"}}"#);
        let scene = scene("unusable_sun", nodes, &lights(&json));
        assert_eq!(scene.strongest_sun(), Some(1));
        let sun = scene.sun.expect("the second one");
        assert!((sun.direction - Vec3::NEG_Y).length() < 1e-6 && sun.intensity == 2.0, "{sun:?}");
        for note in [&format!("directional light 1 ignored: {fault}"), "the sun is directional light 2 of 2"] {
            assert!(scene.notes.iter().any(|line| line.contains(note)), "{note}: {:?}", scene.notes);
        }
    }
}

#[test]
fn an_animated_node_moves_its_sun_and_its_camera() {
    let nodes = LIT.replace(r#""name":"a","#, r#""name":"a","camera":0,"#);
    let members = lights(r#"{"type":"directional"},{"type":"point"},{"type":"point"}"#)
        + &cameras(&perspective(r#""yfov":1,"znear":0.1"#));
    let animation = r#","animations":[{"channels":[{"sampler":0,"target":{"node":1,"path":"rotation"}}],"samplers":[{"input":1,"output":2}]}]"#;
    let scene = with_motion("moving", &nodes, &members, animation);
    let at = |seconds: f32| {
        let pose = scene.pose(Some(0), seconds);
        (
            scene.suns[0].direction(&pose).expect("a direction"),
            scene.cameras[0].placement(&pose).expect("a camera").forward,
        )
    };
    for (seconds, expected) in [(0.0, Vec3::NEG_Y), (1.0, Vec3::new(0.0, -1.0, -1.0).normalize())] {
        let (sun, camera) = at(seconds);
        assert!((sun - expected).length() < 1e-5 && (camera - expected).length() < 1e-5, "{seconds} s: {sun} {camera}");
    }
}

#[test]
fn every_lens_that_makes_an_image_is_kept_and_the_others_are_noted_with_their_number() {
    let degrees = |degrees: f32| format!(r#""yfov":{},"znear":0.01"#, degrees.to_radians());
    for fov in [0.2_f32, 45.0, 170.0, 179.5] {
        let scene = scene(
            "lens",
            SEEN,
            &cameras(
                &[
                    perspective(&degrees(fov)),
                    perspective(r#""yfov":1,"znear":1,"zfar":9,"aspectRatio":2"#),
                    orthographic(r#""xmag":3,"ymag":-2,"znear":0,"zfar":9"#),
                ]
                .join(","),
            ),
        );
        let lenses: Vec<Lens> = scene.cameras.iter().map(|camera| camera.lens).collect();
        assert_eq!(lenses[0], Lens::Perspective { fov_y: fov.to_radians(), near: 0.01, far: None });
        assert_eq!(lenses[1], Lens::Perspective { fov_y: 1.0, near: 1.0, far: Some(9.0) });
        assert_eq!(lenses[2], Lens::Orthographic { half_height: 2.0, near: 0.0, far: 9.0 });
    }
    let bad = [
        (perspective(r#""yfov":0,"znear":0.1"#), "yfov is 0"),
        (perspective(r#""yfov":3.2,"znear":0.1"#), "yfov is 3.2"),
        (perspective(r#""yfov":1,"znear":0"#), "znear is 0"),
        (perspective(r#""yfov":1,"znear":-1"#), "znear is -1"),
        (perspective(r#""yfov":1,"znear":2,"zfar":2"#), "zfar 2"),
        (orthographic(r#""xmag":1,"ymag":0,"znear":0,"zfar":9"#), "ymag is 0"),
        (orthographic(r#""xmag":1,"ymag":1,"znear":9,"zfar":1"#), "zfar 1"),
    ];
    for (json, note) in bad {
        let fine = perspective(r#""yfov":1,"znear":0.1"#);
        let scene = scene("bad_lens", SEEN, &cameras(&[json.clone(), fine.clone(), fine].join(",")));
        assert_eq!(scene.cameras.len(), 2, "{json}");
        let is_noted = scene.notes.iter().any(|line| line.contains("cameras[0]") && line.contains(note));
        assert!(is_noted, "{json}: {:?}", scene.notes);
    }
}

#[test]
fn placements_have_the_roll_of_their_node_and_neither_its_scale_nor_its_shear() {
    let lens = perspective(r#""yfov":1,"znear":0.1"#);
    let scene = scene("rolled", SEEN, &cameras(&[lens.clone(), lens.clone(), lens].join(",")));
    let rest = scene.pose(None, 0.0);
    let placed: Vec<_> = scene.cameras.iter().map(|camera| camera.placement(&rest).expect("a placement")).collect();
    assert_eq!((placed[0].eye, placed[0].forward, placed[0].up), (DVec3::new(1.0, 2.0, 3.0), Vec3::NEG_Z, Vec3::Y));
    let rolled = Vec3::new(-1.0, 1.0, 0.0).normalize();
    assert!((placed[1].up - rolled).length() < 1e-6 && (placed[1].forward - Vec3::NEG_Z).length() < 1e-6);
    assert!((placed[2].forward - Vec3::NEG_Y).length() < 1e-6 && (placed[2].up - Vec3::NEG_Z).length() < 1e-6);
}

#[test]
fn a_camera_whose_node_has_no_size_has_no_placement_and_a_note() {
    let lens = perspective(r#""yfov":1,"znear":0.1"#);
    let nodes = SEEN.replace(r#""name":"a","#, r#""name":"a","scale":[0,0,0],"#);
    let scene = scene("flat_camera", &nodes, &cameras(&[lens.clone(), lens.clone(), lens].join(",")));
    assert!(scene.cameras[0].placement(&scene.pose(None, 0.0)).is_none());
    assert!(scene.notes.iter().any(|note| note.contains("camera 1 ignored")), "{:?}", scene.notes);
}

#[test]
fn animation_channels_without_a_node_are_ignored_with_a_note() {
    let pointer = r#","extensionsUsed":["KHR_animation_pointer"],"animations":[{"channels":[
        {"sampler":0,"target":{"path":"pointer","extensions":{"KHR_animation_pointer":{"pointer":"/extensions/KHR_lights_punctual/lights/0/intensity"}}}},
        {"sampler":0,"target":{"node":1,"path":"rotation"}}],"samplers":[{"input":1,"output":2}]}]"#;
    let members = lights(r#"{"type":"directional"},{"type":"point"},{"type":"point"}"#);
    let scene = with_motion("pointer", LIT, &members, pointer);
    assert_eq!(scene.animations[0].channels.len(), 1);
    let noted = |text: &str| scene.notes.iter().any(|note| note.contains(text));
    assert!(noted("KHR_animation_pointer"), "{:?}", scene.notes);
}
