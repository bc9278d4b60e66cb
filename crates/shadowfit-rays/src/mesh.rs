//! One mesh's triangles and hierarchy as plain data. Meshes can be built on any thread and added to a scene
//! later.

use glam::{Vec2, Vec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::{Bvh2, node::Bvh2Node};
use obvhs::{Boundable, BvhBuildParams};

use crate::cut_out::{CutMaterial, CutOut};
use crate::error::RayError;
use crate::hierarchy::{self, Hierarchy};
use crate::records::{CutOutRecord, NodeRecord, TriangleRecord};

/// A mesh's triangles and their hierarchy.
#[derive(Clone, Debug, Default)]
pub struct RayMesh {
    pub(crate) hierarchy: Hierarchy,
    /// Triangles in leaf order.
    pub(crate) triangles: Vec<TriangleRecord>,
    pub(crate) cut_outs: Vec<CutOutRecord>,
    /// Vertices of each triangle, by triangle index. Empty if the vertices are consecutive.
    indices: Vec<[u32; 3]>,
    pub(crate) vertices: usize,
}

/// Memory of a mesh, in bytes, without its cut-outs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayMemory {
    /// Peak on the CPU while the [`RayMesh`] is built, including the finished mesh.
    pub building: u64,
    /// Size of the finished [`RayMesh`], which may be dropped after it was added to a scene.
    pub kept: u64,
    /// Size in the buffers of a scene.
    pub gpu: u64,
}

/// Longest stack up to which the children of a mesh's nodes keep their best order, largest first. The rest of
/// [`STACK`](crate::STACK) is enough for 10¹¹ instances.
const MESH_STACK: usize = 40;
/// Leaves have up to four triangles. With eight, a ray takes a tenth longer. With two, nodes take twice the
/// memory.
const BUILD: BvhBuildParams = BvhBuildParams { max_prims_per_leaf: 4, ..BvhBuildParams::medium_build() };
/// Nodes per triangle during the build: two for the tree of single triangles, and one in each of the
/// builder's two lists of unjoined nodes.
const NODES_BUILDING: u64 = 4;
/// Bytes per triangle of the builder's sort entries: a code along a space-filling curve, and an index.
const CODE: u64 = size_of::<[u128; 2]>() as u64;
/// Nodes per three triangles in the finished hierarchy, including places without a node. Leaves hold two to
/// three triangles. Measured: 1.9 to 2.3, with more nodes if fewer triangles share edges.
const NODES_KEPT_FOR_3: u64 = 2;

impl RayMesh {
    /// Builds the hierarchy of a triangle list: three indices of `positions` per triangle. Positions are in
    /// the mesh's own space. Rays never hit triangles with non-finite vertices.
    ///
    /// # Errors
    ///
    /// Returns [`RayError::Index`] for an index beyond the positions, and [`RayError::Indices`] for a number
    /// of indices that is not a multiple of 3.
    pub fn new(positions: &[Vec3], indices: &[u32]) -> Result<Self, RayError> {
        let (triangles, []) = indices.as_chunks::<3>() else { return Err(RayError::Indices(indices.len())) };
        let is_beyond = |index: &u32| *index as usize >= positions.len();
        if let Some(place) = indices.iter().position(is_beyond) {
            return Err(RayError::Index { place, index: indices[place], vertices: positions.len() });
        }
        let corners = triangles.iter().map(|triangle| triangle.map(|index| positions[index as usize]));
        let made = Self::from_triangles(corners)?;
        Ok(Self { indices: triangles.to_vec(), vertices: positions.len(), ..made })
    }

    /// Builds the hierarchy of triangles without shared vertices: vertex `3 * t + k` is corner `k` of
    /// triangle `t`. Rays never hit triangles with non-finite vertices.
    ///
    /// # Errors
    ///
    /// Returns [`RayError::Triangles`] for more than 2^32 / 3 triangles.
    pub fn from_triangles(triangles: impl IntoIterator<Item = [Vec3; 3]>) -> Result<Self, RayError> {
        let corners: Vec<Corners> = triangles.into_iter().map(Corners::new).collect();
        if corners.len() > u32::MAX as usize / 3 {
            return Err(RayError::Triangles(corners.len()));
        }
        let (hierarchy, order) = hierarchy::build(&corners, BUILD, MESH_STACK);
        Ok(Self::of(hierarchy, &order, |triangle| corners[triangle as usize].0))
    }

    /// Converts a finished hierarchy. `corners` returns the corners of a triangle by its index. Boxes are
    /// fitted to these corners, so they may differ from the corners of the build. The hierarchy must not have
    /// split triangles.
    pub fn from_bvh(bvh: &Bvh2, corners: impl Fn(u32) -> [Vec3; 3]) -> Self {
        let mut hierarchy = Hierarchy::new(bvh);
        hierarchy.fit_stack(MESH_STACK);
        Self::of(hierarchy, &bvh.primitive_indices, |triangle| Corners::new(corners(triangle)).0)
    }

