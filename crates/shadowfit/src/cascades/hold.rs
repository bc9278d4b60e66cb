//! Held maps, which combine tight fits with edges that do not crawl.
//!
//! A held map keeps its angle and its texel size, and moves by whole texels of the world's grid. It is
//! replaced when the necessary region no longer fits into it, or when a fresh fit would have much finer
//! texels. The new map is larger, so that it also holds the predicted views of the next frames, within the
//! growth that the settings allow:
//!
//! ```text
//!    ┌─────────────────┐ new map
//!    │ ┌────┐          │
//!    │ │now │ ─ ─ ─ ▶  │  what will be seen some frames on
//!    │ └────┘          │
//!    └─────────────────┘
//! ```
//!
//! The views of the last two frames give the camera's [motion](super::motion), which is assumed to continue.
//!
//! Depths are found in one of two ways. If only its slice of the view reads a map, casters count over the outline of the
//! slice. If any point in the map may read it, casters and receivers count over the whole map.

use glam::{DVec2, DVec3};

use crate::base::checks::ROUNDING;
use crate::base::{FitError, checks};
use crate::content::{Content, MAX_SPHERE_VIEWS};
use crate::fits;
use crate::fits::covered::{Detail, LightHull};
use crate::fits::near_plane::{self, NearPlane};
use crate::fits::rectangle::Rectangle;
use crate::fits::{Alignment, FitRule, Frame, Snapping};
use crate::input::FitInput;
use crate::light::grid::Grid;
use crate::light::{BoundSource, LightAxes, Volume, grid};
use crate::technique::settings::Hysteresis;
use crate::view::{Range, ViewFrustum};

use super::motion::Motion;

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
    bounds_from: [BoundSource; 6],
}

/// Context for holding the maps of a frame.
pub(super) struct Holder<'a, 'b> {
    pub(super) frame: &'a Frame<'a, 'b>,
    pub(super) settings: Hysteresis,
    /// Motion of the camera since the last frame.
    pub(super) motion: Option<Motion>,
}

impl Holder<'_, '_> {
    /// Returns the map of this frame: the held one if it is still large enough and not too large.
    pub(super) fn hold(&self, held: Option<HeldMap>, slice: Range, points: &mut [DVec2]) -> Result<HeldMap, FitError> {
        let rule = self.frame.rule;
        let is_of_light = |held: &HeldMap| held.is_of(&self.frame.light.axes(rule.form.roll), rule);
        let Some(held) = held.filter(is_of_light) else { return self.make(&self.fresh(slice, points)?, slice, points) };
        let needed = self.needed(&held, Detail::Bounds, slice, points)?;
        let Some(kept) = self.keep(&held, &needed) else {
            return self.make(&self.fresh(slice, points)?, slice, points);
        };
        // No rectangle is smaller than the outline in it, so most maps need no comparison with a new one.
        let held_size = held.texel * rule.usable();
        let (held_area, max_oversize) = (held_size.x * held_size.y, f64::from(self.settings.max_oversize));
        let is_small = |needed: &Needed| held_area <= needed.area * (1.0 - SAME_AREA) * max_oversize * max_oversize;
        if is_small(&needed) || needed.is_bounds && is_small(&self.needed(&held, Detail::Outline, slice, points)?) {
            return Ok(kept);
        }
        let fresh = self.fresh(slice, points)?;
        let size = fresh.max - fresh.min;
        if held_area > size.x * size.y * max_oversize * max_oversize {
            self.make(&fresh, slice, points)
        } else {
            Ok(kept)
        }
    }

    /// Fits a slice without its border and near plane, which depend on the texels of the map that is kept or made.
    fn fresh(&self, slice: Range, points: &mut [DVec2]) -> Result<Volume, FitError> {
        let plain = trial(&self.frame.rule.without_room());
        fits::fit_map(self.frame.content, &self.frame.light, &plain, slice, Snapping::Tight, points)
    }

