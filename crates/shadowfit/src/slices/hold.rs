//! Maps that are kept as long as they cover what they must: no crawling edges with tight fits.
//!
//! A held map keeps its angle and its texel size, and moves by whole texels of the world's grid. It
//! is given up when what must be covered no longer fits into it, or when a fresh fit would have
//! much finer texels. The new one is made larger, to hold what the camera will see if its motion
//! goes on, for as many frames as the settings allow:
//!
//! ```text
//!    ┌─────────────────┐ new map
//!    │ ┌────┐          │
//!    │ │now │ ─ ─ ─ ▶  │  what will be seen some frames on
//!    │ └────┘          │
//!    └─────────────────┘
//! ```
//!
//! The views of the last two frames give the camera's rotation and movement, which are assumed to go on.

use glam::{DVec2, DVec3, Vec3};

use crate::base::checks::ROUNDING;
use crate::base::{FitError, checks};
use crate::content::{Content, MAX_SPHERE_VIEWS};
use crate::fits;
use crate::fits::covered::{Detail, LightHull};
use crate::fits::rectangle::Rectangle;
use crate::fits::{Alignment, FitRule, Frame, Snapping, near_plane};
use crate::input::FitInput;
use crate::light::grid::Grid;
use crate::light::{Constraint, LightAxes, Volume, grid};
use crate::technique::settings::Hysteresis;
use crate::view::{Range, ViewFrustum};

/// A map of an earlier frame, in absolute world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct HeldMap {
    /// The light's axes, turned.
    axes: LightAxes,
    /// Size of a texel, in metres.
    texel: DVec2,
    /// Grid line of the map's least corner, counted from the world's origin.
    first: DVec2,
    resolution: DVec2,
    /// Range along the light, counted from the world's origin, in metres.
    z: (f64, f64),
    is_empty: bool,
    set_by: [Constraint; 6],
}

/// Keeps the maps of a frame.
pub(super) struct Holder<'a, 'b> {
    pub(super) frame: &'a Frame<'a, 'b>,
    pub(super) settings: Hysteresis,
    /// How the camera moved since the frame before.
    pub(super) motion: Option<Motion>,
}

impl Holder<'_, '_> {
    /// The map of this frame: the held one if it still covers what it must.
    pub(super) fn hold(&self, held: Option<HeldMap>, slice: Range, points: &mut [DVec2]) -> Result<HeldMap, FitError> {
        let rule = self.frame.rule;
        // The border and the near plane depend on the texels of the map that is kept or made.
        let plain = trial(&rule.without_room());
        let fresh = |points: &mut [DVec2]| {
            fits::fit_map(self.frame.content, &self.frame.light, &plain, slice, Snapping::Tight, points)
        };
        let is_of_light = |held: &HeldMap| held.is_of(&self.frame.light.axes(rule.form.roll), rule);
        let Some(held) = held.filter(is_of_light) else { return self.make(&fresh(points)?, rule, slice, points) };
        let needed = self.needed(&held, Detail::Bounds, slice, points)?;
        let Some(kept) = self.keep(&held, &needed, rule) else {
            return self.make(&fresh(points)?, rule, slice, points);
        };
        // No rectangle is smaller than the outline in it, so most maps need not be compared with a new one.
        let waste = f64::from(self.settings.max_waste);
        let held_size = held.texel * rule.usable();
        let held_area = held_size.x * held_size.y;
        let is_small = |needed: &Needed| held_area <= needed.area * (1.0 - SAME_AREA) * waste * waste;
        if is_small(&needed) || rule.serves_all && is_small(&self.needed(&held, Detail::Outline, slice, points)?) {
            return Ok(kept);
        }
        let fresh = fresh(points)?;
        let size = fresh.max - fresh.min;
        if held_area > size.x * size.y * waste * waste { self.make(&fresh, rule, slice, points) } else { Ok(kept) }
    }

