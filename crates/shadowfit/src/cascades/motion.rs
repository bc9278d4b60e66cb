//! The camera's motion from one frame to the next, which held maps extrapolate.

use glam::{DVec3, Vec3};

use crate::base::checks;
use crate::view::ViewFrustum;

/// Motion of a view from one frame to the next.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    /// Rotation about the eye, as the images of the world axes.
    turn: [DVec3; 3],
    /// Movement of the eye, in metres.
    step: DVec3,
}

/// Greatest difference of two views' edges, as an angle in radians, and of their near corners, as a share of
/// the far corners' distance. Above it the lens has changed, and the motion cannot be predicted.
const SAME_LENS: f64 = 1e-4;

/// Greatest difference of the views' far corners, as a share of their distance. An f32 matrix of plain depth
/// has an error of 4 · 2⁻²⁴ · far / near there.
const SAME_FAR: f64 = 1.0 / 64.0;

/// Returns the orthonormal axes of a view, or `None` if it is degenerate.
fn axes(view: &ViewFrustum) -> Option<[DVec3; 3]> {
    let forward = view.forward.as_dvec3();
    let right = (view.corners[5] - view.corners[4]).as_dvec3();
    let up = right.cross(forward);
    let right = forward.cross(up);
    let (r, u, f) = (checks::length(right), checks::length(up), checks::length(forward));
    if r > 0.0 && u > 0.0 && f > 0.0 { Some([right / r, up / u, forward / f]) } else { None }
}

impl Motion {
    /// Returns the motion between two views, if they look through the same lens.
    pub(super) fn between(before: &ViewFrustum, now: &ViewFrustum) -> Option<Self> {
        let (a, b) = (axes(before)?, axes(now)?);
        // Σ bᵢ aᵢᵀ maps one view's axes to the other's.
        let image = |v: DVec3| b[0] * a[0].dot(v) + b[1] * a[1].dot(v) + b[2] * a[2].dot(v);
        let motion =
            Self { turn: [image(DVec3::X), image(DVec3::Y), image(DVec3::Z)], step: now.origin - before.origin };
        let expected = motion.after(before, 1);
        let far = checks::length(now.corners[4].as_dvec3());
        let apart = |i: usize| checks::length((expected.corners[i] - now.corners[i]).as_dvec3());
        let is_same = |i: usize| {
            let edges = [&expected, now].map(|view| (view.corners[i + 4] - view.corners[i]).as_dvec3());
            let [a, b] = edges.map(|edge| edge / checks::length(edge));
            apart(i) <= SAME_LENS * far && apart(i + 4) <= SAME_FAR * far && checks::length(a - b) <= SAME_LENS
        };
        if (0..4).all(is_same) { Some(motion) } else { None }
    }

    /// Returns whether a view is at rest, up to rounding.
    pub(super) fn is_still(&self, view: &ViewFrustum) -> bool {
        let turn = self.turn;
        let turned = (turn[0] - DVec3::X).abs().max((turn[1] - DVec3::Y).abs()).max((turn[2] - DVec3::Z).abs());
        let far = checks::length(view.corners[4].as_dvec3());
        checks::length(self.step) <= STILL * far && turned.max_element() < STILL
    }

    /// Returns a view after a number of further frames of the same motion.
    pub(super) fn after(&self, view: &ViewFrustum, frames: u32) -> ViewFrustum {
        let mut turn = [DVec3::X, DVec3::Y, DVec3::Z];
        let mut power = self.turn;
        let mut left = frames;
        while left > 0 {
            if left & 1 == 1 {
                turn = turn.map(|v| apply(&power, v));
            }
            power = power.map(|v| apply(&power, v));
            left >>= 1;
        }
        let turned = |v: Vec3| apply(&turn, v.as_dvec3()).as_vec3();
        ViewFrustum {
            origin: view.origin + self.step * f64::from(frames),
            corners: view.corners.map(turned),
            forward: turned(view.forward),
            ..*view
        }
    }
}

/// Greatest turn of a view at rest, in radians, and greatest movement, as a share of the far corners'
/// distance: the rounding of f32 corners.
const STILL: f64 = 1e-6;

fn apply(matrix: &[DVec3; 3], v: DVec3) -> DVec3 {
    matrix[0] * v.x + matrix[1] * v.y + matrix[2] * v.z
}
