//! The subject of a report: a scene, a path through it, and a light.

use std::path::PathBuf;

use anyhow::{Context, Result, bail, ensure};
use glam::Vec3;
use shadowfit::Aabb;
use shadowfit_params::tool::LightSettings;
use shadowfit_scene::builtin::BuiltinScene;
use shadowfit_scene::{BlendedCasters, Scene, load_gltf};
use shadowfit_study::{Comparison, Judging, View, tell};
use shadowfit_truth::Tracer;

use crate::drawing::{Drawing, positive};
use crate::path::{CameraPath, find, follow};

/// Bytes of a GiB.
const GIB: f64 = (1u64 << 30) as f64;
/// Ratio of ray offset to scene size above which the offset counts as coarse.
const COARSE_OFFSET: f64 = 5e-4;
/// Relative rounding error of an offset that is computed from the scene's size.
const ROUNDING: f64 = 1e-6;
/// Bytes per vertex: 48 in the scene, and 64 on the GPU if the adapter is the CPU.
const BYTES_A_VERTEX: u64 = 112;
/// Bytes per triangle: its indices, here and twice on the GPU, and the data that the software adapter keeps
/// for a pass.
const BYTES_A_TRIANGLE: u64 = 140;
/// Least number of triangles whose memory is printed.
const MANY_TRIANGLES: usize = 1_000_000;

#[derive(Clone, Debug, clap::Args)]
pub(crate) struct Job {
    /// glTF file, or the name of a built-in scene: courtyard, plain, arcade, forest or town
    scene: PathBuf,
    /// Camera path, TOML or JSON [default: an orbit and a flight that are found in the scene]
    #[arg(long, value_name = "FILE")]
    path: Option<PathBuf>,
    /// Follow a camera of the file instead of a path, by its number from 1; with --play through its animation
    #[arg(long, value_name = "N", conflicts_with = "path")]
    camera: Option<u32>,
    /// Direction toward the sun: azimuth from +z toward +x and elevation, in degrees [default: the path's,
    /// else the scene's, which its animation may move]
    #[arg(long, value_name = "AZIMUTH,ELEVATION", value_parser = light, allow_hyphen_values = true)]
    light: Option<LightSettings>,
    /// Use a directional light of the file as the sun, by its number from 1 [default: the strongest]
    #[arg(long, value_name = "N", conflicts_with = "light")]
    sun: Option<u32>,
    /// Play the scene's first animation at this number of path frames per second
    #[arg(long, value_name = "FPS")]
    play: Option<f32>,
    /// Exclude blended surfaces from the casters, instead of casting where their alpha is at least 0.5
    #[arg(long)]
    no_blended_casters: bool,
    /// Refuse scenes that need more memory than this, in GiB
    #[arg(long, default_value_t = 16.0, value_name = "GIB", value_parser = positive)]
    max_memory: f64,
    #[command(flatten)]
    pub(crate) drawing: Drawing,
}

/// A frame of the path.
#[derive(Clone, Debug)]
pub(crate) struct JobFrame {
    /// Name, such as `orbit/3`.
    pub(crate) name: String,
    /// Group, such as `orbit`.
    pub(crate) group: String,
    pub(crate) view: View,
    /// Time of the animation, in seconds, if it plays.
    pub(crate) seconds: Option<f32>,
}

/// The sun of a scene.
#[derive(Clone, Copy, Debug)]
enum Sunlight {
    /// Index of a directional light of the file, which animations may move.
    OfFile(usize),
    /// Fixed direction of travel.
    Still(Vec3),
}

/// A job, ready to run.
pub(crate) struct Prepared {
    pub(crate) comparison: Comparison,
    pub(crate) judging: Judging,
    /// Path in the coordinates of the scene's file, for writing.
    pub(crate) path: CameraPath,
    pub(crate) light: LightSettings,
    pub(crate) frames: Vec<JobFrame>,
    /// Remarks on the measurement, in whole sentences.
    pub(crate) notes: Vec<String>,
    /// Parts of the scene that import skipped, replaced or repaired.
    pub(crate) scene_notes: Vec<String>,
}