    /// A plain fit around what the views see and what they will see in some frames.
    fn fit_ahead(
        &self,
        ahead: &[ViewFrustum],
        rule: &FitRule,
        slice: Range,
        points: &mut [DVec2],
    ) -> Result<Volume, FitError> {
        let mut views = [self.frame.input.views[0]; MAX_VIEWS];
        let now = self.frame.input.views.len();
        if now + ahead.len() > MAX_VIEWS {
            let (value, max) = (now as f64, (MAX_VIEWS - 1) as f64);
            return Err(FitError::OutOfRange { input: "the number of views of held maps", value, min: 1.0, max });
        }
        views[..now].copy_from_slice(self.frame.input.views);
        views[now..now + ahead.len()].copy_from_slice(ahead);
        let input = FitInput { views: &views[..now + ahead.len()], ..*self.frame.input };
        let (content, points) = Content::new(input.scene(), points)?;
        fits::fit_map(&content, &self.frame.light, rule, slice, Snapping::Tight, points)
    }

    /// The held map moved by whole texels, if what must be covered fits into it.
    fn keep(&self, held: &HeldMap, needed: &Needed, rule: &FitRule) -> Option<HeldMap> {
        let anchor = grid::anchor(&held.axes, self.frame.input.views[0].origin);
        let low = floor((needed.across.min + anchor.truncate()) / held.texel);
        let high = -floor(-((needed.across.max + anchor.truncate()) / held.texel)) - held.resolution;
        if high.x > low.x || high.y > low.y {
            return None;
        }
        let mut kept = *held;
        kept.first = held.first.min(low).max(high);
        let waste = f64::from(self.settings.max_waste);
        let (z, _) = self.depths(&kept, needed, rule);
        kept.z = grid::stabilised_depth(Some(held.z), (z.0 + anchor.z, z.1 + anchor.z), waste);
        kept.is_empty = needed.is_empty;
        kept.set_by = [Constraint::Held; 6];
        Some(kept)
    }

    /// What must be covered and where the near plane must be, along the held axes. Its area may come out too small
    /// where no more than bounds are asked for.
    fn needed(&self, held: &HeldMap, detail: Detail, slice: Range, points: &mut [DVec2]) -> Result<Needed, FitError> {
        let rule = self.frame.rule;
        // Casters are looked for over the outline, or else over the whole map.
        let detail = if rule.serves_all { detail } else { Detail::Outline };
        let hull = LightHull::of((rule.form.covers, detail), self.frame.content, held.axes, slice, points)?;
        let extent = (held.texel * held.resolution).max_element();
        let rounding = (hull.farthest + extent) * ROUNDING;
        let pad = rounding + rule.margin;
        let border = held.texel * rule.border;
        let mut across = Rectangle::around(hull.outline, DVec2::X);
        across.min -= border + pad;
        across.max += border + pad;
        let reach = near_plane::filter_reach(held.texel, rule, rounding);
        let mut z = (hull.z.0 - pad, hull.z.1 + pad);
        let mut near_set_by = None;
        if !rule.serves_all {
            let near = near_plane::find(z.1, &held.axes, hull.outline, self.frame.content, rule.depth, reach);
            (z.1, near_set_by) = (near.z, near.set_by);
        }
        let (area, is_empty) = (area(hull.outline), hull.is_empty);
        Ok(Needed { across, z, near_set_by, reach, area, is_empty })
    }

    /// Depths that a map must reach, where it lies by now, and what sets the near one if it is not what is covered.
    fn depths(&self, map: &HeldMap, needed: &Needed, rule: &FitRule) -> ((f64, f64), Option<Constraint>) {
        if !rule.serves_all {
            return (needed.z, needed.near_set_by);
        }
        let volume = map.volume(self.frame.content.origin);
        let across = (volume.min.truncate(), volume.max.truncate());
        let near = near_plane::find_over(needed.z.1, &map.axes, across, self.frame.content, rule.depth, needed.reach);
        let far = near_plane::find_far(needed.z.0, &map.axes, across, self.frame.content);
        ((far, near.z), near.set_by)
    }

