//! Crawl: how many pixels at shadow edges change their verdict only because the maps moved.
//!
//! The same world points are looked up in the maps of this frame and of the previous frame. Camera motion and
//! true changes of the shadow are therefore not counted.

use glam::DVec3;
use rayon::prelude::*;

use crate::class::counts_as_lit;
use crate::judge::Judged;
use crate::maps::PictureMaps;
use crate::tally::Crawl;
use crate::truth::Truth;

/// The maps of the previous frame, and their factors at the points of this frame.
#[derive(Clone, Copy, Debug)]
pub struct MapsBefore<'a> {
    /// The previous frame's maps, and how they were read.
    pub maps: PictureMaps<'a>,
    /// The previous frame's eye, world space, metres.
    pub eye: DVec3,
    /// The previous frame's unit view direction, world axes. Selection by view depth uses view depths along
    /// it.
    pub forward: DVec3,
    /// Share of the light that the previous frame's maps let through at the points of this frame's pixels,
    /// 0..=1, rows from the top.
    pub factors: &'a [f32],
}

/// Compares the maps of two frames at the counted pixels whose point the maps of both frames cover. It
/// compares factors at all of them, and verdicts in the edge zone.
///
/// `factors` are the factors that [`judge()`](crate::judge()) was called with.
///
/// # Panics
///
/// If either list of factors does not have one element for each pixel.
pub fn crawl(truth: &Truth, judged: &Judged, factors: &[f32], before: &MapsBefore) -> Crawl {
    assert_eq!(factors.len(), truth.points.len(), "one factor for each pixel");
    assert_eq!(before.factors.len(), truth.points.len(), "one factor of the previous frame for each pixel");
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
