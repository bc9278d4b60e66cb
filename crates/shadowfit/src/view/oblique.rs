//! Views whose near and far planes are not parallel to each other, or not perpendicular to the picture's axis.
//!
//! The near plane of a mirror, a water surface or a portal is moved onto the surface (E. Lengyel, "Oblique
//! view frustum depth projection and clipping", 2005). The far plane tilts with it and may lie behind the eye
//! for a part of the picture, so the corners of such a view are meaningless. The clip cube, cut at the end of
//! the shadows, remains usable:
//!
//! ```text
//!      far ╲  ╎ shadows end            The homogeneous position of a clip position c is linear in c. So are its w
//!           ╲ ╎      ╱                 and its h = w · view depth, and w · distance - h ≥ 0 is a half-space of clip
//!   ─────────╲╎────╱                   space. The vertices of the cube in this half-space bound the view depth, and
//!     ▓▓▓▓▓▓▓▓╎▓▓╱ near                the part of the picture that shows anything.
//!   eye ●     ╎╱
//! ```
//!
//! The frustum around this part has rectangles perpendicular to the picture's axis, so other code treats it
//! like any frustum. Its planes move in steps, so that kept maps rarely change while a mirror moves with the
//! camera.

use glam::{DVec3, DVec4, Vec3};

use super::frustum::{CORNERS_XY, Unprojection, ViewFrustum};
use super::slice::{Depths, EDGES};
use crate::base::{DepthConvention, FitError, checks};

/// Greatest variation of w over a picture whose planes count as parallel, as a share of w at the plane with
/// the smaller w.
const PARALLEL: f64 = 1e-3;

/// Greatest variation of w as a share of w at the nearer plane: the rounding of a zero after inverting a
/// matrix in f32.
const INVERTED: f64 = 1.0 / 65_536.0;

/// Greatest sine of the angle between the axis of an orthographic picture and the normal of its planes for
/// which the planes count as perpendicular.
const PERPENDICULAR: f64 = 1e-3;

/// Least change of w with depth, as a share of its other terms. With less, view rays count as parallel.
const PERSPECTIVE: f64 = 1e-4;

/// Number of steps across and down the picture. The visible part is rounded outward to them.
const PICTURE_STEPS: f64 = 8.0;

/// Number of steps per octave of view depth. View depths are rounded outward to them.
const OCTAVE_STEPS: f64 = 8.0;

/// Number of steps in the depth of an orthographic view. Its planes are rounded outward to them.
const DEPTH_STEPS: f64 = 16.0;

/// Margin for rounding, as a share of a view depth.
const PLANE_ROUNDING: f64 = 1e-6;

/// A range of clip x or clip y.
#[derive(Clone, Copy)]
struct Side {
    least: f64,
    greatest: f64,
}

/// The whole picture: clip x, then clip y.
const WHOLE: [Side; 2] = [Side { least: -1.0, greatest: 1.0 }; 2];

/// Corners of the clip cube on its near face. The corners of the far face follow. Both are in the order of
/// [`CORNERS_XY`].
const NEAR_FACE: core::ops::Range<usize> = 0..4;

impl Unprojection {
    /// Returns whether the near and far planes are tilted against each other or against the picture's axis.
    pub(super) fn is_oblique(&self) -> bool {
        let row = self.matrix.row(3);
        let at = |z: f32| (row.z * f64::from(z) + row.w).abs();
        let (near, far) = (at(self.depth.near()), at(self.depth.far()));
        let tilt = row.x.abs() + row.y.abs();
        if tilt > INVERTED * near.max(far) && tilt > PARALLEL * near.min(far) {
            return true;
        }
        if row.z.abs() > PERSPECTIVE * near.max(far) {
            return false;
        }
        // The planes of an orthographic view are parallel, but its axis may be tilted against them.
        let [x, y, z] = [self.matrix.x_axis, self.matrix.y_axis, self.matrix.z_axis].map(DVec4::truncate);
        let normal = x.cross(y);
        checks::length(normal.cross(z)) > PERPENDICULAR * checks::length(normal) * checks::length(z)
    }