    /// What will be covered some frames on, as many as the settings' growth allows; `None` where nothing moves, or
    /// for lack of views: a map without room is still valid for this frame.
    fn look_ahead(
        &self,
        fresh: &Volume,
        rule: &FitRule,
        slice: Range,
        points: &mut [DVec2],
    ) -> Result<Option<Volume>, FitError> {
        let view = &self.frame.input.views[0];
        let Some(motion) = self.motion.filter(|motion| !motion.is_still(view)) else { return Ok(None) };
        let plain = trial(&FitRule { border: 0.0, ..*rule });
        let (old, growth) = (fresh.max - fresh.min, f64::from(self.settings.max_growth));
        let mut within_growth = |frames: u32| {
            let ahead = [motion.after(view, frames / 2), motion.after(view, frames)];
            let larger = match self.fit_ahead(&ahead, &plain, slice, points) {
                Ok(larger) => larger,
                Err(error @ FitError::ScratchTooSmall { .. }) => return Err(error),
                Err(_) => return Ok(None),
            };
            let size = larger.max - larger.min;
            Ok(Some(larger).filter(|_| size.x * size.y <= old.x * old.y * growth * growth))
        };
        if !rule.serves_all {
            let found = steps_ahead(self.settings.look_ahead).find_map(|frames| within_growth(frames).transpose());
            return found.transpose();
        }
        // The more frames the larger: the greatest of a few numbers is found by halves.
        let steps = || core::iter::successors(Some(self.settings.look_ahead), |n| Some(n / 2)).take_while(|n| *n > 0);
        let (mut low, mut high, mut found) = (0, steps().count(), None);
        while low < high {
            let middle = usize::midpoint(low, high);
            match steps().nth(middle).map_or(Ok(None), &mut within_growth)? {
                Some(volume) => (high, found) = (middle, Some(volume)),
                None => low = middle + 1,
            }
        }
        Ok(found)
    }

    /// A new map with room for the motion to come.
    fn make(&self, fresh: &Volume, rule: &FitRule, slice: Range, points: &mut [DVec2]) -> Result<HeldMap, FitError> {
        let mut volume = self.look_ahead(fresh, rule, slice, points)?.unwrap_or(*fresh);
        let room = (volume.max - volume.min).truncate() * (0.5 * f64::from(self.settings.margin));
        volume.min -= room.extend(0.0);
        volume.max += room.extend(0.0);
        let origin = self.frame.input.views[0].origin;
        let grid = rule.snap(&mut volume, origin);
        let mut map = HeldMap::new(&volume, grid, rule, fresh);
        let needed = self.needed(&map, Detail::Bounds, slice, points)?;
        let anchor = grid::anchor(&map.axes, origin).z;
        let (z, near_set_by) = self.depths(&map, &needed, rule);
        let now = (z.0 + anchor, z.1 + anchor);
        let ahead = grid::stabilised_depth(None, (grid.z.0.min(now.0), grid.z.1.max(now.1)), 1.0);
        // A depth range that the next frame would give up at once is not used.
        map.z = grid::stabilised_depth(Some(ahead), now, f64::from(self.settings.max_waste));
        map.set_by[5] = near_set_by.unwrap_or(map.set_by[5]);
        Ok(map)
    }
}

/// Numbers of frames to look ahead, each a quarter less than the one before.
fn steps_ahead(horizon: u32) -> impl Iterator<Item = u32> {
    core::iter::successors(Some(horizon), |frames| Some(frames / 4 * 3 + frames % 4 * 3 / 4))
        .take_while(|frames| *frames > 0)
}

/// A rule for maps whose depths are found later: the rectangle alone is enough, the contents are not visited.
fn trial(rule: &FitRule) -> FitRule {
    FitRule { serves_all: rule.serves_all && rule.form.alignment == Alignment::OnGrid, ..*rule }
}

