//! Hierarchies with four children per node, stored breadth first. The nodes of a level are consecutive, and
//! children come after their parents, so one dispatch refits a level and one backward pass refits all levels.
//! The loads of nodes limit the speed of a ray, and four children halve their number.

use glam::Vec3;
use obvhs::bvh2::{Bvh2, leaf_collapser::collapse, reinsertion::ReinsertionOptimizer};
use obvhs::ploc::PlocBuilder;
use obvhs::{Boundable, BvhBuildParams};

use crate::records::{NO_ROOT, NodeRecord};

/// Consecutive places for the children of a node. Places without a child hold [`NodeRecord::NONE`].
pub(crate) const WIDTH: usize = 4;

/// Greatest number of primitives in a leaf. Shaders pack it into five bits.
const MAX_LEAF: u32 = 31;

/// Greatest number of levels of a built hierarchy. A refit needs one dispatch per level.
const MAX_LEVELS: usize = 64;

/// Nodes breadth first, in groups of [`WIDTH`] places. The first group holds only the root. Each other group
/// holds the children of a node.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hierarchy {
    /// The nodes. Their boxes may be unfitted.
    pub(crate) nodes: Vec<NodeRecord>,
    /// First node of each level, the root's first.
    pub(crate) levels: Vec<u32>,
    /// Greatest number of nodes on the stack of a ray, from [`Self::fit_stack`].
    pub(crate) stack: usize,
}

/// Builds a hierarchy over boxes, empty without boxes. If many boxes coincide, the hierarchy by `obvhs` may
/// have too many levels. It is then built by halving the list.
pub(crate) fn build<T: Boundable>(boxes: &[T], params: BvhBuildParams, max_stack: usize) -> (Hierarchy, Vec<u32>) {
    if boxes.is_empty() {
        return Default::default();
    }
    let bvh = build_bvh2(boxes, params);
    let mut hierarchy = Hierarchy::new(&bvh);
    if hierarchy.levels.len() > MAX_LEVELS {
        hierarchy = Hierarchy::halves(boxes.len() as u32, params.max_prims_per_leaf);
    }
    hierarchy.fit_stack(max_stack);
    (hierarchy, bvh.primitive_indices)
}

/// Builds a binary hierarchy as `obvhs::bvh2::builder::build_bvh2` does, but without reading the clock.
/// Browsers lack that clock, and reading it would end the program.
pub fn build_bvh2<T: Boundable>(boxes: &[T], params: BvhBuildParams) -> Bvh2 {
    let indices = (0..boxes.len() as u32).collect();
    let mut bvh = PlocBuilder::with_capacity(boxes.len()).build(
        params.ploc_search_distance,
        boxes,
        indices,
        params.sort_precision,
        params.search_depth_threshold,
    );
    let mut optimizer = ReinsertionOptimizer::default();
    optimizer.run(&mut bvh, params.reinsertion_batch_ratio, None);
    collapse(&mut bvh, params.max_prims_per_leaf.clamp(1, 255), params.collapse_traversal_cost);
    let ratio = params.reinsertion_batch_ratio * params.post_collapse_reinsertion_batch_ratio_multiplier;
    optimizer.run(&mut bvh, ratio, None);
    bvh
}

/// A node of a binary hierarchy.
#[derive(Clone, Copy)]
struct Part {
    /// The node. Its `first` is an index in the binary hierarchy.
    node: NodeRecord,
    /// Share of the rays that hit it, in any unit.
    size: f64,
    /// Number of primitives, from `first` on, of an inner node without child nodes in the binary hierarchy. 0
    /// for others.
    range: u32,
}

impl Part {
    /// Returns the part that holds a range of primitives. It is a leaf unless there are too many primitives.
    fn of_range(node: NodeRecord, [first, end]: [u32; 2], per_leaf: u32) -> Self {
        let length = end - first;
        let (count, range) = if length <= per_leaf { (length, 0) } else { (0, length) };
        Self { node: NodeRecord { count, first, ..node }, size: f64::from(length), range }
    }

    /// Returns both halves of its primitives.
    fn halves(&self, per_leaf: u32) -> [Self; 2] {
        let [first, end] = [self.node.first, self.node.first + self.range];
        let middle = first + (end - first) / 2;
        [[first, middle], [middle, end]].map(|range| Self::of_range(self.node, range, per_leaf))
    }

