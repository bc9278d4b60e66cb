//! The shadow maps of one picture, and how its shader reads them.

use super::measured::MeasuredMap;

/// The shadow maps of a picture, and how they are read.
#[derive(Clone, Copy, Debug)]
pub struct PictureMaps<'a> {
    /// Maps, in order of their splits. A point reads the first one whose split is beyond its view
    /// depth; where that one does not hold the point, the next later one that does.
    pub maps: &'a [MeasuredMap],
    /// Reach of the filter: greatest distance per axis, in texels, from the sample point to the
    /// centre of a texel of non-zero weight (0.5 point, 1 hardware 2×2).
    pub reach: f32,
    /// Whether the maps were drawn with depth clamp, so that they also hold casters before their
    /// near plane.
    pub depth_clamp: bool,
}

impl PictureMaps<'_> {
    /// Width of the edge zone, in pixels where a texel is no wider than a pixel on screen, otherwise
    /// in texels: the filter's reach and one more, at least 1.5.
    pub fn edge_width(&self) -> f32 {
        (self.reach + 1.0).max(1.5)
    }
}
