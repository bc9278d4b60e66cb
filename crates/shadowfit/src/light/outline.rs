//! The part of a caster's box over a convex outline in the light's plane.
//!
//! Over the outline, a box reaches highest at a corner of (outline ∩ one of the box's faces as seen from the
//! light). Each face that looks toward the light is therefore clipped to the outline as a polygon, and each
//! corner keeps its height.

use glam::{DVec2, DVec3};

use crate::base::box_corners;
use crate::light::LightAxes;

/// A convex outline, widened, with its bounds.
pub(crate) struct Outline<'a> {
    pub(crate) axes: LightAxes,
    /// Anticlockwise, in the plane of the axes' x and y.
    corners: &'a [DVec2],
    min: DVec2,
    max: DVec2,
    /// Widening of the outline on all sides, in metres.
    pad: f64,
}

/// Greatest number of corners of a clipped face. Each edge of the outline adds at most one. Edges beyond the
/// limit are left out, which is on the safe side.
const MAX_CORNERS: usize = 96;

/// A clipped face: a convex polygon in the light's plane with the height of each corner.
#[derive(Clone, Copy)]
struct Face {
    corners: [DVec3; MAX_CORNERS],
    len: usize,
}

impl Face {
    const EMPTY: Self = Self { corners: [DVec3::ZERO; MAX_CORNERS], len: 0 };

    /// Adds a corner, and returns whether there was room for it.
    fn push(&mut self, corner: DVec3) -> bool {
        if self.len == MAX_CORNERS {
            return false;
        }
        self.corners[self.len] = corner;
        self.len += 1;
        true
    }
}

/// Scratch space for clipping faces.
pub(crate) struct OutlineScratch([Face; 2]);

impl OutlineScratch {
    pub(crate) const fn new() -> Self {
        Self([Face::EMPTY; 2])
    }
}

impl<'a> Outline<'a> {
    /// Creates an outline in the plane of `axes` (anticlockwise), widened by `pad` metres on all sides. It
    /// then holds everything within that distance, and nothing beyond √2 times that distance.
    pub(crate) fn new(axes: &LightAxes, corners: &'a [DVec2], pad: f64) -> Self {
        let (mut min, mut max) = (DVec2::MAX, DVec2::MIN);
        for p in corners {
            (min, max) = (min.min(*p), max.max(*p));
        }
        Self { axes: *axes, corners, min: min - pad, max: max + pad, pad }
    }

    /// Returns whether any part of a box may lie over the outline and above `floor`.
    #[inline]
    pub(crate) fn may_hold(&self, min: DVec3, max: DVec3, floor: f64) -> bool {
        let z = self.axes.z.as_dvec3();
        let (centre, half) = ((min + max) * 0.5, (max - min) * 0.5);
        // Most casters lie lower than the highest one found so far.
        if z.dot(centre) + z.abs().dot(half) <= floor {
            return false;
        }
        let (x, y) = (self.axes.x.as_dvec3(), self.axes.y.as_dvec3());
        let centre = DVec2::new(x.dot(centre), y.dot(centre));
        let reach = DVec2::new(x.abs().dot(half), y.abs().dot(half));
        !((centre - reach).cmpgt(self.max).any() || (centre + reach).cmplt(self.min).any())
    }

    /// Emits the corners of the box's faces that look toward the light, clipped to the outline, along the
    /// light's axes. Emits nothing if no part of the box is over the outline or reaches above `floor`.
    pub(crate) fn parts_over(
        &self,
        min: DVec3,
        max: DVec3,
        floor: f64,
        scratch: &mut OutlineScratch,
        mut emit: impl FnMut(DVec3),
    ) {
        if !self.may_hold(min, max, floor) {
            return;
        }
        let (axes, z) = (&self.axes, self.axes.z.as_dvec3());
        let corners = box_corners(min, max).map(|corner| axes.project(corner));
        for (face, inward) in FACES.into_iter().zip([z.x, -z.x, z.y, -z.y, z.z, -z.z]) {
            // Faces that look away from the light lie below the others.
            if inward <= 0.0 {
                let clipped = self.clip(face.map(|i| corners[i]), scratch);
                clipped.corners[..clipped.len].iter().for_each(|corner| emit(*corner));
            }
        }
    }

    /// Clips a face to the edges of the outline, moved outward by the pad. It also cuts across sharp corners,
    /// where the moved edges meet far outside:
    ///
    /// ```text
    ///   ─────────────╮ cut across
    ///     ╶────────● │
    ///   ─────────────╯
    /// ```
    fn clip<'s>(&self, face: [DVec3; 4], scratch: &'s mut OutlineScratch) -> &'s Face {
        let [polygon, other] = &mut scratch.0;
        polygon.corners[..4].copy_from_slice(&face);
        polygon.len = 4;
        let (mut polygon, mut other) = (polygon, other);
        let mut cut_at = |corner: DVec2, outward: DVec2| {
            if cut(polygon, other, |p| self.pad - outward.dot(p.truncate() - corner)) {
                core::mem::swap(&mut polygon, &mut other);
            }
        };
        let n = self.corners.len();
        let edges = || (0..n).filter_map(|i| direction(self.corners[i], self.corners[(i + 1) % n]));
        let Some(mut before) = edges().next_back() else {
            let [low, high] = [self.min + self.pad, self.max - self.pad];
            for (corner, outward) in [(low, DVec2::NEG_X), (low, DVec2::NEG_Y), (high, DVec2::X), (high, DVec2::Y)] {
                cut_at(corner, outward);
            }
            return polygon;
        };
        for i in 0..n {
            let Some(edge) = direction(self.corners[i], self.corners[(i + 1) % n]) else { continue };
            cut_at(self.corners[i], -edge.perp());
            if edge.dot(before) < 0.0
                && let Some(across) = direction(edge, before)
            {
                cut_at(self.corners[i], across);
            }
            before = edge;
        }
        polygon
    }
}

/// Returns the unit vector from one point to another, or `None` if they coincide.
fn direction(from: DVec2, to: DVec2) -> Option<DVec2> {
    let d = to - from;
    let length = libm::sqrt(d.dot(d));
    if length > 0.0 { Some(d / length) } else { None }
}

/// Clips a polygon to the side where a linear function is not negative (I. Sutherland and G. Hodgman,
/// "Reentrant polygon clipping", 1974), and writes the result to `out`. Returns false if the polygon is
/// unchanged or `out` has no room.
fn cut(polygon: &Face, out: &mut Face, inside: impl Fn(DVec3) -> f64) -> bool {
    if polygon.corners[..polygon.len].iter().all(|corner| inside(*corner) >= 0.0) {
        return false;
    }
    out.len = 0;
    let mut fits = true;
    for i in 0..polygon.len {
        let (a, b) = (polygon.corners[i], polygon.corners[(i + 1) % polygon.len]);
        let (da, db) = (inside(a), inside(b));
        if da >= 0.0 {
            fits &= out.push(a);
        }
        if (da >= 0.0) != (db >= 0.0) {
            let t = da / (da - db);
            fits &= out.push(a * (1.0 - t) + b * t);
        }
    }
    fits
}

/// Corners of a box's faces -x, +x, -y, +y, -z, +z, in the order of [`box_corners`].
const FACES: [[usize; 4]; 6] = [[0, 3, 7, 4], [1, 2, 6, 5], [0, 1, 5, 4], [3, 2, 6, 7], [0, 1, 2, 3], [4, 5, 6, 7]];
