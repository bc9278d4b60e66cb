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

use crate::axes::{Light, LightAxes};
use crate::content::Content;
use crate::fits::{self, Placement};
use crate::grid;
use crate::light_hull::LightHull;
use crate::motion::Motion;
use crate::near_plane;
use crate::rectangle::Rectangle;
use crate::rule::FitRule;
use crate::settings::HoldSettings;
use crate::view::Range;
use crate::volume::{Constraint, Grid, ROUNDING, Volume};
use crate::{FitError, FitInput, ViewFrustum, Workspace};

/// A map of an earlier frame, in absolute world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct HeldMap {
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

/// One frame's input to the holding of maps.
pub(crate) struct Holder<'a, 'b> {
    pub(crate) input: &'a FitInput<'b>,
    pub(crate) content: &'a Content<'a>,
    pub(crate) light: Light,
    pub(crate) motion: Option<Motion>,
    pub(crate) hold: HoldSettings,
}

/// A held map as a fit's decision, relative to an origin.
pub(crate) fn volume(held: &HeldMap, origin: DVec3) -> Volume {
    let anchor = grid::anchor(&held.axes, origin);
    let min = held.first * held.texel - anchor.truncate();
    let max = min + held.texel * held.resolution;
    let mut volume = Volume {
        axes: held.axes,
        min: min.extend(held.z.0 - anchor.z),
        max: max.extend(held.z.1 - anchor.z),
        light_z: 0.0,
        depth_range: 0.0,
        set_by: held.set_by,
        is_empty: held.is_empty,
        grid: Some(Grid { first: held.first, texel: held.texel, z: held.z }),
    };
    volume.light_at_near_plane();
    volume
}

impl Holder<'_, '_> {
    /// The map of this frame: the held one if it still covers what it must.
    pub(crate) fn hold(
        &self,
        held: Option<HeldMap>,
        rule: &FitRule,
        slice: Range,
        points: &mut [DVec2],
    ) -> Result<HeldMap, FitError> {
        // The border and the near plane depend on the texels of the map that is kept or made.
        let plain = rule.without_room();
        let fresh = fits::fit_map(self.content, &self.light, &plain, slice, Placement::Tight, points)?;
        if let Some(held) = held.filter(|held| held.is_of(&fresh, rule))
            && let Some(kept) = self.keep(&held, &fresh, rule, slice, points)?
        {
            return Ok(kept);
        }
        self.make(&fresh, rule, slice, points)
    }

    /// A plain fit around what the views see and what they will see in some frames.
    fn fit_ahead(
        &self,
        ahead: &[ViewFrustum],
        rule: &FitRule,
        slice: Range,
        points: &mut [DVec2],
    ) -> Result<Volume, FitError> {
        let mut views = [self.input.views[0]; MAX_VIEWS];
        let now = self.input.views.len();
        if now + ahead.len() > MAX_VIEWS {
            let (value, max) = (now as f64, (MAX_VIEWS - 1) as f64);
            return Err(FitError::OutOfRange { input: "the number of views of held maps", value, min: 1.0, max });
        }
        views[..now].copy_from_slice(self.input.views);
        views[now..now + ahead.len()].copy_from_slice(ahead);
        let input = FitInput { views: &views[..now + ahead.len()], ..*self.input };
        let mut workspace = Workspace::new(points);
        let (content, points) = Content::new(&input, &mut workspace)?;
        fits::fit_map(&content, &self.light, rule, slice, Placement::Tight, points)
    }

    /// The held map moved by whole texels, if what must be covered fits into it and it is not too
    /// coarse.
    fn keep(
        &self,
        held: &HeldMap,
        fresh: &Volume,
        rule: &FitRule,
        slice: Range,
        points: &mut [DVec2],
    ) -> Result<Option<HeldMap>, FitError> {
        let needed = self.needed(held, rule, slice, points)?;
        let size = fresh.max - fresh.min;
        let held_size = held.texel * grid::usable(rule);
        let waste = f64::from(self.hold.waste);
        if held_size.x * held_size.y > size.x * size.y * waste * waste {
            return Ok(None);
        }
        let anchor = grid::anchor(&held.axes, self.input.views[0].origin);
        let low = floor((needed.across.min + anchor.truncate()) / held.texel);
        let high = -floor(-((needed.across.max + anchor.truncate()) / held.texel)) - held.resolution;
        if high.x > low.x || high.y > low.y {
            return Ok(None);
        }
        let mut kept = *held;
        kept.first = held.first.min(low).max(high);
        kept.z = grid::stabilised_depth(Some(held.z), (needed.z.0 + anchor.z, needed.z.1 + anchor.z), waste);
        kept.is_empty = fresh.is_empty;
        kept.set_by = [Constraint::Held; 6];
        Ok(Some(kept))
    }

