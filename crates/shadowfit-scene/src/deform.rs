//! Morph targets and linear blend skinning on the CPU, after the glTF 2.0 specification (sections 3.7.2.2 and
//! 3.7.3). Morphing precedes skinning. A skinned mesh ignores its node's transform.

use glam::{DVec3, Mat3, Mat4, Vec3, Vec4};

use crate::{Instance, Pose, Primitive, Scene, Skin};

/// Vertices of an instance after morphing and skinning, in the order of the primitive's vertices.
///
/// Skinned vertices are in world space. Vertices without a skin are in the mesh's space, like the
/// primitive's.
#[derive(Clone, Debug, Default)]
pub struct Deformed {
    /// Positions, in metres.
    pub positions: Vec<Vec3>,
    /// Unit normals.
    pub normals: Vec<Vec3>,
    /// Unit tangents with the bitangent's sign in w. Empty if the primitive has none.
    pub tangents: Vec<Vec4>,
}

impl Pose {
    /// Returns the vertices of a morphed or skinned instance. Returns `None` for a rigid instance, which has
    /// the primitive's vertices.
    pub fn deform(&self, scene: &Scene, instance: &Instance) -> Option<Deformed> {
        let primitive = scene.meshes.get(instance.mesh)?.primitives.get(instance.primitive)?;
        let skin = scene.instance_skin(instance);
        if skin.is_none() && primitive.morphs.is_empty() {
            return None;
        }
        let mut deformed = Deformed {
            positions: primitive.positions.clone(),
            normals: primitive.normals.clone(),
            tangents: primitive.tangents.clone(),
        };
        if let Some(weights) = self.morph_weights.get(instance.node) {
            morph(&mut deformed, primitive, weights);
        }
        if let Some(skin) = skin {
            skin_vertices(&mut deformed, primitive, &self.world_from_mesh_by_joint(skin));
        }
        Some(deformed)
    }

    /// Returns the corners of an instance's triangles, in the order of [`Pose::triangles_from`]. `deformed`
    /// is the result of [`Pose::deform`] for this instance.
    pub fn corners_from<'a>(
        &self,
        scene: &'a Scene,
        instance: &Instance,
        deformed: Option<&'a Deformed>,
        origin: DVec3,
    ) -> impl ExactSizeIterator<Item = [Vec3; 3]> + use<'a> {
        let primitive = &scene.meshes[instance.mesh].primitives[instance.primitive];
        let mut world_from_local = self.world_from_instance(scene, instance);
        let from_origin = (world_from_local.w_axis.truncate().as_dvec3() - origin).as_vec3();
        world_from_local.w_axis = from_origin.extend(1.0);
        let local = deformed.map_or(&primitive.positions, |deformed| &deformed.positions);
        let mirrored = self.is_mirrored(scene, instance);
        primitive.indices.as_chunks::<3>().0.iter().map(move |corners| {
            let [a, b, c] = corners.map(|index| world_from_local.transform_point3(local[index as usize]));
            if mirrored { [a, c, b] } else { [a, b, c] }
        })
    }

    /// Returns, for each joint of a skin, the world-from-mesh matrix of a vertex that only this joint moves.
    pub fn world_from_mesh_by_joint(&self, skin: &Skin) -> Vec<Mat4> {
        let joints = skin.joints.iter().zip(&skin.joint_from_mesh);
        joints.map(|(&node, &joint_from_mesh)| self.world_from(node) * joint_from_mesh).collect()
    }
}

impl Scene {
    /// Returns the skin that deforms the instance, or `None` if its node has no skin or its primitive has no
    /// joints.
    pub fn instance_skin(&self, instance: &Instance) -> Option<&Skin> {
        let primitive = self.meshes.get(instance.mesh)?.primitives.get(instance.primitive)?;
        let skin = self.skins.get(self.nodes.get(instance.node)?.skin?)?;
        (!primitive.joints.is_empty()).then_some(skin)
    }
}

fn morph(deformed: &mut Deformed, primitive: &Primitive, weights: &[f32]) {
    for (target, &weight) in primitive.morphs.iter().zip(weights) {
        if weight == 0.0 {
            continue;
        }
        for (position, &offset) in deformed.positions.iter_mut().zip(&target.positions) {
            *position += offset * weight;
        }
        for (normal, &offset) in deformed.normals.iter_mut().zip(&target.normals) {
            *normal += offset * weight;
        }
    }
    for normal in &mut deformed.normals {
        *normal = normal.normalize_or(Vec3::Y);
    }
}

fn skin_vertices(deformed: &mut Deformed, primitive: &Primitive, world_from_mesh: &[Mat4]) {
    let influences = primitive.joints.iter().zip(&primitive.weights);
    for (i, (joints, weights)) in influences.enumerate() {
        let matrix = blend(world_from_mesh, *joints, *weights);
        if let Some(position) = deformed.positions.get_mut(i) {
            *position = matrix.transform_point3(*position);
        }
        if let Some(normal) = deformed.normals.get_mut(i) {
            *normal = (normal_matrix(matrix) * *normal).normalize_or(Vec3::Y);
        }
        if let Some(tangent) = deformed.tangents.get_mut(i) {
            let direction = matrix.transform_vector3(tangent.truncate()).normalize_or(Vec3::X);
            *tangent = direction.extend(tangent.w);
        }
    }
}

fn blend(matrices: &[Mat4], joints: [u16; 4], weights: Vec4) -> Mat4 {
    let mut sum = Mat4::ZERO;
    for (joint, weight) in joints.into_iter().zip(weights.to_array()) {
        if weight != 0.0 {
            sum += matrices.get(joint as usize).copied().unwrap_or(Mat4::IDENTITY) * weight;
        }
    }
    sum
}

/// Returns the inverse transpose up to a positive factor, also for singular matrices: the cofactors with the
/// sign of the determinant.
fn normal_matrix(matrix: Mat4) -> Mat3 {
    let m = Mat3::from_mat4(matrix);
    let (x, y, z) = (m.x_axis, m.y_axis, m.z_axis);
    let cofactors = Mat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    if x.dot(cofactors.x_axis) < 0.0 { cofactors * -1.0 } else { cofactors }
}