    /// Returns the children of its node, largest first. Starts with both halves, and replaces the largest one
    /// by its halves while there is room. Blocked rays then test large boxes first, which block more rays.
    fn children(&self, halves: impl Fn(&Self) -> [Self; 2]) -> [Option<Self>; WIDTH] {
        let mut children = halves(self).to_vec();
        while children.len() < WIDTH {
            let inner = children.iter().enumerate().filter(|(_, child)| child.node.count == 0);
            let Some((largest, _)) = inner.max_by(|a, b| a.1.size.total_cmp(&b.1.size)) else { break };
            let pair = halves(&children.swap_remove(largest));
            children.extend(pair);
        }
        children.sort_by(|a, b| b.size.total_cmp(&a.size));
        let mut children = children.into_iter();
        [0; WIDTH].map(|_| children.next())
    }
}

impl Hierarchy {
    /// Converts the nodes of a binary hierarchy. Leaves keep their primitives unless they have too many.
    pub(crate) fn new(bvh: &Bvh2) -> Self {
        let part = |index: u32| {
            let node = &bvh.nodes[index as usize];
            let [least, most] = [node.aabb().min, node.aabb().max].map(|corner| Vec3::from(corner).to_array());
            let record = NodeRecord { least, count: 0, most, first: node.first_index };
            let size = record.half_area();
            if node.prim_count > 0 {
                let range = [node.first_index, node.first_index + node.prim_count];
                return Part { size, ..Part::of_range(record, range, MAX_LEAF) };
            }
            Part { node: record, size, range: 0 }
        };
        let halves = |of: &Part| match of.range {
            0 => [part(of.node.first), part(of.node.first + 1)],
            _ => of.halves(MAX_LEAF),
        };
        if bvh.nodes.is_empty() { Self::default() } else { Self::breadth_first(part(0), halves) }
    }

    /// Builds a hierarchy that halves a list of primitives, whose order keeps neighbours together.
    fn halves(primitives: u32, per_leaf: u32) -> Self {
        let root = Part::of_range(NodeRecord::default(), [0, primitives], per_leaf);
        Self::breadth_first(root, |of| of.halves(per_leaf))
    }

    /// Orders the nodes breadth first and fills each with up to [`WIDTH`] children.
    fn breadth_first(root: Part, halves: impl Fn(&Part) -> [Part; 2]) -> Self {
        let (mut nodes, mut levels) = (Vec::new(), Vec::new());
        let mut level = vec![[Some(root), None, None, None]];
        while !level.is_empty() {
            levels.push(nodes.len() as u32);
            let end = nodes.len() + level.len() * WIDTH;
            let mut below = Vec::new();
            for place in level.into_iter().flatten() {
                let mut node = place.map_or(NodeRecord::NONE, |part| part.node);
                if let Some(part) = place.filter(|part| part.node.count == 0) {
                    node.first = (end + below.len() * WIDTH) as u32;
                    below.push(part.children(&halves));
                }
                nodes.push(node);
            }
            level = below;
        }
        Self { nodes, levels, stack: 0 }
    }

    /// Measures the stack of a ray that follows the largest child first. If it exceeds `most`, reorders the
    /// children of all nodes by their own stack, shortest first. A stack of n nodes then needs at least 1.58ⁿ
    /// leaves (R. Sethi, J. D. Ullman, "The generation of optimal code for arithmetic expressions", 1970, for
    /// four operands).
    pub(crate) fn fit_stack(&mut self, most: usize) {
        self.stack = stack(&mut self.nodes, |_| ());
        if self.stack > most {
            self.stack = stack(&mut self.nodes, |group| group.sort_by_key(|(below, node)| (node.is_none(), *below)));
        }
    }

    /// Fits all boxes. `leaf` returns the box of a leaf's primitives.
    pub(crate) fn fit(&mut self, leaf: impl Fn(std::ops::Range<usize>) -> [Vec3; 2]) {
        for index in (0..self.nodes.len()).rev() {
            let node = self.nodes[index];
            let first = node.first as usize;
            let bounds = match node.count {
                _ if node.is_none() => continue,
                0 => around(&self.nodes[first..first + WIDTH]),
                count => leaf(first..first + count as usize),
            };
            self.nodes[index].set_bounds(bounds);
        }
    }
}

/// Returns the greatest number of nodes on the stack of a ray that follows its first hit child and keeps the
/// others. `reorder` may reorder each group of nodes. It gets each node with the stack that its children
/// need.
fn stack(nodes: &mut [NodeRecord], reorder: impl Fn(&mut [(usize, NodeRecord); WIDTH])) -> usize {
    let mut stacks = vec![0; nodes.len()];
    for first in (0..nodes.len()).step_by(WIDTH).rev() {
        let mut group = [(0, NodeRecord::NONE); WIDTH];
        for (place, node) in group.iter_mut().zip(&nodes[first..]) {
            let below = if node.count > 0 || node.is_none() { 0 } else { node.first as usize };
            let children = nodes[below..][..WIDTH].iter().filter(|child| below > 0 && !child.is_none()).count();
            let stack = stacks[below..below + children].iter().rev().enumerate().map(|(later, stack)| later + stack);
            *place = (stack.max().unwrap_or_default(), *node);
        }
        reorder(&mut group);
        for (index, (stack, node)) in (first..).zip(group) {
            (stacks[index], nodes[index]) = (stack, node);
        }
    }
    stacks.first().copied().unwrap_or_default()
}

