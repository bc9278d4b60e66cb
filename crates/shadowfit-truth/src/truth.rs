//! Whether the light reaches each pixel of a picture, computed by rays.
//!
//! The truth depends on the scene, the camera and the light only. It is traced once, and any number of shadow
//! maps can be judged against it.

use glam::DVec3;
use rayon::prelude::*;

use crate::camera::PixelCamera;
use crate::class::counts_as_lit;
use crate::distances::{NONE_MARKED, squared_distances};
use crate::light::{LightRay, LightRays, TruthLight};
use crate::seen::{SeenPoint, seen_by_ray, seen_point};
use crate::tracer::{Hit, Tracer};

/// Settings for tracing the truth. World space, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TruthSettings {
    /// The light.
    pub light: TruthLight,
    /// Offset of the shadow rays' start along the geometric normal, in metres.
    pub ray_offset: f64,
    /// Greatest view depth at which pixels are judged (the shadow distance), in metres.
    pub max_distance: f64,
}

impl TruthSettings {
    /// Returns settings for a hard sun, with rays that start a millimetre above the surface, and without a
    /// shadow distance: pixels are judged at any view depth. `to_light` is the unit direction toward the
    /// light, world axes.
    pub fn new(to_light: DVec3) -> Self {
        Self::of_light(TruthLight::sun(to_light))
    }

    /// Returns settings for any light, with rays that start a millimetre above the surface, and without a
    /// shadow distance.
    pub fn of_light(light: TruthLight) -> Self {
        Self { light, ray_offset: 1e-3, max_distance: f64::INFINITY }
    }
}

/// The visible point at a pixel's centre. World space, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TruthPoint {
    /// Position of the point, on its triangle's plane.
    pub position: DVec3,
    /// Unit geometric normal on the side of the eye.
    pub normal: DVec3,
    /// Cosine of the angle between the normal and the direction toward the light.
    pub facing: f64,
    /// Distance from the eye along the view, in metres.
    pub view_depth: f64,
    /// Share of the rays that reach the light, 0..=1; 0 if the point is not judged.
    pub lit: f32,
    /// Index of the triangle.
    pub triangle: u32,
    /// Whether the point is judged: it faces the light, lies within the shadow distance, and lies inside of
    /// the light's image if there is one.
    pub is_judged: bool,
}

impl TruthPoint {
    /// Returns whether at least half of the light arrives. `None` if the point is not judged.
    pub fn verdict(&self) -> Option<bool> {
        self.is_judged.then(|| counts_as_lit(self.lit))
    }
}

/// The truth of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// Camera of the picture.
    pub camera: PixelCamera,
    /// Settings that were used for tracing.
    pub settings: TruthSettings,
    /// Visible point of each pixel, rows from the top; `None` for the sky.
    pub points: Vec<Option<TruthPoint>>,
    /// Squares of the distances to the nearest transition pixel.
    transition_squares: Vec<u32>,
}

impl Truth {
    /// Traces the truth of a picture. `seen` is the triangle (index into the tracer's) that the renderer's
    /// rasteriser drew at each pixel, rows from the top, or `None` for the sky. An index out of range counts
    /// as sky.
    ///
    /// The visible point is the intersection of the ray through the pixel's centre with the triangle's plane.
    /// Its view depth is clamped to the range of the triangle's corners, because the ray may hit the plane of
    /// an edge-on sliver anywhere.
    ///
    /// # Panics
    ///
    /// If `seen` does not have one element for each pixel.
    pub fn trace(tracer: &Tracer, camera: &PixelCamera, settings: &TruthSettings, seen: &[Option<u32>]) -> Self {
        Self::traced(tracer, camera, settings, seen, || true)
    }

    /// Traces the truth like [`Self::trace`], but can be cancelled. It calls `goes_on` at every pixel. Once
    /// that returns false, it stops and returns `None`. From then on `goes_on` must not return true.
    ///
    /// # Panics
    ///
    /// As [`Self::trace`].
    pub fn trace_while(
        tracer: &Tracer,
        camera: &PixelCamera,
        settings: &TruthSettings,
        seen: &[Option<u32>],
        goes_on: impl Fn() -> bool + Sync,
    ) -> Option<Self> {
        let truth = Self::traced(tracer, camera, settings, seen, &goes_on);
        goes_on().then_some(truth)
    }

    fn traced(
        tracer: &Tracer,
        camera: &PixelCamera,
        settings: &TruthSettings,
        seen: &[Option<u32>],
        goes_on: impl Fn() -> bool + Sync,
    ) -> Self {
        assert_eq!(seen.len(), camera.pixels(), "one triangle or `None` for each pixel");
        let rays = settings.light.rays();
        let points: Vec<Option<TruthPoint>> = seen
            .par_iter()
            .enumerate()
            .map(|(pixel, seen)| {
                let triangle = seen.filter(|triangle| (*triangle as usize) < tracer.len() && goes_on())?;
                Some(point(tracer, camera, settings, &rays, pixel, triangle))
            })
            .collect();
        let mut truth = Self { camera: *camera, settings: *settings, points, transition_squares: Vec::new() };
        let size = camera.size.map(|side| side as usize);
        truth.transition_squares = squared_distances(size, |x, y| truth.is_transition([x, y]));
        truth
    }

    /// Casts rays to find the nearest triangle at each pixel between the near and the far plane, for pictures
    /// without a rasteriser. If the nearest triangle along a ray is out of that range, the pixel shows the
    /// sky.
    pub fn seen_by_rays(tracer: &Tracer, camera: &PixelCamera) -> Vec<Option<u32>> {
        (0..camera.pixels()).into_par_iter().map(|pixel| seen_by_ray(tracer, camera, pixel)).collect()
    }

