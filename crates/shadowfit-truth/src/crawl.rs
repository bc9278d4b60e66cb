//! Crawl: how many pixels at shadow edges change their verdict only because the maps moved.
//!
//! The same points of the world are looked up in the maps of this frame and in those of the frame
//! before, so that neither the camera's motion nor true changes of the shadow are counted.

use glam::DVec3;
use rayon::prelude::*;

use crate::class::counts_as_lit;
use crate::judge::Judged;
use crate::maps::PictureMaps;
use crate::truth::Truth;

/// The maps of the frame before, and what they show at the points of this frame.
#[derive(Clone, Copy, Debug)]
pub struct MapsBefore<'a> {
    /// Its maps, and how they were read.
    pub maps: PictureMaps<'a>,
    /// Its eye, world space, metres.
    pub eye: DVec3,
    /// Its unit direction of view, world axes: view depths along it choose among maps that are read by
    /// view depth.
    pub forward: DVec3,
    /// Share of the light that its maps let through at the points of this frame's pixels, 0..=1,
    /// rows from the top.
    pub factors: &'a [f32],
}

/// Compares the verdicts of two frames' maps at the pixels that count, lie in the edge zone, and whose point the maps
/// of both frames cover. Returns how many of these pixels have another verdict in the frame before, and how many were
/// compared: with (0, 0) nothing was measured.
///
/// `factors` is what [`judge()`](crate::judge()) was given, `before` the frame before.
///
/// # Panics
///
/// If either list of factors does not have one element for each pixel.
pub fn crawl(truth: &Truth, judged: &Judged, factors: &[f32], before: &MapsBefore) -> (u64, u64) {
    assert_eq!(factors.len(), truth.points.len(), "as many factors as pixels");
    assert_eq!(before.factors.len(), truth.points.len(), "as many factors of the frame before as pixels");
    let is_compared = |pixel: usize| {
        let is_here = judged.counted[pixel] && judged.edge_zone[pixel] && judged.map_index[pixel].is_some();
        is_here
            && truth.points[pixel].is_some_and(|point| {
                let view_depth = (point.position - before.eye).dot(before.forward);
                before.maps.read(view_depth, point.position).is_some()
            })
    };
    (0..factors.len())
        .into_par_iter()
        .filter(|pixel| is_compared(*pixel))
        .map(|pixel| (u64::from(counts_as_lit(factors[pixel]) != counts_as_lit(before.factors[pixel])), 1))
        .reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1))
}
