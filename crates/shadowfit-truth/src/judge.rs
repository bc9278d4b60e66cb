//! The kinds of wrong pixels: false shadow (acne), false light (peter-panning, leaks), hole
//! (clipping) and edge (aliasing).
//!
//! A picture's filtered shadow factors are compared with the truth. What a wrong pixel is called
//! depends on the map that it reads: how wide its texels are on screen, and whether it holds an
//! occluder.

use rayon::prelude::*;

use crate::peers::ShadowMap;
use crate::peers::choice::{Choice, Occluder, choose, pixels_per_texel};
use crate::{PictureTally, Tracer, Truth, TruthPoint};

/// The shadow maps of a picture, and how they are read.
#[derive(Clone, Copy, Debug)]
pub struct MapsSeen<'a> {
    /// Maps, in order of their splits. A point reads the first one whose split is beyond its view
    /// depth, or the next later one that holds it.
    pub maps: &'a [ShadowMap],
    /// Reach of the filter: greatest distance per axis, in texels, from the sample point to the
    /// centre of a texel of non-zero weight (0.5 point, 1 hardware 2×2).
    pub reach: f32,
    /// Whether the maps were drawn with depth clamp, so that they also hold what stands before
    /// their near plane.
    pub depth_clamp: bool,
}

impl MapsSeen<'_> {
    /// Width of the edge zone, in pixels or in shadow texels, whichever is more on screen.
    pub fn edge_width(&self) -> f32 {
        (self.reach + 1.0).max(1.5)
    }
}

/// Verdict on a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Class {
    /// Sky, a surface that faces away from the light, or one beyond the shadow distance.
    NotJudged = 0,
    /// The map agrees with the truth.
    Right = 1,
    /// Lit in truth, shadowed by the map, away from edges: acne.
    FalseShadow = 2,
    /// Shadowed in truth, lit by the map, away from edges, though an occluder is in the map:
    /// peter-panning or a leak.
    FalseLight = 3,
    /// Shadowed in truth, lit because none of the occluders is in the map, or no map covers the
    /// point: the hole from clipping. Also in the edge zone.
    Hole = 4,
    /// Wrong within the edge zone: aliasing.
    Edge = 5,
}

/// A judged picture. All lists are rows of pixels from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// Verdicts.
    pub classes: Vec<Class>,
    /// Screen pixels per shadow texel along the worse axis, in the map that is read; infinite where
    /// no map holds the point, or it is edge-on to the light, and not a number where the pixel is not
    /// judged.
    pub pixels_per_texel: Vec<f32>,
    /// Whether the pixel lies in the edge zone; `false` where it is not judged.
    pub edge_zone: Vec<bool>,
    /// The map that is read: its place among the maps. `None` where none holds the point or the
    /// pixel is not judged.
    pub choice: Vec<Option<u8>>,
    /// Whether the pixel is judged and counts in the sums.
    pub counted: Vec<bool>,
    /// Sums over the pixels that count.
    pub tally: PictureTally,
}

/// What is found out about a pixel by itself.
struct Finding {
    class: Class,
    pixels_per_texel: f32,
    is_in_edge_zone: bool,
    choice: Option<u8>,
}

impl Finding {
    const NOT_JUDGED: Self =
        Self { class: Class::NotJudged, pixels_per_texel: f32::NAN, is_in_edge_zone: false, choice: None };
}

/// Judges a picture that was shadowed by `maps`. `factors` holds the share of the light that the
/// filtered maps let through at each pixel, 0..=1, rows from the top (one that is not a number counts
/// as 0; those of pixels that are not judged are not read). Pixels whose triangle does not count are
/// judged, and make edges, but are in no sum.
///
/// The edge zone is as wide as [`MapsSeen::edge_width`] pixels or texels' footprints; a point that no
/// map holds reads no texel, and only the pixels are meant. Numbers of maps beyond 255 are not told
/// apart.
///
/// # Panics
///
/// If `factors` does not have an element a pixel.
pub fn judge(
    tracer: &Tracer,
    truth: &Truth,
    maps: &MapsSeen,
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
        choice: findings.iter().map(|finding| finding.choice).collect(),
        counted: truth.points.par_iter().map(counted).collect(),
        tally: PictureTally::default(),
    };
    judged.tally = PictureTally::of(truth, &judged, factors);
    judged
}

/// Whether a factor means lit.
pub(crate) fn seems_lit(factor: f32) -> bool {
    factor >= 0.5
}

fn find(tracer: &Tracer, truth: &Truth, maps: &MapsSeen, factor: f32, pixel: usize, point: &TruthPoint) -> Finding {
    let choice = choose(maps.maps, point.view_depth, point.position);
    let footprint = choice.as_ref().map(|choice| footprint(truth, choice, pixel, point));
    let pixels = footprint.map_or(1.0, |footprint| footprint.max(1.0));
    let is_in_edge_zone = truth.is_near_transition(pixel, maps.edge_width() * pixels);
    let is_lit = point.lit >= 0.5;
    let class = match (is_lit, seems_lit(factor)) {
        (true, true) | (false, false) => Class::Right,
        (false, true) if is_hole(tracer, truth, maps, choice.as_ref(), pixel, point) => Class::Hole,
        _ if is_in_edge_zone => Class::Edge,
        (true, false) => Class::FalseShadow,
        (false, true) => Class::FalseLight,
    };
    Finding {
        class,
        pixels_per_texel: footprint.unwrap_or(f32::INFINITY),
        is_in_edge_zone,
        choice: choice.map(|choice| u8::try_from(choice.index).unwrap_or(u8::MAX)),
    }
}

/// Pixels per texel along the worse axis, in the map that the point reads; infinite where it is
/// edge-on to the light.
fn footprint(truth: &Truth, choice: &Choice, pixel: usize, point: &TruthPoint) -> f32 {
    let steps = truth.camera.pixel_steps(truth.camera.ray_of(pixel), point.normal, point.view_depth);
    let pixels = pixels_per_texel(choice.map.gradients(&choice.place).texels_per_step(steps)) as f32;
    if pixels.is_nan() { f32::INFINITY } else { pixels }
}

/// Whether the map that is read holds none of the point's occluders, or none is read.
fn is_hole(
    tracer: &Tracer,
    truth: &Truth,
    maps: &MapsSeen,
    choice: Option<&Choice>,
    pixel: usize,
    point: &TruthPoint,
) -> bool {
    let Some(choice) = choice else { return true };
    let mut is_held = false;
    truth.for_each_occluder(tracer, point, truth.blocked_ray(tracer, pixel, point), |occluder| {
        is_held |= match choice.occluder(occluder) {
            Occluder::In => true,
            Occluder::BeforeNear => maps.depth_clamp,
            Occluder::Out => false,
        };
    });
    !is_held
}
