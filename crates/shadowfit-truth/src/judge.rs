//! Sorts the wrong pixels of a picture: false shadow (acne), false light (peter-panning, leaks), hole
//! (clipping) and edge (aliasing).
//!
//! A picture's filtered shadow factors are compared with the truth. The class of a wrong pixel depends
//! on the map that it reads: how wide its texels are on screen, and whether it holds an
//! occluder. Of two maps that are blended, it is the one that weighs more.

use rayon::prelude::*;

use crate::class::{Class, counts_as_lit};
use crate::displacement::displacement;
use crate::maps::{MIN_FACING, MapChoice, Occluder, PictureMaps, pixels_per_texel};
use crate::tally::{CountedPixel, PictureTally};
use crate::tracer::Tracer;
use crate::truth::{Truth, TruthPoint};

/// A judged picture. All lists are rows of pixels from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// Class of each pixel.
    pub classes: Vec<Class>,
    /// Screen pixels per shadow texel along the worse axis, in the map that is read. Infinite where no map covers the
    /// point or the surface is edge-on to the light; not a number where the pixel is not judged.
    pub pixels_per_texel: Vec<f32>,
    /// Whether the pixel lies in the edge zone; `false` where it is not judged.
    pub edge_zone: Vec<bool>,
    /// Index of the map that is read, of two the one that weighs more; 255 stands for all from there on. `None` where no map covers the point or the
    /// pixel is not judged.
    pub map_index: Vec<Option<u8>>,
    /// Whether the pixel is judged and counts in the sums.
    pub counted: Vec<bool>,
    /// Sums over the pixels that count. [`PictureTally::is_empty`] where there are none.
    pub tally: PictureTally,
}

/// The result for a single pixel.
struct Finding {
    class: Class,
    pixels_per_texel: f32,
    is_in_edge_zone: bool,
    map_index: Option<u8>,
}

impl Finding {
    const NOT_JUDGED: Self =
        Self { class: Class::NotJudged, pixels_per_texel: f32::NAN, is_in_edge_zone: false, map_index: None };
}

/// Judges a picture that was shadowed by `maps`.
///
/// `factors` holds the share of the light that the filtered maps let through at each pixel, 0..=1,
/// rows from the top. A factor that is not a number counts as 0; factors of pixels that are not judged
/// are ignored. `counts` says whether the pixels of a triangle (index into the tracer's) are summed:
/// those of the others are judged too, and their shadow edges are edges, but no sum contains them.
///
/// The edge zone reaches [`PictureMaps::edge_width`] pixels from a true shadow edge, or as many texels where a texel is
/// wider than a pixel on screen. At a point that no map covers it is in pixels.
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
    assert_eq!(factors.len(), truth.points.len(), "as many factors as pixels");
    let findings: Vec<Finding> = (0..factors.len())
        .into_par_iter()
        .map(|pixel| match &truth.points[pixel] {
            Some(point) if point.is_judged => find(tracer, truth, maps, factors[pixel], pixel, point),
            _ => Finding::NOT_JUDGED,
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

/// Judges a single pixel.
fn find(tracer: &Tracer, truth: &Truth, maps: &PictureMaps, factor: f32, pixel: usize, point: &TruthPoint) -> Finding {
    let choice = maps.main(point.view_depth, point.position);
    let texel_width = choice.as_ref().map(|choice| texel_width(truth, choice, pixel, point));
    let pixels = texel_width.map_or(1.0, |width| width.max(1.0));
    let is_in_edge_zone =
        truth.is_near_transition(pixel, maps.edge_width(choice.as_ref().map(|choice| choice.index)) * pixels);
    let class = match (counts_as_lit(point.lit), counts_as_lit(factor)) {
        (true, true) | (false, false) => Class::Right,
        (false, true) if is_hole(tracer, truth, maps, choice.as_ref(), pixel, point) => Class::Hole,
        _ if is_in_edge_zone => Class::Edge,
        (true, false) => Class::FalseShadow,
        (false, true) => Class::FalseLight,
    };
    Finding {
        class,
        pixels_per_texel: texel_width.unwrap_or(f32::INFINITY),
        is_in_edge_zone,
        map_index: choice.map(|choice| u8::try_from(choice.index).unwrap_or(u8::MAX)),
    }
}

/// Pixels per texel along the worse axis, in the map that the point reads; infinite where the surface
/// is edge-on to the light.
fn texel_width(truth: &Truth, choice: &MapChoice, pixel: usize, point: &TruthPoint) -> f32 {
    let steps = truth.camera.pixel_steps(truth.camera.ray_of(pixel), point.normal, point.view_depth);
    let pixels = pixels_per_texel(choice.map.gradients(&choice.position).texels_per_step(steps)) as f32;
    if pixels.is_nan() { f32::INFINITY } else { pixels }
}

/// Whether the map that is read holds none of the point's occluders, or no map is read.
fn is_hole(
    tracer: &Tracer,
    truth: &Truth,
    maps: &PictureMaps,
    choice: Option<&MapChoice>,
    pixel: usize,
    point: &TruthPoint,
) -> bool {
    let Some(choice) = choice else { return true };
    let mut is_held = false;
    truth.for_each_occluder(tracer, point, truth.blocked_ray(tracer, pixel, point), |occluder| {
        is_held |= match choice.occluder(occluder) {
            Occluder::Inside => true,
            Occluder::BeforeNear => maps.depth_clamp,
            Occluder::Outside => false,
        };
    });
    !is_held
}

/// Sums over the pixels that count.
fn sums(truth: &Truth, judged: &Judged, factors: &[f32]) -> PictureTally {
    let mut tally = PictureTally { frames: 1, ..PictureTally::default() };
    for pixel in (0..factors.len()).filter(|pixel| judged.counted[*pixel]) {
        let Some(point) = &truth.points[pixel] else { continue };
        // A factor that is not a number counts as no light, as it does for the class.
        let factor = if factors[pixel].is_nan() { 0.0 } else { factors[pixel].clamp(0.0, 1.0) };
        tally.add(&CountedPixel {
            class: judged.classes[pixel],
            is_in_edge_zone: judged.edge_zone[pixel],
            error: (factor - point.lit).abs(),
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
