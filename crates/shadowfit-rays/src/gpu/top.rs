//! The hierarchy of the instances. It is refitted when some of them have moved.
//!
//! A leaf holds one instance, so rays enter its mesh only if they hit its own box. An instance that rays
//! cannot hit, because its transform is singular, keeps its last box, and its record marks it as skipped.

use glam::Vec3;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;

use super::pool::Records;
use crate::STACK;
use crate::error::RayError;
use crate::hierarchy::{self, WIDTH, around};
use crate::records::{InstanceRecord, NO_ROOT, NodeRecord};

/// Growth of the cost since the last build above which the hierarchy is rebuilt. The time of a ray is roughly
/// proportional to the cost, and the rays of a frame take much longer than a build.
const MAX_COST_GROWTH: f64 = 1.5;

/// Greatest number of unchanged records between two changed ones that share an upload. Copying them takes
/// less time than another upload.
const GAP: usize = 256;

/// Build parameters, twice as fast as for meshes, since any frame may build. One instance per leaf.
const BUILD: BvhBuildParams = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::fast_build() };

/// An instance in a frame: its record and its box. `None` if rays cannot hit it.
pub(crate) type Instance = Option<(InstanceRecord, [Vec3; 2])>;

/// Record of an instance that rays skip.
const HIDDEN: InstanceRecord = InstanceRecord {
    row_x: [0.0; 4],
    row_y: [0.0; 4],
    row_z: [0.0; 4],
    root: NO_ROOT,
    sides: 0,
    custom: 0,
    padding: 0,
};

/// The instances' records and their hierarchy, as on the GPU after [`Self::upload`].
#[derive(Debug)]
pub(crate) struct TopLevel {
    /// Nodes. The first group, with the root, is the first group of the node buffer.
    nodes: Vec<NodeRecord>,
    /// Place of the second group in the node buffer.
    base: u32,
    parents: Vec<u32>,
    stack: usize,
    /// Leaf of each instance.
    leaves: Vec<u32>,
    records: Vec<InstanceRecord>,
    /// Sum of the surface areas of all boxes.
    area: f64,
    /// Cost of a ray at the last build.
    built_cost: f64,
    changed_nodes: Vec<bool>,
    changed_records: Vec<bool>,
}

impl TopLevel {
    /// Returns the number of places for the nodes of some instances, without the first group. It is enough
    /// for any rebuild. A node with fewer than four children has only leaves, at least two, and its parent
    /// has four children. So there are at most two inner nodes per three instances.
    pub(crate) fn room(instances: usize) -> usize {
        (instances * 2 / 3 + 1) * WIDTH
    }

    /// Builds the hierarchy of instances, for nodes from `base` on. `mesh_stack` is the longest stack of
    /// their meshes. Without instances it holds one that rays skip.
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

    /// Builds the hierarchy of the same instances again, at their current places.
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

    /// Returns the stack for a ray, without the stack for a mesh.
    pub(crate) fn stack(&self) -> usize {
        self.stack
    }

    /// Returns the number of records.
    pub(crate) fn records(&self) -> u64 {
        self.records.len() as u64
    }

    /// Returns the box around all instances that rays can hit, or `None` if there are none. After an instance
    /// becomes hidden, its old place may remain in the box for some frames.
    pub(crate) fn bounds(&self) -> Option<[Vec3; 2]> {
        self.records.iter().any(|record| record.root != NO_ROOT).then(|| self.nodes[0].bounds())
    }

    /// Moves an instance. Call [`Self::refit`] afterwards.
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

    /// Fits the boxes above changed boxes. Rebuilds the hierarchy if a ray would cost much more than after
    /// the last build. `mesh_stack` is the longest stack of the meshes.
    pub(crate) fn refit(&mut self, mesh_stack: usize) {
        // Children come after their parents, so a backward pass fits all boxes.
        for index in (0..self.nodes.len()).rev() {
            let node = &self.nodes[index];
            if self.changed_nodes[index] && node.count == 0 && !node.is_none() {
                let bounds = around(&self.nodes[(node.first - self.base) as usize + WIDTH..][..WIDTH]);
                self.changed_nodes[index] = false;
                self.set_bounds(index, bounds);
            }
        }
        // A refitted hierarchy is slow but correct. The rebuilt one may exceed the stack.
        if self.cost() > self.built_cost * MAX_COST_GROWTH
            && let Ok(better) = self.rebuilt(mesh_stack)
        {
            *self = better;
        }
    }

    /// Sets the box of a node, and marks the node and its parent as changed.
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

    /// Returns the expected number of box tests of a ray, by the surface area heuristic.
    fn cost(&self) -> f64 {
        let whole = self.nodes[0].half_area();
        // Without area, all hierarchies cost the same.
        if whole > 0.0 { self.area / whole } else { 0.0 }
    }

    /// Uploads the changed records and nodes. Returns the number of bytes.
    pub(crate) fn upload(&mut self, nodes: &Records, instances: &Records) -> u64 {
        let (root, others) = self.nodes.split_at(WIDTH);
        let (changed_root, changed) = self.changed_nodes.split_at_mut(WIDTH);
        upload(nodes, 0, root, changed_root)
            + upload(nodes, self.base, others, changed)
            + upload(instances, 0, &self.records, &mut self.changed_records)
    }
}

/// Uploads the changed records, in runs, to `target` from place `base` on. Returns the number of bytes.
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