    /// Returns whether at least half of the light reaches a pixel, given by its index in rows from the top.
    /// `None` if it is not judged.
    pub fn verdict(&self, pixel: usize) -> Option<bool> {
        self.points[pixel].as_ref()?.verdict()
    }

    /// Returns the distance, in pixels, from a pixel's centre to the nearest transition: a border between two
    /// judged pixels, side by side or one above the other, with different verdicts. It is the distance to the
    /// centre of the nearest pixel with such a border, plus half a pixel. Infinite without a transition.
    pub fn transition_distance(&self, pixel: usize) -> f32 {
        match self.transition_squares[pixel] {
            NONE_MARKED => f32::INFINITY,
            square => (square as f32).sqrt() + 0.5,
        }
    }

    /// Returns whether the distance to a transition is at most `width`, in pixels.
    pub(crate) fn is_near_transition(&self, pixel: usize, width: f32) -> bool {
        is_within(self.transition_squares[pixel], width)
    }

    fn is_transition(&self, pixel: [usize; 2]) -> bool {
        let size = self.camera.size.map(|side| side as usize);
        is_transition(size, |[x, y]| self.verdict(y * size[0] + x), pixel)
    }
}

/// Returns whether a judged pixel borders on a judged pixel with another verdict, side by side or one above
/// the other.
pub(crate) fn is_transition(
    [width, height]: [usize; 2],
    verdict: impl Fn([usize; 2]) -> Option<bool>,
    [x, y]: [usize; 2],
) -> bool {
    let Some(here) = verdict([x, y]) else { return false };
    let differs = |x: usize, y: usize| verdict([x, y]).is_some_and(|there| there != here);
    (x > 0 && differs(x - 1, y))
        || (x + 1 < width && differs(x + 1, y))
        || (y > 0 && differs(x, y - 1))
        || (y + 1 < height && differs(x, y + 1))
}

/// Returns whether the squared distance to a transition means at most `width` pixels.
///
/// It works in f32 and without a root: it compares the square with the square of `width` less half a pixel.
/// Another implementation, such as the GPU's, thus finds exactly the same pixels.
pub(crate) fn is_within(square: u32, width: f32) -> bool {
    let reach = width - 0.5;
    square != NONE_MARKED && square as f32 <= reach * reach
}

/// Returns the point of a triangle that a pixel shows, and how much light reaches it. `rays` are the rays of
/// the settings' light.
pub(crate) fn point(
    tracer: &Tracer,
    camera: &PixelCamera,
    settings: &TruthSettings,
    rays: &LightRays,
    pixel: usize,
    triangle: u32,
) -> TruthPoint {
    let SeenPoint { position, normal, view_depth } = seen_point(tracer, camera, pixel, triangle);
    let light = &settings.light;
    let facing = normal.dot(light.ray_from(position).direction);
    let is_judged = facing > 0.0 && view_depth <= settings.max_distance && light.shines_toward(position);
    let mut point = TruthPoint { position, normal, facing, view_depth, lit: 0.0, triangle, is_judged };
    if is_judged {
        point.lit = lit_share(tracer, rays, ray_origin(settings, &point), pixel);
    }
    point
}

/// An occluder between a point and the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occluder {
    /// Intersection, moved onto the straight line from the point to the light, because rays start above the
    /// surface. World space, metres.
    pub position: DVec3,
    /// Distance from the ray's start along the ray toward the light, in metres.
    pub distance: f64,
    /// Index of the tracer's triangle.
    pub triangle: u32,
}

impl TruthSettings {
    /// Returns a blocked ray of a shadowed point: the ray toward the light's centre, or the first blocked ray
    /// if that one is free.
    fn blocked_ray(&self, tracer: &Tracer, origin: DVec3, pixel: usize) -> LightRay {
        let (centre, rays) = (self.light.ray_from(origin), self.light.rays());
        if rays.count() == 1 || is_blocked(tracer, origin, &centre) {
            return centre;
        }
        rays.from(origin, pixel).find(|ray| is_blocked(tracer, origin, ray)).unwrap_or(centre)
    }

    /// Calls `visit` with every occluder of a judged point along a blocked ray, in no particular order.
    pub(crate) fn for_each_occluder(
        &self,
        tracer: &Tracer,
        pixel: usize,
        point: &TruthPoint,
        mut visit: impl FnMut(Occluder),
    ) {
        let origin = ray_origin(self, point);
        let LightRay { direction, length } = self.blocked_ray(tracer, origin, pixel);
        tracer.for_each_hit_within(origin.as_vec3(), direction.as_vec3(), length as f32, |hit: Hit| {
            let distance = tracer.refine(hit, tracer.plane_normal(hit.triangle), origin, direction);
            // Toward a light with a position the offset shrinks; toward a sun it is constant.
            let offset = (point.position - origin) * (1.0 - distance / length);
            let position = origin + direction * distance + offset;
            visit(Occluder { position, distance, triangle: hit.triangle });
        });
    }
}

/// Returns the start of a point's shadow rays.
fn ray_origin(settings: &TruthSettings, point: &TruthPoint) -> DVec3 {
    point.position + point.normal * settings.ray_offset
}

/// Returns the share of a point's rays that reach the light.
fn lit_share(tracer: &Tracer, rays: &LightRays, origin: DVec3, pixel: usize) -> f32 {
    let free = rays.from(origin, pixel).filter(|ray| !is_blocked(tracer, origin, ray)).count();
    free as f32 / rays.count() as f32
}

/// Returns whether any triangle blocks a ray to the light.
pub(crate) fn is_blocked(tracer: &Tracer, origin: DVec3, ray: &LightRay) -> bool {
    tracer.is_occluded_within(origin.as_vec3(), ray.direction.as_vec3(), ray.length as f32)
}