    /// Returns a frustum around the part of a tilted view in front of a view depth, in metres.
    pub(super) fn enclosing(&self, max_distance: f32) -> Result<ViewFrustum, FitError> {
        let cube = self.cube()?;
        let limit = f64::from(max_distance);
        let Some(seen) = cube.within(limit) else {
            // If the plane hides the whole picture, the view is empty at any depth.
            let near = cube.within(f64::MAX).map_or(limit.min(1.0), |all| all.depths.near);
            checks::may_begin_beyond(near as f32, max_distance)?;
            return cube.frustum(self.eye, WHOLE, Depths { near, far: near });
        };
        let is_endless = seen.least_w <= self.infinite_w * cube.greatest_w();
        if max_distance == f32::MAX && (is_endless || seen.is_cut) {
            return Err(FitError::Endless);
        }
        let Depths { near, far } = cube.stepped(seen.depths);
        cube.frustum(self.eye, seen.picture, Depths { near, far: far.min(limit) })
    }

    /// Returns the clip cube in the world, with the viewing direction.
    fn cube(&self) -> Result<Cube, FitError> {
        let cube = Cube::new(self, 1.0)?;
        // A negated matrix is the same projection. If the plane hides the whole picture, all of the cube also
        // lies behind the eye.
        if cube.greatest_w() > 0.0 || cube.is_ahead { Ok(cube) } else { Cube::new(self, -1.0) }
    }
}

/// A clip position in the world relative to the eye, homogeneous. `h` is its view depth times its w.
#[derive(Clone, Copy)]
struct Vertex {
    position: DVec3,
    w: f64,
    h: f64,
}

/// The clip cube in the world.
struct Cube {
    corners: [Vertex; 8],
    /// Unit viewing direction: the axis of the picture.
    forward: DVec3,
    /// Whether view rays meet at the eye.
    is_perspective: bool,
    /// Whether view rays meet at the eye and w falls along them away from the eye.
    is_ahead: bool,
}

/// The part of a clip cube in front of a view depth.
struct Seen {
    /// Least and greatest view depth, in metres.
    depths: Depths,
    /// The part of the picture that shows it: least and greatest clip x, then clip y.
    picture: [Side; 2],
    least_w: f64,
    /// Whether a part of the cube lies beyond that view depth.
    is_cut: bool,
}

impl Cube {
    fn new(unprojection: &Unprojection, sign: f64) -> Result<Self, FitError> {
        let (near, far) = (f64::from(unprojection.depth.near()), f64::from(unprojection.depth.far()));
        let at = |x: f64, y: f64, z: f64, w: f64| {
            let (position, its_w) = unprojection.homogeneous(x * sign, y * sign, z * sign, w * sign);
            Vertex { position, w: its_w, h: 0.0 }
        };
        let mut corners = [at(0.0, 0.0, 0.0, 1.0); 8];
        for (i, corner) in corners.iter_mut().enumerate() {
            let (x, y) = CORNERS_XY[i % 4];
            *corner = at(x, y, if NEAR_FACE.contains(&i) { near } else { far }, 1.0);
        }
        let (right, up, along) = (at(1.0, 0.0, 0.0, 0.0), at(0.0, 1.0, 0.0, 0.0), at(0.0, 0.0, far - near, 0.0));
        let greatest = corners.iter().map(|corner| corner.w.abs()).fold(0.0, f64::max);
        let is_perspective = along.w.abs() > PERSPECTIVE * greatest;
        let axis = if is_perspective {
            // Directions of constant w, to the right and up. They span the plane of the picture.
            let across = |side: Vertex| side.position * along.w - along.position * side.w;
            across(right).cross(across(up))
        } else {
            check_rays(&corners, right.w, up.w)?;
            along.position
        };
        let length = checks::length(axis);
        // The sign of the change of h / w along a ray.
        let centre = at(0.0, 0.0, near, 1.0);
        let change = axis.dot(along.position) * centre.w - axis.dot(centre.position) * along.w;
        if !(length > 0.0 && length.is_finite()) || change == 0.0 || greatest == 0.0 {
            let [right, up, along] = [right.position, up.position, along.position].map(checks::length);
            return Err(coinciding(right, up, along));
        }
        let forward = axis / if change < 0.0 { -length } else { length };
        // A ray begins at the eye with infinite w, and w falls from there on.
        if is_perspective && along.w > 0.0 && corners.iter().any(|corner| corner.w > 0.0) {
            return Err(facing(unprojection.depth));
        }
        for corner in &mut corners {
            corner.h = corner.position.dot(forward);
        }
        Ok(Self { corners, forward, is_perspective, is_ahead: is_perspective && along.w < 0.0 })
    }

