//! The passes of a frame as data: rectangles, with the casters of each.

use alloc::vec::Vec;
use core::ops::Range;

use glam::{DVec3, IVec2, UVec2};

use crate::scroll::{StoredRect, TexelRect};
use crate::{Aabb, CasterVolume, FittedMap};

/// One of a map's layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// The layer that shaders read.
    Shown,
    /// The layer of the static casters alone. Passes restore the shown layer from it. It exists from the
    /// first moving caster on. See [`MapCache::has_static_layers`](super::MapCache::has_static_layers).
    Static,
}

/// Content of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PassKind {
    /// All casters, static and moving. No part of the map is kept.
    All,
    /// Static casters, in new parts and where one of them changed.
    Static,
    /// Moving casters, over the static ones.
    Moving,
}

/// The part of a map that a frame reuses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapReuse {
    /// All of it, with the matrices of an earlier frame. The [schedule](super::UpdateSchedule) draws it
    /// later.
    Waits,
    /// All texels that the map already had, except where a static caster changed. The texel at `t` was at
    /// `t + shift` before, counted right and down.
    Kept {
        /// Movement of the map, in texels. Zero for a map that stays in its place.
        shift: IVec2,
    },
    /// No part. The map is drawn with all static casters over it, so that later frames can keep it.
    New,
    /// No part. The map is drawn for this frame alone, with fewer casters.
    OneFrame,
}

/// A pass into one layer of a map. It clears and restores parts of the layer first, then draws its regions.
#[derive(Clone, Debug, PartialEq)]
pub struct PassPlan {
    /// Index of the map.
    pub map: usize,
    /// Casters that the pass draws.
    pub content: PassKind,
    /// Layer that it draws into.
    pub layer: Layer,
    /// Whether the whole layer is cleared first. Otherwise its content is loaded.
    pub clears: bool,
    /// Rectangles of the layer to clear first, as a range of [`FramePlan::rects`].
    pub cleared: Range<usize>,
    /// Rectangles to copy first from the static casters' layer, as a range of [`FramePlan::rects`].
    pub mended: Range<usize>,
    /// Boxes to restore first from the static casters' layer, in all texels that they cover, as a range of
    /// [`FramePlan::boxes`].
    pub mended_boxes: Range<usize>,
    /// Top left corners of the viewports for drawing these boxes, as a range of [`FramePlan::viewports`].
    /// Each viewport has the size [`Self::size`].
    pub viewports: Range<usize>,
    /// Parts to draw, as a range of [`FramePlan::regions`].
    pub regions: Range<usize>,
    /// Width and height of the map, in texels.
    pub size: UVec2,
}

/// A part of a pass that is drawn with one viewport and one scissor rectangle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RegionPlan {
    /// The part in the map's coordinates and as stored in the layer. [`StoredRect::stored`] is the scissor
    /// rectangle, and [`StoredRect::viewport`] the top left corner of the viewport, whose size is
    /// [`PassPlan::size`].
    pub part: StoredRect,
    /// Listed casters to draw, nearest to the light first, as a range of [`FramePlan::casters`].
    pub casters: Range<usize>,
    /// Static boxes to draw, nearest to the light first, as a range of [`FramePlan::static_boxes`].
    pub static_boxes: Range<usize>,
}

/// The passes of a frame, and the maps to read after them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FramePlan {
    /// The maps to read, with their [texel offsets](FittedMap::texel_offset). A waiting map is the map that
    /// was drawn last, relative to the origin of the fitted one.
    pub maps: Vec<FittedMap>,
    /// The part of each map that is reused.
    pub reuse: Vec<MapReuse>,
    /// A volume for each map. If the passes depend on the views, it contains the casters that can shadow
    /// something in view, otherwise all casters that the map can store. Each volume is relative to its own
    /// origin.
    pub in_view: Vec<CasterVolume>,
    /// The passes in drawing order. Unchanged maps have none.
    pub passes: Vec<PassPlan>,
    /// Regions of the passes.
    pub regions: Vec<RegionPlan>,
    /// Casters of the regions, by their indices in the list.
    pub casters: Vec<u32>,
    /// Static boxes of the regions, by their numbers.
    pub static_boxes: Vec<u32>,
    /// Rectangles of layers, in stored texels.
    pub rects: Vec<TexelRect>,
    /// Boxes around moved casters, in metres relative to [`Self::origin`].
    pub boxes: Vec<Aabb>,
    /// Top left corners of viewports, in texels. They may lie outside the layer.
    pub viewports: Vec<IVec2>,
    /// World position that [`Self::boxes`] are relative to, in metres. It is the origin of the frame's
    /// [reader](super::CacheFrame::reader).
    pub origin: DVec3,
}

impl FramePlan {
    /// Returns the regions of a pass of this plan.
    pub fn regions_of(&self, pass: &PassPlan) -> &[RegionPlan] {
        self.regions.get(pass.regions.clone()).unwrap_or_default()
    }

    /// Returns the listed casters that a region of this plan draws, by number.
    pub fn casters_of(&self, region: &RegionPlan) -> &[u32] {
        self.casters.get(region.casters.clone()).unwrap_or_default()
    }

    /// Returns the numbers of the static boxes that a region of this plan draws.
    pub fn static_boxes_of(&self, region: &RegionPlan) -> &[u32] {
        self.static_boxes.get(region.static_boxes.clone()).unwrap_or_default()
    }

    /// Removes all passes.
    pub(super) fn clear_passes(&mut self) {
        self.passes.clear();
        self.regions.clear();
        self.casters.clear();
        self.static_boxes.clear();
        self.rects.clear();
        self.boxes.clear();
        self.viewports.clear();
    }
}