    /// What must be covered and where the near plane must be, along the held axes.
    fn needed(&self, held: &HeldMap, rule: &FitRule, slice: Range, points: &mut [DVec2]) -> Result<Needed, FitError> {
        let hull = LightHull::of(rule.covers, self.content, held.axes, slice, points)?;
        let extent = (held.texel * held.resolution).max_element();
        let rounding = (hull.farthest + extent) * ROUNDING;
        let pad = rounding + rule.margin;
        let border = held.texel * rule.border;
        let mut across = Rectangle::around(hull.outline, DVec2::X);
        across.min -= border + pad;
        across.max += border + pad;
        let reach = near_plane::filter_reach(held.texel, rule, rounding);
        let (low, high) = (hull.z.0 - pad, hull.z.1 + pad);
        let near = near_plane::find(high, &held.axes, hull.outline, self.content, rule.depth, reach);
        Ok(Needed { across, z: (low, near.z), near_set_by: near.set_by })
    }

    /// A new map with room for the motion to come.
    fn make(&self, fresh: &Volume, rule: &FitRule, slice: Range, points: &mut [DVec2]) -> Result<HeldMap, FitError> {
        let mut volume = *fresh;
        let plain = FitRule { border: 0.0, ..*rule };
        let mut frames = self.hold.horizon;
        while let Some(motion) = self.motion.filter(|motion| frames > 0 && !motion.is_still(&self.input.views[0])) {
            let ahead = [motion.after(&self.input.views[0], frames / 2), motion.after(&self.input.views[0], frames)];
            // Without enough storage or views there is no looking ahead; the map is still valid for this
            // frame.
            let Ok(larger) = self.fit_ahead(&ahead, &plain, slice, points) else { break };
            let (size, old) = (larger.max - larger.min, fresh.max - fresh.min);
            let growth = f64::from(self.hold.growth);
            if size.x * size.y <= old.x * old.y * growth * growth {
                volume = larger;
                break;
            }
            frames = frames * 3 / 4;
        }
        let room = (volume.max - volume.min).truncate() * (0.5 * f64::from(self.hold.margin));
        volume.min -= room.extend(0.0);
        volume.max += room.extend(0.0);
        let origin = self.input.views[0].origin;
        let grid = grid::snap(&mut volume, origin, rule);
        let mut map = HeldMap::new(&volume, grid, rule, fresh);
        let needed = self.needed(&map, rule, slice, points)?;
        let anchor = grid::anchor(&map.axes, origin).z;
        let now = (needed.z.0 + anchor, needed.z.1 + anchor);
        let ahead = grid::stabilised_depth(None, (grid.z.0.min(now.0), grid.z.1.max(now.1)), 1.0);
        // A depth range that the next frame would give up at once is not used.
        map.z = grid::stabilised_depth(Some(ahead), now, f64::from(self.hold.waste));
        map.set_by[5] = needed.near_set_by.unwrap_or(map.set_by[5]);
        Ok(map)
    }
}

/// What a map must cover in this frame, along its axes and relative to the origin.
struct Needed {
    across: Rectangle,
    z: (f64, f64),
    near_set_by: Option<Constraint>,
}

/// Most views that held maps are fitted to, predicted ones included.
const MAX_VIEWS: usize = 10;

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

    /// Whether the map is of the same light and resolution.
    fn is_of(&self, fresh: &Volume, rule: &FitRule) -> bool {
        self.axes.z == fresh.axes.z && self.resolution == rule.resolution.as_dvec2()
    }
}

fn floor(v: DVec2) -> DVec2 {
    DVec2::new(grid::floor(v.x), grid::floor(v.y))
}
