//! Scenes, cameras and lights for comparing fits: the file `scenarios.json`.
//!
//! World space is right-handed, y up, in metres. Matrices are 16 numbers, column-major, for column vectors.

use std::path::Path;

use glam::{DMat4, DVec3};
use serde::{Deserialize, Serialize};
use shadowfit::PerspectiveCamera;

use super::error::{PeersError, Problem, check_finite, read_json};
use super::whole;

/// The content of `scenarios.json`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Scenarios {
    /// Scenes.
    pub scenes: Vec<Scene>,
    /// Frames. The frames of a path (same scene and light) are consecutive and in order.
    pub frames: Vec<Frame>,
}

/// A scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// Name. It is the first part of the ids of its frames.
    pub name: String,
    /// glTF file, relative to the folder of assets. `None` for a scene that is only known as a list of
    /// triangles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Metres per unit of the glTF file. World coordinates, after the nodes' transforms, are multiplied by
    /// it.
    pub scale: f64,
    /// Ground, added as the last object after the objects of the glTF file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ground: Option<Ground>,
    /// Number of triangles, including the ground.
    #[serde(deserialize_with = "whole::number")]
    pub triangles: usize,
    /// World-space boxes of the objects: min x, y, z, max x, y, z, in metres. One box for each node with a
    /// mesh, depth first, then the ground.
    pub objects: Vec<[f64; 6]>,
    /// World-space box of all objects, in the same form.
    pub aabb: [f64; 6],
}

/// A horizontal square centred on x = z = 0: two triangles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ground {
    /// Length of a side, in metres.
    pub size: f64,
    /// Height, in metres.
    pub y: f64,
}

/// A camera and a light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// `scene/elevation/frame`, for example `town/45/7`.
    pub id: String,
    /// Index into [`Scenarios::scenes`].
    #[serde(deserialize_with = "whole::number")]
    pub scene: usize,
    /// Elevation of the light over the horizon, in degrees.
    pub elevation_deg: f64,
    /// Number along the path.
    #[serde(deserialize_with = "whole::number")]
    pub frame: u32,
    /// View-from-world matrix. The camera looks down -z.
    pub view: [f64; 16],
    /// Vertical field of view, in degrees.
    pub fov_y_deg: f64,
    /// Width of the picture over its height.
    pub aspect: f64,
    /// Near distance along the view, in metres.
    pub near: f64,
    /// Far distance along the view, in metres.
    pub far: f64,
    /// Unit direction of travel of the light, world axes.
    pub light_dir: [f64; 3],
}

impl Scenarios {
    /// Reads and checks a file.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, does not have this format, or contains an impossible value.
    pub fn read(file: &Path) -> Result<Self, PeersError> {
        let scenarios: Self = read_json(file)?;
        scenarios.check().map_err(|problem| problem.at(file))?;
        Ok(scenarios)
    }

    /// Returns the name of a frame's group, which is its scene under its light: `town/45`.
    ///
    /// # Panics
    ///
    /// If the index of the frame's scene is out of range.
    pub fn group(&self, frame: &Frame) -> String {
        format!("{}/{}", self.scenes[frame.scene].name, frame.elevation_deg)
    }

    /// Returns the index of the previous frame of the same path, or `None` for the first frame of a path.
    pub fn previous(&self, index: usize) -> Option<usize> {
        let (now, before) = (&self.frames[index], index.checked_sub(1)?);
        let then = &self.frames[before];
        let follows = then.scene == now.scene && then.elevation_deg == now.elevation_deg && then.frame + 1 == now.frame;
        follows.then_some(before)
    }

