//! The path of a camera of the scene's file, which its animation may move.

use anyhow::{Context, Result, ensure};
use shadowfit_scene::Scene;
use shadowfit_study::{camera_reaches, file_camera};

use super::{CameraPath, PathFrame};

/// Greatest number of frames of an animated path.
const MAX_FRAMES: f32 = 100_000.0;

/// Returns a path for a camera of the file, by its number from 1. It has a frame for each step of the first
/// animation at `play` frames per second, or one frame if nothing plays. All frames have one lens, near and
/// far plane. The vertical field of view is the camera's, and the horizontal one follows from `aspect` (width
/// divided by height).
///
/// # Errors
///
/// If the file has no such camera, its node has no size, or the animation has too many frames.
pub(crate) fn follow(scene: &Scene, number: u32, play: Option<f32>, aspect: f32) -> Result<CameraPath> {
    let count = scene.cameras.len();
    let index = (number as usize).checked_sub(1).filter(|index| *index < count);
    let index = index.with_context(|| format!("--camera {number}: the file has {count} cameras, counted from 1"))?;
    let duration = scene.animations.first().map_or(0.0, |animation| animation.duration);
    let frames = play.map_or(1.0, |fps| (duration * fps).round().max(1.0));
    ensure!(frames <= MAX_FRAMES, "--play: {frames} frames are more than the {MAX_FRAMES} that a path may have");
    let bounds = scene.bounds(&scene.pose(None, 0.0)).context("the scene has no triangles")?;
    let reach = camera_reaches(scene, &bounds)[index];
    let frames = (0..frames as usize).map(|frame| {
        let pose = scene.pose(play.map(|_| 0), play.map_or(0.0, |fps| frame as f32 / fps));
        let camera = file_camera(&scene.cameras[index], &pose, reach, aspect);
        let camera = camera.context("the node of the camera has no size")?;
        camera.frustum().with_context(|| format!("--camera {number}"))?;
        Ok(PathFrame { camera, group: "camera".to_owned() })
    });
    Ok(CameraPath { frames: frames.collect::<Result<_>>()?, light: None })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use glam::{Quat, Vec3};
    use shadowfit::Lens;
    use shadowfit_scene::{Animation, Channel, ChannelValues, Interpolation, Lens as FileLens, Node, SceneCamera};

    use super::*;

    /// A triangle, and a camera that turns a quarter to the left in 2 s.
    fn scene(lens: FileLens) -> Scene {
        let mut scene = Scene::from_objects("turning", &[vec![[Vec3::ZERO, Vec3::X, Vec3::Z]]]);
        scene.nodes.push(Node::default());
        scene.cameras.push(SceneCamera { name: String::new(), node: 1, lens });
        let values = ChannelValues::Rotation(vec![Quat::IDENTITY, Quat::from_rotation_y(std::f32::consts::FRAC_PI_2)]);
        let channel = Channel { node: 1, times: vec![0.0, 2.0], interpolation: Interpolation::Linear, values };
        scene.animations.push(Animation { name: String::new(), duration: 2.0, channels: vec![channel] });
        scene
    }

    #[test]
    fn a_camera_of_the_file_gives_a_frame_for_each_step_of_its_animation() {
        let scene = scene(FileLens::Perspective { fov_y: 0.003, near: 0.1, far: None });
        let path = follow(&scene, 1, Some(2.0), 1.5).expect("a path");
        let forward: Vec<Vec3> = path.frames.iter().map(|frame| frame.camera.forward).collect();
        assert_eq!((forward.len(), forward[0]), (4, Vec3::NEG_Z));
        assert!((forward[2] - Vec3::new(-1.0, 0.0, -1.0).normalize()).length() < 1e-5, "{forward:?}");
        assert_eq!(path.frames[0].camera.lens, Lens::Perspective { fov_y: 0.003 });
        assert_eq!(follow(&scene, 1, None, 1.5).expect("a path").frames.len(), 1);
    }

    #[test]
    fn the_path_of_a_camera_that_flies_away_can_be_written_and_sees_the_scene_in_each_frame() {
        for lens in [
            FileLens::Perspective { fov_y: 1.0, near: 0.1, far: None },
            FileLens::Orthographic { half_height: 2.0, near: 0.0, far: 1e9 },
        ] {
            let mut scene = scene(lens);
            let values = ChannelValues::Translation(vec![Vec3::ZERO, Vec3::Z * 1e3]);
            let channel = Channel { node: 1, times: vec![0.0, 2.0], interpolation: Interpolation::Linear, values };
            scene.animations[0].channels = vec![channel];
            let path = follow(&scene, 1, Some(8.0), 1.5).expect("a path");
            assert!(path.to_text(Path::new("path.toml")).is_ok_and(|text| text.contains("keys")), "{lens:?}");
            let last = path.frames.last().expect("a frame").camera;
            assert!(f64::from(last.far) > last.eye.z, "{lens:?}: {last:?}");
        }
    }

    #[test]
    fn cameras_that_are_not_there_are_refused_by_number() {
        let scene = scene(FileLens::Orthographic { half_height: 2.0, near: 0.0, far: 9.0 });
        assert!(follow(&scene, 1, None, 1.0).is_ok_and(|path| path.frames[0].camera.near > 0.0));
        for number in [0, 2] {
            let error = follow(&scene, number, None, 1.0).expect_err("no camera").to_string();
            assert!(error.contains("1 cameras"), "{error}");
        }
    }
}
