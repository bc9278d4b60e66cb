//! The nodes of the hierarchy. A node has up to eight boxes, each around the boxes of a child node.
//!
//! ```text
//!   root   ┌─[all of a]─[all of b]─[all of c]─┐     level 1
//!          ▼            ▼           ▼
//!   leaves [1][4][9]    [0][2]      [3][5][6][7]     level 0: numbers of boxes
//! ```
//!
//! A box is inserted where it widens the surrounding boxes least. A full node is cut in two across its
//! longest axis. A node with too few boxes is dissolved, and its boxes are inserted elsewhere. So all leaves
//! have the same level, and each change costs one path from a leaf to the root.
//!
//! Source: A. Guttman, "R-trees: a dynamic index structure for spatial searching", 1984. Differences: full
//! nodes are cut at the median along the longest axis, and a whole list is built at once from the top.

use alloc::vec::Vec;

use glam::Vec3;

use crate::base::Aabb;

/// Greatest number of boxes in a node.
const WIDTH: usize = 8;

/// Nodes with fewer boxes are dissolved.
const FEWEST: usize = 3;

/// No node or no box.
pub(super) const NONE: u32 = u32::MAX;

/// A box in a node, with its number in a leaf or else the index of its child node.
type Entry = (Aabb, u32);

/// A node: boxes that lie close together.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Node {
    boxes: [Aabb; WIDTH],
    ids: [u32; WIDTH],
    parent: u32,
    len: u8,
    /// Number of levels below. 0 for a leaf.
    level: u8,
}

/// All nodes, and the leaf of each box.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Nodes {
    all: Vec<Node>,
    free: Vec<u32>,
    root: u32,
    /// The leaf of each box, by box number.
    leaves: Vec<u32>,
}

impl Node {
    fn new(level: u8) -> Self {
        Self { boxes: [Aabb::EMPTY; WIDTH], ids: [NONE; WIDTH], parent: NONE, len: 0, level }
    }

    fn entries(&self) -> impl Iterator<Item = Entry> {
        self.boxes.into_iter().zip(self.ids).take(usize::from(self.len))
    }

    fn bounds(&self) -> Aabb {
        self.entries().fold(Aabb::EMPTY, |all, (aabb, _)| all.union(aabb))
    }

    fn push(&mut self, (aabb, id): Entry) {
        let slot = usize::from(self.len);
        (self.boxes[slot], self.ids[slot]) = (aabb, id);
        self.len += 1;
    }

    fn slot_of(&self, id: u32) -> Option<usize> {
        self.ids[..usize::from(self.len)].iter().position(|known| *known == id)
    }

    fn remove(&mut self, id: u32) -> Option<Aabb> {
        let slot = self.slot_of(id)?;
        let removed = self.boxes[slot];
        self.len -= 1;
        let last = usize::from(self.len);
        (self.boxes[slot], self.ids[slot]) = (self.boxes[last], self.ids[last]);
        Some(removed)
    }

    /// Returns the slot whose box grows least if it takes in another box.
    fn nearest(&self, aabb: &Aabb) -> usize {
        let mut best = (f32::INFINITY, f32::INFINITY, 0);
        for (slot, around) in self.boxes[..usize::from(self.len)].iter().enumerate() {
            let size = half_area(around);
            let wider = half_area(&around.union(*aabb)) - size;
            if (wider, size) < (best.0, best.1) {
                best = (wider, size, slot);
            }
        }
        best.2
    }
}

/// Returns half of a box's surface area, in square metres.
fn half_area(aabb: &Aabb) -> f32 {
    let size = aabb.max - aabb.min;
    size.x * size.y + size.y * size.z + size.z * size.x
}

/// Returns whether a box holds another one completely.
fn holds(outer: &Aabb, inner: &Aabb) -> bool {
    outer.min.cmple(inner.min).all() && outer.max.cmpge(inner.max).all()
}

/// Partitions boxes at the index `middle` along the axis of the greatest distance between their centres. The
/// boxes with the lower centres come first.
fn cut(entries: &mut [Entry], middle: usize) {
    let centre = |entry: &Entry| entry.0.min + entry.0.max;
    let (low, high) =
        entries.iter().map(centre).fold((Vec3::MAX, Vec3::MIN), |(low, high), p| (low.min(p), high.max(p)));
    let size = high - low;
    let axis = if size.x >= size.y && size.x >= size.z { 0 } else { 1 + usize::from(size.z > size.y) };
    let order = |a: &Entry, b: &Entry| centre(a)[axis].total_cmp(&centre(b)[axis]).then(a.1.cmp(&b.1));
    if middle < entries.len() {
        entries.select_nth_unstable_by(middle, order);
    }
}

