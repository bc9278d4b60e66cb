//! Skins: joints and inverse bind matrices.

use glam::Mat4;
use gltf::json::{Root, skin};

use super::accessor::{Integers, Reader};
use super::nodes::Tree;
use crate::error::Problem;
use crate::{Mesh, Skin};

/// Loads skin `index` of the file.
pub(crate) fn load(reader: &Reader, root: &Root, tree: &Tree, index: usize) -> Result<Skin, Problem> {
    let element = format!("skins[{index}]");
    let json = root.skins.get(index);
    let json = json.ok_or_else(|| Problem::new(element.clone(), "there is no such skin"))?;
    let mut joints = Vec::with_capacity(json.joints.len());
    for (i, joint) in json.joints.iter().enumerate() {
        let node = tree.scene_index.get(joint.value()).copied().flatten();
        joints.push(node.ok_or_else(|| {
            let reason = format!("node {joint} is not part of the scene");
            Problem::new(format!("{element}.joints[{i}]"), reason)
        })?);
    }
    if joints.is_empty() {
        return Err(Problem::new(format!("{element}.joints"), "it has no joints"));
    }
    let joint_from_mesh = bind_matrices(reader, json, &format!("{element}.inverseBindMatrices"))?;
    Ok(Skin { joints, joint_from_mesh })
}

fn bind_matrices(reader: &Reader, json: &skin::Skin, element: &str) -> Result<Vec<Mat4>, Problem> {
    let joints = json.joints.len();
    let Some(index) = json.inverse_bind_matrices else {
        return Ok(vec![Mat4::IDENTITY; joints]);
    };
    let matrices = reader.floats::<16>(index, element, Integers::AsDeclared)?;
    let wrong = |reason: String| Problem::new(format!("{element}, accessor {index}"), reason);
    if matrices.len() < joints {
        return Err(wrong(format!("it has {} matrices for {joints} joints", matrices.len())));
    }
    let matrices = matrices.iter().take(joints).map(Mat4::from_cols_array);
    let matrices: Vec<Mat4> = matrices.collect();
    match matrices.iter().position(|matrix| !matrix.is_finite()) {
        Some(joint) => Err(wrong(format!("the matrix of joint {joint} is not finite"))),
        None => Ok(matrices),
    }
}

/// Checks that the skin has all joints that a mesh uses.
pub(crate) fn check_joints(mesh: &Mesh, skin: &Skin, element: &str) -> Result<(), Problem> {
    let count = skin.joints.len();
    for (index, primitive) in mesh.primitives.iter().enumerate() {
        let greatest = primitive.joints.iter().flatten().max().copied().unwrap_or(0);
        if greatest as usize >= count && !primitive.joints.is_empty() {
            let reason = format!("primitive {index} of its mesh uses joint {greatest}, its skin has {count}");
            return Err(Problem::new(element, reason));
        }
    }
    Ok(())
}