/// What a map must cover in this frame, along its axes and relative to the origin.
struct Needed {
    across: Rectangle,
    z: (f64, f64),
    near_set_by: Option<Constraint>,
    /// How far beside it casters count, in metres.
    reach: f64,
    /// Area of the outline of what must be covered, in square metres.
    area: f64,
    /// Whether nothing of it is known to receive.
    is_empty: bool,
}

/// Share by which the rounding of a map's axes may change an area.
const SAME_AREA: f64 = 1e-5;

/// Most views that held maps are fitted to: those of a frame and two predicted ones.
const MAX_VIEWS: usize = MAX_SPHERE_VIEWS + 2;

impl HeldMap {
    fn new(volume: &Volume, grid: Grid, rule: &FitRule, fresh: &Volume) -> Self {
        Self {
            axes: volume.axes,
            texel: grid.texel,
            first: grid.first,
            resolution: rule.resolution.as_dvec2(),
            z: grid.z,
            is_empty: fresh.is_empty,
            set_by: fresh.set_by,
        }
    }

    /// The box that it stores, relative to an origin.
    pub(super) fn volume(&self, origin: DVec3) -> Volume {
        let grid = Grid { first: self.first, texel: self.texel, z: self.z };
        Volume::on_grid(self.axes, grid, self.resolution, origin, (self.set_by, self.is_empty))
    }

    /// Whether the map is of the same light and resolution.
    fn is_of(&self, axes: &LightAxes, rule: &FitRule) -> bool {
        self.axes.z == axes.z && self.resolution == rule.resolution.as_dvec2()
    }
}

/// Area of a convex outline (anticlockwise), in square metres.
fn area(outline: &[DVec2]) -> f64 {
    let Some(first) = outline.first() else { return 0.0 };
    outline.windows(2).map(|edge| (edge[0] - *first).perp_dot(edge[1] - *first) * 0.5).sum()
}

fn floor(v: DVec2) -> DVec2 {
    DVec2::new(checks::floor(v.x), checks::floor(v.y))
}

/// The step of a view from one frame to the next.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    /// Rotation about the eye, as the world axes' images.
    turn: [DVec3; 3],
    /// Movement of the eye, in metres.
    step: DVec3,
}

/// Difference of two views' edges, as an angle in radians, and of their near corners, as a share of the
/// far ones' distance, above which the lens has changed and nothing can be predicted.
const SAME_LENS: f64 = 1e-4;

/// The same for their far corners, for which an f32 matrix of plain depth has an error of 4 · 2⁻²⁴ ·
/// far / near.
const SAME_FAR: f64 = 1.0 / 64.0;

/// Orthonormal axes of a view; `None` for a view without them.
fn axes(view: &ViewFrustum) -> Option<[DVec3; 3]> {
    let forward = view.forward.as_dvec3();
    let right = (view.corners[5] - view.corners[4]).as_dvec3();
    let up = right.cross(forward);
    let right = forward.cross(up);
    let (r, u, f) = (checks::length(right), checks::length(up), checks::length(forward));
    if r > 0.0 && u > 0.0 && f > 0.0 { Some([right / r, up / u, forward / f]) } else { None }
}

impl Motion {
    /// The step between two views, if they look through the same lens.
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

    /// Whether a view stands still, up to rounding.
    pub(super) fn is_still(&self, view: &ViewFrustum) -> bool {
        let turn = self.turn;
        let turned = (turn[0] - DVec3::X).abs().max((turn[1] - DVec3::Y).abs()).max((turn[2] - DVec3::Z).abs());
        let far = checks::length(view.corners[4].as_dvec3());
        checks::length(self.step) <= STILL * far && turned.max_element() < STILL
    }

    /// A view after a number of further frames of the same motion.
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

/// Turn below which a view counts as still, in radians, and movement as a share of the far corners'
/// distance: the rounding of f32 corners.
const STILL: f64 = 1e-6;

fn apply(matrix: &[DVec3; 3], v: DVec3) -> DVec3 {
    matrix[0] * v.x + matrix[1] * v.y + matrix[2] * v.z
}
