//! Where the near plane stands, so that every caster that can throw a shadow into view is kept.
//!
//! What can do so stands over the footprint, toward the light. A caster's box reaches highest
//! above it at a corner of (the footprint's outline ∩ one of the box's faces as the light sees
//! them), so each of the faces that look toward the light is clipped to the outline as a polygon.
//!
//! ```text
//!    toward the light          ┌──────┐
//!           ▲                  │caster│   only the part over the outline counts,
//!    near ──┼───────────────●──┤- - - │   so the plane stands at ●
//!           │     outline   │  └──────┘
//!           └───────────────┘
//! ```

use glam::{DVec2, DVec3};

use super::Content;
use crate::axes::LightAxes;
use crate::light_fit::Constraint;
use crate::settings::{CasterPolicy, FitSettings};
use crate::view::{box_corners, moved};
use crate::{Aabb, Boxes};

/// Coordinate of the near plane along the light's z, and what set it if not the footprint.
pub(crate) struct NearPlane {
    pub(crate) z: f64,
    pub(crate) set_by: Option<Constraint>,
}

/// Places the near plane of a volume that so far ends at `covered` along the light's z.
///
/// `outline` is the convex outline of what is covered, anticlockwise, in the plane of `axes`.
pub(crate) fn place(
    covered: f64,
    axes: &LightAxes,
    outline: &[DVec2],
    content: &Content,
    settings: &FitSettings,
    pad: f64,
) -> NearPlane {
    let over = Outline::new(axes, outline, pad);
    let z = match settings.casters {
        CasterPolicy::None | CasterPolicy::DepthClamp => covered,
        CasterPolicy::Extend => covered + f64::from(settings.caster_extension),
        CasterPolicy::SceneBounds => {
            let all = content.casters.boxes.iter().filter(|b| !b.is_empty()).fold(Aabb::EMPTY, |a, b| a.union(*b));
            let all = [all];
            over.highest(&Boxes { boxes: &all, ..content.casters }, content.origin, covered)
        }
        CasterPolicy::List => over.highest(&content.casters, content.origin, covered),
    };
    let moved = match settings.casters {
        CasterPolicy::Extend => Constraint::CasterExtension,
        _ => Constraint::Casters,
    };
    NearPlane { z, set_by: if z > covered { Some(moved) } else { None } }
}

/// A convex outline with its bounds, widened by what rounding may shift.
struct Outline<'a> {
    axes: LightAxes,
    corners: &'a [DVec2],
    min: DVec2,
    max: DVec2,
    pad: f64,
}

/// Most corners of a face clipped to one edge after the other that are kept; beyond it the face
/// counts unclipped, which is on the safe side.
const MAX_CORNERS: usize = 24;

/// A clipped face: a convex polygon in the light's plane with the height of each corner.
#[derive(Clone, Copy)]
struct Face {
    corners: [DVec3; MAX_CORNERS],
    len: usize,
}

impl<'a> Outline<'a> {
    fn new(axes: &LightAxes, corners: &'a [DVec2], pad: f64) -> Self {
        let (mut min, mut max) = (DVec2::MAX, DVec2::MIN);
        for p in corners {
            (min, max) = (min.min(*p), max.max(*p));
        }
        Self { axes: *axes, corners, min: min - pad, max: max + pad, pad }
    }

    /// The greatest z of all casters over the outline, or `covered` where none reaches higher.
    fn highest(&self, casters: &Boxes, origin: DVec3, covered: f64) -> f64 {
        let offset = casters.origin - origin;
        let mut z = covered;
        for aabb in casters.boxes.iter().filter(|aabb| !aabb.is_empty()) {
            let (min, max) = moved(aabb, offset);
            if let Some(top) = self.top(min, max, z - self.pad) {
                z = z.max(top + self.pad);
            }
        }
        z
    }

    /// Greatest height of a box over the outline, if that may be above `floor`.
    fn top(&self, min: DVec3, max: DVec3, floor: f64) -> Option<f64> {
        let axes = &self.axes;
        let (centre, half) = ((min + max) * 0.5, (max - min) * 0.5);
        let (x, y, z) = (axes.x.as_dvec3(), axes.y.as_dvec3(), axes.z.as_dvec3());
        let centre = axes.project(centre);
        let reach = DVec3::new(x.abs().dot(half), y.abs().dot(half), z.abs().dot(half));
        let top = centre.z + reach.z;
        let (low, high) = (centre - reach, centre + reach);
        if top <= floor || low.x > self.max.x || low.y > self.max.y || high.x < self.min.x || high.y < self.min.y {
            return None;
        }
        let corners = box_corners(min, max).map(|corner| axes.project(corner));
        let mut best = None;
        for (face, inward) in FACES.into_iter().zip([z.x, -z.x, z.y, -z.y, z.z, -z.z]) {
            // Faces that look away from the light lie below the others.
            if inward <= 0.0 {
                let clipped = self.clip(face.map(|i| corners[i]));
                for corner in &clipped.corners[..clipped.len] {
                    best = Some(corner.z.max(best.unwrap_or(f64::MIN)));
                }
            }
        }
        best.filter(|top| *top > floor)
    }

    /// A face cut by all edges of the outline moved outward by the pad.
    fn clip(&self, face: [DVec3; 4]) -> Face {
        let mut polygon = Face { corners: [DVec3::ZERO; MAX_CORNERS], len: 4 };
        polygon.corners[..4].copy_from_slice(&face);
        let n = self.corners.len();
        if n < 3 {
            return polygon;
        }
        for i in 0..n {
            let (a, b) = (self.corners[i], self.corners[(i + 1) % n]);
            let edge = b - a;
            let slack = self.pad * (edge.x.abs() + edge.y.abs());
            let inside = |p: DVec3| edge.perp_dot(p.truncate() - a) + slack;
            match cut(&polygon, inside) {
                Some(cut) => polygon = cut,
                None => break,
            }
            if polygon.len == 0 {
                break;
            }
        }
        polygon
    }
}

/// The part of a polygon where a linear function is not negative (I. Sutherland and G. Hodgman,
/// "Reentrant polygon clipping", 1974); `None` when it has too many corners to store.
fn cut(polygon: &Face, inside: impl Fn(DVec3) -> f64) -> Option<Face> {
    let mut out = Face { corners: [DVec3::ZERO; MAX_CORNERS], len: 0 };
    let mut push = |p: DVec3| {
        if out.len < MAX_CORNERS {
            out.corners[out.len] = p;
        }
        out.len += 1;
    };
    for i in 0..polygon.len {
        let (a, b) = (polygon.corners[i], polygon.corners[(i + 1) % polygon.len]);
        let (da, db) = (inside(a), inside(b));
        if da >= 0.0 {
            push(a);
        }
        if (da >= 0.0) != (db >= 0.0) {
            let t = da / (da - db);
            push(a * (1.0 - t) + b * t);
        }
    }
    if out.len > MAX_CORNERS { None } else { Some(out) }
}

/// Corners of a box's faces -x, +x, -y, +y, -z, +z, by the order of [`box_corners`].
const FACES: [[usize; 4]; 6] = [[0, 3, 7, 4], [1, 2, 6, 5], [0, 1, 5, 4], [3, 2, 6, 7], [0, 1, 2, 3], [4, 5, 6, 7]];
