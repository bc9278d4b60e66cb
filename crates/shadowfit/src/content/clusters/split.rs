//! Cuts groups of pieces in two: always the group with the most empty space, where the cut leaves the least
//! of it.
//!
//! Cuts are tried between slabs along an axis. These are the binned splits of bounding volume hierarchies
//! (Wald, Ingo: "On fast construction of SAH-based bounding volume hierarchies", 2007), with pieces cut at
//! the planes (Stich, Martin, et al.: "Spatial splits in bounding volume hierarchies", 2009). Unlike in these
//! papers, the cost of a half does not grow with its number of triangles, because a fit reads each box once
//! regardless of the triangles in it.

use alloc::collections::BinaryHeap;
use alloc::vec;
use alloc::vec::Vec;
use core::cmp::Ordering;

use glam::{DVec3, Vec3, Vec3Swizzles as _};

use super::piece::{Corners, Piece, Triangle};
use crate::base::Aabb;

/// Number of a group's pieces that decide where it is cut. This many give cuts as good as all pieces.
const SAMPLE: usize = 128;

/// Depth of the empty space that is assumed at the uncovered part of a box's sides, as a share of the box's
/// longest side.
const SILHOUETTE_WEIGHT: f64 = 0.1;

/// Share of a side that counts as the full side in spite of rounding.
const FILLED: f64 = 1.0 - 1e-3;

/// Number of corners of cut pieces that may be kept, per triangle and per cluster: ten times the need of
/// ordinary scenes. In scenes where very many large triangles intersect, later cuts leave pieces whole, and
/// the boxes overlap.
const CORNERS_PER_TRIANGLE: usize = 16;
const CORNERS_PER_CLUSTER: usize = 64;

/// Pieces of one object that share a box.
pub(super) struct Group {
    pub(super) object: u32,
    pub(super) pieces: Vec<Piece>,
    aabb: Aabb,
    /// Estimate of the empty space in the box, in m³.
    air: f64,
    /// Its slot in [`Splitter::next`]. It also breaks ties.
    slot: usize,
}

impl Group {
    fn new(object: u32, pieces: Vec<Piece>, slot: usize) -> Self {
        let mut aabb = Aabb::EMPTY;
        let (mut front, mut back) = (Vec3::ZERO, Vec3::ZERO);
        for piece in &pieces {
            aabb = aabb.union(piece.aabb);
            front += piece.area.max(Vec3::ZERO);
            back += (-piece.area).max(Vec3::ZERO);
        }
        Self { object, air: air(&aabb, front.max(back)), aabb, pieces, slot }
    }

    /// Returns the axis and coordinate to cut at. `None` for a point.
    fn cut(&self, triangles: &[Triangle], corners: &Corners, buffer: &mut Vec<Vec3>) -> Option<(usize, f32)> {
        let mut slabs = [0, 1, 2].map(|axis| Slabs::new(axis, &self.aabb));
        for piece in self.pieces.iter().step_by(self.pieces.len().div_ceil(SAMPLE).max(1)) {
            corners.copy(piece.outline, &triangles[piece.outline.triangle as usize], buffer);
            for slabs in &mut slabs {
                slabs.add(&piece.aabb, buffer);
            }
        }
        let mut best: Option<(f64, usize, f32)> = None;
        for (axis, slabs) in slabs.iter().enumerate() {
            if let Some((cost, cut)) = slabs.best()
                && best.is_none_or(|(least, ..)| cost < least)
            {
                best = Some((cost, axis, cut));
            }
        }
        best.map(|(_, axis, cut)| (axis, cut)).or_else(|| middle(&self.aabb))
    }

    /// Returns the axis along which the pieces' middles spread most, and the centre of this range. `None` if
    /// all middles coincide.
    fn middle_of_middles(&self) -> Option<(usize, f32)> {
        middle(&self.pieces.iter().fold(Aabb::EMPTY, |aabb, piece| aabb.with_point(piece.middle())))
    }
}

/// Returns the axis of a box's longest side, and the middle of that side. `None` for a point.
fn middle(aabb: &Aabb) -> Option<(usize, f32)> {
    let size = aabb.max - aabb.min;
    let axis = size.max_position();
    (size[axis] > 0.0).then(|| (axis, aabb.min[axis] + size[axis] * 0.5))
}

impl Ord for Group {
    /// Orders groups by empty space. Of equal groups, the one with the lower slot is greater.
    fn cmp(&self, other: &Self) -> Ordering {
        self.air.total_cmp(&other.air).then(other.slot.cmp(&self.slot))
    }
}

