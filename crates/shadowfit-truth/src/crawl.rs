//! Crawl: how many pixels at shadow edges change their verdict only because the maps moved.
//!
//! The same points of the world are looked up in the maps of this frame and in those of the frame
//! before, so that neither the camera's motion nor true changes of the shadow are counted.

use glam::DVec3;
use rayon::prelude::*;

use crate::class::counts_as_lit;
use crate::judge::Judged;
use crate::maps::PictureMaps;
use crate::tally::Crawl;
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
/// of both frames cover; and the factors of those that lie elsewhere, too.
///
/// `factors` is what [`judge()`](crate::judge()) was given, `before` the frame before.
///
/// # Panics
///
/// If either list of factors does not have one element for each pixel.
pub fn crawl(truth: &Truth, judged: &Judged, factors: &[f32], before: &MapsBefore) -> Crawl {
    assert_eq!(factors.len(), truth.points.len(), "as many factors as pixels");
    assert_eq!(before.factors.len(), truth.points.len(), "as many factors of the frame before as pixels");
    let is_compared = |pixel: usize| {
        let is_here = judged.counted[pixel] && judged.map_index[pixel].is_some();
        is_here
            && truth.points[pixel].is_some_and(|point| {
                let view_depth = (point.position - before.eye).dot(before.forward);
                before.maps.read(view_depth, point.position).is_some()
            })
    };
    let of_pixel = |pixel: usize| {
        let (now, then) = (factors[pixel], before.factors[pixel]);
        let is_edge = judged.edge_zone[pixel];
        let is_different = is_edge && counts_as_lit(now) != counts_as_lit(then);
        (f64::from((now - then).abs()), is_edge, is_different)
    };
    let found: Vec<(f64, bool, bool)> =
        (0..factors.len()).into_par_iter().filter(|pixel| is_compared(*pixel)).map(of_pixel).collect();
    Crawl {
        different: found.iter().filter(|(_, _, is_different)| *is_different).count() as u64,
        compared: found.iter().filter(|(_, is_edge, _)| *is_edge).count() as u64,
        change: found.iter().map(|(change, ..)| change).sum(),
        change_compared: found.len() as u64,
    }
}
