//! The judgement of a single pixel.
//!
//! The judge of pictures calls this module for each pixel, with the visible triangle from the rasteriser and
//! the distances to shadow edges from the whole picture. For a pixel judged alone, rays around the pixel find
//! both.

use rayon::prelude::*;

use crate::camera::PixelCamera;
use crate::class::{Class, counts_as_lit};
use crate::distances::NONE_MARKED;
use crate::maps::{OccluderPlace, PictureMaps, SelectedMap, pixels_per_texel};
use crate::seen::seen_by_ray;
use crate::tracer::Tracer;
use crate::truth::{self, Occluder, TruthPoint, TruthSettings, is_transition, is_within};

/// Farthest distance at which shadow edges are searched around a single pixel, in pixels. It covers the edge
/// zone of texels that are 25 pixels wide, with the widest filter that is not soft.
const FARTHEST_EDGE: f32 = 128.0;

/// The truth of a picture, traced pixel by pixel. Pixels are indices in rows from the top.
#[derive(Clone, Copy, Debug)]
pub struct PixelTruth<'a> {
    /// Tracer that casts the rays.
    pub tracer: &'a Tracer,
    /// Camera of the picture.
    pub camera: &'a PixelCamera,
    /// How the truth is traced.
    pub settings: &'a TruthSettings,
}

/// The result for a single pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelFinding {
    /// Class of the pixel.
    pub class: Class,
    /// Screen pixels per shadow texel along the worse axis, in the map that is read. Infinite if no map
    /// covers the point or the surface is edge-on to the light. NaN if the pixel is not judged.
    pub pixels_per_texel: f32,
    /// Whether the pixel lies in the edge zone. If a pixel [is judged alone](PixelTruth::judge), it is
    /// computed only for wrong pixels, and `false` otherwise.
    pub is_in_edge_zone: bool,
    /// Index of the map that is read, or of the one with the greater weight if two are blended. Indices from
    /// 255 on are recorded as 255. `None` if no map covers the point or the pixel is not judged.
    pub map_index: Option<u8>,
}

impl PixelFinding {
    /// The finding for a pixel that is not judged.
    pub const NOT_JUDGED: Self =
        Self { class: Class::NotJudged, pixels_per_texel: f32::NAN, is_in_edge_zone: false, map_index: None };
}