impl PartialOrd for Group {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Group {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Group {}

/// Estimates the empty space in a box, in m³, from the areas of its surfaces projected along x, y and z.
///
/// The estimate is the volume of the box, since surfaces are thin, plus a tenth of the box's longest side
/// times the uncovered area of its sides. A flat, full box has no empty space.
fn air(aabb: &Aabb, area: Vec3) -> f64 {
    let size = (aabb.max - aabb.min).as_dvec3();
    let open = (sides(size) * FILLED - area.as_dvec3()).max(DVec3::ZERO);
    size.element_product() + SILHOUETTE_WEIGHT * open.element_sum() * size.max_element()
}

/// Cuts objects into at most `limit` groups, or one for each object with triangles if these are more. The
/// groups of an object follow one another, and so do the parts of a group.
pub(super) fn split(objects: &[&[Triangle]], limit: usize) -> (Vec<Group>, Corners) {
    let mut splitter = Splitter::new(objects, limit);
    let mut open = BinaryHeap::new();
    for (object, triangles) in (0..).zip(objects).filter(|(_, triangles)| !triangles.is_empty()) {
        let pieces = (0..).zip(*triangles).map(|(i, triangle)| Piece::whole(i, triangle)).collect();
        splitter.next.push(open.len() + 1);
        open.push(Group::new(object, pieces, open.len()));
    }
    let mut done = Vec::new();
    while open.len() + done.len() < limit {
        let Some(group) = open.pop() else { break };
        match splitter.halves(group) {
            Ok(halves) => open.extend(halves),
            Err(group) => done.push(group),
        }
    }
    done.extend(open);
    let ranks = splitter.ranks();
    done.sort_unstable_by_key(|group| ranks[group.slot]);
    (done, splitter.corners)
}

struct Splitter<'a> {
    objects: &'a [&'a [Triangle]],
    corners: Corners,
    /// Greatest number of corners to keep.
    room: usize,
    /// Whether that number has been reached. Then pieces are no longer cut.
    is_full: bool,
    /// The order of the groups: the next slot after each slot. The last slot has an invalid index as next.
    next: Vec<usize>,
    /// Scratch memory for the corners of one piece.
    buffer: Vec<Vec3>,
}

impl<'a> Splitter<'a> {
    fn new(objects: &'a [&'a [Triangle]], limit: usize) -> Self {
        let triangles = objects.iter().map(|triangles| triangles.len()).fold(0, usize::saturating_add);
        let room = triangles.saturating_mul(CORNERS_PER_TRIANGLE);
        let room = room.saturating_add(limit.saturating_mul(CORNERS_PER_CLUSTER)).min(u32::MAX as usize);
        Self { objects, corners: Corners::default(), room, is_full: false, next: Vec::new(), buffer: Vec::new() }
    }

    /// Returns a new slot that follows another one.
    fn slot_after(&mut self, slot: usize) -> usize {
        self.next.push(self.next[slot]);
        self.next[slot] = self.next.len() - 1;
        self.next[slot]
    }

    /// Returns each slot's rank in the order.
    fn ranks(&self) -> Vec<usize> {
        let mut ranks = vec![0; self.next.len()];
        let mut slot = 0;
        for rank in 0..self.next.len() {
            ranks[slot] = rank;
            slot = self.next[slot];
        }
        ranks
    }

    /// Returns both halves of a group, or the group itself if it has no empty space or cannot be cut.
    fn halves(&mut self, mut group: Group) -> Result<[Group; 2], Group> {
        let triangles = self.objects[group.object as usize];
        let cut = match self.is_full {
            _ if group.air <= 0.0 => None,
            true => group.middle_of_middles(),
            false => group.cut(triangles, &self.corners, &mut self.buffer),
        };
        let Some((axis, cut)) = cut else { return Err(group) };
        let mut above = Vec::new();
        group.pieces.retain_mut(|piece| {
            self.is_full |= self.corners.len() + self.corners.needed_to_cut(piece.outline) > self.room;
            let is_below = if self.is_full { piece.middle()[axis] < cut } else { piece.aabb.max[axis] <= cut };
            if is_below || self.is_full || piece.aabb.min[axis] >= cut {
                above.extend((!is_below).then_some(*piece));
                return is_below;
            }
            let [below, part_above] = self.corners.cut(piece, &triangles[piece.outline.triangle as usize], axis, cut);
            above.extend(part_above);
            *piece = below.unwrap_or(*piece);
            below.is_some()
        });
        if group.pieces.is_empty() || above.is_empty() {
            group.pieces.append(&mut above);
            return Err(group);
        }
        group.pieces.shrink_to_fit();
        let slot = self.slot_after(group.slot);
        Ok([Group::new(group.object, group.pieces, group.slot), Group::new(group.object, above, slot)])
    }
}

