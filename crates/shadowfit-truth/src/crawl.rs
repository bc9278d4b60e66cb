//! Shimmering: how many pixels at shadow edges change their verdict only because the maps moved.
//!
//! The same points of the world are looked up in the maps of this frame and in those of the frame
//! before, so that neither the camera's motion nor true changes of the shadow have a say.

use glam::DVec3;
use rayon::prelude::*;

use crate::judge::seems_lit;
use crate::peers::ShadowMap;
use crate::peers::choice::choose;
use crate::{Judged, Truth};

/// The frame before, as this frame's points see it.
#[derive(Clone, Copy, Debug)]
pub struct MapsBefore<'a> {
    /// Its maps, in order of their splits.
    pub maps: &'a [ShadowMap],
    /// Its eye, world space, metres.
    pub eye: DVec3,
    /// Its unit direction of view, world axes: a point's view depth along it chooses the map.
    pub forward: DVec3,
    /// Share of the light that its maps let through at the points of this frame's pixels, 0..=1,
    /// rows from the top.
    pub factors: &'a [f32],
}

/// Of the pixels that count and lie in the edge zone, where the maps of both frames hold the point:
/// how many have another verdict in the frame before, and how many there are.
///
/// # Panics
///
/// If either list of factors does not have an element a pixel.
pub fn crawl(truth: &Truth, judged: &Judged, factors: &[f32], before: &MapsBefore) -> (u64, u64) {
    assert_eq!(factors.len(), truth.points.len(), "as many factors as pixels");
    assert_eq!(before.factors.len(), truth.points.len(), "as many factors of the frame before as pixels");
    let is_compared = |pixel: usize| {
        let is_here = judged.counted[pixel] && judged.edge_zone[pixel] && judged.choice[pixel].is_some();
        is_here
            && truth.points[pixel].is_some_and(|point| {
                let view_depth = (point.position - before.eye).dot(before.forward);
                choose(before.maps, view_depth, point.position).is_some()
            })
    };
    (0..factors.len())
        .into_par_iter()
        .filter(|pixel| is_compared(*pixel))
        .map(|pixel| (u64::from(seems_lit(factors[pixel]) != seems_lit(before.factors[pixel])), 1))
        .reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1))
}
