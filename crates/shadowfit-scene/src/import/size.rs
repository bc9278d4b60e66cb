//! Size of a scene, read from the file before its content is decoded.

use gltf::json::mesh::Semantic;
use gltf::json::validation::Checked;
use gltf::json::{Index, Mesh, Root, image, mesh};

use super::instancing;
use super::nodes::Tree;
use super::uri::{Folder, uri_size};

/// Amounts that decide how long it takes to load a file and to prepare its scene. The file declares them, so
/// they may be wrong if it is broken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneSize {
    /// Bytes of the file.
    pub file: u64,
    /// Bytes of JSON in the file. 0 until it has been read.
    pub json: u64,
    /// Nodes of the scene. This and the following fields are 0 until the JSON has been parsed.
    pub nodes: u64,
    /// Triangles of the meshes that the scene draws, each mesh counted once.
    pub triangles: u64,
    /// Triangles that the scene draws, counted at every node.
    pub drawn: u64,
    /// Bytes of the encoded images.
    pub images: u64,
}

impl SceneSize {
    /// Returns the size of a file of `bytes` bytes that has not been read.
    pub(super) fn of_file(bytes: u64) -> Self {
        Self { file: bytes, ..Self::default() }
    }

    /// Adds the numbers that the JSON declares for a scene.
    pub(super) fn with_content(self, root: &Root, tree: &Tree, folder: Folder<'_>) -> Self {
        // The counts are unchecked, so their sums may overflow.
        let sum = u64::saturating_add;
        let triangles = |mesh: &Mesh| mesh.primitives.iter().map(|primitive| triangles(root, primitive)).fold(0, sum);
        // For each mesh: its triangles, and whether an earlier node drew it.
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

/// Returns the number of triangles of a primitive, counted as a triangle list.
fn triangles(root: &Root, primitive: &mesh::Primitive) -> u64 {
    let positions = || primitive.attributes.get(&Checked::Valid(Semantic::Positions)).copied();
    let accessor = primitive.indices.or_else(positions).and_then(|index| root.accessors.get(Index::value(&index)));
    accessor.map_or(0, |accessor| accessor.count.0 / 3)
}

/// Returns the bytes of an encoded image, or 0 if unknown.
fn encoded(root: &Root, image: &image::Image, folder: Folder<'_>) -> u64 {
    match (&image.uri, image.buffer_view) {
        (Some(uri), _) => uri_size(folder, uri),
        (None, Some(view)) => root.buffer_views.get(view.value()).map_or(0, |view| view.byte_length.0),
        (None, None) => 0,
    }
}
