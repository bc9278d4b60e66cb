//! Import of glTF 2.0 scenes from files that may be broken or malicious.
//!
//! The gltf crate parses the JSON. This module checks everything else (GLB chunks, URIs, accessors, all
//! indices) before use, because the crate's own readers may panic on bad data. A file either loads completely
//! or is refused with a [`SceneError`]. [`Scene::notes`] lists repairs.

mod accessor;
mod animation;
mod container;
#[cfg(not(target_family = "wasm"))]
mod decode;
mod drawn;
mod extensions;
mod image;
mod influence;
mod instancing;
mod material;
mod mesh;
mod nodes;
mod notes;
mod origin;
mod repair;
mod size;
mod skin;
mod surface;
mod topology;
mod transforms;
mod uri;
mod view;

use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use gltf::json::Root;

use self::accessor::Reader;
use self::animation::Animations;
use self::container::Source;
#[cfg(not(target_family = "wasm"))]
pub use self::decode::decode_image;
use self::drawn::Drawn;
use self::image::Images;
pub use self::image::{DecodeImage, DecodedImage};
use self::material::Materials;
use self::mesh::Geometries;
use self::nodes::Tree;
use self::notes::Notes;
pub use self::size::SceneSize;
use self::uri::Folder;
#[cfg(not(target_family = "wasm"))]
use self::uri::{MAX_FILE_BYTES, file_size, read_file};
use crate::error::{Problem, entry};
use crate::{Mesh, Node, Scene, SceneError, Skin};

/// Loads the default scene of a `.gltf` or `.glb` file, or its first scene if there is no default.
///
/// # Errors
/// If the file cannot be read, is not valid glTF 2.0, requires an extension that is not supported, or draws nothing;
/// see [`SceneError`].
#[cfg(not(target_family = "wasm"))]
pub fn load_gltf(path: &Path) -> Result<Scene, SceneError> {
    load_gltf_scene(path, None)
}

/// Loads scene number `scene` of a file, counted from 0. `None` loads the default scene.
///
/// # Errors
/// As [`load_gltf`]. Also fails if the file does not have the scene.
#[cfg(not(target_family = "wasm"))]
pub fn load_gltf_scene(path: &Path, scene: Option<usize>) -> Result<Scene, SceneError> {
    load_gltf_with_progress(path, scene, &|_, _| ())
}

/// A step of loading a file, in the order of execution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LoadStep {
    /// The file is read.
    Read,
    /// Its JSON is parsed.
    Parse,
    /// Meshes, images and animations are decoded.
    Decode,
}

/// Loads a scene like [`load_gltf_scene`]. Calls `progress` before each step, with the scene's size as known
/// so far.
///
/// # Errors
/// As [`load_gltf_scene`].
#[cfg(not(target_family = "wasm"))]
pub fn load_gltf_with_progress(
    path: &Path,
    scene: Option<usize>,
    progress: &dyn Fn(LoadStep, &SceneSize),
) -> Result<Scene, SceneError> {
    let size = SceneSize::of_file(file_size(path));
    progress(LoadStep::Read, &size);
    let bytes = read_file(path, MAX_FILE_BYTES).map_err(|reason| SceneError::Unreadable {
        path: path.to_owned(),
        reason,
        hint: "Check the path and its permissions",
    })?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let source = File { bytes: &bytes, folder: Folder::Disk(folder), decode: &decode_image };
    load(path, &source, scene, size, progress)
}

/// Loads scene number `scene` of the file `name` without a file system, such as in a browser. `None` loads
/// the default scene. `files` holds the contents of that file and the files that it refers to, by their paths
/// relative to it. Files that were chosen one by one have no folders, so a file with only the right name is
/// accepted, too. `decode` decodes the images: `decode_image` of this crate, or in a browser a function that
/// returns the decoded results of [`gltf_images`].
///
/// # Errors
/// As [`load_gltf_scene`].
pub fn load_gltf_from_memory(
    name: &str,
    files: &BTreeMap<String, Vec<u8>>,
    decode: DecodeImage<'_>,
    scene: Option<usize>,
    progress: &dyn Fn(LoadStep, &SceneSize),
) -> Result<Scene, SceneError> {
    let path = Path::new(name);
    let bytes = files.get(name).ok_or_else(|| SceneError::Unreadable {
        path: path.to_owned(),
        reason: "the file is missing".to_owned(),
        hint: "Open the file again",
    })?;
    let size = SceneSize::of_file(bytes.len() as u64);
    progress(LoadStep::Read, &size);
    let source = File { bytes, folder: Folder::Memory(files), decode };
    load(path, &source, scene, size, progress)
}

