//! Parts triangles, again and again where the largest box stands.
//!
//! Binned splits by surface area (Wald, Ingo: "On fast construction of SAH-based bounding volume
//! hierarchies", 2007), with two differences: no tree is kept, and a half costs its box's area
//! alone, not times its triangles, because a fit looks at each box once, whatever is in it.

use alloc::collections::BinaryHeap;
use alloc::vec::Vec;
use core::cmp::Ordering;

use glam::Vec3;

use crate::Aabb;

/// Slabs that a box is cut into along each axis; a split is tried between each two.
const BINS: usize = 32;

/// A triangle, known by its box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reference {
    aabb: Aabb,
    pub(super) object: u32,
    pub(super) triangle: u32,
}

impl Reference {
    pub(super) fn new(object: u32, triangle: u32, [a, b, c]: &[Vec3; 3]) -> Self {
        Self { aabb: Aabb { min: a.min(*b).min(*c), max: a.max(*b).max(*c) }, object, triangle }
    }

    /// Twice the middle of its box.
    fn centre(&self) -> Vec3 {
        self.aabb.min + self.aabb.max
    }
}

/// References `start..end` of one object that may be split further.
#[derive(Clone, Copy, Debug)]
struct Node {
    start: usize,
    end: usize,
    /// Half the surface of the box.
    area: f32,
}

impl Node {
    fn new(start: usize, end: usize, aabb: &Aabb) -> Self {
        Self { start, end, area: half_area(aabb) }
    }
}

impl Ord for Node {
    /// The larger area is greater; of equal ones that which comes first.
    fn cmp(&self, other: &Self) -> Ordering {
        self.area.total_cmp(&other.area).then(other.start.cmp(&self.start))
    }
}

impl PartialOrd for Node {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Node {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Node {}

/// Sorts references, given object by object, into groups: at most `limit` of them, or one for each
/// object. Gives where each group ends.
pub(super) fn split(references: &mut [Reference], limit: usize) -> Vec<usize> {
    let mut open = BinaryHeap::new();
    let mut start = 0;
    for object in references.chunk_by(|a, b| a.object == b.object) {
        let aabb = object.iter().fold(Aabb::EMPTY, |aabb, reference| aabb.union(reference.aabb));
        open.push(Node::new(start, start + object.len(), &aabb));
        start += object.len();
    }
    let mut ends = Vec::with_capacity(limit.min(references.len()));
    while open.len() + ends.len() < limit {
        let Some(node) = open.pop() else { break };
        match Bins::fill(&node, references).best() {
            Some(plane) => open.extend(part(&node, &plane, references)),
            None => ends.push(node.end),
        }
    }
    ends.extend(open.into_iter().map(|node| node.end));
    ends.sort_unstable();
    ends
}

/// A place to part a node: by the slabs of one axis.
#[derive(Clone, Copy, Debug)]
struct Plane {
    axis: usize,
    /// Centres in slabs below this one go to the first half.
    slab: usize,
    slabs: Slabs,
}

/// How centres are sorted into slabs.
#[derive(Clone, Copy, Debug)]
struct Slabs {
    min: Vec3,
    per_unit: Vec3,
}

impl Slabs {
    fn of(&self, centre: Vec3) -> [usize; 3] {
        // Not a number, from zero times infinity where the extent is tiny, becomes slab 0.
        ((centre - self.min) * self.per_unit).to_array().map(|slab| (slab as usize).min(BINS - 1))
    }
}

/// Number and box of the references in each slab.
struct Bins {
    slabs: Slabs,
    is_used: [bool; 3],
    counts: [[usize; BINS]; 3],
    boxes: [[Aabb; BINS]; 3],
}

impl Bins {
    fn fill(node: &Node, references: &[Reference]) -> Self {
        let references = &references[node.start..node.end];
        let centres = references.iter().fold(Aabb::EMPTY, |aabb, reference| aabb.with_point(reference.centre()));
        let slabs = Slabs { min: centres.min, per_unit: BINS as f32 / (centres.max - centres.min) };
        let is_used = (centres.max - centres.min).to_array().map(|extent| extent > 0.0);
        let mut bins = Self { slabs, is_used, counts: [[0; BINS]; 3], boxes: [[Aabb::EMPTY; BINS]; 3] };
        for reference in references {
            for (axis, slab) in slabs.of(reference.centre()).into_iter().enumerate() {
                bins.counts[axis][slab] += 1;
                bins.boxes[axis][slab] = bins.boxes[axis][slab].union(reference.aabb);
            }
        }
        bins
    }

    /// The plane with the least sum of the halves' areas, `None` where all centres are one.
    fn best(&self) -> Option<Plane> {
        let mut best: Option<(f32, Plane)> = None;
        for axis in (0..3).filter(|&axis| self.is_used[axis]) {
            let mut above = [Aabb::EMPTY; BINS];
            let mut aabb = Aabb::EMPTY;
            for slab in (0..BINS).rev() {
                aabb = aabb.union(self.boxes[axis][slab]);
                above[slab] = aabb;
            }
            let mut below = Aabb::EMPTY;
            for (slab, above) in above.iter().enumerate().skip(1) {
                below = below.union(self.boxes[axis][slab - 1]);
                if self.counts[axis][slab - 1] == 0 {
                    continue; // the same halves as one slab before
                }
                let cost = half_area(&below) + half_area(above);
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, Plane { axis, slab, slabs: self.slabs }));
                }
            }
        }
        best.map(|(_, plane)| plane)
    }
}

/// Sorts the references of a node to both sides of a plane.
fn part(node: &Node, plane: &Plane, references: &mut [Reference]) -> [Node; 2] {
    let references = &mut references[node.start..node.end];
    let mut halves = [Aabb::EMPTY; 2];
    let mut middle = 0;
    for i in 0..references.len() {
        let reference = references[i];
        let is_first = plane.slabs.of(reference.centre())[plane.axis] < plane.slab;
        let half = &mut halves[usize::from(!is_first)];
        *half = half.union(reference.aabb);
        if is_first {
            references.swap(i, middle);
            middle += 1;
        }
    }
    let middle = node.start + middle;
    [Node::new(node.start, middle, &halves[0]), Node::new(middle, node.end, &halves[1])]
}

/// Half the surface of a box, zero for an empty one.
fn half_area(aabb: &Aabb) -> f32 {
    if aabb.is_empty() {
        return 0.0;
    }
    let size = aabb.max - aabb.min;
    size.x * size.y + size.y * size.z + size.z * size.x
}
