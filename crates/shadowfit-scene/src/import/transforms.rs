//! Transforms of nodes in f64. The gltf crate reads them as f32, which has steps of half a metre at the
//! coordinates of georeferenced files.

use glam::{DMat4, DQuat, DVec3};
use gltf::json::{Error, deserialize};
use serde::Deserialize;

use crate::Transform;

/// The nodes of a file.
#[derive(Default, Deserialize)]
#[serde(default)]
struct File {
    nodes: Vec<Node>,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct Node {
    matrix: Option<[f64; 16]>,
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
}

/// Reads the transform of each node of the file.
pub(super) fn read(json: &[u8]) -> Result<Vec<Transform>, Error> {
    let file: File = deserialize::from_slice(json)?;
    Ok(file.nodes.iter().map(transform).collect())
}

fn transform(json: &Node) -> Transform {
    Transform {
        translation: json.translation.map_or(DVec3::ZERO, DVec3::from_array),
        rotation: rotation(json.rotation.map_or(DQuat::IDENTITY, DQuat::from_array)),
        scale: json.scale.map_or(DVec3::ONE, DVec3::from_array),
        matrix: json.matrix.map(|m| DMat4::from_cols_array(&m)).filter(|&m| m != DMat4::IDENTITY),
    }
}

/// Returns the rotation as a unit quaternion. Zero counts as no rotation.
pub(super) fn rotation(rotation: DQuat) -> DQuat {
    let length = rotation.length();
    if length > 0.0 { rotation * (1.0 / length) } else { DQuat::IDENTITY }
}