/// Returns the encoded images of a file, to be decoded before [`load_gltf_from_memory`]. Skips missing and
/// broken images.
pub fn gltf_images(name: &str, files: &BTreeMap<String, Vec<u8>>) -> Vec<Vec<u8>> {
    let parsed = files.get(name).and_then(|bytes| container::parse(Path::new(name), bytes, |_| ()).ok());
    let Some(mut source) = parsed else { return Vec::new() };
    let (folder, binary) = (Folder::Memory(files), source.binary.take());
    let reader = Reader::new(&source.root, binary, folder);
    let images = source.root.images.iter().enumerate();
    images.filter_map(|(index, json)| Some(image::encoded(json, index, folder, &reader).ok()?.into_owned())).collect()
}

/// The content of a file, and access to the files and images that it refers to.
struct File<'a> {
    bytes: &'a [u8],
    folder: Folder<'a>,
    decode: DecodeImage<'a>,
}

fn load(
    path: &Path,
    file: &File<'_>,
    scene: Option<usize>,
    mut size: SceneSize,
    progress: &dyn Fn(LoadStep, &SceneSize),
) -> Result<Scene, SceneError> {
    let File { bytes, folder, decode } = *file;
    let mut source = container::parse(path, bytes, |json| {
        size.json = json;
        progress(LoadStep::Parse, &size);
    })?;
    let binary = source.binary.take();
    let tree = nodes::collect(&source.root, &source.transforms, scene).map_err(|problem| problem.at(path))?;
    check_not_empty(&source.root, &tree, path)?;
    progress(LoadStep::Decode, &size.with_content(&source.root, &tree, folder));
    let reader = Reader::new(&source.root, binary, folder);
    let mut imported = import(&source, &reader, tree, Images::new(&source.root, folder, decode))
        .map_err(|problem| problem.at(path))?;
    imported.name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    Ok(imported)
}

fn check_not_empty(root: &Root, tree: &Tree, path: &Path) -> Result<(), SceneError> {
    let has_mesh = |index: &usize| root.nodes[*index].mesh.is_some();
    let visible = tree.file_index.iter().zip(&tree.hidden).filter(|(_, hidden)| !**hidden);
    if visible.map(|(index, _)| index).any(has_mesh) {
        return Ok(());
    }
    let reason = if root.meshes.is_empty() {
        "the file has no meshes"
    } else if tree.file_index.iter().any(has_mesh) {
        "KHR_node_visibility hides every node of the scene that has a mesh"
    } else {
        "no node of the scene has a mesh"
    };
    let hint = "Choose a file or scene that draws triangles";
    Err(SceneError::Empty { path: path.to_owned(), reason: reason.to_owned(), hint })
}