impl Job {
    /// Loads the scene, opens the GPU, and finds the frames. Prints the notes of the import to standard
    /// error.
    pub(crate) fn prepare(&self) -> Result<Prepared> {
        let scene = self.load()?;
        scene.warnings(&self.scene).for_each(tell);
        self.check_memory(&scene)?;
        let sun = self.sun_of(&scene)?;
        self.check_play(&scene)?;
        let mut notes = Vec::new();
        let scene_notes = scene.notes.clone();
        let mut comparison = Comparison::new(self.drawing.gpu()?, scene, self.drawing.judging())?;
        if !self.drawing.sets_units() {
            comparison.judging.ray_offset = comparison.scene().ray_offset();
        }
        let judging = comparison.judging;
        let aspect = judging.size[0] as f32 / judging.size[1] as f32;
        // Path files use the coordinates of the scene's file.
        let file_origin = comparison.scene().scene().origin;
        let path = self.path(&comparison, aspect, &mut notes)?;
        let fixed = if self.sun.is_some() { None } else { self.light.or(path.light) };
        let sun = sun.filter(|_| fixed.is_none());
        let scene = comparison.scene().scene();
        let frames = self.frames(&path, |seconds| match sun {
            Some(Sunlight::OfFile(index)) => {
                let pose = scene.pose(seconds.map(|_| 0), seconds.unwrap_or(0.0));
                scene.suns[index].direction(&pose).and_then(LightSettings::from_direction)
            }
            Some(Sunlight::Still(direction)) => LightSettings::from_direction(direction),
            None => fixed,
        });
        let first = frames.first().and_then(|frame| LightSettings::from_direction(frame.view.direction));
        let light = fixed.or(first).unwrap_or_default();
        notes.extend(ray_offset_note(comparison.scene().bounds().size(), judging.ray_offset));
        let path = path.moved(file_origin);
        Ok(Prepared { comparison, judging, path, light, frames, notes, scene_notes })
    }

    fn check_play(&self, scene: &Scene) -> Result<()> {
        let animates = !scene.animations.is_empty();
        let name = self.scene.display();
        ensure!(self.play.is_none() || animates, "--play: {name} has no animation; leave the option out");
        let is_rate = self.play.is_none_or(|fps| fps.is_finite() && fps > 0.0);
        ensure!(is_rate, "--play: give a number of frames per second above 0");
        Ok(())
    }

    /// Returns the path in the coordinates of the loaded scene. Adds the notes of the path search.
    fn path(&self, comparison: &Comparison, aspect: f32, notes: &mut Vec<String>) -> Result<CameraPath> {
        let scene = comparison.scene();
        if let Some(file) = &self.path {
            return Ok(CameraPath::read(file, aspect)?.moved(-scene.scene().origin));
        }
        if let Some(camera) = self.camera {
            return follow(scene.scene(), camera, self.play, aspect);
        }
        let (bounds, rays) = (scene.bounds(), scene.rays());
        let origin = rays.origin;
        let relative = |corner: Vec3| (corner.as_dvec3() - origin).as_vec3();
        let bounds = Aabb::new(relative(bounds.min), relative(bounds.max));
        let found = find(&rays.tracer, bounds, aspect).with_context(|| self.title())?;
        notes.extend(found.notes);
        Ok(found.path.moved(origin))
    }

    /// Returns the chosen or strongest directional light of the file, or the sun of a built-in scene.
    fn sun_of(&self, scene: &Scene) -> Result<Option<Sunlight>> {
        let still = || scene.sun.map(|sun| Sunlight::Still(sun.direction));
        let Some(number) = self.sun else { return Ok(scene.strongest_sun().map(Sunlight::OfFile).or_else(still)) };
        let count = scene.suns.len();
        let index = (number as usize).checked_sub(1).filter(|index| *index < count);
        let index = index
            .with_context(|| format!("--sun {number}: the file has {count} directional lights, counted from 1"))?;
        Ok(Some(Sunlight::OfFile(index)))
    }

    /// Returns the scene's name for reports.
    pub(crate) fn title(&self) -> String {
        self.scene.file_stem().unwrap_or_default().to_string_lossy().into_owned()
    }

    fn load(&self) -> Result<Scene> {
        if let Some(scene) = self.scene.to_str().and_then(BuiltinScene::from_id).filter(|_| !self.scene.exists()) {
            return Ok(scene.build());
        }
        let mut scene = load_gltf(&self.scene)?;
        if self.no_blended_casters {
            scene.blended_casters = BlendedCasters::Never;
        }
        Ok(scene)
    }

    /// Prints the memory that a large scene will need before it is allocated. Fails if it exceeds the limit.
    fn check_memory(&self, scene: &Scene) -> Result<()> {
        let primitive =
            |instance: &shadowfit_scene::Instance| &scene.meshes[instance.mesh].primitives[instance.primitive];
        let triangles: usize = scene.instances().iter().map(|instance| primitive(instance).indices.len() / 3).sum();
        let vertices: usize = scene.meshes.iter().flat_map(|mesh| &mesh.primitives).map(|p| p.positions.len()).sum();
        let memory = Tracer::memory(triangles);
        let others = vertices as u64 * BYTES_A_VERTEX + triangles as u64 * BYTES_A_TRIANGLE;
        let [rays, all] = [memory.building, memory.building + others].map(|bytes| bytes as f64 / GIB);
        if triangles >= MANY_TRIANGLES {
            tell(format_args!("{triangles} triangles: about {all:.1} GiB of memory, {rays:.1} GiB of it for rays"));
        }
        if all > self.max_memory {
            bail!(
                "{}: its {triangles} triangles need about {all:.1} GiB of memory, more than --max-memory {}",
                self.scene.display(),
                self.max_memory
            );
        }
        Ok(())
    }

