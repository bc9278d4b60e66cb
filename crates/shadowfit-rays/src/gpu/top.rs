//! The hierarchy of the instances: built, and fitted again when some of them have moved.
//!
//! A leaf holds one instance, so that rays are taken into its mesh only where they meet its own box. What cannot be met,
//! because its transform is singular, keeps the box that it had, and its record says that rays pass it by.

use glam::Vec3;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;

use super::pool::Records;
use crate::STACK;
use crate::error::RayError;
use crate::hierarchy::{self, WIDTH, around};
use crate::records::{InstanceRecord, NO_ROOT, NodeRecord};

/// A refitted hierarchy is built again when its cost has grown by more than this factor since it was built. The time of
/// a ray grows about as the cost does, and a frame traces many more rays than a build takes.
const MAX_COST_GROWTH: f64 = 1.5;

/// Unchanged records between two changed ones up to which one upload takes both: they are copied in less time than
/// another upload takes.
const GAP: usize = 256;

/// A build that is twice as fast as that of meshes, since it may be made in any frame; one instance a leaf.
const BUILD: BvhBuildParams = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::fast_build() };

/// What an instance is in a frame: its record and the box around it; `None` where it cannot be met.
pub(crate) type Instance = Option<(InstanceRecord, [Vec3; 2])>;

/// What is never met.
const HIDDEN: InstanceRecord = InstanceRecord {
    row_x: [0.0; 4],
    row_y: [0.0; 4],
    row_z: [0.0; 4],
    root: NO_ROOT,
    sides: 0,
    custom: 0,
    padding: 0,
};

/// The instances' records and their hierarchy, as they are on the GPU after [`Self::upload`].
#[derive(Debug)]
pub(crate) struct TopLevel {
    /// The first group, with the root, is the first one of the buffer of nodes.
    nodes: Vec<NodeRecord>,
    /// Place of the second group in the buffer of nodes.
    base: u32,
    parents: Vec<u32>,
    stack: usize,
    /// Leaf of each instance.
    leaves: Vec<u32>,
    records: Vec<InstanceRecord>,
    /// Sum of the areas of all boxes.
    area: f64,
    /// Cost of a ray when it was built.
    built_cost: f64,
    changed_nodes: Vec<bool>,
    changed_records: Vec<bool>,
}

impl TopLevel {
    /// Places that the nodes of some instances take beside the first group, however often they are built again. A node
    /// with fewer than four children has leaves alone, two or more, and is the child of one with four, so that there are
    /// at most two such nodes for every three instances.
    pub(crate) fn room(instances: usize) -> usize {
        (instances * 2 / 3 + 1) * WIDTH
    }

    /// Builds the hierarchy of instances whose meshes need a stack of up to a length, for nodes from `base` on. Without
    /// instances it has one that is never met.
    pub(crate) fn new(instances: &[Instance], mesh_stack: usize, base: u32) -> Result<Self, RayError> {
        let somewhere = instances.iter().flatten().next().map_or(Vec3::ZERO, |(_, bounds)| bounds[0]);
        let bounds = |instance: &Instance| instance.map_or([somewhere; 2], |(_, bounds)| bounds);
        let record = |instance: &Instance| instance.map_or(HIDDEN, |(record, _)| record);
        let (mut bounds, mut records): (Vec<_>, Vec<_>) =
            instances.iter().map(|instance| (bounds(instance), record(instance))).unzip();
        if bounds.is_empty() {
            (bounds, records) = (vec![[somewhere; 2]], vec![HIDDEN]);
        }
        Self::build(&bounds, records, mesh_stack, base)
    }

    /// Builds the same instances' hierarchy again, where they are now.
    fn rebuilt(&self, mesh_stack: usize) -> Result<Self, RayError> {
        let bounds: Vec<_> = self.leaves.iter().map(|leaf| self.nodes[*leaf as usize].bounds()).collect();
        Self::build(&bounds, self.records.clone(), mesh_stack, self.base)
    }

