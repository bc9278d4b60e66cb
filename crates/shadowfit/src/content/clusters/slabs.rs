//! Where to cut: slabs along an axis, and the cut between two of them that leaves the least empty
//! space.
//!
//! Binned splits as of bounding volume hierarchies (Wald, Ingo: "On fast construction of SAH-based
//! bounding volume hierarchies", 2007), of pieces cut at the planes (Stich, Martin, et al.: "Spatial
//! splits in bounding volume hierarchies", 2009). Unlike there, a half's cost does not grow with its
//! number of triangles, because a fit reads each box once, no matter how many triangles are in it.

use glam::{DVec3, Vec3, Vec3Swizzles as _};

use crate::base::Aabb;

/// Slabs that a box is cut into along an axis; a cut is tried between each two. More did not make
/// the fits of five measured scenes tighter, and 32 took three times as long.
const SLABS: usize = 8;

/// Weight of longest side times area, relative to volume, in the cost: flat boxes are then cut
/// where that removes most of their area.
const AREA_WEIGHT: f64 = 0.01;

/// Boxes of what lies in each slab along an axis.
pub(super) struct Slabs {
    axis: usize,
    min: f32,
    size: f32,
    /// Slabs in a metre.
    density: f32,
    boxes: [Aabb; SLABS],
}

impl Slabs {
    /// Empty slabs along an axis of a box.
    pub(super) fn new(axis: usize, aabb: &Aabb) -> Self {
        let min = aabb.min[axis];
        let size = aabb.max[axis] - min;
        Self { axis, min, size, density: SLABS as f32 / size, boxes: [Aabb::EMPTY; SLABS] }
    }

    /// Adds a piece with its box and its corners, in order around it, to the slabs that it passes
    /// through.
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

    /// Adds the end of an edge, and where it passes from slab to slab.
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

    /// The coordinate to cut at, and the cost of the two halves; `None` where all lies in one slab.
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
        // Negative numbers and NaN, from zero times infinity without extent, become slab 0.
        (((coordinate - self.min) * self.density) as usize).min(SLABS - 1)
    }

    fn plane(&self, slab: usize) -> f32 {
        self.min + self.size * (slab as f32 / SLABS as f32)
    }
}

/// Cost of a box, in m³: the empty space that it may hold.
fn cost(aabb: &Aabb) -> f64 {
    let size = (aabb.max - aabb.min).as_dvec3();
    size.element_product() + AREA_WEIGHT * sides(size).element_sum() * size.max_element()
}

/// Areas of a box's sides across x, y and z.
pub(super) fn sides(size: DVec3) -> DVec3 {
    size.yzx() * size.zxy()
}
