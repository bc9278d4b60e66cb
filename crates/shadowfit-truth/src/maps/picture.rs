//! The shadow maps of one picture, and how its shader reads them.

use glam::DVec3;
use shadowfit::selection::{DepthRange, MapOrder, MapRead, by_coverage, by_view_depth};

use super::measured::MeasuredMap;
use super::selection::SelectedMap;

/// Which of the maps of a picture a point reads; [`shadowfit::selection`] has the rules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MapReading {
    /// The first one whose split is beyond the point's view depth; where that one does not hold the point, the next
    /// later one that does. It is blended into the next one from that one's `blend_near` on.
    ViewDepth,
    /// The finest one that holds the point with the filter's reach.
    Coverage {
        /// The maps that are read, the finest first.
        order: MapOrder,
        /// Texels over which a map is blended into the next one toward its border; 0 for none.
        blend: f32,
    },
}

/// The shadow maps of a picture, and how they are read.
#[derive(Clone, Copy, Debug)]
pub struct PictureMaps<'a> {
    /// Maps; by view depth they are in order of their splits.
    pub maps: &'a [MeasuredMap],
    /// Which of them a point reads.
    pub reading: MapReading,
    /// Radius of the filter: greatest distance per axis, in texels, from the sample point to the
    /// centre of a texel of non-zero weight (0.5 point, 1 hardware 2×2). Selection by coverage uses it, and so
    /// does the edge zone of a map without [a radius](MeasuredMap::filter_radius).
    pub filter_radius: f32,
    /// Whether the maps were drawn with depth clamp, so that they also hold casters before their
    /// near plane.
    pub depth_clamp: bool,
}

impl<'a> PictureMaps<'a> {
    /// Width of the edge zone where a point reads a map, in pixels where a texel is no wider than a pixel on screen,
    /// otherwise in texels: the filter's reach in that map and one more, at least 1.5. Without a map
    /// (`None`), or with an index beyond the last one, the reach is [`Self::filter_radius`].
    pub fn edge_width(&self, map: Option<usize>) -> f32 {
        let own = map.and_then(|map| self.maps.get(map)?.filter_radius);
        (own.unwrap_or(self.filter_radius) + 1.0).max(1.5)
    }

    /// The maps that a point of the world reads, and with which weights; `None` where no map covers it. `view_depth` is
    /// in metres.
    pub fn read(&self, view_depth: f64, point: DVec3) -> Option<MapRead> {
        let free = |index: usize| {
            let map = self.maps.get(index)?;
            let position = map.project(point);
            map.is_inside(&position).then(|| map.texels_to_edge(&position))
        };
        match self.reading {
            MapReading::ViewDepth => {
                let range = |map: &MeasuredMap| {
                    let covered_from = map.blend_near.is_finite().then_some(map.blend_near);
                    Some(DepthRange { covered_from, ..DepthRange::new(0.0, Some(map.split_far)) })
                };
                by_view_depth(self.maps.iter().map(range), view_depth, |index| free(index).is_some())
            }
            MapReading::Coverage { order, blend } => {
                by_coverage(order.iter(), f64::from(self.filter_radius), f64::from(blend), free)
            }
        }
    }

    /// The map that weighs more of those that a point reads.
    pub(crate) fn main(&self, view_depth: f64, point: DVec3) -> Option<SelectedMap<'a>> {
        let index = self.read(view_depth, point)?.main();
        let map = &self.maps[index];
        Some(SelectedMap { index, map, position: map.project(point) })
    }
}
