//! Limits on the amount that a scene draws. Nodes and rows of tables share meshes, so a small file can ask for any amount.

use super::accessor::Reader;
use crate::Mesh;
use crate::error::Problem;

/// Triangles that a scene may draw.
const MAX_TRIANGLES: u64 = 1 << 26;

/// Primitives that a scene may draw, counted at each node. Each takes a few hundred bytes in memory and on the GPU.
const MAX_PRIMITIVES: u64 = 1 << 21;

/// Counts the meshes that nodes draw, before anything is stored for them.
pub(super) struct Drawn<'a> {
    reader: &'a Reader<'a>,
    triangles: u64,
    primitives: u64,
}

impl<'a> Drawn<'a> {
    /// Counts nothing yet.
    pub(super) fn new(reader: &'a Reader<'a>) -> Self {
        Self { reader, triangles: 0, primitives: 0 }
    }

    /// Counts a mesh that `element` draws `times` times. Refuses the mesh if the scene draws too much with it.
    pub(super) fn add(&mut self, mesh: &Mesh, times: usize, element: &str) -> Result<(), Problem> {
        let triangles: u64 = mesh.primitives.iter().map(|primitive| primitive.indices.len() as u64 / 3).sum();
        // A mesh without primitives still takes a node each time.
        let primitives = mesh.primitives.len().max(1) as u64;
        self.triangles = self.triangles.saturating_add(triangles.saturating_mul(times as u64));
        self.primitives = self.primitives.saturating_add(primitives.saturating_mul(times as u64));
        for (count, max, kind) in
            [(self.triangles, MAX_TRIANGLES, "triangles"), (self.primitives, MAX_PRIMITIVES, "primitives")]
        {
            if count > max {
                let reason = format!("with it the scene draws more than {max} {kind}");
                return Err(Problem::new(element, reason).hint("Split or simplify the scene"));
            }
        }
        self.reader.spend(mesh.targets().saturating_mul(times), &format!("{element}, morph weights"))
    }
}
