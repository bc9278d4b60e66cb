//! Animations of all scenes: each moves something, and ends where it begins.

use glam::{Mat4, Quat};

use super::all;
use crate::builtin::BuiltinScene;
use crate::{ChannelValues, Pose, Scene};

/// Returns the farthest distance that a vertex moves from one pose to another, in metres.
fn farthest(scene: &Scene, a: &Pose, b: &Pose) -> f32 {
    let distance = |instance: &crate::Instance| {
        let [a, b]: [Mat4; 2] = [a, b].map(|pose| pose.world_from_node[instance.node]);
        let positions = &scene.meshes[instance.mesh].primitives[instance.primitive].positions;
        if a == b {
            return 0.0;
        }
        positions.iter().map(|&p| a.transform_point3(p).distance(b.transform_point3(p))).fold(0.0, f32::max)
    };
    scene.instances().iter().map(distance).fold(0.0, f32::max)
}

/// Returns whether two rotations agree. A quaternion and its negative are one rotation.
fn same_turn(a: Quat, b: Quat) -> bool {
    a.dot(b).abs() > 1.0 - 1e-5
}

#[test]
fn animations_have_the_names_that_are_promised() {
    for (builtin, scene) in all() {
        let names: Vec<&str> = scene.animations.iter().map(|animation| animation.name.as_str()).collect();
        let promised: &[&str] = match builtin {
            BuiltinScene::Courtyard => &["walk", "turn"],
            BuiltinScene::Plain => &["turn"],
            BuiltinScene::Arcade => &["swing"],
            BuiltinScene::Forest => &["wind"],
            BuiltinScene::Town => &["sway"],
        };
        assert_eq!(names, promised, "{builtin:?}");
    }
}

#[test]
fn animations_end_where_they_begin() {
    for (builtin, scene) in all() {
        let animations = scene.animations.iter();
        for (animation, channel) in animations.flat_map(|each| each.channels.iter().map(move |channel| (each, channel)))
        {
            let last = channel.times[channel.times.len() - 1];
            assert!((last - animation.duration).abs() < 1e-4, "{builtin:?}: {} after {last} s", animation.name);
            assert_eq!(channel.times.first(), Some(&0.0));
            assert!(channel.times.windows(2).all(|pair| pair[0] < pair[1]));
            match &channel.values {
                ChannelValues::Translation(values) => assert!(values[0].distance(values[values.len() - 1]) < 1e-4),
                ChannelValues::Rotation(values) => assert!(same_turn(values[0], values[values.len() - 1])),
                _ => panic!("{builtin:?}: a channel is neither a translation nor a rotation"),
            }
        }
    }
}

#[test]
fn animations_move_something_without_a_jump() {
    for (builtin, scene) in all() {
        for (index, animation) in scene.animations.iter().enumerate() {
            let pose = |seconds: f32| scene.pose(Some(index), seconds);
            let moved = (1..6).map(|step| farthest(&scene, &pose(0.0), &pose(0.17 * step as f32 * animation.duration)));
            assert!(moved.fold(0.0, f32::max) > 0.1, "{builtin:?}: {}", animation.name);
            // Steps of 0.01 s across the end of the loop and elsewhere. The limit is 5 m/s, the speed of a
            // sail's tip.
            for seconds in [animation.duration - 0.005, 0.0, 0.31 * animation.duration] {
                let step = farthest(&scene, &pose(seconds), &pose(seconds + 0.01));
                assert!(step < 0.05, "{builtin:?}: {} moves {step} m at {seconds} s", animation.name);
            }
        }
    }
}
