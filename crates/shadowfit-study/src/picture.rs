//! A drawn picture judged against rays on the CPU, on the drawing thread or in the background.

use std::sync::Arc;

use glam::{DVec3, Vec3};
use shadowfit::FittedMap;
use shadowfit_render::ProbePixel;
use shadowfit_truth::{Judged, MapsBefore, Truth, area, crawl, judge_while};
use shadowfit_wgpu::ShadowMapDescriptor;
use shadowfit_wgpu::exact_edges::EdgeCounts;

use crate::maps::{measured, picture_maps};
use crate::{Judging, SceneRays, View};

/// The maps of the previous frame, and their shadow factors at the points of a picture, to measure crawl.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameBefore {
    /// The previous frame's maps.
    pub maps: Vec<FittedMap>,
    /// The previous frame's eye; world space, metres.
    pub eye: DVec3,
    /// The previous frame's unit view direction, world axes.
    pub forward: Vec3,
    /// Share of the light that the previous frame's maps let through at each pixel of the picture, 0..=1,
    /// rows from the top.
    pub factors: Vec<f32>,
}

/// A picture to judge, with all that the judge needs from the scene. Created by
/// [`Evaluator::judge_job`](crate::Evaluator::judge_job).
#[derive(Clone, Debug)]
pub struct JudgeJob {
    /// The scene's rays for the pose in which it was drawn.
    pub rays: Arc<SceneRays>,
    /// Content of each pixel, rows from the top, for [`Judging::size`]. `None` for the sky.
    pub pixels: Vec<Option<ProbePixel>>,
    /// The view.
    pub view: View,
    /// Settings for judging it.
    pub judging: Judging,
    /// The maps that it was drawn with.
    pub maps: Vec<FittedMap>,
    /// The shadow map that the maps were drawn into.
    pub descriptor: ShadowMapDescriptor,
    /// Whether each of the scene's instances counts in sums. See
    /// [`PosedScene::counted_instances`](crate::PosedScene::counted_instances).
    pub counted: Vec<bool>,
    /// The previous frame; `None` if crawl is not measured.
    pub before: Option<FrameBefore>,
    /// Number of its pixels that were traced; `None` if edges are filtered.
    pub traced: Option<EdgeCounts>,
}

impl JudgeJob {
    /// Traces the truth of the picture.
    pub(crate) fn trace(&self) -> Truth {
        self.trace_while(|| true).expect("never cancelled")
    }

    /// Traces the truth of the picture while `goes_on` returns `true`.
    pub(crate) fn trace_while(&self, goes_on: impl Fn() -> bool + Sync) -> Option<Truth> {
        let seen: Vec<Option<u32>> = self.pixels.iter().map(|pixel| pixel.map(|pixel| pixel.triangle)).collect();
        let camera = self.judging.pixel_camera(self.rays.origin, &self.view);
        Truth::trace_while(&self.rays.tracer, &camera, &self.judging.truth_settings(&self.view), &seen, goes_on)
    }

    /// Judges the picture by its truth, and measures its crawl against the previous frame.
    pub(crate) fn judge_by(&self, truth: &Truth) -> Judged {
        self.judge_while(truth, || true).expect("never cancelled")
    }

    /// Judges the picture while `goes_on` returns `true`.
    pub(crate) fn judge_while(&self, truth: &Truth, goes_on: impl Fn() -> bool + Sync) -> Option<Judged> {
        let Self { rays, maps, descriptor, .. } = self;
        let factors = factors(&self.pixels);
        let measure = |maps: &[FittedMap]| measured(maps, descriptor, self.view.direction, rays.origin);
        let measured = measure(maps);
        let seen = picture_maps(&measured, maps, descriptor);
        let counts = |triangle| rays.instance(triangle).is_some_and(|instance| self.counted[instance as usize]);
        let mut judged = judge_while(&rays.tracer, truth, &seen, &factors, counts, goes_on)?;
        if self.judging.area > 0 {
            judged.tally.area = area(&rays.tracer, truth, &judged.counted, &factors, self.judging.area);
        }
        if let Some(counts) = &self.traced {
            judged.tally.add_traced(counts.traced.into(), counts.facing.into());
        }
        if let Some(before) = &self.before {
            let measured = measure(&before.maps);
            let maps_before = MapsBefore {
                maps: picture_maps(&measured, &before.maps, descriptor),
                eye: before.eye - rays.origin,
                forward: before.forward.as_dvec3(),
                factors: &before.factors,
            };
            judged.tally.add_crawl(&crawl(truth, &judged, &factors, &maps_before));
        }
        Some(judged)
    }
}

/// Returns the shadow factor of each pixel. The sky is lit.
pub(crate) fn factors(pixels: &[Option<ProbePixel>]) -> Vec<f32> {
    pixels.iter().map(|pixel| pixel.map_or(1.0, |pixel| pixel.factor)).collect()
}