    fn check(&self) -> Result<(), Problem> {
        for (index, scene) in self.scenes.iter().enumerate() {
            if self.scenes[..index].iter().any(|other| other.name == scene.name) {
                let reason = format!("\"{}\" is the name of two scenes", scene.name);
                return Err(Problem::new(format!("scenes[{index}].name"), reason));
            }
            if !(scene.scale.is_finite() && scene.scale > 0.0) {
                return Err(Problem::new(format!("scenes[{index}].scale"), format!("{} is not above 0", scene.scale)));
            }
        }
        let mut ids = std::collections::HashSet::new();
        for (index, frame) in self.frames.iter().enumerate() {
            let element = |field: &str| format!("frames[{index}].{field}");
            if frame.scene >= self.scenes.len() {
                let reason = format!("there is no scene {}, the file has {}", frame.scene, self.scenes.len());
                return Err(Problem::new(element("scene"), reason));
            }
            if !ids.insert(&frame.id) {
                return Err(Problem::new(element("id"), format!("\"{}\" is the id of two frames", frame.id)));
            }
            frame.check(&element)?;
        }
        Ok(())
    }
}

impl Frame {
    /// Returns the view-from-world matrix.
    pub fn view_from_world(&self) -> DMat4 {
        DMat4::from_cols_array(&self.view)
    }

    /// Returns the unit direction toward the light, world axes.
    pub fn to_light(&self) -> DVec3 {
        -DVec3::from_array(self.light_dir)
    }

    /// Returns the tangent of half of the vertical field of view.
    pub fn tan_half_fov(&self) -> f64 {
        (self.fov_y_deg.to_radians() * 0.5).tan()
    }

    /// Returns the camera. Its eye is in f64, and all other values are rounded to f32.
    pub fn camera(&self) -> PerspectiveCamera {
        let world_from_view = self.view_from_world().inverse();
        PerspectiveCamera {
            eye: world_from_view.col(3).truncate(),
            forward: -world_from_view.col(2).truncate().as_vec3(),
            up: world_from_view.col(1).truncate().as_vec3(),
            fov_y: self.fov_y_deg.to_radians() as f32,
            aspect: self.aspect as f32,
            near: self.near as f32,
            far: self.far as f32,
        }
    }

    /// Returns the view depth of a world position, in metres, or `None` outside the view. Near and far planes
    /// are inside.
    pub fn view_depth(&self, point: DVec3) -> Option<f64> {
        let p = self.view_from_world().transform_point3(point);
        let (depth, tan) = (-p.z, self.tan_half_fov());
        let is_inside = depth >= self.near
            && depth <= self.far
            && p.x.abs() <= depth * tan * self.aspect
            && p.y.abs() <= depth * tan;
        is_inside.then_some(depth)
    }

