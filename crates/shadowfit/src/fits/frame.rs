//! Input of a placement for one frame, and the maps that it returns.

use crate::content::Content;
use crate::fits::FitRule;
use crate::input::FitInput;
use crate::light::{Light, Volume};
use crate::selection::DepthRange;
use crate::technique::Technique;
use crate::technique::settings::MAX_MAPS;
use crate::view::{Range, ViewFrustum};

/// One frame, with checked input.
pub(crate) struct Frame<'a, 'b> {
    pub(crate) input: &'a FitInput<'b>,
    pub(crate) technique: &'a Technique,
    /// Fit rule of each map.
    pub(crate) rule: &'a FitRule,
    pub(crate) light: Light,
    pub(crate) content: &'a Content<'b>,
    /// View depths that have shadows.
    pub(crate) range: Range,
    /// First view of the last frame.
    pub(crate) last_view: Option<&'a ViewFrustum>,
}

/// A map before it becomes matrices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedMap {
    /// Box that the map stores, from the near plane to the far plane.
    pub(crate) volume: Volume,
    /// [`FittedMap::depths`](crate::FittedMap::depths).
    pub(crate) depths: Option<DepthRange>,
}

/// The maps of a frame.
pub(crate) type PlacedMaps = [Option<PlacedMap>; MAX_MAPS];
