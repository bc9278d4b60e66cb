//! The records of a mesh in the buffers of a scene.

use core::ops::Range;

use crate::hierarchy::WIDTH;
use crate::mesh::RayMesh;
use crate::records::{NO_ROOT, packed};

/// Ranges of a mesh in the buffers of all nodes, triangles and cut-outs.
#[derive(Clone, Debug, Default)]
pub(crate) struct MeshRanges {
    pub(crate) nodes: Range<u32>,
    pub(crate) triangles: Range<u32>,
    pub(crate) cut_outs: Range<u32>,
}

impl MeshRanges {
    /// Returns the packed root of the mesh.
    pub(crate) fn root(&self) -> u32 {
        match self.nodes.len() {
            0 => NO_ROOT,
            // The root is a leaf.
            WIDTH => packed(self.triangles.len() as u32, self.triangles.start),
            _ => packed(0, self.nodes.start + WIDTH as u32),
        }
    }

    /// Returns whether the records of a mesh fill the ranges exactly.
    pub(crate) fn fit(&self, mesh: &RayMesh) -> bool {
        [self.nodes.len(), self.triangles.len(), self.cut_outs.len()]
            == [mesh.hierarchy.nodes.len(), mesh.triangles.len(), mesh.cut_outs.len()]
    }
}