impl Nodes {
    pub(super) const fn new() -> Self {
        Self { all: Vec::new(), free: Vec::new(), root: NONE, leaves: Vec::new() }
    }

    /// Builds the nodes of a whole list. The boxes must not be empty and have different numbers below
    /// `count`.
    pub(super) fn of(entries: &mut [Entry], count: usize) -> Self {
        let mut nodes = Self::new();
        nodes.leaves.resize(count, NONE);
        if !entries.is_empty() {
            let levels = core::iter::successors(Some(WIDTH), |capacity| capacity.checked_mul(WIDTH));
            let level = levels.take_while(|capacity| *capacity < entries.len()).count();
            nodes.root = nodes.build(entries, level as u8);
        }
        nodes
    }

    /// Builds a node from boxes, which must fit into a node of its level. Returns the node's index.
    fn build(&mut self, entries: &mut [Entry], level: u8) -> u32 {
        let index = self.add_node(Node::new(level));
        let each = if level == 0 { 1 } else { WIDTH.pow(u32::from(level)) };
        self.distribute(index, entries, each);
        index
    }

    /// Cuts boxes into groups of at most `each`, and adds the groups to a node.
    fn distribute(&mut self, index: u32, entries: &mut [Entry], each: usize) {
        let groups = entries.len().div_ceil(each);
        if groups > 1 {
            let middle = entries.len() * (groups / 2) / groups;
            cut(entries, middle);
            let (low, high) = entries.split_at_mut(middle);
            self.distribute(index, low, each);
            self.distribute(index, high, each);
            return;
        }
        let level = self.all[index as usize].level;
        let mut entry = entries[0];
        if level > 0 {
            let child = self.build(entries, level - 1);
            entry = (self.all[child as usize].bounds(), child);
        }
        self.all[index as usize].push(entry);
        self.adopt(entry.1, index);
    }

    fn add_node(&mut self, node: Node) -> u32 {
        if let Some(index) = self.free.pop() {
            self.all[index as usize] = node;
            return index;
        }
        self.all.push(node);
        self.all.len() as u32 - 1
    }

    /// Records that a box or child node lies in a node.
    fn adopt(&mut self, id: u32, index: u32) {
        if self.all[index as usize].level == 0 {
            self.leaves[id as usize] = index;
        } else {
            self.all[id as usize].parent = index;
        }
    }

    /// Returns the box with a number, if there is one.
    pub(super) fn get(&self, number: u32) -> Option<Aabb> {
        let leaf = self.all.get(*self.leaves.get(number as usize)? as usize)?;
        leaf.slot_of(number).map(|slot| leaf.boxes[slot])
    }

    /// Returns a box around all boxes.
    pub(super) fn bounds(&self) -> Aabb {
        self.all.get(self.root as usize).map_or(Aabb::EMPTY, Node::bounds)
    }

    /// Adds a box that is not empty under an unused number.
    pub(super) fn insert(&mut self, number: u32, aabb: Aabb) {
        let least = number as usize + 1;
        if self.leaves.len() < least {
            self.leaves.resize(least, NONE);
        }
        self.put((aabb, number), 0);
    }

    /// Inserts a box into a node of a level.
    fn put(&mut self, entry: Entry, level: u8) {
        if self.root == NONE {
            self.root = if level == 0 { self.add_node(Node::new(0)) } else { entry.1 };
            if level > 0 {
                self.all[entry.1 as usize].parent = NONE;
                return;
            }
        }
        let mut index = self.root;
        while self.all[index as usize].level > level {
            let node = &mut self.all[index as usize];
            let slot = node.nearest(&entry.0);
            node.boxes[slot] = node.boxes[slot].union(entry.0);
            index = node.ids[slot];
        }
        self.push(index, entry);
    }

    /// Adds a box to a node whose own box already holds it. Cuts the node in two if it is full.
    fn push(&mut self, index: u32, entry: Entry) {
        let node = &mut self.all[index as usize];
        if usize::from(node.len) < WIDTH {
            node.push(entry);
            self.adopt(entry.1, index);
            return;
        }
        let (parent, level) = (node.parent, node.level);
        let mut entries = [entry; WIDTH + 1];
        entries.iter_mut().zip(node.entries()).for_each(|(to, from)| *to = from);
        cut(&mut entries, WIDTH / 2);
        let other = self.add_node(Node::new(level));
        self.all[index as usize] = Node { parent, ..Node::new(level) };
        for (i, entry) in entries.into_iter().enumerate() {
            let to = if i < WIDTH / 2 { index } else { other };
            self.all[to as usize].push(entry);
            self.adopt(entry.1, to);
        }
        let [first, second] = [index, other].map(|index| (self.all[index as usize].bounds(), index));
        if parent == NONE {
            self.root = self.add_node(Node::new(level + 1));
            self.push(self.root, first);
            self.push(self.root, second);
            return;
        }
        let above = &mut self.all[parent as usize];
        if let Some(slot) = above.slot_of(index) {
            above.boxes[slot] = first.0;
        }
        self.push(parent, second);
    }

