//! The scenes, camera paths and suns of the figures: data that is part of the program.

use anyhow::{Context, Result, bail};
use glam::Vec3;
use glam::dcamera::rh::view::look_to_mat4;
use serde::Deserialize;
use shadowfit_params::tool::LightSettings;
use shadowfit_report::peers::{Frame, Scenarios, Scene as PeerScene};
use shadowfit_scene::Scene;
use shadowfit_scene::builtin::BuiltinScene;

use crate::path::CameraPath;

/// Scenes with their suns.
const FIGURES: &str = include_str!("../../../figures/figures.toml");
/// Camera path of each scene.
const PATHS: [(&str, &str); 5] = [
    ("courtyard", include_str!("../../../figures/courtyard.toml")),
    ("arcade", include_str!("../../../figures/arcade.toml")),
    ("plain", include_str!("../../../figures/plain.toml")),
    ("forest", include_str!("../../../figures/forest.toml")),
    ("town", include_str!("../../../figures/town.toml")),
];
/// Width of the pictures over their height.
const ASPECT: f32 = 16.0 / 9.0;
/// Frames of each path. A path's last key ends it.
pub(super) const FRAMES: u32 = 20;
/// Sun and frame of a path that the page shows.
const PICTURED: (usize, u32) = (1, FRAMES - 1);

#[derive(Deserialize)]
struct File {
    scene: Vec<FileScene>,
}

#[derive(Deserialize)]
struct FileScene {
    name: String,
    /// Azimuth and elevation of each sun, in degrees.
    suns: Vec<[f32; 2]>,
}

/// A generated scene.
#[derive(Default)]
pub(super) struct FigureScene {
    pub(super) name: String,
    pub(super) scene: Scene,
}

impl FigureScene {
    /// Hands the scene over; its memory is freed with it.
    pub(super) fn take(&mut self) -> Self {
        std::mem::take(self)
    }
}

/// All scenes and frames.
pub(super) struct Figures {
    pub(super) scenes: Vec<FigureScene>,
    /// Frames of all scenes, in order.
    pub(super) scenarios: Scenarios,
    /// Elevation of the pictured sun of each scene, in degrees.
    pictured: Vec<f64>,
}

impl Figures {
    /// Generates the scenes of these names, or all of them.
    pub(super) fn new(names: &[String]) -> Result<Self> {
        let file: File = toml::from_str(FIGURES).context("figures.toml")?;
        if let Some(name) = names.iter().find(|name| file.scene.iter().all(|scene| scene.name != **name)) {
            let known: Vec<&str> = file.scene.iter().map(|scene| scene.name.as_str()).collect();
            bail!("--scene {name}: there is no such scene; take one of {}", known.join(", "));
        }
        let mut figures = Self { scenes: Vec::new(), scenarios: Scenarios::default(), pictured: Vec::new() };
        for scene in file.scene.iter().filter(|scene| names.is_empty() || names.contains(&scene.name)) {
            figures.add(scene).with_context(|| scene.name.clone())?;
        }
        Ok(figures)
    }

    /// Returns whether the page shows pictures of a frame.
    pub(super) fn is_pictured(&self, frame: &Frame) -> bool {
        frame.elevation_deg == self.pictured[frame.scene] && frame.frame == PICTURED.1
    }

    fn add(&mut self, file: &FileScene) -> Result<()> {
        let builtin = BuiltinScene::from_id(&file.name).context("there is no built-in scene of this name")?;
        let (_, text) = PATHS.iter().find(|(name, _)| *name == file.name).context("there is no path for it")?;
        let path = CameraPath::from_toml(text, ASPECT)?;
        let scene = builtin.build();
        let index = self.scenes.len();
        self.scenarios.scenes.push(described(&scene)?);
        for sun in &file.suns {
            let frames = path.frames.iter().take(FRAMES as usize).enumerate();
            self.scenarios.frames.extend(frames.map(|(number, camera)| frame(&file.name, index, number, camera, *sun)));
        }
        self.pictured.push(f64::from(file.suns[PICTURED.0][1]));
        self.scenes.push(FigureScene { name: file.name.clone(), scene });
        Ok(())
    }
}