    fn check(&self, element: &impl Fn(&str) -> String) -> Result<(), Problem> {
        let bad = |field: &str, reason: String| Err(Problem::new(element(field), reason));
        check_finite(|| element("view"), &self.view)?;
        if !self.view_from_world().inverse().is_finite() {
            return bad("view", "the matrix has no inverse".to_owned());
        }
        if !(self.fov_y_deg > 0.0 && self.fov_y_deg < 180.0) {
            return bad("fov_y_deg", format!("{} is not between 0 and 180", self.fov_y_deg));
        }
        if !(self.aspect.is_finite() && self.aspect > 0.0) {
            return bad("aspect", format!("{} is not above 0", self.aspect));
        }
        if !(self.near >= 0.0 && self.near < self.far && self.far.is_finite()) {
            return bad("far", format!("the range from near {} to far {} is empty", self.near, self.far));
        }
        let length = self.to_light().length();
        if (length - 1.0).abs() > 1e-6 || length.is_nan() {
            return bad("light_dir", format!("its length is {length}, not 1"));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::peers::closed_form::scenarios;
    use crate::peers::error::parse_json;

    #[test]
    fn the_frame_before_is_that_of_the_same_path() {
        let mut scenarios = scenarios(3);
        assert_eq!([0, 1, 2].map(|index| scenarios.previous(index)), [None, Some(0), Some(1)]);
        scenarios.frames[1].elevation_deg = 45.0;
        assert_eq!([0, 1, 2].map(|index| scenarios.previous(index)), [None, None, None]);
        assert_eq!(scenarios.group(&scenarios.frames[1]), "room/45");
    }

    /// A change that breaks the scenarios, and the expected message.
    type Case = (fn(&mut Scenarios), &'static str);

    #[test]
    fn impossible_frames_are_refused_by_element() {
        let refused = |change: fn(&mut Scenarios)| {
            let mut scenarios = scenarios(2);
            change(&mut scenarios);
            scenarios.check().expect_err("refused").at(Path::new("scenarios.json")).to_string()
        };
        assert_eq!(scenarios(2).check(), Ok(()));
        let cases: [Case; 9] = [
            (|s| s.frames[1].view[7] = f64::NAN, "frames[1].view: NaN is not finite"),
            (|s| s.frames[1].view = [0.0; 16], "frames[1].view: the matrix has no inverse"),
            (|s| s.frames[1].fov_y_deg = 180.0, "frames[1].fov_y_deg: 180 is not between 0 and 180"),
            (|s| s.frames[1].aspect = -1.0, "frames[1].aspect: -1 is not above 0"),
            (|s| s.frames[1].far = f64::NAN, "frames[1].far: the range from near 0.1 to far NaN is empty"),
            (|s| s.frames[1].light_dir = [0.0; 3], "frames[1].light_dir: its length is 0, not 1"),
            (|s| s.frames[1].scene = 4, "frames[1].scene: there is no scene 4, the file has 1"),
            (|s| s.frames[1].id = s.frames[0].id.clone(), "frames[1].id: \"room/90/0\" is the id of two frames"),
            (|s| s.scenes[0].scale = 0.0, "scenes[0].scale: 0 is not above 0"),
        ];
        for (change, message) in cases {
            assert_eq!(refused(change), format!("scenarios.json: {message}"));
        }
    }
    /// Returns the scenarios read from changed JSON.
    fn json(change: fn(&mut serde_json::Value)) -> Result<Scenarios, String> {
        let mut value = serde_json::to_value(scenarios(2)).expect("JSON");
        change(&mut value);
        parse_json::<Scenarios>(value.to_string().as_bytes())
            .map_err(|problem| problem.at(Path::new("scenarios.json")).to_string())
    }

    #[test]
    fn whole_numbers_are_read_with_and_without_a_point() {
        let found = json(|value| {
            value["scenes"][0]["triangles"] = 2.0.into();
            value["frames"][1]["scene"] = 0.0.into();
            value["frames"][1]["frame"] = 1.0.into();
        });
        assert_eq!(found, Ok(scenarios(2)));
    }

    /// A change that breaks the scenarios' JSON, and the expected message.
    type JsonCase = (fn(&mut serde_json::Value), &'static str);

    #[test]
    fn numbers_that_are_not_whole_or_negative_are_refused_by_element_and_reason() {
        let cases: [JsonCase; 4] = [
            (|v| v["scenes"][0]["triangles"] = 2048.5.into(), "scenes[0].triangles: 2048.5 is not a whole number"),
            (|v| v["frames"][1]["scene"] = (-1.0).into(), "frames[1].scene: -1.0 is negative"),
            (|v| v["frames"][1]["frame"] = 0.5.into(), "frames[1].frame: 0.5 is not a whole number"),
            (|v| v["frames"][1]["frame"] = (-1).into(), "frames[1].frame: -1 is negative"),
        ];
        for (change, reason) in cases {
            let message = json(change).expect_err("refused");
            assert!(message.starts_with(&format!("scenarios.json: {reason}")), "{message}");
        }
    }

    #[test]
    fn a_scene_needs_no_file() {
        let found = json(|value| _ = value["scenes"][0].as_object_mut().expect("a scene").remove("file"));
        assert_eq!(found.expect("scenarios").scenes[0].file, None);
        assert_eq!(json(|_| ()).expect("scenarios").scenes[0].file.as_deref(), Some("room.glb"));
    }
}
