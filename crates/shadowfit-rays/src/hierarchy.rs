//! Hierarchies breadth first: the nodes of a level stand together and children come after their parents, so that a level
//! can be refitted by one dispatch and all of them by one backward sweep.

use glam::Vec3;
use obvhs::bvh2::{Bvh2, leaf_collapser::collapse, reinsertion::ReinsertionOptimizer};
use obvhs::ploc::PlocBuilder;
use obvhs::{Boundable, BvhBuildParams};

use crate::records::NodeRecord;

/// Nodes breadth first, the root first of all and the two children of a node side by side.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hierarchy {
    /// Their boxes may still have to be fitted.
    pub(crate) nodes: Vec<NodeRecord>,
    /// First node of each level, the root's first.
    pub(crate) levels: Vec<u32>,
}

/// Builds a hierarchy over a number of boxes; none without boxes. What `obvhs` makes of boxes of which many coincide may
/// be deeper than the shaders can follow; then it is built by halves.
pub(crate) fn build<T: Boundable>(boxes: &[T], params: BvhBuildParams, max_depth: usize) -> (Hierarchy, Vec<u32>) {
    if boxes.is_empty() {
        return Default::default();
    }
    let bvh = build_bvh2(boxes, params);
    let hierarchy = Hierarchy::new(&bvh);
    if hierarchy.depth() <= max_depth {
        return (hierarchy, bvh.primitive_indices);
    }
    (Hierarchy::halves(boxes.len() as u32, params.max_prims_per_leaf), bvh.primitive_indices)
}

/// What `obvhs::bvh2::builder::build_bvh2` does, without the clock that it reads: browsers have no such one, and it ends
/// the program there.
fn build_bvh2<T: Boundable>(boxes: &[T], params: BvhBuildParams) -> Bvh2 {
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

impl Hierarchy {
    /// The nodes of a hierarchy, whose leaves stay those of the same primitives.
    pub(crate) fn new(bvh: &Bvh2) -> Self {
        let record = |index: u32| {
            let node = &bvh.nodes[index as usize];
            let [least, most] = [node.aabb().min, node.aabb().max].map(|corner| Vec3::from(corner).to_array());
            (NodeRecord { least, count: node.prim_count, most, first: node.first_index }, [index; 2])
        };
        let children = |node: &NodeRecord, _| {
            let [left, right] = [record(node.first), record(node.first + 1)];
            [left, right]
        };
        if bvh.nodes.is_empty() { Self::default() } else { Self::breadth_first(record(0), children) }
    }

    /// The hierarchy that halves a number of primitives, which are in an order that keeps neighbours together.
    fn halves(primitives: u32, per_leaf: u32) -> Self {
        let node = |range: [u32; 2]| {
            let count = range[1] - range[0];
            let count = if count <= per_leaf { count } else { 0 };
            (NodeRecord { count, first: range[0], ..NodeRecord::default() }, range)
        };
        let children = |_: &NodeRecord, [first, end]: [u32; 2]| {
            let middle = first + (end - first) / 2;
            [node([first, middle]), node([middle, end])]
        };
        Self::breadth_first(node([0, primitives]), children)
    }

    /// Puts nodes in order, each with what finds its children.
    fn breadth_first(
        root: (NodeRecord, [u32; 2]),
        children: impl Fn(&NodeRecord, [u32; 2]) -> [(NodeRecord, [u32; 2]); 2],
    ) -> Self {
        let (mut nodes, mut levels, mut level) = (vec![root.0], Vec::new(), vec![root.1]);
        while !level.is_empty() {
            let first = nodes.len() - level.len();
            levels.push(first as u32);
            let mut below = Vec::new();
            for (index, source) in (first..).zip(level) {
                if nodes[index].count > 0 {
                    continue;
                }
                let [left, right] = children(&nodes[index], source);
                nodes[index].first = nodes.len() as u32;
                nodes.extend([left.0, right.0]);
                below.extend([left.1, right.1]);
            }
            level = below;
        }
        Self { nodes, levels }
    }

    /// Number of levels.
    pub(crate) fn depth(&self) -> usize {
        self.levels.len()
    }

    /// Fits all boxes, those of leaves to what `leaf` says of their primitives.
    pub(crate) fn fit(&mut self, leaf: impl Fn(std::ops::Range<usize>) -> [Vec3; 2]) {
        for index in (0..self.nodes.len()).rev() {
            let node = self.nodes[index];
            let first = node.first as usize;
            let bounds = match node.count {
                0 => union(self.nodes[first].bounds(), self.nodes[first + 1].bounds()),
                count => leaf(first..first + count as usize),
            };
            self.nodes[index].set_bounds(bounds);
        }
    }
}

/// The box around two boxes.
pub(crate) fn union(a: [Vec3; 2], b: [Vec3; 2]) -> [Vec3; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

impl NodeRecord {
    /// Least and greatest corner of its box.
    pub(crate) fn bounds(&self) -> [Vec3; 2] {
        [self.least.into(), self.most.into()]
    }

    pub(crate) fn set_bounds(&mut self, [least, most]: [Vec3; 2]) {
        (self.least, self.most) = (least.into(), most.into());
    }

    /// Half of the area of its box, in square metres.
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

    #[test]
    fn a_hierarchy_that_would_be_too_deep_is_built_by_halves_and_has_every_box_once() {
        let boxes: Vec<_> = (0..100u8).map(|x| Aabb::from_point(Vec3::new(x.into(), 0.0, 0.0).into())).collect();
        let params = BvhBuildParams { max_prims_per_leaf: 2, ..BvhBuildParams::medium_build() };
        for (max_depth, is_halved) in [(64, false), (1, true)] {
            let (mut hierarchy, order) = build(&boxes, params, max_depth);
            assert!(!is_halved || hierarchy.depth() == 7, "64 leaves of at most two boxes: {}", hierarchy.depth());
            let nodes = hierarchy.nodes.clone();
            let leaves = nodes.iter().filter(|node| node.count > 0);
            let mut met: Vec<_> = leaves.flat_map(|leaf| leaf.first..leaf.first + leaf.count).collect();
            met.sort_unstable();
            assert!(met.into_iter().eq(0..100));
            hierarchy.fit(|slots| {
                let points = order[slots].iter().map(|index| Vec3::X * *index as f32);
                points.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |bounds, at| union(bounds, [at; 2]))
            });
            assert_eq!(hierarchy.nodes[0].bounds(), [Vec3::ZERO, Vec3::X * 99.0]);
            let is_after = |(index, node): (usize, &NodeRecord)| node.count > 0 || node.first as usize > index;
            assert!(hierarchy.nodes.iter().enumerate().all(is_after));
        }
    }
}
