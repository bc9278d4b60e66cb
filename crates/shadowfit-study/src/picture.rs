//! A drawn picture judged against rays on the CPU, wherever that is done: where it was drawn, or in the background.

use glam::{DVec3, Vec3};
use shadowfit::FittedMap;
use shadowfit_render::ProbePixel;
use shadowfit_truth::{Judged, MapsBefore, Truth, crawl, judge_while};
use shadowfit_wgpu::ShadowMapDescriptor;

use crate::maps::{measured, picture_maps};
use crate::{Judging, SceneRays, View};

/// The maps of the frame before, and their shadow factors at the points of a picture: crawl is measured against them.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameBefore {
    /// Its maps.
    pub maps: Vec<FittedMap>,
    /// Its eye; world space, metres.
    pub eye: DVec3,
    /// Its unit direction of view, world axes.
    pub forward: Vec3,
    /// Share of the light that its maps let through at each pixel of the picture, 0..=1, rows from the top.
    pub factors: Vec<f32>,
}

/// A picture, and the rays that it is judged with.
pub(crate) struct Picture<'a> {
    pub(crate) rays: &'a SceneRays,
    pub(crate) view: &'a View,
    pub(crate) judging: &'a Judging,
    pub(crate) maps: &'a [FittedMap],
    pub(crate) descriptor: &'a ShadowMapDescriptor,
    /// Whether each of the scene's instances counts in sums.
    pub(crate) counted: &'a [bool],
}

impl Picture<'_> {
    /// The truth of the picture, for the triangles that a probe found.
    pub(crate) fn trace(&self, pixels: &[Option<ProbePixel>]) -> Truth {
        self.trace_while(pixels, || true).expect("nobody gives it up")
    }

    /// The same while `goes_on` returns `true`.
    pub(crate) fn trace_while(
        &self,
        pixels: &[Option<ProbePixel>],
        goes_on: impl Fn() -> bool + Sync,
    ) -> Option<Truth> {
        let seen: Vec<Option<u32>> = pixels.iter().map(|pixel| pixel.map(|pixel| pixel.triangle)).collect();
        let camera = self.judging.pixel_camera(self.rays.origin, self.view);
        Truth::trace_while(&self.rays.tracer, &camera, &self.judging.truth_settings(self.view), &seen, goes_on)
    }

    /// Judges the picture, whose shadows are `factors`, and its crawl against the frame before.
    pub(crate) fn judge(&self, truth: &Truth, factors: &[f32], before: Option<&FrameBefore>) -> Judged {
        self.judge_while(truth, factors, before, || true).expect("nobody gives it up")
    }

    /// The same while `goes_on` returns `true`.
    pub(crate) fn judge_while(
        &self,
        truth: &Truth,
        factors: &[f32],
        before: Option<&FrameBefore>,
        goes_on: impl Fn() -> bool + Sync,
    ) -> Option<Judged> {
        let Self { rays, maps, descriptor, .. } = *self;
        let measure = |maps: &[FittedMap]| measured(maps, descriptor, self.view.direction, rays.origin);
        let measured = measure(maps);
        let seen = picture_maps(&measured, maps, descriptor);
        let counts = |triangle: u32| self.counted[rays.triangles[triangle as usize].instance as usize];
        let mut judged = judge_while(&rays.tracer, truth, &seen, factors, counts, goes_on)?;
        if let Some(before) = before {
            let measured = measure(&before.maps);
            let maps_before = MapsBefore {
                maps: picture_maps(&measured, &before.maps, descriptor),
                eye: before.eye - rays.origin,
                forward: before.forward.as_dvec3(),
                factors: &before.factors,
            };
            judged.tally.add_crawl(crawl(truth, &judged, factors, &maps_before));
        }
        Some(judged)
    }
}

/// The shadow factor of each pixel; the sky is lit.
pub(crate) fn factors(pixels: &[Option<ProbePixel>]) -> Vec<f32> {
    pixels.iter().map(|pixel| pixel.map_or(1.0, |pixel| pixel.factor)).collect()
}