/// Returns the box around two boxes.
pub(crate) fn union(a: [Vec3; 2], b: [Vec3; 2]) -> [Vec3; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// Returns the box around the children in a group of nodes.
pub(crate) fn around(group: &[NodeRecord]) -> [Vec3; 2] {
    let children = group.iter().filter(|node| !node.is_none());
    let empty = [Vec3::INFINITY, Vec3::NEG_INFINITY];
    children.fold(empty, |bounds, child| union(bounds, child.bounds()))
}

impl NodeRecord {
    /// A place without a node.
    pub(crate) const NONE: Self = Self { least: [0.0; 3], count: 0, most: [0.0; 3], first: NO_ROOT };

    /// Returns whether this is a place without a node.
    pub(crate) fn is_none(&self) -> bool {
        self.first == NO_ROOT
    }

    /// Returns the least and greatest corner of its box.
    pub(crate) fn bounds(&self) -> [Vec3; 2] {
        [self.least.into(), self.most.into()]
    }

    pub(crate) fn set_bounds(&mut self, [least, most]: [Vec3; 2]) {
        (self.least, self.most) = (least.into(), most.into());
    }

    /// Returns half of the surface area of its box, in square metres.
    pub(crate) fn half_area(&self) -> f64 {
        let [least, most] = self.bounds();
        let size = (most - least).as_dvec3();
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use obvhs::aabb::Aabb;

    /// Returns boxes along a diagonal.
    fn boxes(place: impl Fn(f32) -> f32) -> Vec<Aabb> {
        (0..200u8).map(|number| Aabb::from_point((Vec3::ONE * place(number.into())).into())).collect()
    }

    const PARAMS: BvhBuildParams = BvhBuildParams { max_prims_per_leaf: 2, ..BvhBuildParams::medium_build() };

    #[test]
    fn hierarchies_have_every_box_once_in_few_levels_and_children_after_their_parents() {
        for apart in [1.0, 0.0] {
            let (mut hierarchy, order) = build(&boxes(|number| number * apart), PARAMS, 40);
            assert!(hierarchy.levels.len() <= MAX_LEVELS, "{apart}: {}", hierarchy.levels.len());
            let nodes = hierarchy.nodes.clone();
            let leaves = nodes.iter().filter(|node| node.count > 0);
            let mut met: Vec<_> = leaves.flat_map(|leaf| leaf.first..leaf.first + leaf.count).collect();
            met.sort_unstable();
            assert!(met.into_iter().eq(0..200));
            hierarchy.fit(|slots| {
                let points = order[slots].iter().map(|index| Vec3::ONE * *index as f32);
                points.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |bounds, at| union(bounds, [at; 2]))
            });
            assert_eq!(hierarchy.nodes[0].bounds(), [Vec3::ZERO, Vec3::ONE * 199.0]);
            let is_after = |(index, node): (usize, &NodeRecord)| node.count > 0 || node.first as usize > index;
            assert!(hierarchy.nodes.iter().enumerate().all(is_after));
        }
    }

    /// Returns the longest stack of a ray that hits all boxes, and the number of primitives that it reaches.
    fn walk(hierarchy: &Hierarchy) -> (usize, u32) {
        let (mut longest, mut met, mut waiting) = (0, 0, vec![0]);
        while let Some(index) = waiting.pop() {
            let node = hierarchy.nodes[index];
            met += node.count;
            if node.count == 0 && !node.is_none() {
                let first = node.first as usize;
                waiting.extend((first..first + WIDTH).rev().filter(|child| !hierarchy.nodes[*child].is_none()));
                longest = longest.max(waiting.len() - 1);
            }
        }
        (longest, met)
    }

    #[test]
    fn the_stack_of_a_ray_is_known_and_another_order_of_children_shortens_it() {
        // Each box is farther from the others than they are from each other, so that inner nodes are on one
        // side only.
        let lopsided = boxes(|number| 1.1_f32.powf(number));
        let [largest_first, shortest_first] = [200, 0].map(|most| build(&lopsided, PARAMS, most).0);
        for hierarchy in [&largest_first, &shortest_first] {
            assert_eq!(walk(hierarchy), (hierarchy.stack, 200));
        }
        assert!(shortest_first.stack < largest_first.stack, "{} {}", shortest_first.stack, largest_first.stack);
        // 1.58 to the tenth is a hundred leaves or more.
        assert!(shortest_first.stack <= 11, "{}", shortest_first.stack);
    }
}
