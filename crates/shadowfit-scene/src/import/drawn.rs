//! Limits on the amount that a scene draws. Nodes and rows of instance tables share meshes, so a small file
//! can request any amount.

use super::accessor::Reader;
use crate::Mesh;
use crate::error::Problem;

/// Triangles that a scene may draw.
const TRIANGLES: Limit = Limit { max: 1 << 26, kind: "triangles" };

/// Primitives that a scene may draw, counted at each node. Each takes a few hundred bytes in memory and on the GPU.
const PRIMITIVES: Limit = Limit { max: 1 << 21, kind: "primitives" };

/// Rows of all instance tables together. Each becomes a node.
const ROWS: Limit = Limit { max: 1 << 20, kind: "rows of tables" };

/// Primitives with morph targets drawn by table rows. Each has its own vertices, in its own GPU buffers.
const MORPHED: Limit = Limit { max: 1 << 14, kind: "primitives with morph targets by tables" };

/// The greatest amount of a kind that a scene may draw.
struct Limit {
    max: u64,
    kind: &'static str,
}

/// Counts the meshes that nodes draw, before anything is stored for them.
pub(super) struct Drawn<'a> {
    reader: &'a Reader<'a>,
    triangles: u64,
    primitives: u64,
    rows: u64,
    morphed: u64,
}

impl<'a> Drawn<'a> {
    /// Starts with zero counts.
    pub(super) fn new(reader: &'a Reader<'a>) -> Self {
        Self { reader, triangles: 0, primitives: 0, rows: 0, morphed: 0 }
    }

    /// Counts a mesh that `element` draws `times` times. Fails if the scene then draws too much.
    pub(super) fn add(&mut self, mesh: &Mesh, times: usize, element: &str) -> Result<(), Problem> {
        let triangles = mesh.primitives.iter().map(|primitive| primitive.indices.len() as u64 / 3).sum();
        // A mesh without primitives still needs a node each time.
        let primitives = mesh.primitives.len().max(1) as u64;
        TRIANGLES.count(&mut self.triangles, triangles, times, element)?;
        PRIMITIVES.count(&mut self.primitives, primitives, times, element)?;
        self.reader.spend(mesh.targets().saturating_mul(times), &format!("{element}, morph weights"))
    }

    /// Counts a mesh that `rows` rows of a table draw instead of their node, which is counted already.
    pub(super) fn add_rows(&mut self, mesh: &Mesh, rows: usize, element: &str) -> Result<(), Problem> {
        let morphed = || mesh.primitives.iter().filter(|primitive| !primitive.morphs.is_empty());
        let primitives = morphed().count() as u64;
        ROWS.count(&mut self.rows, 1, rows, element)?;
        MORPHED.count(&mut self.morphed, primitives, rows, element)?;
        let vertices = morphed().map(|primitive| primitive.positions.len()).fold(0, usize::saturating_add);
        self.reader.spend(vertices.saturating_mul(rows), element)?;
        self.add(mesh, rows.saturating_sub(1), element)
    }
}

impl Limit {
    /// Adds an amount, drawn `times` times, to a sum. Fails if the sum exceeds the limit.
    fn count(&self, sum: &mut u64, amount: u64, times: usize, element: &str) -> Result<(), Problem> {
        *sum = sum.saturating_add(amount.saturating_mul(times as u64));
        if *sum <= self.max {
            return Ok(());
        }
        let reason = format!("the scene then draws more than {} {}", self.max, self.kind);
        Err(Problem::new(element, reason).hint("Split or simplify the scene"))
    }
}