    /// Moves the held map by whole texels, if the necessary region fits into it.
    fn keep(&self, held: &HeldMap, needed: &Needed) -> Option<HeldMap> {
        let anchor = grid::anchor(&held.axes, self.frame.input.views[0].origin);
        let low = floor((needed.across.min + anchor.truncate()) / held.texel);
        let high = -floor(-((needed.across.max + anchor.truncate()) / held.texel)) - held.resolution;
        if high.x > low.x || high.y > low.y {
            return None;
        }
        let mut kept = *held;
        kept.first = held.first.min(low).max(high);
        let depths = self.depths(&kept, needed);
        let max_oversize = f64::from(self.settings.max_oversize);
        kept.z = grid::stabilised_depth(Some(held.z), depths.far + anchor.z, depths.near + anchor.z, max_oversize);
        kept.is_empty = needed.is_empty;
        kept.bounds_from = [BoundSource::Held; 6];
        Some(kept)
    }

    /// Finds the region that must be covered, along the held axes.
    fn needed(&self, held: &HeldMap, detail: Detail, slice: Range, points: &mut [DVec2]) -> Result<Needed, FitError> {
        let rule = self.frame.rule;
        // Casters count over the outline, or else over the whole map.
        let detail = if rule.serves_all { detail } else { Detail::Outline };
        let hull = LightHull::of(rule.form.covers, detail, self.frame.content, held.axes, slice, points)?;
        let extent = (held.texel * held.resolution).max_element();
        let rounding = (hull.farthest + extent) * ROUNDING;
        let pad = rounding + rule.margin;
        let border = held.texel * rule.border;
        let mut across = Rectangle::around(hull.outline, DVec2::X);
        across.min -= border + pad;
        across.max += border + pad;
        let reach = near_plane::filter_reach(held.texel, rule, rounding);
        let (far, near) = (hull.z.0 - pad, hull.z.1 + pad);
        let over_outline = || near_plane::find(near, &held.axes, hull.outline, self.frame.content, rule.depth, reach);
        Ok(Needed {
            across,
            far,
            near,
            over_outline: (!rule.serves_all).then(over_outline),
            reach,
            area: area(hull.outline),
            is_bounds: detail == Detail::Bounds,
            is_empty: hull.is_empty,
        })
    }

    /// Finds the depths that a map must reach at its current position.
    fn depths(&self, map: &HeldMap, needed: &Needed) -> Depths {
        let (axes, content) = (&map.axes, self.frame.content);
        if let Some(near) = &needed.over_outline {
            return Depths { far: needed.far, near: near.z, near_from: near.from };
        }
        let Volume { min, max, .. } = map.volume(content.origin);
        let (min, max) = (min.truncate(), max.truncate());
        let near = near_plane::find_over(needed.near, axes, min, max, content, self.frame.rule.depth, needed.reach);
        let far = near_plane::find_far(needed.far, axes, min, max, content);
        Depths { far, near: near.z, near_from: near.from }
    }

    /// Makes a map with room for the predicted motion.
    fn make(&self, fresh: &Volume, slice: Range, points: &mut [DVec2]) -> Result<HeldMap, FitError> {
        let rule = self.frame.rule;
        let mut volume = self.look_ahead(fresh, slice, points)?.unwrap_or(*fresh);
        let room = (volume.max - volume.min).truncate() * (0.5 * f64::from(self.settings.margin));
        volume.min -= room.extend(0.0);
        volume.max += room.extend(0.0);
        let origin = self.frame.input.views[0].origin;
        let grid = rule.snap(&mut volume, origin);
        let mut map = HeldMap::new(&volume, grid, rule, fresh);
        let needed = self.needed(&map, Detail::Bounds, slice, points)?;
        let anchor = grid::anchor(&map.axes, origin).z;
        let depths = self.depths(&map, &needed);
        let (far, near) = (depths.far + anchor, depths.near + anchor);
        let ahead = grid::stabilised_depth(None, grid.z.0.min(far), grid.z.1.max(near), 1.0);
        // A depth range that the next frame would discard at once is not used.
        map.z = grid::stabilised_depth(Some(ahead), far, near, f64::from(self.settings.max_oversize));
        map.bounds_from[5] = depths.near_from.unwrap_or(map.bounds_from[5]);
        Ok(map)
    }

