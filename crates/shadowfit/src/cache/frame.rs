//! The input of a frame.

use glam::{DVec3, Vec3};

use super::casters::Casters;
use crate::culling::Reader;
use crate::{CasterVolume, FittedMap, StaticBoxes, ViewFrustum};

/// The part of the world with visible shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InView<'a> {
    /// The views that show the shadows, the same that the fit received. The cache computes the casters that
    /// can shadow something in them.
    Views(&'a [ViewFrustum]),
    /// The casters of each map that can shadow something in view, from an engine that knows them better, by
    /// portals or occlusion. A map without a volume takes all casters. Disappeared casters count as in view.
    Volumes(&'a [CasterVolume]),
}

/// Input of [`MapCache::update`](super::MapCache::update) for one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CacheFrame<'a> {
    /// The maps that were fitted for this frame. Maps with a [grid position](FittedMap::grid_position) can be
    /// kept. Others are redrawn in each frame. Their [`texel_offset`](FittedMap::texel_offset) is ignored,
    /// and so are maps past [`MAX_MAPS`](crate::settings::MAX_MAPS).
    pub maps: &'a [FittedMap],
    /// Moving casters, and static casters that are not in [`Self::static_boxes`]. The fit must have received
    /// the same casters, because a map cannot hold a caster that its fit did not know.
    pub casters: Casters<'a>,
    /// Static casters. Pass the same [`StaticBoxes`] in every frame: a different one, or none, redraws all
    /// maps.
    pub static_boxes: Option<&'a StaticBoxes>,
    /// Travel direction of the maps' light, in world axes, of any length.
    pub direction: Vec3,
    /// Origin of positions in the shaders, and the eye that view depths are measured from.
    pub reader: Reader,
    /// The part of the world with visible shadows.
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
