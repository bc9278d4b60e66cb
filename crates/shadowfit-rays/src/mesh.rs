//! One mesh's triangles and hierarchy, as plain data: meshes can be built on any threads, and be added to a scene later.

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
    /// In leaf order.
    pub(crate) triangles: Vec<TriangleRecord>,
    pub(crate) cut_outs: Vec<CutOutRecord>,
    /// Vertices of each triangle by its own index; empty where they follow each other.
    indices: Vec<[u32; 3]>,
    pub(crate) vertices: usize,
}

/// Memory that a mesh needs, in bytes, its cut-outs not included.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayMemory {
    /// On the CPU while the [`RayMesh`] is built, at most, including what stays.
    pub building: u64,
    /// Of the finished [`RayMesh`], which may be dropped once it was added to a scene.
    pub kept: u64,
    /// In the buffers of a scene.
    pub gpu: u64,
}

/// Stack up to which the children of a mesh's nodes stay in the best order. What remains of [`STACK`](crate::STACK) suffices
/// for 10¹¹ instances.
const MESH_STACK: usize = 40;
/// Leaves of up to four triangles: with eight a ray takes a tenth longer, and with two nodes take twice the memory.
const BUILD: BvhBuildParams = BvhBuildParams { max_prims_per_leaf: 4, ..BvhBuildParams::medium_build() };
/// Nodes for each triangle while the hierarchy is built: two for the tree of single triangles, and one in each of the two
/// lists between which the builder moves what is not joined yet.
const NODES_BUILDING: u64 = 4;
/// Bytes for each triangle of what the builder sorts: a code along a space-filling curve, with its index.
const CODE: u64 = size_of::<[u128; 2]>() as u64;
/// Nodes for every three triangles afterwards, places without a node included: leaves hold two to three triangles.
/// Measured: 1.9 to 2.3, more where fewer triangles share edges.
const NODES_KEPT_FOR_3: u64 = 2;

impl RayMesh {
    /// Builds the hierarchy of a triangle list: three indices of `positions` a triangle. Positions are in the mesh's own
    /// space. Triangles with non-finite vertices are never met.
    ///
    /// # Errors
    ///
    /// [`RayError::Index`] and [`RayError::Indices`] for indices that are not those of triangles.
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

    /// Builds the hierarchy of triangles that share no vertices: vertex `3 * t + k` is corner `k` of triangle `t`.
    /// Triangles with non-finite vertices are never met.
    ///
    /// # Errors
    ///
    /// [`RayError::Triangles`] for more of them than 2^32 / 3.
    pub fn from_triangles(triangles: impl IntoIterator<Item = [Vec3; 3]>) -> Result<Self, RayError> {
        let corners: Vec<Corners> = triangles.into_iter().map(Corners::new).collect();
        if corners.len() > u32::MAX as usize / 3 {
            return Err(RayError::Triangles(corners.len()));
        }
        let (hierarchy, order) = hierarchy::build(&corners, BUILD, MESH_STACK);
        Ok(Self::of(hierarchy, &order, |triangle| corners[triangle as usize].0))
    }

    /// Takes over a hierarchy that was built, with the corners of each triangle by its own index. Boxes are fitted to
    /// the corners, which may therefore be others than those that it was built for. The hierarchy must not have split
    /// triangles.
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

    /// Sets the triangles with holes, by their own indices, in place of those set before; the last one given for a
    /// triangle counts.
    ///
    /// # Errors
    ///
    /// [`RayError::CutOut`] for a triangle that the mesh does not have.
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

    /// Gives all triangles holes: texture coordinates of each vertex, in the order of the positions, and one material.
    ///
    /// # Errors
    ///
    /// [`RayError::Uvs`] unless there is one for each vertex.
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

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Own index of each triangle in leaf order, the order of [`RayScene::slots`](crate::RayScene::slots).
    pub fn order(&self) -> impl Iterator<Item = u32> {
        self.triangles.iter().map(|triangle| triangle.index)
    }

    /// Least and greatest corner of the box around all triangles, in the mesh's own space; `None` without triangles.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        self.hierarchy.nodes.first().map(NodeRecord::bounds)
    }

    /// Memory that a mesh of this number of triangles will need. It is right to a factor of 1.5 for a thousand triangles
    /// or more.
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

    /// Vertices of a triangle by its own index.
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