    /// Fits a slice for the predicted views of the next frames, up to the settings' greatest growth. Returns
    /// `None` if the camera does not move or the views cannot be fitted. A map without room is still valid
    /// for this frame.
    fn look_ahead(&self, fresh: &Volume, slice: Range, points: &mut [DVec2]) -> Result<Option<Volume>, FitError> {
        let view = &self.frame.input.views[0];
        let Some(motion) = self.motion.filter(|motion| !motion.is_still(view)) else { return Ok(None) };
        let plain = trial(&FitRule { border: 0.0, ..*self.frame.rule });
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
        if self.frame.rule.serves_all {
            by_halves(self.settings.look_ahead, within_growth)
        } else {
            steps_ahead(self.settings.look_ahead).find_map(|frames| within_growth(frames).transpose()).transpose()
        }
    }

    /// Fits a slice for the current views and for predicted ones.
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
}

/// Returns numbers of frames to look ahead, each a quarter less than the one before. All are tried in this
/// order, since a map does not always grow with the number: a turning camera returns to its first view.
fn steps_ahead(horizon: u32) -> impl Iterator<Item = u32> {
    core::iter::successors(Some(horizon), |frames| Some(frames / 4 * 3 + frames % 4 * 3 / 4))
        .take_while(|frames| *frames > 0)
}

/// Finds a number of frames to look ahead within the allowed growth, by bisection over numbers that are each
/// half of the one before. It is the greatest such number if maps grow with the number. If not, it is still
/// within the growth. That is enough for maps that cover more than a slice anyway, and saves most of the
/// fits.
fn by_halves(
    horizon: u32,
    mut within_growth: impl FnMut(u32) -> Result<Option<Volume>, FitError>,
) -> Result<Option<Volume>, FitError> {
    let steps = || core::iter::successors(Some(horizon), |n| Some(n / 2)).take_while(|n| *n > 0);
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

/// Returns a rule for maps whose depths are found later. The rectangle is then enough, and the contents are
/// not visited.
fn trial(rule: &FitRule) -> FitRule {
    FitRule { serves_all: rule.serves_all && rule.form.alignment == Alignment::OnGrid, ..*rule }
}

/// Region that a map must cover in this frame, along its axes and relative to the origin.
struct Needed {
    across: Rectangle,
    /// Depths that must be covered, along the light's z.
    far: f64,
    near: f64,
    /// The near plane, if casters count over the outline. Otherwise it depends on the position of the map.
    over_outline: Option<NearPlane>,
    /// Distance beside the map within which casters count, in metres.
    reach: f64,
    /// Area of the region's outline, in square metres.
    area: f64,
    /// Whether the outline may lack corners, so that its area may be too small.
    is_bounds: bool,
    /// Whether no part of the region is known to receive shadows.
    is_empty: bool,
}

/// Depths of a map along the light's z, relative to the origin.
struct Depths {
    far: f64,
    near: f64,
    /// Source of the near depth, unless it is the necessary region.
    near_from: Option<BoundSource>,
}

/// Greatest change of an area by the rounding of a map's axes, as a share of the area.
const SAME_AREA: f64 = 1e-5;

/// Greatest number of views that held maps are fitted to: the views of a frame and two predicted ones.
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
            bounds_from: fresh.bounds_from,
        }
    }

    /// Returns the box that the map stores, relative to an origin.
    pub(super) fn volume(&self, origin: DVec3) -> Volume {
        let grid = Grid { first: self.first, texel: self.texel, z: self.z };
        Volume::on_grid(self.axes, grid, self.resolution, origin, self.bounds_from, self.is_empty)
    }

    /// Returns whether the map belongs to this light and resolution.
    fn is_of(&self, axes: &LightAxes, rule: &FitRule) -> bool {
        self.axes.z == axes.z && self.resolution == rule.resolution.as_dvec2()
    }
}

/// Computes the area of a convex outline (anticlockwise), in square metres.
fn area(outline: &[DVec2]) -> f64 {
    let Some(first) = outline.first() else { return 0.0 };
    outline.windows(2).map(|edge| (edge[0] - *first).perp_dot(edge[1] - *first) * 0.5).sum()
}

fn floor(v: DVec2) -> DVec2 {
    DVec2::new(checks::floor(v.x), checks::floor(v.y))
}