/// Number of slabs along an axis of a box. Cuts are tried between them. More slabs did not make the fits of
/// five measured scenes tighter, and 32 took three times as long.
const SLABS: usize = 8;

/// Weight of longest side times area in the cost, relative to volume. With it, flat boxes are cut where this
/// removes most of their area.
const AREA_WEIGHT: f64 = 0.01;

/// Slabs along an axis, with the bounding box of the content of each.
pub(super) struct Slabs {
    axis: usize,
    min: f32,
    size: f32,
    /// Number of slabs per metre.
    density: f32,
    boxes: [Aabb; SLABS],
}

impl Slabs {
    /// Returns empty slabs along an axis of a box.
    pub(super) fn new(axis: usize, aabb: &Aabb) -> Self {
        let min = aabb.min[axis];
        let size = aabb.max[axis] - min;
        Self { axis, min, size, density: SLABS as f32 / size, boxes: [Aabb::EMPTY; SLABS] }
    }

    /// Adds a piece to the slabs that it crosses. `corners` are in order around the piece.
    pub(super) fn add(&mut self, aabb: &Aabb, corners: &[Vec3]) {
        let (first, last) = (self.slab(aabb.min[self.axis]), self.slab(aabb.max[self.axis]));
        if first == last {
            self.boxes[first] = self.boxes[first].union(*aabb);
            return;
        }
        let mut before = corners[corners.len() - 1];
        for &corner in corners {
            self.add_edge(before, corner);
            before = corner;
        }
    }

    /// Adds the end of an edge, and the points where the edge crosses from slab to slab.
    fn add_edge(&mut self, a: Vec3, b: Vec3) {
        let axis = self.axis;
        let (start, end) = (self.slab(a[axis]), self.slab(b[axis]));
        self.boxes[end] = self.boxes[end].with_point(b);
        for plane in start.min(end) + 1..=start.max(end) {
            let cut = self.plane(plane);
            let share = ((cut - a[axis]) / (b[axis] - a[axis])).clamp(0.0, 1.0);
            let mut p = a + (b - a) * share;
            p[axis] = cut;
            for slab in [plane - 1, plane] {
                self.boxes[slab] = self.boxes[slab].with_point(p);
            }
        }
    }

    /// Returns the cost of the best two halves and the coordinate to cut at. `None` if only one slab has
    /// content.
    pub(super) fn best(&self) -> Option<(f64, f32)> {
        let mut above = [Aabb::EMPTY; SLABS];
        let mut aabb = Aabb::EMPTY;
        for (above, slab) in above.iter_mut().zip(&self.boxes).rev() {
            aabb = aabb.union(*slab);
            *above = aabb;
        }
        let mut best: Option<(f64, usize)> = None;
        let mut below = Aabb::EMPTY;
        for (plane, above) in above.iter().enumerate().skip(1) {
            below = below.union(self.boxes[plane - 1]);
            if !below.is_empty() && !above.is_empty() {
                let cost = cost(&below) + cost(above);
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, plane));
                }
            }
        }
        best.map(|(cost, plane)| (cost, self.plane(plane)))
    }

    fn slab(&self, coordinate: f32) -> usize {
        // Negative numbers become slab 0, and so does NaN, which is zero times infinity for a box without
        // extent.
        (((coordinate - self.min) * self.density) as usize).min(SLABS - 1)
    }

    fn plane(&self, slab: usize) -> f32 {
        self.min + self.size * (slab as f32 / SLABS as f32)
    }
}

/// Returns the cost of a box, in m³: the empty space that it may hold.
fn cost(aabb: &Aabb) -> f64 {
    let size = (aabb.max - aabb.min).as_dvec3();
    size.element_product() + AREA_WEIGHT * sides(size).element_sum() * size.max_element()
}

/// Returns the areas of a box's sides across x, y and z.
pub(super) fn sides(size: DVec3) -> DVec3 {
    size.yzx() * size.zxy()
}
