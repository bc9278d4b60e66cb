//! Instances of meshes: what the shaders read of one, and the box that holds it.

use glam::{Affine3A, DMat3, DVec3, Mat3A, Vec3, Vec3A};

use super::placed::MeshId;
use crate::records::{InstanceRecord, NO_ROOT};

/// Which triangles of an instance block the light, by the side that the light sees. The front is the side from which the
/// corners follow each other counter-clockwise; an instance that is mirrored, by a negative determinant, keeps the sides
/// of its mesh outward, as glTF says and engines draw it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Sides {
    /// All of them: what engines draw into shadow maps without culling.
    #[default]
    Both = 0,
    /// Those whose front faces the light: what back-face culling leaves in shadow maps.
    Front = 1,
    /// Those whose back faces the light: what front-face culling leaves.
    Back = 2,
}

/// A mesh somewhere in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayInstance {
    /// The mesh, from [`RayScene::add_mesh`](crate::RayScene::add_mesh).
    pub mesh: MeshId,
    /// From the mesh's own space to the world's axes in metres, relative to the origin that is given with it.
    pub world_from_mesh: Affine3A,
    /// Least and greatest corner of a box that holds it in this frame, in world axes, in metres, relative to the same
    /// origin; `None` for that of its mesh, transformed. What deforms is traced the faster the less its box holds beside it.
    pub bounds: Option<[Vec3; 2]>,
    /// Which of its triangles block the light.
    pub sides: Sides,
    /// A number of the engine's own, which its WGSL is told of a hit.
    pub custom: u32,
}

impl RayInstance {
    /// An instance whose triangles block the light from both sides, and whose own number is 0.
    pub const fn new(mesh: MeshId, world_from_mesh: Affine3A) -> Self {
        Self { mesh, world_from_mesh, bounds: None, sides: Sides::Both, custom: 0 }
    }

    /// The record, and the box around the instance; `None` where it cannot be met.
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

/// The inverse to half a unit in the last place; `None` where it is not finite.
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

/// Roundings between a corner of a mesh and what a ray in the world finds of it, at most: three products and sums in the
/// shader, as many here, and the matrix's own.
const ROUNDINGS: f32 = 8.0;

/// The box around a transformed box, with what rounding may add: to the box itself, and to the way from a ray in the
/// world to one in the mesh.
fn world_bounds(world: &Affine3A, mesh: &Affine3A, [least, most]: [Vec3; 2]) -> [Vec3; 2] {
    let [least, most] = [least, most].map(Vec3A::from);
    let centre = world.transform_point3a((least + most) * 0.5);
    let half = world.matrix3.abs() * ((most - least) * 0.5);
    widened(world, mesh, [(centre - half).into(), (centre + half).into()])
}

/// A box in the world with what rounding may add.
fn widened(world: &Affine3A, mesh: &Affine3A, [least, most]: [Vec3; 2]) -> [Vec3; 2] {
    let [least, most] = [least, most].map(Vec3A::from);
    let (world_size, mesh_size) = (world.matrix3.abs(), mesh.matrix3.abs());
    let reach = least.abs().max(most.abs());
    let there_and_back = world_size * (mesh_size * reach + mesh.translation.abs()) + world.translation.abs();
    let margin = (reach + there_and_back) * (ROUNDINGS * f32::EPSILON);
    [(least - margin).into(), (most + margin).into()]
}