    fn build(
        bounds: &[[Vec3; 2]],
        records: Vec<InstanceRecord>,
        mesh_stack: usize,
        base: u32,
    ) -> Result<Self, RayError> {
        let boxes: Vec<Aabb> = bounds.iter().map(|[least, most]| Aabb::new((*least).into(), (*most).into())).collect();
        let (mut made, order) = hierarchy::build(&boxes, BUILD, STACK.saturating_sub(mesh_stack));
        let stack = made.stack;
        if stack + mesh_stack > STACK {
            return Err(RayError::TooDeep { top: stack, mesh: mesh_stack, limit: STACK });
        }
        made.fit(|slots| bounds[order[slots.start] as usize]);
        let (mut parents, mut leaves) = (vec![0; made.nodes.len()], vec![0; records.len()]);
        for (index, node) in (0u32..).zip(&mut made.nodes) {
            if node.count > 0 {
                node.first = order[node.first as usize];
                leaves[node.first as usize] = index;
            } else if !node.is_none() {
                parents[node.first as usize..][..WIDTH].fill(index);
                node.first = base + node.first - WIDTH as u32;
            }
        }
        let (changed_nodes, changed_records) = (vec![true; made.nodes.len()], vec![true; records.len()]);
        let area = made.nodes.iter().map(NodeRecord::half_area).sum();
        let nodes = made.nodes;
        let mut top = Self {
            nodes,
            base,
            parents,
            stack,
            leaves,
            records,
            area,
            built_cost: 0.0,
            changed_nodes,
            changed_records,
        };
        top.built_cost = top.cost();
        Ok(top)
    }

    /// Stack that a ray needs, beside that of a mesh.
    pub(crate) fn stack(&self) -> usize {
        self.stack
    }

    /// Number of records.
    pub(crate) fn records(&self) -> u64 {
        self.records.len() as u64
    }

    /// The box around all instances that can be met; around where they were for some frames after one cannot be met any
    /// more. `None` if none can.
    pub(crate) fn bounds(&self) -> Option<[Vec3; 2]> {
        self.records.iter().any(|record| record.root != NO_ROOT).then(|| self.nodes[0].bounds())
    }

    /// Moves an instance; [`Self::refit`] has to follow.
    pub(crate) fn set(&mut self, index: usize, instance: Instance) {
        let record = instance.map_or(HIDDEN, |(record, _)| record);
        if self.records[index] != record {
            self.records[index] = record;
            self.changed_records[index] = true;
        }
        if let Some((_, bounds)) = instance {
            self.set_bounds(self.leaves[index] as usize, bounds);
        }
    }

    /// Fits the boxes above those that have changed, and builds the hierarchy again where a ray through the fitted one
    /// would cost much more than when it was built. `mesh_stack` is the longest one of their meshes.
    pub(crate) fn refit(&mut self, mesh_stack: usize) {
        // Children come after their parents.
        for index in (0..self.nodes.len()).rev() {
            let node = &self.nodes[index];
            if self.changed_nodes[index] && node.count == 0 && !node.is_none() {
                let bounds = around(&self.nodes[(node.first - self.base) as usize + WIDTH..][..WIDTH]);
                self.changed_nodes[index] = false;
                self.set_bounds(index, bounds);
            }
        }
        // A fitted hierarchy is slow and right; the better one may be too deep.
        if self.cost() > self.built_cost * MAX_COST_GROWTH
            && let Ok(better) = self.rebuilt(mesh_stack)
        {
            *self = better;
        }
    }

    /// Sets the box of a node, and notes that it and those above it have changed.
    fn set_bounds(&mut self, index: usize, bounds: [Vec3; 2]) {
        let node = &mut self.nodes[index];
        if node.bounds() != bounds {
            self.area -= node.half_area();
            node.set_bounds(bounds);
            self.area += node.half_area();
            self.changed_nodes[index] = true;
            self.changed_nodes[self.parents[index] as usize] = true;
        }
    }

    /// Expected number of boxes that a ray is tested against, by the surface area heuristic.
    fn cost(&self) -> f64 {
        let whole = self.nodes[0].half_area();
        // Without any area all hierarchies cost the same.
        if whole > 0.0 { self.area / whole } else { 0.0 }
    }

    /// Uploads what has changed, and returns its bytes.
    pub(crate) fn upload(&mut self, nodes: &Records, instances: &Records) -> u64 {
        let (root, others) = self.nodes.split_at(WIDTH);
        let (changed_root, changed) = self.changed_nodes.split_at_mut(WIDTH);
        upload(nodes, 0, root, changed_root)
            + upload(nodes, self.base, others, changed)
            + upload(instances, 0, &self.records, &mut self.changed_records)
    }
}

/// Uploads the changed ones of records, in runs, to `target` from place `base` on. Returns their bytes.
fn upload<T: bytemuck::Pod>(target: &Records, base: u32, records: &[T], changed: &mut [bool]) -> u64 {
    let mut bytes = 0;
    let mut from = 0;
    while let Some(skipped) = changed[from..].iter().position(|changed| *changed) {
        let first = from + skipped;
        let mut end = first + 1;
        while let Some(last) = changed[end..].iter().take(GAP).rposition(|changed| *changed) {
            end += last + 1;
        }
        target.write(base + first as u32, &records[first..end]);
        bytes += size_of_val(&records[first..end]) as u64;
        changed[first..end].fill(false);
        from = end;
    }
    bytes
}
