//! The shadow maps of one picture, and its shader's rules for reading them.

use glam::DVec3;
use shadowfit::selection::{DepthRange, MapOrder, MapRead, by_coverage, by_view_depth};

use super::measured::MeasuredMap;
use super::selection::SelectedMap;

/// Selection of the map that a point reads. [`shadowfit::selection`] documents the rules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MapReading {
    /// The first map whose split is beyond the point's view depth. If it does not hold the point, the next
    /// later map that does. It is blended into the next map from that map's `blend_near` on.
    ViewDepth,
    /// The finest map that holds the point and the filter's footprint.
    Coverage {
        /// The maps that are read, the finest first.
        order: MapOrder,
        /// Texels over which a map is blended into the next one toward its border; 0 for no blend.
        blend: f32,
    },
}

/// The shadow maps of a picture, and the way they are read.
#[derive(Clone, Copy, Debug)]
pub struct PictureMaps<'a> {
    /// Maps. For selection by view depth, they are sorted by their splits.
    pub maps: &'a [MeasuredMap],
    /// Selection of the map that a point reads.
    pub reading: MapReading,
    /// Radius of the filter: greatest distance per axis, in texels, from the sample point to the centre of a
    /// texel of non-zero weight (0.5 point, 1 hardware 2×2). Selection by coverage uses it. It also sets the
    /// edge zone of a map without [its own radius](MeasuredMap::filter_radius).
    pub filter_radius: f32,
    /// Whether the maps were drawn with depth clamp, so that they also hold casters before their near plane.
    pub depth_clamp: bool,
}

impl<'a> PictureMaps<'a> {
    /// Returns the width of the edge zone of a point that reads a map: the filter's radius in that map plus
    /// 1, at least 1.5. It is in pixels, or in texels if a texel is wider than a pixel on screen. Without a
    /// map (`None`), or if the index is out of range, the radius is [`Self::filter_radius`].
    pub fn edge_width(&self, map: Option<usize>) -> f32 {
        let own = map.and_then(|map| self.maps.get(map)?.filter_radius);
        (own.unwrap_or(self.filter_radius) + 1.0).max(1.5)
    }

    /// Returns the maps that a world point reads, and their weights. `None` if no map covers it. `view_depth`
    /// is in metres.
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

    /// Returns the map with the greatest weight among the maps that a point reads.
    pub(crate) fn main(&self, view_depth: f64, point: DVec3) -> Option<SelectedMap<'a>> {
        let index = self.read(view_depth, point)?.main();
        let map = &self.maps[index];
        Some(SelectedMap { index, map, position: map.project(point) })
    }
}