    /// Removes the box with a number and returns it.
    pub(super) fn remove(&mut self, number: u32) -> Option<Aabb> {
        let leaf = *self.leaves.get(number as usize)?;
        let removed = self.all.get_mut(leaf as usize)?.remove(number)?;
        self.leaves[number as usize] = NONE;
        self.tighten(leaf);
        Some(removed)
    }

    /// Moves the box with a number.
    pub(super) fn set(&mut self, number: u32, aabb: Aabb) {
        let Some(leaf) = self.leaves.get(number as usize).copied().filter(|leaf| *leaf != NONE) else {
            return self.insert(number, aabb);
        };
        let node = &mut self.all[leaf as usize];
        if let Some(slot) = node.slot_of(number).filter(|_| holds(&node.bounds(), &aabb)) {
            node.boxes[slot] = aabb;
            self.tighten(leaf);
        } else {
            self.remove(number);
            self.insert(number, aabb);
        }
    }

    /// Shrinks the boxes around a node, up to the root, and dissolves nodes with too few boxes.
    fn tighten(&mut self, mut index: u32) {
        loop {
            let node = self.all[index as usize];
            if node.parent == NONE {
                return self.lower_root();
            }
            let above = &mut self.all[node.parent as usize];
            if usize::from(node.len) < FEWEST {
                above.remove(index);
                self.free.push(index);
                self.tighten(node.parent);
                node.entries().for_each(|entry| self.put(entry, node.level));
                return;
            }
            let bounds = node.bounds();
            match above.slot_of(index) {
                Some(slot) if above.boxes[slot] != bounds => above.boxes[slot] = bounds,
                _ => return,
            }
            index = node.parent;
        }
    }

    /// Removes roots with a single child node.
    fn lower_root(&mut self) {
        while let Some(root) = self.all.get(self.root as usize).copied() {
            if root.len > 1 || root.len == 1 && root.level == 0 {
                return;
            }
            self.free.push(self.root);
            self.root = if root.len == 0 { NONE } else { root.ids[0] };
            if let Some(root) = self.all.get_mut(self.root as usize) {
                root.parent = NONE;
            }
        }
    }

    /// Visits boxes from the root down. `enter` gets a box and the context of its parent, and returns the
    /// context of the box or `None` to skip it. `take` gets each reached box of a leaf with its number and
    /// context.
    pub(super) fn visit<C: Copy, S>(
        &self,
        context: C,
        state: &mut S,
        enter: &impl Fn(&mut S, C, &Aabb) -> Option<C>,
        take: &mut impl FnMut(&mut S, C, u32, &Aabb),
    ) {
        if self.root != NONE {
            self.visit_node(self.root, context, state, enter, take);
        }
    }

    fn visit_node<C: Copy, S>(
        &self,
        index: u32,
        context: C,
        state: &mut S,
        enter: &impl Fn(&mut S, C, &Aabb) -> Option<C>,
        take: &mut impl FnMut(&mut S, C, u32, &Aabb),
    ) {
        let node = &self.all[index as usize];
        for (aabb, id) in node.boxes.iter().zip(node.ids).take(usize::from(node.len)) {
            match enter(state, context, aabb) {
                Some(context) if node.level == 0 => take(state, context, id, aabb),
                Some(context) => self.visit_node(id, context, state, enter, take),
                None => {}
            }
        }
    }

    /// Visits boxes from the root down. Boxes without least and greatest `distances` are skipped, and so are
    /// boxes for which `enter` returns false. The boxes of each node are visited in the order of their least
    /// distances.
    pub(super) fn visit_nearest<S>(
        &self,
        state: &mut S,
        distances: &impl Fn(&Aabb) -> Option<(f64, f64)>,
        enter: &impl Fn(&S, (f64, f64), &Aabb) -> bool,
        take: &mut impl FnMut(&mut S, (f64, f64), u32, &Aabb),
    ) {
        if self.root != NONE {
            self.visit_nearest_in(self.root, state, distances, enter, take);
        }
    }

