//! Cameras and suns of a file.

use std::f32::consts::PI;

use glam::Vec3;
use gltf::json::extensions::scene::khr_lights_punctual::{Light, Type as LightType};
use gltf::json::validation::Checked;
use gltf::json::{Root, camera};

use super::nodes::Tree;
use super::notes::Notes;
use crate::error::{Problem, entry};
use crate::{Lens, Pose, Scene, SceneCamera, SceneSun};

/// Loads the cameras in node order, except cameras whose lens forms no image.
pub(crate) fn cameras(root: &Root, tree: &Tree, notes: &mut Notes) -> Result<Vec<SceneCamera>, Problem> {
    let mut cameras = Vec::new();
    for (node, &index) in tree.file_index.iter().enumerate() {
        let Some(camera) = root.nodes[index].camera else { continue };
        let json = entry(&root.cameras, camera.value(), "camera", &format!("nodes[{index}].camera"))?;
        match lens(json) {
            Ok(lens) => cameras.push(SceneCamera { name: name(json.name.as_ref(), tree, node), node, lens }),
            Err(reason) => notes.add(format!("cameras[{camera}]: skipped: {reason}")),
        }
    }
    Ok(cameras)
}

/// Returns an element's own name, or the name of the node that carries it.
fn name(own: Option<&String>, tree: &Tree, node: usize) -> String {
    own.filter(|name| !name.is_empty()).unwrap_or(&tree.nodes[node].name).clone()
}

/// Reads the lens of a camera, or returns the reason why it forms no image.
fn lens(json: &camera::Camera) -> Result<Lens, String> {
    match json.type_ {
        Checked::Valid(camera::Type::Perspective) => {
            let lens = json.perspective.as_ref().ok_or("it has no perspective")?;
            let (fov_y, near, far) = (lens.yfov, lens.znear, lens.zfar);
            if !(fov_y > 0.0 && fov_y < PI) {
                return Err(format!("its yfov is {fov_y}, not between 0 and pi"));
            }
            check_planes(near, far.unwrap_or(f32::INFINITY), near > 0.0)?;
            Ok(Lens::Perspective { fov_y, near, far })
        }
        Checked::Valid(camera::Type::Orthographic) => {
            let lens = json.orthographic.as_ref().ok_or("it has no orthographic")?;
            let (half_height, near, far) = (lens.ymag.abs(), lens.znear, lens.zfar);
            if !(half_height > 0.0 && half_height.is_finite()) {
                return Err(format!("its ymag is {}", lens.ymag));
            }
            check_planes(near, far, near >= 0.0 && far.is_finite())?;
            Ok(Lens::Orthographic { half_height, near, far })
        }
        Checked::Invalid => Err("its type is neither perspective nor orthographic".to_owned()),
    }
}

/// Checks that the near and far planes bound a volume.
fn check_planes(near: f32, far: f32, in_range: bool) -> Result<(), String> {
    let is_sound = in_range && near.is_finite() && far > near;
    is_sound.then_some(()).ok_or_else(|| format!("its znear is {near} and its zfar {far}"))
}

/// Loads the directional lights in node order. Notes the other lights, which are ignored.
pub(crate) fn suns(root: &Root, tree: &Tree, notes: &mut Notes) -> Result<Vec<SceneSun>, Problem> {
    let lights = root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
    let lights = lights.map_or(&[][..], |extension| &extension.lights);
    let (mut suns, mut others) = (Vec::new(), 0);
    for (node, &index) in tree.file_index.iter().enumerate() {
        let extensions = root.nodes[index].extensions.as_ref();
        let link = extensions.and_then(|e| e.khr_lights_punctual.as_ref()).filter(|_| !tree.hidden[node]);
        let Some(link) = link else { continue };
        let element = format!("nodes[{index}].extensions.KHR_lights_punctual");
        let light = entry(lights, link.light.value(), "light", &element)?;
        if matches!(light.type_, Checked::Valid(LightType::Directional)) {
            suns.push(sun(light, name(light.name.as_ref(), tree, node), node));
        } else {
            others += 1;
        }
    }
    if others > 0 {
        notes.add(format!("{others} point or spot lights ignored: only directional lights cast here"));
    }
    Ok(suns)
}

fn sun(light: &Light, name: String, node: usize) -> SceneSun {
    let color = Vec3::from_array(light.color.map(|channel| channel.max(0.0)));
    SceneSun { name, node, color, intensity: light.intensity.max(0.0) }
}

/// Adds a note about the chosen sun if there are several, and about unusable cameras and suns.
pub(crate) fn note_views(scene: &Scene, rest: &Pose, notes: &mut Notes) {
    for (camera, number) in scene.cameras.iter().zip(1..) {
        if camera.placement(rest).is_none() {
            notes.add(format!("camera {number} ignored: its node has no size"));
        }
    }
    for (sun, number) in scene.suns.iter().zip(1..) {
        if let Some(fault) = sun.fault(rest) {
            notes.add(format!("directional light {number} ignored: {fault}"));
        }
    }
    let count = scene.suns.len();
    if let Some(taken) = scene.strongest_sun_in(rest).filter(|_| count > 1) {
        notes.add(format!("the sun is directional light {} of {count}, the strongest", taken + 1));
    }
}
