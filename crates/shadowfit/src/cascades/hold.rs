//! Maps that are kept while they serve: zero crawl with tight fits.
//!
//! A held map keeps its angle and its texel size, and moves by whole texels of the world's grid.
//! It is given up when what must be covered no longer fits into it, or when a fresh fit would
//! have much finer texels. The new one is made larger, by what the camera will see if it goes on
//! as it does, for as long as that costs no more than the settings allow:
//!
//! ```text
//!    ┌─────────────────┐ new map
//!    │ ┌────┐          │
//!    │ │now │ ─ ─ ─ ▶  │  what will be seen some frames on
//!    │ └────┘          │
//!    └─────────────────┘
//! ```

use glam::{DVec2, DVec3};

use crate::axes::LightAxes;
use crate::fits::{self, Content, Footprint, Light, Range, Volume};
use crate::light_fit::Constraint;
use crate::motion::Motion;
use crate::rectangle::Rectangle;
use crate::settings::{FitKind, FitSettings, HoldSettings};
use crate::{FitError, FitInput, ViewFrustum, Workspace, grid};

/// A map of an earlier frame, in the world's own coordinates.
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
pub(crate) struct Frame<'a, 'b> {
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
    };
    volume.light_at_near_plane();
    volume
}

impl Frame<'_, '_> {
    /// The map of this frame: the held one if it serves.
    pub(crate) fn place(
        &self,
        held: Option<HeldMap>,
        settings: &FitSettings,
        slice: Range,
        points: &mut [DVec2],
    ) -> Result<HeldMap, FitError> {
        let fresh = fits::fit_slice(self.content, &self.light, settings, slice, points)?;
        if let Some(held) = held.filter(|held| held.is_of(&fresh, settings))
            && let Some(kept) = self.keep(&held, &fresh, settings, slice, points)?
        {
            return Ok(kept);
        }
        self.make(&fresh, settings, slice, points)
    }

    /// A plain fit around what the views see and what they will see in some frames.
    fn fit_ahead(
        &self,
        ahead: &[ViewFrustum],
        settings: &FitSettings,
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
        fits::fit_slice(&content, &self.light, settings, slice, points)
    }

    /// The held map moved by whole texels, if what must be covered fits into it and it is not too
    /// coarse.
    fn keep(
        &self,
        held: &HeldMap,
        fresh: &Volume,
        settings: &FitSettings,
        slice: Range,
        points: &mut [DVec2],
    ) -> Result<Option<HeldMap>, FitError> {
        let needed = self.needed(held, settings, slice, points)?;
        let size = fresh.max - fresh.min;
        let held_size = held.texel * held.resolution;
        let waste = f64::from(self.hold.waste);
        if held_size.x * held_size.y > size.x * size.y * waste * waste {
            return Ok(None);
        }
        let anchor = grid::anchor(&held.axes, self.input.views[0].origin);
        let low = floor((needed.min + anchor.truncate()) / held.texel);
        let high = -floor(-((needed.max + anchor.truncate()) / held.texel)) - held.resolution;
        if high.x > low.x || high.y > low.y {
            return Ok(None);
        }
        let mut kept = *held;
        kept.first = held.first.min(low).max(high);
        kept.cover_depth(fresh, anchor.z);
        kept.is_empty = fresh.is_empty;
        kept.set_by = [Constraint::Held; 6];
        Ok(Some(kept))
    }

    /// What must be covered, along the held axes.
    fn needed(
        &self,
        held: &HeldMap,
        settings: &FitSettings,
        slice: Range,
        points: &mut [DVec2],
    ) -> Result<Rectangle, FitError> {
        let footprint = match settings.kind {
            FitKind::Focused => Footprint::of_receivers(self.content, held.axes, slice, points)?,
            _ => Footprint::of_views(self.content, held.axes, slice, points)?,
        };
        let pad = footprint.reach * grid::ROUNDING + f64::from(settings.margin);
        let kernel = held.texel * f64::from(settings.kernel_margin);
        let mut needed = Rectangle::around(footprint.outline, DVec2::X);
        needed.min -= kernel + pad;
        needed.max += kernel + pad;
        Ok(needed)
    }

    /// A new map with room for the motion to come.
    fn make(
        &self,
        fresh: &Volume,
        settings: &FitSettings,
        slice: Range,
        points: &mut [DVec2],
    ) -> Result<HeldMap, FitError> {
        // Margins in texels are added by the grid, whose texels are larger than a fresh fit's.
        let plain = FitSettings { kernel_margin: 0.0, ..*settings };
        let now = if settings.kernel_margin > 0.0 {
            fits::fit_slice(self.content, &self.light, &plain, slice, points)?
        } else {
            *fresh
        };
        let mut volume = now;
        let mut frames = self.hold.horizon;
        while let Some(motion) = self.motion.filter(|motion| frames > 0 && !motion.is_still()) {
            let ahead = [motion.after(&self.input.views[0], frames / 2), motion.after(&self.input.views[0], frames)];
            // Without storage or view to spare nothing is looked ahead: the map serves now all the same.
            let Ok(larger) = self.fit_ahead(&ahead, &plain, slice, points) else { break };
            let (size, old) = (larger.max - larger.min, now.max - now.min);
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
        grid::snap(&mut volume, self.input.views[0].origin, settings);
        Ok(HeldMap::new(&volume, self.input.views[0].origin, settings, fresh))
    }
}

/// Most views that held maps are fitted to, those looked ahead included.
const MAX_VIEWS: usize = 10;

impl HeldMap {
    fn new(volume: &Volume, origin: DVec3, settings: &FitSettings, fresh: &Volume) -> Self {
        let anchor = grid::anchor(&volume.axes, origin);
        let resolution = settings.resolution.as_dvec2();
        let texel = (volume.max - volume.min).truncate() / resolution;
        let line = (volume.min + anchor).truncate() / texel;
        Self {
            axes: volume.axes,
            texel,
            first: DVec2::new(libm::round(line.x), libm::round(line.y)),
            resolution,
            z: (volume.min.z + anchor.z, volume.max.z + anchor.z),
            is_empty: fresh.is_empty,
            set_by: fresh.set_by,
        }
    }

    /// Whether the map is of the same light and resolution.
    fn is_of(&self, fresh: &Volume, settings: &FitSettings) -> bool {
        self.axes.z == fresh.axes.z && self.resolution == settings.resolution.as_dvec2()
    }

    /// Makes the depth range hold a fresh fit's, in steps of its own.
    fn cover_depth(&mut self, fresh: &Volume, anchor: f64) {
        let (low, high) = (fresh.min.z + anchor, fresh.max.z + anchor);
        if low >= self.z.0 && high <= self.z.1 {
            return;
        }
        let depth = grid::quantised((high - low).max(self.z.1 - self.z.0));
        let step = depth / grid::DEPTH_STEPS;
        let start = libm::floor(low / step) * step;
        self.z = (start, start + depth + step);
    }
}

fn floor(v: DVec2) -> DVec2 {
    DVec2::new(libm::floor(v.x), libm::floor(v.y))
}