    /// Returns the frames of a path. `light` returns the light at a time of the animation, in seconds; if it
    /// returns `None`, the frame gets the default light.
    fn frames(&self, path: &CameraPath, light: impl Fn(Option<f32>) -> Option<LightSettings>) -> Vec<JobFrame> {
        let seconds = |index: usize| self.play.map(|fps| index as f32 / fps);
        let names = path.names();
        let frames = path.frames.iter().zip(names).enumerate().map(|(index, (frame, name))| JobFrame {
            name,
            group: frame.group.clone(),
            view: View {
                camera: frame.camera,
                direction: light(seconds(index)).unwrap_or_default().direction(),
                is_first: index == 0 || path.frames[index - 1].group != frame.group,
            },
            seconds: seconds(index),
        });
        frames.collect()
    }
}

/// Returns a note if shadow rays do not start 1 mm above the surfaces, or if they start so far above them
/// that they miss occluders close to the surface.
fn ray_offset_note(size: Vec3, offset: f64) -> Option<String> {
    let size = f64::from(size.length());
    let (millimetres, usual) = (offset * 1e3, Judging::default().ray_offset);
    if offset > size * COARSE_OFFSET * (1.0 + ROUNDING) {
        return Some(format!(
            "Shadow rays start {millimetres} mm above the surfaces, which is a lot for a scene {size:.2} m across: if \
             surfaces are closer together, truth counts them as lit and the map as shadowed (false shadow). Without \
             --units-per-metre the distance is computed from the scene's size."
        ));
    }
    (offset != usual).then(|| {
        format!(
            "Shadow rays start {millimetres:.4} mm above the surfaces of this scene, which is {size:.3} m across. \
             --units-per-metre N starts them N mm above the surfaces."
        )
    })
}

fn light(text: &str) -> Result<LightSettings> {
    let (azimuth, elevation) =
        text.split_once(',').with_context(|| format!("\"{text}\" is not AZIMUTH,ELEVATION, such as 37,45"))?;
    let degrees = |text: &str| -> Result<f32> {
        let degrees: f32 = text.trim().parse().with_context(|| format!("\"{text}\" is not a number of degrees"))?;
        ensure!(degrees.is_finite(), "{degrees} is not finite");
        Ok(degrees.to_radians())
    };
    let (azimuth, elevation) = (degrees(azimuth)?, degrees(elevation)?);
    ensure!(elevation > 0.0, "the sun's elevation is not above 0");
    Ok(LightSettings { azimuth, elevation, ..LightSettings::default() })
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use clap::Parser;
    use shadowfit_testing::adapter_name;

    use super::*;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        job: Job,
    }

    /// A triangle and a camera before it, 1000 km from the file's origin.
    const FAR_AWAY: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
        "nodes":[{"mesh":0,"translation":[1e6,0,0]},{"camera":0,"translation":[1000000.5,0.5,3]}],
        "cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.01}}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIA/"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,0,1]}]}"#;

    #[test]
    fn gpu_a_written_path_gives_the_same_views_of_a_scene_that_is_far_from_its_origin() {
        let folder = std::env::temp_dir().join(format!("shadowfit-job-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder");
        let [scene, path] = ["far.gltf", "path.toml"].map(|name| folder.join(name));
        fs::write(&scene, FAR_AWAY).expect("written");
        let prepare = |option: &str, value: &str| {
            let scene = scene.to_str().expect("text");
            let line =
                Line::parse_from(["report", scene, "--adapter", adapter_name(), "--size", "96x54", option, value]);
            line.job.prepare().expect("a job")
        };
        let first = prepare("--camera", "1");
        assert!(first.comparison.scene().scene().origin.x > 9e5);
        assert!((first.path.frames[0].camera.eye.x - 1_000_000.5).abs() < 1e-3, "{:?}", first.path);
        fs::write(&path, first.path.to_text(Path::new("path.toml")).expect("text")).expect("written");
        let second = prepare("--path", path.to_str().expect("text"));
        fs::remove_dir_all(&folder).expect("removed");
        let eyes = [&first, &second].map(|job| job.frames[0].view.camera.eye);
        assert!(eyes[0].distance(eyes[1]) < 1e-6, "{eyes:?}");
    }
}