    fn visit_nearest_in<S>(
        &self,
        index: u32,
        state: &mut S,
        distances: &impl Fn(&Aabb) -> Option<(f64, f64)>,
        enter: &impl Fn(&S, (f64, f64), &Aabb) -> bool,
        take: &mut impl FnMut(&mut S, (f64, f64), u32, &Aabb),
    ) {
        let node = &self.all[index as usize];
        let mut order = [((0.0, 0.0), 0); WIDTH];
        let mut count = 0;
        for (slot, aabb) in node.boxes[..usize::from(node.len)].iter().enumerate() {
            let Some(distances) = distances(aabb) else { continue };
            let place = order[..count].iter().position(|(known, _)| distances.0 < known.0).unwrap_or(count);
            order.copy_within(place..count, place + 1);
            order[place] = (distances, slot);
            count += 1;
        }
        for (distances_of_box, slot) in order.into_iter().take(count) {
            let (aabb, id) = (&node.boxes[slot], node.ids[slot]);
            if !enter(state, distances_of_box, aabb) {
                continue;
            }
            if node.level == 0 {
                take(state, distances_of_box, id, aabb);
            } else {
                self.visit_nearest_in(id, state, distances, enter, take);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks every tree's invariants: the boxes around nodes are tight, all leaves have level 0, and each
    /// box lies in its recorded leaf. Returns the number of boxes.
    fn check(nodes: &Nodes) -> usize {
        fn below(nodes: &Nodes, index: u32) -> usize {
            let node = &nodes.all[index as usize];
            assert!(node.len > 0 && usize::from(node.len) <= WIDTH);
            node.entries()
                .map(|(aabb, id)| {
                    if node.level == 0 {
                        assert_eq!(nodes.leaves[id as usize], index);
                        return 1;
                    }
                    let child = &nodes.all[id as usize];
                    assert_eq!((child.parent, child.level + 1), (index, node.level));
                    assert_eq!(child.bounds(), aabb);
                    below(nodes, id)
                })
                .sum()
        }
        let used = nodes.all.len() - nodes.free.len();
        if nodes.root == NONE {
            assert_eq!(used, 0);
            return 0;
        }
        below(nodes, nodes.root)
    }

    /// Returns pseudo-random numbers.
    fn random(state: &mut u64) -> f32 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 40) as f32 / 16_777_216.0
    }

    fn cube(state: &mut u64) -> Aabb {
        let low = Vec3::new(random(state), random(state) * 0.1, random(state)) * 100.0;
        Aabb::new(low, low + random(state) * 3.0)
    }

    #[test]
    fn a_tree_stays_whole_whatever_comes_goes_and_moves() {
        let mut state = 7;
        let mut nodes = Nodes::new();
        let mut known: Vec<Option<Aabb>> = alloc::vec![None; 600];
        for step in 0..12_000 {
            let number = (random(&mut state) * known.len() as f32) as u32;
            // The tree grows, shrinks until it is empty, and grows again.
            let grows = random(&mut state) < if step / 3000 % 2 == 0 { 0.8 } else { 0.2 };
            let slot = &mut known[number as usize];
            if grows {
                let aabb = cube(&mut state);
                nodes.set(number, aabb);
                *slot = Some(aabb);
            } else {
                assert_eq!(nodes.remove(number), slot.take());
            }
            if step % 100 == 0 {
                assert_eq!(check(&nodes), known.iter().flatten().count());
            }
        }
        for (number, aabb) in known.iter().enumerate() {
            assert_eq!(nodes.get(number as u32), *aabb);
            nodes.remove(number as u32);
        }
        assert_eq!((check(&nodes), nodes.bounds()), (0, Aabb::EMPTY));
    }

    #[test]
    fn a_list_becomes_full_nodes() {
        let mut state = 3;
        for count in [0, 1, 8, 9, 64, 65, 1000, 4097] {
            let mut entries: Vec<Entry> = (0..count).map(|number| (cube(&mut state), number)).collect();
            let all = entries.iter().fold(Aabb::EMPTY, |all, (aabb, _)| all.union(*aabb));
            let nodes = Nodes::of(&mut entries, count as usize);
            assert_eq!((check(&nodes), nodes.bounds()), (count as usize, all));
            assert!(nodes.all.len() <= 1 + count as usize / 3, "{count} boxes in {} nodes", nodes.all.len());
        }
    }

    #[test]
    fn few_boxes_are_looked_at_for_a_small_region() {
        let mut state = 11;
        let mut nodes = Nodes::new();
        (0..20_000).for_each(|number| nodes.insert(number, cube(&mut state)));
        let region = Aabb::new(Vec3::new(40.0, 0.0, 40.0), Vec3::new(44.0, 10.0, 44.0));
        let (mut looked, mut found) = (0, 0);
        let meets = |looked: &mut u32, (), aabb: &Aabb| {
            *looked += 1;
            (aabb.min.cmple(region.max).all() && aabb.max.cmpge(region.min).all()).then_some(())
        };
        nodes.visit((), &mut looked, &meets, &mut |_, (), _, _| found += 1);
        assert!(found > 30 && looked < 12 * found, "{looked} for {found}");
    }
}
