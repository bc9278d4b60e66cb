//! Memory that a tracer needs, estimated before it is built.
//!
//! The estimate follows from the structures of the `obvhs` crate. A test compares it with the allocator's
//! counts.

use glam::Vec3;
use obvhs::bvh2::node::Bvh2Node;

/// Nodes per triangle while the hierarchy is built: two for the tree of single triangles, and one in each of
/// the two lists between which the builder moves nodes that are not joined yet.
const NODES_BUILDING: u64 = 4;
/// Bytes per triangle of the builder's sort keys: a code along a space-filling curve, with its index.
const CODE: u64 = size_of::<[u128; 2]>() as u64;
/// Lists of triangle indices while the hierarchy is built.
const INDICES_BUILDING: u64 = 2;
/// Nodes per three triangles afterwards. Leaves hold about three triangles, and there are twice as many nodes
/// as leaves. Measured: 1.5 to 2.3, more if fewer triangles share edges.
const NODES_KEPT_FOR_3: u64 = 2;

/// Memory that a tracer needs, in bytes, without its cut-outs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TracerMemory {
    /// Peak while the tracer is built, including the memory that is kept.
    pub building: u64,
    /// Memory that is kept once the tracer is built.
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
