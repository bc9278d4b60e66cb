//! Pieces of triangles, cut by planes.
//!
//! A corner of a piece is stored as its position in the triangle, (u, v) for a + u (b - a) + v (c - a). So
//! the piece follows any movement and deformation of the triangle:
//!
//! ```text
//!    c                 c
//!    | \               | \
//!    |   \       =>    |   *       *  \         each part keeps the corners on its side
//!    |     \           |   |       |    \       and gets the two new ones (*)
//!    a ---- b          a --*       * --- b
//! ```

use alloc::vec::Vec;

use glam::{DVec2, DVec3, Vec3};

use crate::base::Aabb;

/// Three positions, in metres.
pub(super) type Triangle = [Vec3; 3];

/// Corners of a whole triangle.
const WHOLE: [DVec2; 3] = [DVec2::ZERO, DVec2::X, DVec2::Y];

/// A triangle or a part of one. The caller keeps track of its object.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) aabb: Aabb,
    /// Area vector in m²: along the normal by the right-hand rule, with the area as length.
    pub(super) area: Vec3,
    pub(super) outline: Outline,
}

/// A triangle of an object, or a part of that triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Outline {
    pub(super) triangle: u32,
    /// Index of its first corner in [`Corners`].
    first: u32,
    /// Number of its corners. 0 for the whole triangle.
    count: u32,
}

impl Piece {
    /// Returns a whole triangle as a piece.
    pub(super) fn whole(index: u32, triangle: &Triangle) -> Self {
        let aabb = triangle.iter().fold(Aabb::EMPTY, |aabb, &corner| aabb.with_point(corner));
        let outline = Outline { triangle: index, first: 0, count: 0 };
        Self { aabb, area: area(triangle).as_vec3(), outline }
    }

    /// Returns the middle of the piece's box.
    pub(super) fn middle(&self) -> Vec3 {
        (self.aabb.min + self.aabb.max) * 0.5
    }
}

/// Corners of cut pieces, by position in their triangle.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Corners {
    positions: Vec<DVec2>,
}

impl Corners {
    pub(super) fn len(&self) -> usize {
        self.positions.len()
    }

    /// Writes the rounded corners of a piece to `out`, in order around it.
    pub(super) fn copy(&self, outline: Outline, triangle: &Triangle, out: &mut Vec<Vec3>) {
        out.clear();
        match outline.count {
            0 => out.extend(triangle),
            _ => out.extend(self.positions(outline).iter().map(|&position| at(triangle, position).as_vec3())),
        }
    }

    /// Returns the smallest f32 box around a piece.
    pub(super) fn bounds(&self, outline: Outline, triangle: &Triangle) -> Aabb {
        if outline.count == 0 {
            return triangle.iter().fold(Aabb::EMPTY, |aabb, &corner| aabb.with_point(corner));
        }
        let corners = self.positions(outline).iter().map(|&position| at(triangle, position));
        let (min, max) = corners.fold((DVec3::MAX, DVec3::MIN), |(min, max), p| (min.min(p), max.max(p)));
        rounded_out(min, max)
    }

    /// Copies the corners of a piece from `other`. Corners that no piece uses are left behind.
    pub(super) fn adopt(&mut self, outline: Outline, other: &Self) -> Outline {
        if outline.count == 0 {
            return outline;
        }
        let first = self.positions.len() as u32;
        self.positions.extend_from_slice(other.positions(outline));
        Outline { first, ..outline }
    }

    /// Returns an upper bound for the number of corners of both parts of a piece.
    pub(super) fn needed_to_cut(&self, outline: Outline) -> usize {
        // Each part has the corners on its side, and each corner and each edge may add one more.
        4 * self.positions(outline).len()
    }

    /// Returns the parts of a piece below and above a coordinate along an axis. A part without extent is
    /// `None`. At least one part exists.
    pub(super) fn cut(&mut self, piece: &Piece, triangle: &Triangle, axis: usize, cut: f32) -> [Option<Piece>; 2] {
        let mut parts = [1.0, -1.0].map(|side| self.part(piece, triangle, axis, cut, side));
        match &mut parts {
            [None, None] => parts[0] = Some(*piece), // only by rounding: a piece as flat as the plane
            [Some(below), above] => {
                below.aabb.max[axis] = below.aabb.max[axis].min(cut);
                if let Some(above) = above {
                    above.aabb.min[axis] = above.aabb.min[axis].max(cut);
                }
            }
            [None, Some(above)] => above.aabb.min[axis] = above.aabb.min[axis].max(cut),
        }
        parts
    }

    /// Returns the part of a piece on one side of a plane: below it for `side` 1, above it for -1.
    fn part(&mut self, piece: &Piece, triangle: &Triangle, axis: usize, cut: f32, side: f64) -> Option<Piece> {
        let first = self.positions.len();
        let count = self.positions(piece.outline).len();
        let position = |corners: &Self, i: usize| match piece.outline.count {
            0 => WHOLE[i],
            _ => corners.positions[piece.outline.first as usize + i],
        };
        let height = |position: DVec2| (at(triangle, position)[axis] - f64::from(cut)) * side;
        let mut before = position(self, count - 1);
        for i in 0..count {
            let corner = position(self, i);
            let (a, b) = (height(before), height(corner));
            if a * b < 0.0 {
                self.positions.push(before + (corner - before) * (a / (a - b)));
            }
            if b <= 0.0 {
                self.positions.push(corner);
            }
            before = corner;
        }
        let count = self.positions.len() - first;
        if count < 3 {
            self.positions.truncate(first);
            return None;
        }
        let outline = Outline { first: first as u32, count: count as u32, ..piece.outline };
        let bounds = self.bounds(outline, triangle);
        let aabb = Aabb { min: bounds.min.max(piece.aabb.min), max: bounds.max.min(piece.aabb.max) };
        let share = share(&self.positions[first..]);
        Some(Piece { aabb, area: (area(triangle) * share).as_vec3(), outline })
    }

    fn positions(&self, outline: Outline) -> &[DVec2] {
        if outline.count == 0 { &WHOLE } else { &self.positions[outline.first as usize..][..outline.count as usize] }
    }
}

/// Returns the point of a triangle at a position (u, v). The common coordinate of an axis-aligned triangle is
/// exact.
fn at(triangle: &Triangle, position: DVec2) -> DVec3 {
    let [a, b, c] = triangle.map(Vec3::as_dvec3);
    a + (b - a) * position.x + (c - a) * position.y
}

fn area(triangle: &Triangle) -> DVec3 {
    let [a, b, c] = triangle.map(Vec3::as_dvec3);
    (b - a).cross(c - a) * 0.5
}

/// Returns the area of a convex polygon of positions, as a share of the triangle's area.
fn share(positions: &[DVec2]) -> f64 {
    let fan = positions.windows(2).map(|edge| (edge[0] - positions[0]).perp_dot(edge[1] - positions[0]));
    fan.sum::<f64>().abs()
}

/// Returns the smallest f32 box around an f64 box.
fn rounded_out(min: DVec3, max: DVec3) -> Aabb {
    let down = |v: f64, r: f32| if f64::from(r) > v { r.next_down() } else { r };
    let up = |v: f64, r: f32| if f64::from(r) < v { r.next_up() } else { r };
    let (low, high) = (min.as_vec3(), max.as_vec3());
    Aabb {
        min: Vec3::new(down(min.x, low.x), down(min.y, low.y), down(min.z, low.z)),
        max: Vec3::new(up(max.x, high.x), up(max.y, high.y), up(max.z, high.z)),
    }
}
