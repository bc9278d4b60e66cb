//! How much memory a tracer needs, estimated before it is built.
//!
//! It follows from the structures of the `obvhs` crate, and a test compares it with what the allocator
//! counts.

use glam::Vec3;
use obvhs::bvh2::node::Bvh2Node;

/// Nodes for each triangle while the hierarchy is built: two for the tree of single triangles, and one
/// in each of the two lists between which the builder moves what is not joined yet.
const NODES_BUILDING: u64 = 4;
/// Bytes for each triangle of what the builder sorts: a code along a space-filling curve, with its
/// index.
const CODE: u64 = size_of::<[u128; 2]>() as u64;
/// Lists of triangles' indices while the hierarchy is built.
const INDICES_BUILDING: u64 = 2;
/// Nodes for every three triangles afterwards: leaves hold about three triangles, and there are twice
/// as many nodes as leaves. Measured: 1.5 to 2.3, more where fewer triangles share edges.
const NODES_KEPT_FOR_3: u64 = 2;

/// Memory that a tracer needs, in bytes, its cut-outs not included.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TracerMemory {
    /// Peak while it is built, including what stays.
    pub building: u64,
    /// What is kept once it is built.
    pub kept: u64,
}

impl TracerMemory {
    pub(crate) fn of(triangles: usize) -> Self {
        let triangles = triangles as u64;
        let [triangle, node, index] =
            [size_of::<[Vec3; 3]>(), size_of::<Bvh2Node>(), size_of::<u32>()].map(|bytes| bytes as u64);
        let building = triangle + NODES_BUILDING * node + CODE + INDICES_BUILDING * index;
        let kept = 3 * (triangle + index) + NODES_KEPT_FOR_3 * node;
        Self { building: triangles.saturating_mul(building), kept: triangles.saturating_mul(kept) / 3 }
    }
}
