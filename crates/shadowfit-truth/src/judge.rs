//! Classifies the wrong pixels of a picture: false shadow (acne), false light (peter-panning, leaks), hole
//! (clipping) and edge (aliasing).
//!
//! A picture's filtered shadow factors are compared with the truth. The class of a wrong pixel depends on the
//! map that it reads: on the width of the map's texels on screen, and on whether the map holds an occluder.
//! If two maps are blended, the map with the greater weight decides.

use rayon::prelude::*;

use crate::class::{Class, counts_as_lit};
use crate::displacement::displacement;
use crate::maps::{MIN_FACING, PictureMaps};
use crate::pixel::{PixelFinding, PixelTruth};
use crate::tally::{CountedPixel, PictureTally};
use crate::tracer::Tracer;
use crate::truth::{Truth, TruthPoint};

/// A judged picture. All lists are rows of pixels from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// Class of each pixel.
    pub classes: Vec<Class>,
    /// Screen pixels per shadow texel along the worse axis, in the map that is read. Infinite if no map
    /// covers the point or the surface is edge-on to the light. NaN if the pixel is not judged.
    pub pixels_per_texel: Vec<f32>,
    /// Whether the pixel lies in the edge zone. `false` if it is not judged.
    pub edge_zone: Vec<bool>,
    /// Index of the map that is read, or of the one with the greater weight if two are blended. Indices from
    /// 255 on are recorded as 255. `None` if no map covers the point or the pixel is not judged.
    pub map_index: Vec<Option<u8>>,
    /// Whether the pixel is judged and counts in the sums.
    pub counted: Vec<bool>,
    /// Sums over the counted pixels. [`PictureTally::is_empty`] without any.
    pub tally: PictureTally,
}

/// Judges a picture that was shadowed by `maps`.
///
/// `factors` holds the share of the light that the filtered maps let through at each pixel, 0..=1, rows from
/// the top. NaN counts as 0. Factors of pixels that are not judged are ignored. `counts` returns whether the
/// pixels of a triangle (index into the tracer's) are summed. The other pixels are judged too, and their
/// shadow edges count as edges, but they do not enter the sums.
///
/// The edge zone reaches [`PictureMaps::edge_width`] pixels from a true shadow edge. The width is in texels
/// if a texel is wider than a pixel on screen. At a point that no map covers it is in pixels.
///
/// # Panics
///
/// If `factors` does not have one element for each pixel.
pub fn judge(
    tracer: &Tracer,
    truth: &Truth,
    maps: &PictureMaps,
    factors: &[f32],
    counts: impl Fn(u32) -> bool + Sync,
) -> Judged {
    judged(tracer, truth, maps, factors, counts, || true)
}

/// Judges a picture like [`judge()`], but can be cancelled. It calls `goes_on` at every pixel. Once that
/// returns false, it stops and returns `None`. From then on `goes_on` must not return true.
///
/// # Panics
///
/// As [`judge()`].
pub fn judge_while(
    tracer: &Tracer,
    truth: &Truth,
    maps: &PictureMaps,
    factors: &[f32],
    counts: impl Fn(u32) -> bool + Sync,
    goes_on: impl Fn() -> bool + Sync,
) -> Option<Judged> {
    let judged = judged(tracer, truth, maps, factors, counts, &goes_on);
    goes_on().then_some(judged)
}

fn judged(
    tracer: &Tracer,
    truth: &Truth,
    maps: &PictureMaps,
    factors: &[f32],
    counts: impl Fn(u32) -> bool + Sync,
    goes_on: impl Fn() -> bool + Sync,
) -> Judged {
    assert_eq!(factors.len(), truth.points.len(), "one factor for each pixel");
    let rays = PixelTruth { tracer, camera: &truth.camera, settings: &truth.settings };
    let findings: Vec<PixelFinding> = (0..factors.len())
        .into_par_iter()
        .map(|pixel| match &truth.points[pixel] {
            Some(point) if point.is_judged && goes_on() => {
                rays.find(maps, factors[pixel], pixel, point, |width| truth.is_near_transition(pixel, width))
            }
            _ => PixelFinding::NOT_JUDGED,
        })
        .collect();
    let counted = |point: &Option<TruthPoint>| point.is_some_and(|point| point.is_judged && counts(point.triangle));
    let mut judged = Judged {
        classes: findings.iter().map(|finding| finding.class).collect(),
        pixels_per_texel: findings.iter().map(|finding| finding.pixels_per_texel).collect(),
        edge_zone: findings.iter().map(|finding| finding.is_in_edge_zone).collect(),
        map_index: findings.iter().map(|finding| finding.map_index).collect(),
        counted: truth.points.par_iter().map(counted).collect(),
        tally: PictureTally::default(),
    };
    judged.tally = sums(truth, &judged, factors);
    judged
}

/// Computes the sums over the counted pixels.
fn sums(truth: &Truth, judged: &Judged, factors: &[f32]) -> PictureTally {
    let mut tally = PictureTally { frames: 1, ..PictureTally::default() };
    for pixel in (0..factors.len()).filter(|pixel| judged.counted[*pixel]) {
        let Some(point) = &truth.points[pixel] else { continue };
        // NaN counts as no light, as in the classification.
        let factor = if factors[pixel].is_nan() { 0.0 } else { factors[pixel].clamp(0.0, 1.0) };
        tally.add(&CountedPixel {
            class: judged.classes[pixel],
            is_in_edge_zone: judged.edge_zone[pixel],
            error: (factor - point.lit).abs(),
            facing: point.facing,
            is_covered: judged.map_index[pixel].is_some(),
            is_grazing: point.facing < MIN_FACING,
            pixels_per_texel: judged.pixels_per_texel[pixel],
        });
    }
    let size = truth.camera.size.map(|side| side as usize);
    let seen = |pixel: usize| truth.verdict(pixel).map(|_| counts_as_lit(factors[pixel]));
    let edges = displacement(size, &|pixel| truth.verdict(pixel), &seen, |pixel| judged.counted[pixel]);
    PictureTally { displacement: edges.sum, transitions: edges.transitions, ..tally }
}
