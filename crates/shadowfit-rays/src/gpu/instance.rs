//! Instances of meshes, with their records for the shaders and their boxes.

use glam::{Affine3A, DMat3, DVec3, Mat3A, Vec3, Vec3A};

use super::placed::MeshId;
use crate::records::{InstanceRecord, NO_ROOT};

/// The triangles of an instance that block the light, by the side that faces the light. The corners of a
/// triangle are counter-clockwise as seen from its front. A mirrored instance (negative determinant) keeps
/// the outward sides of its mesh, as glTF specifies and engines draw it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Sides {
    /// All triangles, as in shadow maps without culling.
    #[default]
    Both = 0,
    /// Triangles whose front faces the light, as in shadow maps with back-face culling.
    Front = 1,
    /// Triangles whose back faces the light, as in shadow maps with front-face culling.
    Back = 2,
}

/// A mesh, placed in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayInstance {
    /// The mesh, from [`RayScene::add_mesh`](crate::RayScene::add_mesh).
    pub mesh: MeshId,
    /// Transform from the mesh's own space to world axes, in metres relative to the origin of
    /// [`RayScene::set_instances`](crate::RayScene::set_instances).
    pub world_from_mesh: Affine3A,
    /// Least and greatest corner of a box that holds the instance in this frame, in world axes, in metres,
    /// relative to the same origin. `None` uses the transformed box of its mesh. For a deforming mesh, a
    /// tighter box makes tracing faster.
    pub bounds: Option<[Vec3; 2]>,
    /// The triangles that block the light.
    pub sides: Sides,
    /// A number that the engine assigns. The engine's WGSL gets it with each hit.
    pub custom: u32,
}

impl RayInstance {
    /// Returns an instance whose triangles block the light from both sides, with the number 0.
    pub const fn new(mesh: MeshId, world_from_mesh: Affine3A) -> Self {
        Self { mesh, world_from_mesh, bounds: None, sides: Sides::Both, custom: 0 }
    }

    /// Returns the record and the box of the instance, or `None` if rays cannot hit it.
    pub(crate) fn placed(&self, root: u32, bounds: [Vec3; 2]) -> Option<(InstanceRecord, [Vec3; 2])> {
        let mesh_from_world = inverse(&self.world_from_mesh).filter(|_| root != NO_ROOT)?;
        let bounds = match self.bounds {
            Some(bounds) => widened(&self.world_from_mesh, &mesh_from_world, bounds),
            None => world_bounds(&self.world_from_mesh, &mesh_from_world, bounds),
        };
        let rows = mesh_from_world.matrix3.transpose();
        let offset = mesh_from_world.translation;
        let row = |row: Vec3A, offset: f32| row.extend(offset).to_array();
        let record = InstanceRecord {
            row_x: row(rows.x_axis, offset.x),
            row_y: row(rows.y_axis, offset.y),
            row_z: row(rows.z_axis, offset.z),
            root,
            sides: self.sides as u32,
            custom: self.custom,
            padding: 0,
        };
        bounds.iter().all(|corner| corner.is_finite()).then_some((record, bounds))
    }
}

/// Returns the inverse, exact to half a unit in the last place, or `None` if it is not finite.
fn inverse(transform: &Affine3A) -> Option<Affine3A> {
    let linear = DMat3::from_cols(
        transform.matrix3.x_axis.as_dvec3(),
        transform.matrix3.y_axis.as_dvec3(),
        transform.matrix3.z_axis.as_dvec3(),
    );
    let determinant = linear.determinant();
    if !determinant.is_normal() {
        return None;
    }
    let linear = linear.inverse();
    let offset = -(linear * transform.translation.as_dvec3());
    let column = |column: DVec3| column.as_vec3a();
    let matrix3 = Mat3A::from_cols(column(linear.x_axis), column(linear.y_axis), column(linear.z_axis));
    let inverse = Affine3A { matrix3, translation: offset.as_vec3a() };
    inverse.is_finite().then_some(inverse)
}

/// Greatest number of roundings between a corner of a mesh and its position for a ray in the world: three
/// products and sums in the shader, three here, and the matrix's own.
const ROUNDINGS: f32 = 8.0;

/// Returns the box around a transformed box, widened by rounding errors of the box itself and of the
/// transform of rays from the world to the mesh.
fn world_bounds(world: &Affine3A, mesh: &Affine3A, [least, most]: [Vec3; 2]) -> [Vec3; 2] {
    let [least, most] = [least, most].map(Vec3A::from);
    let centre = world.transform_point3a((least + most) * 0.5);
    let half = world.matrix3.abs() * ((most - least) * 0.5);
    widened(world, mesh, [(centre - half).into(), (centre + half).into()])
}

/// Returns a box in the world, widened by rounding errors.
fn widened(world: &Affine3A, mesh: &Affine3A, [least, most]: [Vec3; 2]) -> [Vec3; 2] {
    let [least, most] = [least, most].map(Vec3A::from);
    let (world_size, mesh_size) = (world.matrix3.abs(), mesh.matrix3.abs());
    let reach = least.abs().max(most.abs());
    let there_and_back = world_size * (mesh_size * reach + mesh.translation.abs()) + world.translation.abs();
    let margin = (reach + there_and_back) * (ROUNDINGS * f32::EPSILON);
    [(least - margin).into(), (most + margin).into()]
}