impl PixelTruth<'_> {
    /// Traces a ray for the point that a pixel shows between the near and the far plane, and the light that
    /// reaches it. `None` for the sky and for a pixel beyond the picture.
    pub fn point(&self, pixel: usize) -> Option<TruthPoint> {
        if pixel >= self.camera.pixels() {
            return None;
        }
        let triangle = seen_by_ray(self.tracer, self.camera, pixel)?;
        let rays = self.settings.light.rays();
        Some(truth::point(self.tracer, self.camera, self.settings, &rays, pixel, triangle))
    }

    /// Returns all occluders between a judged point and the light along a blocked ray, in no particular
    /// order. Empty if every ray is free.
    pub fn occluders(&self, pixel: usize, point: &TruthPoint) -> Vec<Occluder> {
        let mut occluders = Vec::new();
        self.settings.for_each_occluder(self.tracer, pixel, point, |occluder| occluders.push(occluder));
        occluders
    }

    /// Judges a single pixel by the rules of [`judge()`](crate::judge()). `factor` is the share of the light
    /// that the filtered maps let through there.
    ///
    /// The edge zone is searched by rays, and only if the pixel is wrong. It is cut off at 128 pixels.
    pub fn judge(&self, maps: &PictureMaps, factor: f32, pixel: usize, point: &TruthPoint) -> PixelFinding {
        if !point.is_judged {
            return PixelFinding::NOT_JUDGED;
        }
        let is_wrong = counts_as_lit(point.lit) != counts_as_lit(factor);
        self.find(maps, factor, pixel, point, |width| {
            is_wrong && self.transition_distance(pixel, width.min(FARTHEST_EDGE)).is_finite()
        })
    }

    /// Returns the distance to the nearest transition like
    /// [`Truth::transition_distance`](crate::Truth::transition_distance), by rays around a pixel, up to
    /// `at_most` pixels. Infinite if no transition is that near.
    pub fn transition_distance(&self, pixel: usize, at_most: f32) -> f32 {
        let mut radius = 2;
        loop {
            let square = self.transition_square(pixel, radius);
            let is_nearest = square <= (radius * radius) as u32;
            if is_nearest || radius as f32 >= at_most {
                let distance = if square == NONE_MARKED { f32::INFINITY } else { (square as f32).sqrt() + 0.5 };
                return if is_within(square, at_most) { distance } else { f32::INFINITY };
            }
            radius *= 2;
        }
    }

    /// Returns the squared distance to the nearest transition pixel within `radius` pixels per axis.
    fn transition_square(&self, pixel: usize, radius: usize) -> u32 {
        let size = self.camera.size.map(|side| side as usize);
        let middle = [pixel % size[0], pixel / size[0]];
        // A transition at the square's border depends on the pixels beyond it.
        let first = middle.map(|place| place.saturating_sub(radius + 1));
        let last = [0, 1].map(|axis| (middle[axis] + radius + 1).min(size[axis] - 1));
        let [width, height] = [0, 1].map(|axis| last[axis] - first[axis] + 1);
        let verdicts: Vec<Option<bool>> = (0..width * height)
            .into_par_iter()
            .map(|index| {
                let (x, y) = (first[0] + index % width, first[1] + index / width);
                self.point(y * size[0] + x)?.verdict()
            })
            .collect();
        let verdict = |[x, y]: [usize; 2]| verdicts[(y - first[1]) * width + (x - first[0])];
        let is_inside = |[x, y]: [usize; 2]| x.abs_diff(middle[0]).max(y.abs_diff(middle[1])) <= radius;
        (0..width * height)
            .map(|index| [first[0] + index % width, first[1] + index / width])
            .filter(|place| is_inside(*place) && is_transition(size, verdict, *place))
            .map(|[x, y]| (x.abs_diff(middle[0]).pow(2) + y.abs_diff(middle[1]).pow(2)) as u32)
            .min()
            .unwrap_or(NONE_MARKED)
    }

    /// Judges a pixel. `is_near_transition` returns whether a true shadow edge lies within a number of
    /// pixels.
    pub(crate) fn find(
        &self,
        maps: &PictureMaps,
        factor: f32,
        pixel: usize,
        point: &TruthPoint,
        is_near_transition: impl FnOnce(f32) -> bool,
    ) -> PixelFinding {
        let choice = maps.main(point.view_depth, point.position);
        let texel_width = choice.as_ref().map(|choice| self.texel_width(choice, pixel, point));
        let pixels = texel_width.map_or(1.0, |width| width.max(1.0));
        let is_in_edge_zone = is_near_transition(maps.edge_width(choice.as_ref().map(|choice| choice.index)) * pixels);
        let class = match (counts_as_lit(point.lit), counts_as_lit(factor)) {
            (true, true) | (false, false) => Class::Right,
            (false, true) if self.is_hole(maps, choice.as_ref(), pixel, point) => Class::Hole,
            _ if is_in_edge_zone => Class::Edge,
            (true, false) => Class::FalseShadow,
            (false, true) => Class::FalseLight,
        };
        PixelFinding {
            class,
            pixels_per_texel: texel_width.unwrap_or(f32::INFINITY),
            is_in_edge_zone,
            map_index: choice.map(|choice| u8::try_from(choice.index).unwrap_or(u8::MAX)),
        }
    }

    /// Returns pixels per texel along the worse axis, in the map that the point reads. Infinite if the
    /// surface is edge-on to the light.
    fn texel_width(&self, choice: &SelectedMap, pixel: usize, point: &TruthPoint) -> f32 {
        let steps = self.camera.pixel_steps(&self.camera.ray_of(pixel), point.normal, point.view_depth);
        let pixels = pixels_per_texel(choice.map.gradients(&choice.position).texels_per_step(steps)) as f32;
        if pixels.is_nan() { f32::INFINITY } else { pixels }
    }

    /// Returns whether the point reads no map, or a map that holds none of its occluders.
    fn is_hole(&self, maps: &PictureMaps, choice: Option<&SelectedMap>, pixel: usize, point: &TruthPoint) -> bool {
        let Some(choice) = choice else { return true };
        let mut is_held = false;
        self.settings.for_each_occluder(self.tracer, pixel, point, |occluder| {
            is_held |= match choice.occluder(occluder.position) {
                OccluderPlace::Inside => true,
                OccluderPlace::BeforeNear => maps.depth_clamp,
                OccluderPlace::Outside => false,
            };
        });
        !is_held
    }
}
