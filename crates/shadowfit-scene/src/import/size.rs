//! How much there is to load: what a file says about itself before its content is decoded.

use gltf::json::mesh::Semantic;
use gltf::json::validation::Checked;
use gltf::json::{Index, Mesh, Root, image, mesh};

use super::instancing;
use super::nodes::Tree;
use super::uri::{Folder, uri_size};

/// The amounts that decide how long a file takes to be loaded and its scene to be made ready. They are what the file
/// claims, and may be wrong where it cannot be loaded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneSize {
    /// Bytes of the file.
    pub file: u64,
    /// Bytes of JSON in it; 0 until it has been read.
    pub json: u64,
    /// Nodes of the scene; 0 until the JSON has been parsed, as all that follows.
    pub nodes: u64,
    /// Triangles of the meshes that it draws, each mesh once.
    pub triangles: u64,
    /// Triangles that it draws, every node counted.
    pub drawn: u64,
    /// Bytes of its images, as they are encoded.
    pub images: u64,
}

impl SceneSize {
    /// That of a file of so many bytes which has not been read.
    pub(super) fn of_file(bytes: u64) -> Self {
        Self { file: bytes, ..Self::default() }
    }

    /// The same with what the JSON says about a scene.
    pub(super) fn with_content(self, root: &Root, tree: &Tree, folder: Folder<'_>) -> Self {
        // The counts are claims, so that their sums may be too large for a number.
        let sum = u64::saturating_add;
        let triangles = |mesh: &Mesh| mesh.primitives.iter().map(|primitive| triangles(root, primitive)).fold(0, sum);
        // Each with whether a node before drew it.
        let mut meshes: Vec<(u64, bool)> = root.meshes.iter().map(|mesh| (triangles(mesh), false)).collect();
        let (mut all, mut drawn) = (0_u64, 0_u64);
        for (node, _) in tree.file_index.iter().zip(&tree.hidden).filter(|(_, hidden)| !**hidden) {
            let node = &root.nodes[*node];
            let Some(index) = node.mesh else { continue };
            let Some((triangles, is_counted)) = meshes.get_mut(index.value()) else { continue };
            drawn = drawn.saturating_add(triangles.saturating_mul(instancing::declared(root, node)));
            if !std::mem::replace(is_counted, true) {
                all = all.saturating_add(*triangles);
            }
        }
        let images = root.images.iter().map(|image| encoded(root, image, folder)).fold(0, sum);
        Self { nodes: tree.nodes.len() as u64, triangles: all, drawn, images, ..self }
    }
}

/// Triangles of a primitive, as if they were in a list.
fn triangles(root: &Root, primitive: &mesh::Primitive) -> u64 {
    let positions = || primitive.attributes.get(&Checked::Valid(Semantic::Positions)).copied();
    let accessor = primitive.indices.or_else(positions).and_then(|index| root.accessors.get(Index::value(&index)));
    accessor.map_or(0, |accessor| accessor.count.0 / 3)
}

/// Bytes of an image; 0 where they are unknown.
fn encoded(root: &Root, image: &image::Image, folder: Folder<'_>) -> u64 {
    match (&image.uri, image.buffer_view) {
        (Some(uri), _) => uri_size(folder, uri),
        (None, Some(view)) => root.buffer_views.get(view.value()).map_or(0, |view| view.byte_length.0),
        (None, None) => 0,
    }
}
