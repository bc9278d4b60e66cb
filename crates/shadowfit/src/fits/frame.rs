//! One frame as placements see it, and the maps that they return.

use crate::content::Content;
use crate::fits::FitRule;
use crate::input::FitInput;
use crate::light::{Light, Volume};
use crate::selection::DepthRange;
use crate::technique::Technique;
use crate::technique::settings::MAX_MAPS;
use crate::view::{Range, ViewFrustum};

/// One frame, checked.
pub(crate) struct Frame<'a, 'b> {
    pub(crate) input: &'a FitInput<'b>,
    pub(crate) technique: &'a Technique,
    /// How each of its maps is fitted.
    pub(crate) rule: &'a FitRule,
    pub(crate) light: Light,
    pub(crate) content: &'a Content<'b>,
    /// The view depths that are shadowed at all.
    pub(crate) range: Range,
    /// The first view of the frame before.
    pub(crate) last_view: Option<&'a ViewFrustum>,
}

/// A map before it becomes matrices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedMap {
    /// The box that it stores, from the near plane to the far plane.
    pub(crate) volume: Volume,
    /// [`FittedMap::depths`](crate::FittedMap::depths).
    pub(crate) depths: Option<DepthRange>,
}

/// The maps of a frame.
pub(crate) type PlacedMaps = [Option<PlacedMap>; MAX_MAPS];
