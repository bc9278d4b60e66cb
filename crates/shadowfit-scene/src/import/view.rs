//! Cameras and the sun of a file.

use std::f32::consts::PI;

use glam::Vec3;
use gltf::json::extensions::scene::khr_lights_punctual::{Light, Type as LightType};
use gltf::json::validation::Checked;
use gltf::json::{Root, camera};

use super::nodes::Tree;
use super::notes::Notes;
use crate::error::{Problem, entry};
use crate::{Lens, Pose, SceneCamera, Sun};

/// Cameras in node order.
pub(crate) fn cameras(root: &Root, tree: &Tree, notes: &mut Notes) -> Result<Vec<SceneCamera>, Problem> {
    let mut cameras = Vec::new();
    for (node, &index) in tree.file_index.iter().enumerate() {
        let Some(camera) = root.nodes[index].camera else { continue };
        let json = entry(&root.cameras, camera.value(), "camera", &format!("nodes[{index}].camera"))?;
        match lens(json) {
            Some(lens) => {
                let name = json.name.clone().filter(|name| !name.is_empty());
                let name = name.unwrap_or_else(|| tree.nodes[node].name.clone());
                cameras.push(SceneCamera { name, node, lens });
            }
            None => notes.add(format!("cameras[{camera}]: skipped: its lens makes no image")),
        }
    }
    Ok(cameras)
}

fn lens(json: &camera::Camera) -> Option<Lens> {
    match json.type_ {
        Checked::Valid(camera::Type::Perspective) => {
            let lens = json.perspective.as_ref()?;
            let (fov_y, near, far) = (lens.yfov, lens.znear, lens.zfar);
            let sound = fov_y > 0.0 && fov_y < PI && near > 0.0 && far.is_none_or(|far| far > near);
            (sound && near.is_finite()).then_some(Lens::Perspective { fov_y, near, far })
        }
        Checked::Valid(camera::Type::Orthographic) => {
            let lens = json.orthographic.as_ref()?;
            let (half_height, near, far) = (lens.ymag.abs(), lens.znear, lens.zfar);
            let sound = half_height > 0.0 && near >= 0.0 && far > near;
            let finite = half_height.is_finite() && far.is_finite();
            (sound && finite).then_some(Lens::Orthographic { half_height, near, far })
        }
        Checked::Invalid => None,
    }
}

/// The first directional light; others are only noted.
pub(crate) fn sun(root: &Root, tree: &Tree, rest: &Pose, notes: &mut Notes) -> Result<Option<Sun>, Problem> {
    let lights = root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
    let lights = lights.map_or(&[][..], |extension| &extension.lights);
    let (mut sun, mut skipped) = (None, 0);
    for (node, &index) in tree.file_index.iter().enumerate() {
        let extensions = root.nodes[index].extensions.as_ref();
        let link = extensions.and_then(|e| e.khr_lights_punctual.as_ref()).filter(|_| !tree.hidden[node]);
        let Some(link) = link else { continue };
        let element = format!("nodes[{index}].extensions.KHR_lights_punctual");
        let light = entry(lights, link.light.value(), "light", &element)?;
        let found = directional(light, rest.world_from(node).transform_vector3(Vec3::NEG_Z));
        if sun.is_none() && found.is_some() {
            sun = found;
        } else {
            skipped += 1;
        }
    }
    if skipped > 0 {
        notes.add(format!("{skipped} lights ignored: the sun is the first directional light"));
    }
    Ok(sun)
}

fn directional(light: &Light, direction: Vec3) -> Option<Sun> {
    if !matches!(light.type_, Checked::Valid(LightType::Directional)) {
        return None;
    }
    let direction = direction.try_normalize()?;
    let color = Vec3::from_array(light.color.map(|c| c.max(0.0)));
    let intensity = light.intensity.max(0.0);
    (color.is_finite() && intensity.is_finite()).then_some(Sun { direction, color, intensity })
}
