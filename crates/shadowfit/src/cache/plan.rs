//! The passes of a frame, as data: rectangles, and the casters of each.

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
    /// The layer of the static casters alone. Passes restore the shown layer from it. It is needed from the first moving
    /// caster on; see [`MapCache::has_static_layers`](super::MapCache::has_static_layers).
    Static,
}

/// Content of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PassKind {
    /// All casters, static and moving: no part of the map is kept.
    All,
    /// All static casters, where the map is new or one of them changed.
    Static,
    /// Moving casters, over the static ones.
    Moving,
}

/// The part of a map that a frame reuses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapReuse {
    /// All of it, with the matrices of an earlier frame: the [schedule](super::UpdateSchedule) draws it later.
    Waits,
    /// All texels that were in it before, unless a static caster changed there. The texel at `t` was at `t + shift`
    /// before, right and down.
    Kept {
        /// Movement of the map, in texels; zero for a map that stays in its place.
        shift: IVec2,
    },
    /// Nothing. It is drawn with all static casters over it, for later frames to keep.
    New,
    /// Nothing. It is drawn for this frame alone, with fewer casters.
    OneFrame,
}

/// A pass into one layer of a map. It begins by clearing and restoring parts of the layer, and then draws its regions.
#[derive(Clone, Debug, PartialEq)]
pub struct PassPlan {
    /// Index of the map.
    pub map: usize,
    /// Casters that the pass draws.
    pub content: PassKind,
    /// Layer that it draws into.
    pub layer: Layer,
    /// Whether the whole layer is cleared first. Otherwise it is loaded.
    pub clears: bool,
    /// Rectangles of the layer to clear first: a range of [`FramePlan::rects`].
    pub cleared: Range<usize>,
    /// Rectangles to copy first from the static casters' layer: a range of [`FramePlan::rects`].
    pub mended: Range<usize>,
    /// Boxes to restore first from the static casters' layer, in every texel that they cover on the map: a range of
    /// [`FramePlan::boxes`].
    pub mended_boxes: Range<usize>,
    /// Left top corners of the viewports with which the boxes are drawn, each of [`Self::size`]: a range of
    /// [`FramePlan::viewports`].
    pub viewports: Range<usize>,
    /// Parts to draw: a range of [`FramePlan::regions`].
    pub regions: Range<usize>,
    /// Width and height of the map, in texels.
    pub size: UVec2,
}

/// A part of a pass that is drawn with one viewport and one scissor rectangle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RegionPlan {
    /// The part as shaders look it up, and as it is stored: [`StoredRect::stored`] is the scissor rectangle, and
    /// [`StoredRect::viewport`] the left top corner of the viewport, whose size is [`PassPlan::size`].
    pub part: StoredRect,
    /// Casters of the list to draw, nearest to the light first: a range of [`FramePlan::casters`].
    pub casters: Range<usize>,
    /// Static boxes to draw, nearest to the light first: a range of [`FramePlan::static_boxes`].
    pub static_boxes: Range<usize>,
}

/// The passes of a frame, and the maps to read after them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FramePlan {
    /// The maps to read, with their [texel offsets](FittedMap::texel_offset). A map that waits is the one that was drawn
    /// last, relative to the origin of the fitted one.
    pub maps: Vec<FittedMap>,
    /// The reuse of each map.
    pub reuse: Vec<MapReuse>,
    /// The casters of each map that can shadow something in view, where the passes depend on that; otherwise all that the
    /// map can store. The origins of the volumes differ.
    pub in_view: Vec<CasterVolume>,
    /// The passes, in the order in which they must be drawn. A map that is kept unchanged has none.
    pub passes: Vec<PassPlan>,
    /// Regions of the passes.
    pub regions: Vec<RegionPlan>,
    /// Casters of the regions, by their indices in the list.
    pub casters: Vec<u32>,
    /// Static boxes of the regions, by their numbers.
    pub static_boxes: Vec<u32>,
    /// Rectangles of layers, as they are stored.
    pub rects: Vec<TexelRect>,
    /// Boxes around casters that moved, in metres relative to [`Self::origin`].
    pub boxes: Vec<Aabb>,
    /// Left top corners of viewports, in texels; they may lie outside the layer.
    pub viewports: Vec<IVec2>,
    /// World position that [`Self::boxes`] are relative to, in metres: the origin of the frame's
    /// [reader](super::CacheFrame::reader).
    pub origin: DVec3,
}

impl FramePlan {
    /// Returns the parts of a pass of this plan.
    pub fn regions_of(&self, pass: &PassPlan) -> &[RegionPlan] {
        self.regions.get(pass.regions.clone()).unwrap_or_default()
    }

    /// Returns the casters of the list that a part of this plan draws.
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
