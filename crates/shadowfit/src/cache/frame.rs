//! The input of a frame.

use glam::{DVec3, Vec3};

use super::casters::Casters;
use crate::culling::Reader;
use crate::{CasterVolume, FittedMap, StaticBoxes, ViewFrustum};

/// The part of the world in which shadows are visible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InView<'a> {
    /// The views that show the shadows, as they were given to the fit. The cache computes the casters that can shadow
    /// something in them.
    Views(&'a [ViewFrustum]),
    /// The casters of each map that can shadow something in view, for engines that know them better: by portals or
    /// occlusion. A map without a volume takes all casters. Gone casters count as in view.
    Volumes(&'a [CasterVolume]),
}

/// A frame, as [`MapCache::update`](super::MapCache::update) takes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CacheFrame<'a> {
    /// Maps that were fitted to this frame. Those with a [grid position](FittedMap::grid_position) can be kept; others
    /// are redrawn in each frame. Their [`texel_offset`](FittedMap::texel_offset) is ignored, and so are maps past
    /// [`MAX_MAPS`](crate::settings::MAX_MAPS).
    pub maps: &'a [FittedMap],
    /// Moving casters, and static ones that are not in [`Self::static_boxes`]. The fit must have had the same casters:
    /// a map cannot hold a caster that its fit did not know.
    pub casters: Casters<'a>,
    /// Static casters. Keep one [`StaticBoxes`]: another one, or none, redraws all maps.
    pub static_boxes: Option<&'a StaticBoxes>,
    /// Direction of travel of the maps' light, world axes, of any length.
    pub direction: Vec3,
    /// Origin of positions in the shaders, and the eye from which they count view depths.
    pub reader: Reader,
    /// The part of the world in which shadows are visible.
    pub in_view: InView<'a>,
}

impl<'a> CacheFrame<'a> {
    /// Returns a frame without static boxes, whose shaders take positions relative to the first view's eye.
    pub fn new(maps: &'a [FittedMap], casters: Casters<'a>, views: &'a [ViewFrustum], direction: Vec3) -> Self {
        let (eye, forward) = views.first().map_or((DVec3::ZERO, Vec3::NEG_Z), |view| (view.origin, view.forward));
        let reader = Reader::from_eye(eye, forward);
        Self { maps, casters, static_boxes: None, direction, reader, in_view: InView::Views(views) }
    }
}