fn import<'a>(
    source: &'a Source,
    reader: &'a Reader<'a>,
    mut tree: Tree,
    images: Images<'a>,
) -> Result<Scene, Problem> {
    let root = &source.root;
    let mut notes = Notes::default();
    source.notes.iter().for_each(|note| notes.add(note));
    let mut nodes = std::mem::take(&mut tree.nodes);
    let (meshes, materials) = meshes(root, reader, &tree, &mut nodes, images, &mut notes)?;
    let mut drawn = Drawn::new(reader);
    for (node, index) in nodes.iter().zip(&tree.file_index) {
        if let Some(mesh) = node.mesh {
            drawn.add(&meshes[mesh], 1, &format!("nodes[{index}]"))?;
        }
    }
    let skins = skins(root, reader, &tree, &mut nodes, &meshes)?;
    tree.nodes = nodes;
    let targets: Vec<usize> = meshes.iter().map(Mesh::targets).collect();
    let animations = Animations { root, reader, tree: &tree, nodes: &tree.nodes, targets: &targets };
    let animations = animations.load(&mut notes)?;
    let cameras = view::cameras(root, &tree, &mut notes)?;
    let suns = view::suns(root, &tree, &mut notes)?;
    let (materials, images) = materials.finish(&mut notes);
    let nodes = std::mem::take(&mut tree.nodes);
    let mut scene = Scene { nodes, meshes, materials, images, skins, animations, cameras, suns, ..Scene::default() };
    instancing::expand(root, reader, &mut tree, &mut scene, &mut drawn, &mut notes)?;
    origin::place(&mut scene, &tree, reader, &mut notes)?;
    let rest = scene.pose(None, 0.0);
    scene.sun = scene.sun_of(&rest);
    view::note_views(&scene, &rest, &mut notes);
    scene.notes = notes.finish();
    Ok(scene)
}

/// Loads the meshes that nodes draw, and stores their indices in the nodes.
fn meshes<'a>(
    root: &'a Root,
    reader: &'a Reader<'a>,
    tree: &Tree,
    nodes: &mut [Node],
    images: Images<'a>,
    notes: &mut Notes,
) -> Result<(Vec<Mesh>, Materials<'a>), Problem> {
    let mut materials = Materials::new(root, reader, images);
    let mut geometries = Geometries::new(reader);
    let mut meshes = Vec::new();
    let mut loaded = HashMap::new();
    for ((node, &index), &hidden) in nodes.iter_mut().zip(&tree.file_index).zip(&tree.hidden) {
        let Some(mesh) = root.nodes[index].mesh.filter(|_| !hidden) else { continue };
        node.mesh = match loaded.entry(mesh.value()) {
            Entry::Occupied(known) => Some(*known.get()),
            Entry::Vacant(new) => {
                let json = entry(&root.meshes, mesh.value(), "mesh", &format!("nodes[{index}].mesh"))?;
                meshes.push(load_mesh(json, &format!("meshes[{mesh}]"), &mut geometries, &mut materials, notes)?);
                Some(*new.insert(meshes.len() - 1))
            }
        };
    }
    Ok((meshes, materials))
}

fn load_mesh(
    json: &gltf::json::Mesh,
    element: &str,
    geometries: &mut Geometries,
    materials: &mut Materials,
    notes: &mut Notes,
) -> Result<Mesh, Problem> {
    let morph_weights = json.weights.clone().unwrap_or_default();
    nodes::check_weights(&morph_weights, element)?;
    let mut primitives = Vec::new();
    for (index, primitive) in json.primitives.iter().enumerate() {
        let element = format!("{element}.primitives[{index}]");
        let look = materials.look(primitive.material, &element, notes)?;
        if look.is_hidden {
            notes.add(format!("{element}: skipped: alphaCutoff of its material is above 1, which hides it"));
            continue;
        }
        primitives.extend(geometries.load(primitive, &element, &look, notes)?);
    }
    Ok(Mesh { name: json.name.clone().unwrap_or_default(), primitives, morph_weights })
}

/// Loads the skins that deform a mesh, and stores their indices in the nodes.
fn skins(root: &Root, reader: &Reader, tree: &Tree, nodes: &mut [Node], meshes: &[Mesh]) -> Result<Vec<Skin>, Problem> {
    let mut skins: Vec<Skin> = Vec::new();
    let mut loaded = HashMap::new();
    for (node, &index) in nodes.iter_mut().zip(&tree.file_index) {
        let (Some(skin), Some(mesh)) = (root.nodes[index].skin, node.mesh) else { continue };
        let own = match loaded.entry(skin.value()) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(new) => {
                skins.push(skin::load(reader, root, tree, skin.value())?);
                *new.insert(skins.len() - 1)
            }
        };
        node.skin = Some(own);
        skin::check_joints(&meshes[mesh], &skins[own], &format!("nodes[{index}].skin"))?;
    }
    Ok(skins)
}
