//! Triangles of the scenes for comparing fits, from glTF files or from plain files of triangles.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use glam::{DVec3, Vec3};
use shadowfit_scene::load_gltf;

use crate::peers::{Ground, Scene};

/// Allowed difference of boxes, as a share of the scene's size: transforms are composed in f32.
const TOLERANCE: f64 = 1e-6;
/// Bytes of a triangle in a plain file: nine little-endian f32.
const TRIANGLE_BYTES: usize = 36;

/// Corners of a triangle, world space, metres.
pub type Corners = [Vec3; 3];

/// Source of the triangles: one of these two folders, if triangles are needed.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "program", derive(clap::Args))]
#[cfg_attr(feature = "program", group(required = false, multiple = false))]
pub struct Source {
    /// Folder of the scenes' glTF files
    #[cfg_attr(feature = "program", arg(long, value_name = "DIR"))]
    pub assets: Option<PathBuf>,
    /// Folder with SCENE.f32 for each scene: 9 little-endian f32 for each triangle, world space, metres
    #[cfg_attr(feature = "program", arg(long, value_name = "DIR"))]
    pub triangles: Option<PathBuf>,
}

impl Source {
    /// Returns the file with the triangles of a scene.
    ///
    /// # Errors
    ///
    /// If no folder was given, or the scene has no glTF file and no folder of plain files was given.
    pub fn file(&self, scene: &Scene) -> Result<PathBuf> {
        let Scene { name, file, .. } = scene;
        match (&self.triangles, &self.assets, file) {
            (Some(folder), ..) => Ok(folder.join(format!("{name}.f32"))),
            (None, Some(folder), Some(file)) => Ok(folder.join(file)),
            (None, _, None) => bail!(
                "the scenarios name no \"file\" for scene \"{name}\": add it, a glTF file below the folder of --assets, \
                 or give the folder that holds {name}.f32 with --triangles DIR"
            ),
            (None, None, Some(_)) => bail!("give the scenes' files with --assets DIR or --triangles DIR"),
        }
    }

    /// Returns the triangles of a scene, world space, metres: a list for each object in the order of
    /// [`Scene::objects`], or a single list from a plain file, which has no objects.
    ///
    /// # Errors
    ///
    /// As for [`Self::file`], and if the file cannot be read, or its triangles differ from the scenarios.
    pub fn read(&self, scene: &Scene) -> Result<Vec<Vec<Corners>>> {
        let file = self.file(scene)?;
        let at = || format!("{}: scene \"{}\"", file.display(), scene.name);
        if self.triangles.is_some() {
            let objects = vec![read_plain(&file)?];
            check_whole(scene, &objects).with_context(at)?;
            return Ok(objects);
        }
        let objects = read_gltf(&file, scene)?;
        check_whole(scene, &objects).and_then(|()| check_objects(scene, &objects)).with_context(at)?;
        Ok(objects)
    }
}

fn read_gltf(file: &Path, scene: &Scene) -> Result<Vec<Vec<Corners>>> {
    let loaded = load_gltf(file)?;
    // One object for each node with a mesh. Nodes are in depth-first order.
    let mut object_of_node = vec![usize::MAX; loaded.nodes.len()];
    let mut objects = Vec::new();
    for (node, _) in loaded.nodes.iter().enumerate().filter(|(_, node)| node.mesh.is_some()) {
        object_of_node[node] = objects.len();
        objects.push(Vec::new());
    }
    let instances = loaded.instances();
    let scaled = |corner: Vec3| (corner.as_dvec3() * scene.scale).as_vec3();
    for triangle in loaded.pose(None, 0.0).triangles(&loaded) {
        let object = object_of_node[instances[triangle.instance as usize].node];
        objects[object].push(triangle.vertices.map(scaled));
    }
    objects.extend(scene.ground.map(ground));
    Ok(objects)
}

fn ground(ground: Ground) -> Vec<Corners> {
    let half = ground.size * 0.5;
    let corner = |x: f64, z: f64| DVec3::new(x * half, ground.y, z * half).as_vec3();
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    vec![[a, b, c], [a, c, d]]
}

fn read_plain(file: &Path) -> Result<Vec<Corners>> {
    let bytes = std::fs::read(file).with_context(|| format!("{}: cannot be read", file.display()))?;
    let length = bytes.len();
    if !length.is_multiple_of(TRIANGLE_BYTES) {
        bail!("{}: {length} bytes are not whole triangles of {TRIANGLE_BYTES} bytes", file.display());
    }
    let number = |place: usize| f32::from_le_bytes([0, 1, 2, 3].map(|byte| bytes[place * 4 + byte]));
    let corner = |place: usize| Vec3::new(number(place), number(place + 1), number(place + 2));
    Ok((0..length / TRIANGLE_BYTES).map(|triangle| [0, 3, 6].map(|offset| corner(triangle * 9 + offset))).collect())
}

/// Compares all triangles with the scenarios' data of the scene.
fn check_whole(scene: &Scene, objects: &[Vec<Corners>]) -> Result<()> {
    // Import drops triangles without area, which no ray hits.
    let triangles: usize = objects.iter().map(Vec::len).sum();
    ensure!(triangles <= scene.triangles, "{triangles} triangles, but the scenarios say {}", scene.triangles);
    compare(objects.iter().flatten(), &scene.aabb, tolerance(scene)).context("aabb")
}

/// Compares the objects with the scenarios' data of each object.
fn check_objects(scene: &Scene, objects: &[Vec<Corners>]) -> Result<()> {
    let count = objects.len();
    ensure!(count == scene.objects.len(), "{count} objects, but the scenarios say {}", scene.objects.len());
    for (index, (object, wanted)) in objects.iter().zip(&scene.objects).enumerate() {
        compare(object.iter(), wanted, tolerance(scene)).with_context(|| format!("objects[{index}]"))?;
    }
    Ok(())
}

/// Returns the allowed difference of boxes, in metres.
fn tolerance(scene: &Scene) -> f64 {
    let [low, high] = corners_of(&scene.aabb);
    (high - low).length() * TOLERANCE
}

fn compare<'a>(triangles: impl Iterator<Item = &'a Corners>, wanted: &[f64; 6], tolerance: f64) -> Result<()> {
    let start = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let found = triangles.flatten().fold(start, |[low, high], corner| {
        let corner = corner.as_dvec3();
        [low.min(corner), high.max(corner)]
    });
    let wanted = corners_of(wanted);
    let differs = found.iter().zip(&wanted).any(|(found, wanted)| !found.abs_diff_eq(*wanted, tolerance));
    ensure!(!differs, "the box is {found:?}, but the scenarios say {wanted:?}");
    Ok(())
}

fn corners_of(bounds: &[f64; 6]) -> [DVec3; 2] {
    [DVec3::from_slice(&bounds[..3]), DVec3::from_slice(&bounds[3..])]
}
