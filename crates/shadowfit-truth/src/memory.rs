//! How much memory a tracer needs, told before it is built.
//!
//! It follows from the structures of the `obvhs` crate, and a test holds it against what the
//! allocator counts.

use obvhs::bvh2::node::Bvh2Node;
use obvhs::triangle::Triangle;

/// Nodes a triangle while the hierarchy is built: two for the tree of single triangles, and one for
/// each of the two lists between which the builder moves what is not yet joined.
const NODES_BUILDING: u64 = 4;
/// Bytes a triangle of what the builder sorts: a code along a space-filling curve, with its index.
const CODE: u64 = size_of::<[u128; 2]>() as u64;
/// Lists of triangles' numbers while the hierarchy is built.
const NUMBERS_BUILDING: u64 = 2;
/// Nodes in three triangles afterwards: leaves hold about three triangles, and there are twice as
/// many nodes as leaves. Measured: 1.5 to 2.3, the more the less the triangles are connected.
const NODES_KEPT_BY_3: u64 = 2;

/// What a tracer needs, in bytes; its cut-outs come on top.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TracerMemory {
    /// While it is built: the most at any time, what is kept included.
    pub building: u64,
    /// Afterwards.
    pub kept: u64,
}

impl TracerMemory {
    pub(crate) fn of(triangles: usize) -> Self {
        let triangles = triangles as u64;
        let [triangle, node, number] =
            [size_of::<Triangle>(), size_of::<Bvh2Node>(), size_of::<u32>()].map(|bytes| bytes as u64);
        let building = triangle + NODES_BUILDING * node + CODE + NUMBERS_BUILDING * number;
        let kept = 3 * (triangle + number) + NODES_KEPT_BY_3 * node;
        Self { building: triangles.saturating_mul(building), kept: triangles.saturating_mul(kept) / 3 }
    }
}