    fn greatest_w(&self) -> f64 {
        self.corners.iter().map(|corner| corner.w).fold(f64::MIN, f64::max)
    }

    /// Returns the part in front of a view depth, or `None` if it is empty.
    fn within(&self, limit: f64) -> Option<Seen> {
        let room = |vertex: &Vertex| if limit == f64::MAX { vertex.w } else { limit * vertex.w - vertex.h };
        let mut seen = Seen {
            depths: Depths { near: f64::INFINITY, far: f64::NEG_INFINITY },
            picture: [Side { least: f64::INFINITY, greatest: f64::NEG_INFINITY }; 2],
            least_w: f64::INFINITY,
            is_cut: false,
        };
        let corners = || self.corners.iter().zip(CORNERS_XY.iter().cycle());
        for (corner, (x, y)) in corners() {
            if room(corner) >= 0.0 {
                seen.add(corner.h, corner.w, [*x, *y]);
            } else {
                seen.is_cut = true;
            }
        }
        for (i, j) in EDGES {
            let (a, b) = (&self.corners[i], &self.corners[j]);
            let (inside, outside) = (room(a), room(b));
            if (inside < 0.0) == (outside < 0.0) {
                continue;
            }
            let t = inside / (inside - outside);
            let mix = |a: f64, b: f64| a + (b - a) * t;
            let ((ax, ay), (bx, by)) = (CORNERS_XY[i % 4], CORNERS_XY[j % 4]);
            seen.add(mix(a.h, b.h), mix(a.w, b.w), [mix(ax, bx), mix(ay, by)]);
        }
        (seen.depths.near < seen.depths.far).then_some(seen)
    }

    /// Returns view depths, rounded outward to steps, so that they mostly stay constant during small
    /// movements of the planes.
    fn stepped(&self, Depths { near, far }: Depths) -> Depths {
        if self.is_perspective && near > 0.0 {
            let step =
                |depth: f64, round: fn(f64) -> f64| libm::exp2(round(libm::log2(depth) * OCTAVE_STEPS) / OCTAVE_STEPS);
            return Depths {
                near: step(near * (1.0 - PLANE_ROUNDING), libm::floor),
                far: step(far * (1.0 + PLANE_ROUNDING), libm::ceil),
            };
        }
        let rounding = (far - near) * PLANE_ROUNDING;
        let step = libm::exp2(libm::ceil(libm::log2((far - near) / DEPTH_STEPS)));
        Depths { near: libm::floor((near - rounding) / step) * step, far: libm::ceil((far + rounding) / step) * step }
    }

    /// Returns the frustum of a part of the picture between two view depths.
    fn frustum(&self, origin: DVec3, picture: [Side; 2], depths: Depths) -> Result<ViewFrustum, FitError> {
        let Depths { near, far } = depths;
        let mut corners = [Vec3::ZERO; 8];
        let [across, along] = picture.map(stepped_side);
        for (i, (x, y)) in CORNERS_XY.into_iter().enumerate() {
            let (x, y) = (
                if x < 0.0 { across.least } else { across.greatest },
                if y < 0.0 { along.least } else { along.greatest },
            );
            corners[i] = self.point(x, y, near).as_vec3();
            corners[i + 4] = self.point(x, y, far).as_vec3();
        }
        let (near, far) = (near as f32, far as f32);
        ViewFrustum { origin, corners, near, far, forward: self.forward.as_vec3() }.checked()
    }

