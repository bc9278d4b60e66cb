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

use glam::{DVec2, DVec3};

use crate::base::FitError;
use crate::base::numbers::{self, ROUNDING};
use crate::content::{Content, MAX_SPHERE_VIEWS};
use crate::fits::light_hull::LightHull;
use crate::fits::rectangle::Rectangle;
use crate::fits::{self, Constraint, FitInput, FitRule, Frame, Snapping, Volume, near_plane};
use crate::light::grid::Grid;
use crate::light::{LightAxes, grid};
use crate::slices::motion::Motion;
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
        let needed = self.needed(&held, rule, slice, points)?;
        let Some(kept) = self.keep(&held, &needed, rule) else {
            return self.make(&fresh(points)?, rule, slice, points);
        };
        // No rectangle is smaller than the outline in it, so most maps need not be compared with a new one.
        let waste = f64::from(self.frame.technique.hold.waste);
        let held_size = held.texel * rule.usable();
        let held_area = held_size.x * held_size.y;
        if held_area <= needed.area * (1.0 - SAME_AREA) * waste * waste {
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
        let waste = f64::from(self.frame.technique.hold.waste);
        let (z, _) = self.depths(&kept, needed, rule);
        kept.z = grid::stabilised_depth(Some(held.z), (z.0 + anchor.z, z.1 + anchor.z), waste);
        kept.is_empty = needed.is_empty;
        kept.set_by = [Constraint::Held; 6];
        Some(kept)
    }

    /// What must be covered and where the near plane must be, along the held axes.
    fn needed(&self, held: &HeldMap, rule: &FitRule, slice: Range, points: &mut [DVec2]) -> Result<Needed, FitError> {
        let hull = LightHull::of(rule.form.covers, self.frame.content, held.axes, slice, points)?;
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
    /// for lack of storage or views: a map without room is still valid for this frame.
    fn look_ahead(&self, fresh: &Volume, rule: &FitRule, slice: Range, points: &mut [DVec2]) -> Option<Volume> {
        let view = &self.frame.input.views[0];
        let motion = self.motion.filter(|motion| !motion.is_still(view))?;
        let plain = trial(&FitRule { border: 0.0, ..*rule });
        let (old, growth) = (fresh.max - fresh.min, f64::from(self.frame.technique.hold.growth));
        let mut within_growth = |frames: u32| {
            let ahead = [motion.after(view, frames / 2), motion.after(view, frames)];
            let larger = self.fit_ahead(&ahead, &plain, slice, points).ok()?;
            let size = larger.max - larger.min;
            Some(larger).filter(|_| size.x * size.y <= old.x * old.y * growth * growth)
        };
        if !rule.serves_all {
            return steps_ahead(self.frame.technique.hold.horizon).find_map(within_growth);
        }
        // The more frames the larger: the greatest of a few numbers is found by halves.
        let steps =
            || core::iter::successors(Some(self.frame.technique.hold.horizon), |n| Some(n / 2)).take_while(|n| *n > 0);
        let (mut low, mut high, mut found) = (0, steps().count(), None);
        while low < high {
            let middle = usize::midpoint(low, high);
            match steps().nth(middle).and_then(&mut within_growth) {
                Some(volume) => (high, found) = (middle, Some(volume)),
                None => low = middle + 1,
            }
        }
        found
    }

    /// A new map with room for the motion to come.
    fn make(&self, fresh: &Volume, rule: &FitRule, slice: Range, points: &mut [DVec2]) -> Result<HeldMap, FitError> {
        let mut volume = self.look_ahead(fresh, rule, slice, points).unwrap_or(*fresh);
        let room = (volume.max - volume.min).truncate() * (0.5 * f64::from(self.frame.technique.hold.margin));
        volume.min -= room.extend(0.0);
        volume.max += room.extend(0.0);
        let origin = self.frame.input.views[0].origin;
        let grid = volume.snap(origin, rule);
        let mut map = HeldMap::new(&volume, grid, rule, fresh);
        let needed = self.needed(&map, rule, slice, points)?;
        let anchor = grid::anchor(&map.axes, origin).z;
        let (z, near_set_by) = self.depths(&map, &needed, rule);
        let now = (z.0 + anchor, z.1 + anchor);
        let ahead = grid::stabilised_depth(None, (grid.z.0.min(now.0), grid.z.1.max(now.1)), 1.0);
        // A depth range that the next frame would give up at once is not used.
        map.z = grid::stabilised_depth(Some(ahead), now, f64::from(self.frame.technique.hold.waste));
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
    FitRule { serves_all: rule.serves_all && rule.form.is_on_grid, ..*rule }
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
    DVec2::new(numbers::floor(v.x), numbers::floor(v.y))
}