    fn of(mut hierarchy: Hierarchy, order: &[u32], corners: impl Fn(u32) -> [Vec3; 3]) -> Self {
        let record = |triangle: &u32| {
            let [a, b, c] = corners(*triangle).map(Into::into);
            TriangleRecord { a, b, c, index: *triangle, ..TriangleRecord::default() }
        };
        let triangles: Vec<_> = order.iter().map(record).collect();
        hierarchy.fit(|slots| {
            let corners = triangles[slots].iter().flat_map(|triangle| [triangle.a, triangle.b, triangle.c]);
            let empty = [Vec3::INFINITY, Vec3::NEG_INFINITY];
            corners.map(Vec3::from).fold(empty, |bounds, corner| hierarchy::union(bounds, [corner; 2]))
        });
        let vertices = triangles.len() * 3;
        Self { hierarchy, triangles, vertices, ..Self::default() }
    }

    /// Replaces the triangles with holes, given by triangle index. If a triangle occurs more than once, its
    /// last cut-out counts.
    ///
    /// # Errors
    ///
    /// Returns [`RayError::CutOut`] for a triangle that the mesh does not have.
    pub fn with_cut_outs(mut self, cut_outs: impl IntoIterator<Item = (u32, CutOut)>) -> Result<Self, RayError> {
        let mut of_triangle = vec![0; self.triangles.len()];
        self.cut_outs.clear();
        for (triangle, cut_out) in cut_outs {
            let Some(number) = of_triangle.get_mut(triangle as usize) else {
                return Err(RayError::CutOut { triangle, triangles: self.triangles.len() });
            };
            self.cut_outs.push(cut_out.record());
            *number = self.cut_outs.len() as u32;
        }
        for triangle in &mut self.triangles {
            triangle.cut_out = of_triangle[triangle.index as usize];
        }
        Ok(self)
    }

    /// Gives all triangles holes, from texture coordinates of each vertex, in the order of the positions, and
    /// one material.
    ///
    /// # Errors
    ///
    /// Returns [`RayError::Uvs`] unless there is one texture coordinate for each vertex.
    pub fn with_material(self, uvs: &[Vec2], material: &CutMaterial) -> Result<Self, RayError> {
        if uvs.len() != self.vertices {
            return Err(RayError::Uvs { uvs: uvs.len(), vertices: self.vertices });
        }
        let cut_out = |triangle: u32| {
            let uvs = self.vertices_of(triangle).map(|vertex| uvs[vertex as usize]);
            (triangle, CutOut { uvs, alphas: [1.0; 3], material: *material })
        };
        let cut_outs: Vec<_> = (0..self.len() as u32).map(cut_out).collect();
        self.with_cut_outs(cut_outs)
    }

    /// Returns the number of triangles.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Returns whether the mesh has zero triangles.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Returns the index of each triangle in leaf order, the order of
    /// [`RayScene::slots`](crate::RayScene::slots).
    pub fn order(&self) -> impl Iterator<Item = u32> {
        self.triangles.iter().map(|triangle| triangle.index)
    }

    /// Returns the least and greatest corner of the box around all triangles, in the mesh's own space. `None`
    /// without triangles.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        self.hierarchy.nodes.first().map(NodeRecord::bounds)
    }

    /// Estimates the memory of a mesh with this number of triangles. It is correct to a factor of 1.5 for a
    /// thousand triangles or more.
    pub fn memory(triangles: usize) -> RayMemory {
        let triangles = triangles as u64;
        let corners = size_of::<Corners>() as u64;
        let [building, kept] = [size_of::<Bvh2Node>(), size_of::<NodeRecord>()].map(|bytes| bytes as u64);
        let index = size_of::<u32>() as u64;
        let building = corners + NODES_BUILDING * building + CODE + 2 * index;
        let gpu = 3 * size_of::<TriangleRecord>() as u64 + NODES_KEPT_FOR_3 * kept;
        let of = |bytes: u64| triangles.saturating_mul(bytes);
        RayMemory { building: of(building), kept: of(gpu + 9 * index) / 3, gpu: of(gpu) / 3 }
    }

    /// Returns the vertices of a triangle by its index.
    pub(crate) fn vertices_of(&self, triangle: u32) -> [u32; 3] {
        let following = [0, 1, 2].map(|corner| triangle * 3 + corner);
        self.indices.get(triangle as usize).copied().unwrap_or(following)
    }
}

/// Corners of a triangle, all zero if one of them is not finite.
struct Corners([Vec3; 3]);

impl Corners {
    fn new(corners: [Vec3; 3]) -> Self {
        Self(if corners.iter().all(|corner| corner.is_finite()) { corners } else { [Vec3::ZERO; 3] })
    }
}

impl Boundable for Corners {
    fn aabb(&self) -> Aabb {
        Aabb::from_points(&self.0.map(Vec3A::from))
    }
}