/// Returns a scene as files of scenarios describe it.
fn described(scene: &Scene) -> Result<PeerScene> {
    let pose = scene.pose(None, 0.0);
    let bounds = |low: Vec3, high: Vec3| {
        let corners = low.as_dvec3().to_array().into_iter().chain(high.as_dvec3().to_array());
        let mut corners = corners;
        std::array::from_fn(|_| corners.next().unwrap_or_default())
    };
    let whole = scene.bounds(&pose).context("it has no triangles")?;
    let triangles = pose.triangles(scene);
    let mut objects = vec![[Vec3::INFINITY, Vec3::NEG_INFINITY]; scene.instances().len()];
    for triangle in &triangles {
        let [low, high] = &mut objects[triangle.instance as usize];
        for vertex in triangle.vertices {
            (*low, *high) = (low.min(vertex), high.max(vertex));
        }
    }
    objects.retain(|[low, high]| low.cmple(*high).all());
    Ok(PeerScene {
        name: scene.name.clone(),
        file: None,
        scale: 1.0,
        ground: None,
        triangles: triangles.len(),
        objects: objects.into_iter().map(|[low, high]| bounds(low, high)).collect(),
        aabb: bounds(whole.min, whole.max),
    })
}

fn frame(name: &str, scene: usize, number: usize, camera: &crate::path::PathFrame, sun: [f32; 2]) -> Frame {
    let [azimuth, elevation] = sun.map(f32::to_radians);
    let light = LightSettings { azimuth, elevation, ..LightSettings::default() };
    let camera = camera.camera;
    let view = look_to_mat4(camera.eye, camera.forward.as_dvec3(), camera.up.as_dvec3());
    let fov_y = 2.0 * camera.half_size().y.atan();
    Frame {
        id: format!("{name}/{}/{number}", sun[1]),
        scene,
        elevation_deg: f64::from(sun[1]),
        frame: number as u32,
        view: view.to_cols_array(),
        fov_y_deg: fov_y.to_degrees(),
        aspect: f64::from(ASPECT),
        near: f64::from(camera.near),
        far: f64::from(camera.far),
        light_dir: light.direction().as_dvec3().normalize().to_array(),
    }
}

#[cfg(test)]
mod tests {
    use shadowfit_truth::Tracer;

    use super::*;

    /// Least distance of an eye from every surface, in metres: nothing lies before the near plane.
    const CLEAR: f32 = 0.3;

    #[test]
    fn every_path_has_its_frames_and_an_eye_in_the_open() {
        let figures = Figures::new(&[]).expect("the data is sound");
        assert_eq!(figures.scenes.len(), BuiltinScene::ALL.len());
        for (index, FigureScene { name, scene }) in figures.scenes.iter().enumerate() {
            let frames: Vec<&Frame> = figures.scenarios.frames.iter().filter(|frame| frame.scene == index).collect();
            assert_eq!(frames.len(), 3 * FRAMES as usize, "{name}");
            let triangles = scene.pose(None, 0.0).triangles(scene);
            let tracer = Tracer::new(triangles.iter().map(|triangle| triangle.vertices));
            for frame in frames {
                let eye = frame.camera().eye.as_vec3();
                let nearest = triangles.iter().flat_map(|triangle| triangle.vertices).map(|v| v.distance(eye));
                let nearest = nearest.fold(f32::INFINITY, f32::min);
                assert!(nearest > CLEAR, "{}: {nearest} m", frame.id);
                // Some ground is in view below the middle.
                let down = frame.camera().forward.normalize() - 0.3 * Vec3::Y;
                assert!(tracer.first_hit(eye, down).is_some(), "{}", frame.id);
            }
        }
        assert_eq!(figures.scenarios.frames.iter().filter(|frame| figures.is_pictured(frame)).count(), 5);
    }

    #[test]
    fn an_unknown_scene_is_refused() {
        let error = Figures::new(&["village".to_owned()]).err().expect("refused");
        assert!(error.to_string().contains("village"), "{error}");
    }
}
