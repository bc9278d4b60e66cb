//! Writes a generated scene as a binary glTF file, for programs that measure other engines on it: one node per
//! object, with positions, normals and plain materials. Textures are left out.

use std::collections::HashMap;
use std::sync::Arc;

use anyhow::Result;
use glam::Vec3;
use serde_json::{Value, json};
use shadowfit_scene::{Geometry, Scene};

/// Magic number, version and chunk types of the format (glTF 2.0 specification, section 4.4).
const MAGIC: u32 = 0x4654_6C67;
const VERSION: u32 = 2;
const JSON_CHUNK: u32 = 0x4E4F_534A;
const BINARY_CHUNK: u32 = 0x004E_4942;
/// Component types and buffer targets (section 5).
const U32: u32 = 5125;
const F32: u32 = 5126;
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;

/// Returns a scene in its rest pose as the bytes of a GLB file.
///
/// # Errors
/// If the JSON cannot be written.
pub(super) fn glb(scene: &Scene) -> Result<Vec<u8>> {
    let mut file = File::default();
    let pose = scene.pose(None, 0.0);
    let (mut nodes, mut meshes, mut mesh_of) = (Vec::new(), Vec::new(), HashMap::new());
    for instance in scene.instances() {
        let primitive = &scene.meshes[instance.mesh].primitives[instance.primitive];
        let key = (Arc::as_ptr(&primitive.geometry), primitive.material);
        let mesh = *mesh_of.entry(key).or_insert_with(|| {
            meshes.push(json!({ "primitives": [file.primitive(&primitive.geometry, primitive.material)] }));
            meshes.len() - 1
        });
        nodes.push(json!({ "mesh": mesh, "matrix": pose.world_from_instance(scene, &instance).to_cols_array() }));
    }
    let materials: Vec<Value> = scene.materials.iter().map(material).collect();
    let roots: Vec<usize> = (0..nodes.len()).collect();
    let document = json!({
        "asset": { "version": "2.0", "generator": "shadowfit-report" },
        "scene": 0,
        "scenes": [{ "name": scene.name, "nodes": roots }],
        "nodes": nodes,
        "meshes": meshes,
        "materials": materials,
        "accessors": file.accessors,
        "bufferViews": file.views,
        "buffers": [{ "byteLength": file.bytes.len() }],
    });
    Ok(container(&serde_json::to_vec(&document)?, &file.bytes))
}

fn material(material: &shadowfit_scene::Material) -> Value {
    json!({
        "name": material.name,
        "doubleSided": material.double_sided,
        "pbrMetallicRoughness": {
            "baseColorFactor": material.base_color.to_array(),
            "metallicFactor": material.metallic,
            "roughnessFactor": material.roughness,
        },
    })
}

/// The binary chunk and the lists that describe it.
#[derive(Default)]
struct File {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl File {
    fn primitive(&mut self, geometry: &Geometry, material: usize) -> Value {
        let positions = self.vectors(&geometry.positions);
        let normals = self.vectors(&geometry.normals);
        let indices: Vec<u8> = geometry.indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let indices = self.accessor(
            &indices,
            INDICES,
            json!({
                "componentType": U32, "type": "SCALAR", "count": geometry.indices.len(),
            }),
        );
        json!({ "attributes": { "POSITION": positions, "NORMAL": normals }, "indices": indices, "material": material })
    }

    fn vectors(&mut self, vectors: &[Vec3]) -> usize {
        let bytes: Vec<u8> = vectors.iter().flat_map(Vec3::to_array).flat_map(f32::to_le_bytes).collect();
        let min = vectors.iter().copied().fold(Vec3::MAX, Vec3::min).to_array();
        let max = vectors.iter().copied().fold(Vec3::MIN, Vec3::max).to_array();
        self.accessor(
            &bytes,
            VERTICES,
            json!({
                "componentType": F32, "type": "VEC3", "count": vectors.len(), "min": min, "max": max,
            }),
        )
    }

    /// Adds data with its view and accessor. Returns the accessor's index.
    fn accessor(&mut self, bytes: &[u8], target: u32, mut accessor: Value) -> usize {
        accessor["bufferView"] = json!(self.views.len());
        self.views.push(json!({
            "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len(), "target": target,
        }));
        self.bytes.extend(bytes);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}

/// Joins the two chunks of a file. Each is padded to a multiple of four bytes.
fn container(json: &[u8], binary: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], fill: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), fill);
        bytes
    };
    let chunks = [(JSON_CHUNK, padded(json, b' ')), (BINARY_CHUNK, padded(binary, 0))];
    let length = 12 + chunks.iter().map(|(_, bytes)| 8 + bytes.len()).sum::<usize>();
    let mut file: Vec<u8> = [MAGIC, VERSION, length as u32].into_iter().flat_map(u32::to_le_bytes).collect();
    for (kind, bytes) in chunks {
        file.extend([bytes.len() as u32, kind].into_iter().flat_map(u32::to_le_bytes));
        file.extend(bytes);
    }
    file
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use shadowfit_scene::builtin::BuiltinScene;
    use shadowfit_scene::{decode_image, load_gltf_from_memory};

    use super::*;

    #[test]
    fn a_written_scene_has_the_same_triangles() {
        let scene = BuiltinScene::from_id("courtyard").expect("a scene").build();
        let name = "courtyard.glb";
        let files = BTreeMap::from([(name.to_owned(), glb(&scene).expect("a file"))]);
        let read = load_gltf_from_memory(name, &files, &decode_image, None, &|_, _| ()).expect("a scene");
        let triangles = |scene: &Scene| scene.pose(None, 0.0).triangles(scene);
        let (was, is) = (triangles(&scene), triangles(&read));
        assert_eq!(was.len(), is.len());
        for (was, is) in was.iter().zip(&is) {
            let same = was.vertices.iter().zip(&is.vertices).all(|(a, b)| a.distance(*b) < 1e-4);
            assert!(same, "{:?} {:?}", was.vertices, is.vertices);
        }
    }
}
