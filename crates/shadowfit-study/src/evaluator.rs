//! The only place where a technique's pictures are drawn and judged.

use anyhow::Result;
use glam::{DVec3, Vec3};
use shadowfit_render::{Frame, Gpu, ProbePixel, ProbeTargets, RenderTarget, Renderer, Statistics};
use shadowfit_truth::gpu::GpuPixel;
use shadowfit_truth::{Judged, MapsBefore, MeasuredMap, PictureMaps, crawl, judge};
use shadowfit_wgpu::{MapFit, ShadowMapError};

use crate::frame::frame;
use crate::live::{LiveInput, LiveTruth};
use crate::maps::{measured, picture_maps};
use crate::{FrameOptions, Judging, PreparedScene, SharedTruth, View};

/// Draws a technique's maps and the scene shadowed by them, and judges the picture.
#[derive(Debug)]
pub struct Evaluator {
    /// Draws; its shadow map is the one that the maps are drawn into.
    pub renderer: Renderer,
    /// How pictures are judged.
    pub judging: Judging,
    targets: Option<ProbeTargets>,
    picture: Option<RenderTarget>,
    before: Option<Before>,
}

/// The maps of the frame before, and the eye and forward direction that chose among them.
#[derive(Debug)]
struct Before {
    maps: Vec<MapFit>,
    eye: DVec3,
    forward: Vec3,
}

impl Evaluator {
    /// An evaluator that has judged nothing yet.
    pub fn new(renderer: Renderer, judging: Judging) -> Self {
        Self { renderer, judging, targets: None, picture: None, before: None }
    }

    /// Draws the maps of a view and its shaded picture.
    ///
    /// # Errors
    ///
    /// When a map does not suit the shadow map; nothing is drawn then.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[MapFit],
        options: &FrameOptions<'_>,
        picture: &RenderTarget,
    ) -> Result<Statistics, ShadowMapError> {
        let atmosphere = options.atmosphere(view);
        let frame = frame(view, maps, options, &atmosphere);
        self.renderer.draw(gpu, &mut scene.gpu_scene, &frame, picture)
    }

    /// The shaded picture of a view, in the size that is judged: sRGB pixels, four bytes each, rows from the top.
    ///
    /// # Errors
    ///
    /// As for [`Self::draw`].
    pub fn picture(&mut self, gpu: &Gpu, scene: &mut PreparedScene, view: &View, maps: &[MapFit]) -> Result<Vec<u8>> {
        let kept = self.picture.take().filter(|picture| picture.size == self.judging.size);
        let picture = kept.unwrap_or_else(|| self.renderer.target(gpu, self.judging.size));
        self.draw(gpu, scene, view, maps, &FrameOptions::default(), &picture)?;
        let pixels = picture.read(gpu);
        self.picture = Some(picture);
        Ok(pixels?)
    }

    /// Draws the maps of a view and judges the shadows that they give.
    ///
    /// # Errors
    ///
    /// When a map does not suit the shadow map, or the device cannot tell triangles apart.
    pub fn judge(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[MapFit],
        truth: &mut SharedTruth,
    ) -> Result<Judged> {
        if view.is_first {
            self.before = None;
        }
        let pixels = self.probe(gpu, scene, view, maps, None)?;
        let truth = truth.or_trace(scene, view, &self.judging, &pixels);
        let factors = factors(&pixels);
        let origin = scene.origin();
        let descriptor = *self.renderer.shadow_map().descriptor();
        let measured_maps = measured(maps, &descriptor, view.direction, origin);
        let rays = scene.rays();
        let counted = scene.counted_instances(self.judging.subject_only);
        let counts = |triangle: u32| counted[rays.triangles[triangle as usize].instance as usize];
        let mut judged = judge(&rays.tracer, truth, &self.seen(&measured_maps, maps), &factors, counts);
        if let Some(before) = self.before.take().filter(|_| self.judging.crawl) {
            let choice = Some((before.eye, before.forward));
            let factors_before = self::factors(&self.probe(gpu, scene, view, &before.maps, choice)?);
            let measured_before = measured(&before.maps, &descriptor, view.direction, origin);
            let before = MapsBefore {
                maps: self.seen(&measured_before, &before.maps),
                eye: before.eye - origin,
                forward: before.forward.as_dvec3(),
                factors: &factors_before,
            };
            judged.tally.add_crawl(crawl(truth, &judged, &factors, &before));
        }
        let forward = view.camera.forward.normalize();
        self.before = Some(Before { maps: maps.to_vec(), eye: view.camera.eye, forward });
        Ok(judged)
    }

    /// Draws a view and judges it on the GPU. All pixels count there, whatever [`Judging::subject_only`] says.
    ///
    /// # Errors
    ///
    /// As for [`Self::judge`], and when the sun has a radius.
    pub fn judge_live(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[MapFit],
        live: &mut LiveTruth,
    ) -> Result<Vec<GpuPixel>> {
        self.with_live_input(gpu, scene, view, maps, |input| live.judge(gpu, input))
    }

    /// Mean time of judging a view on the GPU, without drawing it, in milliseconds.
    ///
    /// # Errors
    ///
    /// As for [`Self::judge_live`].
    pub fn time_live(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[MapFit],
        (live, repeats): (&mut LiveTruth, u32),
    ) -> Result<f64> {
        self.with_live_input(gpu, scene, view, maps, |input| live.time(gpu, input, repeats))
    }

    fn with_live_input<T>(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[MapFit],
        judge: impl FnOnce(&LiveInput<'_>) -> Result<T>,
    ) -> Result<T> {
        let targets = self.draw_probe(gpu, scene, view, maps, None)?;
        let descriptor = self.renderer.shadow_map().descriptor();
        let measured = measured(maps, descriptor, view.direction, scene.origin());
        let result = judge(&LiveInput {
            camera: self.judging.pixel_camera(scene, view),
            settings: self.judging.truth_settings(view),
            maps: self.seen(&measured, maps),
            seen: &targets.view,
        });
        self.targets = Some(targets);
        result
    }

    fn seen<'a>(&self, maps: &'a [MeasuredMap], fits: &[MapFit]) -> PictureMaps<'a> {
        picture_maps(maps, fits, self.renderer.shadow_map().descriptor())
    }

    /// What each pixel shows. `choice` is the eye and the forward direction that choose the maps, if not the camera's.
    fn probe(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[MapFit],
        choice: Option<(DVec3, Vec3)>,
    ) -> Result<Vec<Option<ProbePixel>>> {
        let targets = self.draw_probe(gpu, scene, view, maps, choice)?;
        let probe = targets.read(gpu);
        self.targets = Some(targets);
        Ok(probe?.pixels)
    }

    /// Draws a probe into targets that the caller gives back.
    fn draw_probe(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[MapFit],
        choice: Option<(DVec3, Vec3)>,
    ) -> Result<ProbeTargets> {
        let kept = self.targets.take().filter(|targets| targets.size == self.judging.size);
        let targets = kept.unwrap_or_else(|| ProbeTargets::new(&gpu.device, self.judging.size));
        let options = FrameOptions::default();
        let atmosphere = options.atmosphere(view);
        let frame = Frame { choice, ..frame(view, maps, &options, &atmosphere) };
        self.renderer.draw_probe(gpu, &mut scene.gpu_scene, &frame, &targets)?;
        Ok(targets)
    }
}

/// The shadow factor of each pixel; the sky is lit.
fn factors(pixels: &[Option<ProbePixel>]) -> Vec<f32> {
    pixels.iter().map(|pixel| pixel.map_or(1.0, |pixel| pixel.factor)).collect()
}