    /// Returns the point with a clip x, a clip y and a view depth.
    fn point(&self, x: f64, y: f64, depth: f64) -> DVec3 {
        let [a, b] = [0, 4].map(|face| self.on_face(face, x, y));
        // The point is a + (b - a) t, homogeneous, with h = w · depth.
        let (of_a, of_b) = (a.h - a.w * depth, b.h - b.w * depth);
        (a.position * of_b - b.position * of_a) / (a.w * of_b - b.w * of_a)
    }

    /// Returns the position of a clip x and y on the near face (first corner 0) or on the far face (first
    /// corner 4).
    fn on_face(&self, face: usize, x: f64, y: f64) -> Vertex {
        // Positions are linear in x and y, so three corners are enough.
        let [left_top, right_top, _, left_bottom] = [0, 1, 2, 3].map(|i| self.corners[face + i]);
        let (across, down) = ((x + 1.0) * 0.5, (1.0 - y) * 0.5);
        let at = |of: fn(&Vertex) -> DVec3| {
            of(&left_top) + (of(&right_top) - of(&left_top)) * across + (of(&left_bottom) - of(&left_top)) * down
        };
        let numbers = at(|vertex| DVec3::new(vertex.w, vertex.h, 0.0));
        Vertex { position: at(|vertex| vertex.position), w: numbers.x, h: numbers.y }
    }
}

impl Seen {
    /// Adds a vertex, unless it lies behind the eye.
    fn add(&mut self, h: f64, w: f64, at: [f64; 2]) {
        if w <= 0.0 {
            self.is_cut = true;
            return;
        }
        let depth = h / w;
        self.least_w = self.least_w.min(w);
        self.depths = Depths { near: self.depths.near.min(depth), far: self.depths.far.max(depth) };
        for (side, at) in self.picture.iter_mut().zip(at) {
            *side = Side { least: side.least.min(at), greatest: side.greatest.max(at) };
        }
    }
}

/// Returns a range of clip x or y, rounded outward to steps.
fn stepped_side(side: Side) -> Side {
    let steps = PICTURE_STEPS * 0.5;
    let low = libm::floor((side.least - PLANE_ROUNDING) * steps) / steps;
    let high = libm::ceil((side.greatest + PLANE_ROUNDING) * steps) / steps;
    Side { least: low.max(-1.0), greatest: high.min(1.0) }
}

/// Returns an error for a picture with parallel view rays if w is zero or changes its sign within the
/// picture.
fn check_rays(corners: &[Vertex; 8], right: f64, up: f64) -> Result<(), FitError> {
    let (least, greatest) =
        corners.iter().fold((f64::MAX, f64::MIN), |(min, max), corner| (min.min(corner.w), max.max(corner.w)));
    if least > 0.0 || greatest < 0.0 {
        return Ok(());
    }
    let plane = match (right.abs() > up.abs(), right > 0.0, up > 0.0) {
        (true, true, _) => "left plane",
        (true, false, _) => "right plane",
        (false, _, true) => "bottom plane",
        (false, _, false) => "top plane",
    };
    Err(FitError::UnusablePlane {
        plane,
        why: "w is zero or changes its sign before it; use a matrix whose w is positive in all of the picture",
    })
}

/// Returns the error for a clip cube without a volume, by the lengths of its sides.
fn coinciding(right: f64, up: f64, along: f64) -> FitError {
    let plane = if right.min(up) > along {
        "near and far planes"
    } else if right < up {
        "left and right planes"
    } else {
        "top and bottom planes"
    };
    FitError::UnusablePlane { plane, why: "they coincide; pass the inverse of clip_from_world" }
}

/// Returns the error for a near plane with the eye on its far side.
fn facing(depth: DepthConvention) -> FitError {
    let why = if depth == DepthConvention::Reversed {
        "the eye lies on its visible side; turn the plane around, or name a depth convention that is not reversed if the \
         matrix has one"
    } else {
        "the eye lies on its visible side; turn the plane around, or name DepthConvention::Reversed if the matrix has it"
    };
    FitError::UnusablePlane { plane: "near plane", why }
}
