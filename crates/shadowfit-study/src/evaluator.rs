//! The only place where a technique's pictures are drawn and judged.

use std::sync::Arc;

use anyhow::Result;
use glam::{DVec3, Vec3};
use shadowfit::FittedMap;
use shadowfit_render::{
    Atmosphere, Frame, Gpu, PixelQuery, PixelRead, ProbePixel, ProbeTargets, RayError, RenderTarget, Renderer,
    Statistics,
};
use shadowfit_truth::gpu::{GpuBefore, GpuPixel};
use shadowfit_truth::{FlipReference, Judged, TruthPoint};
use shadowfit_wgpu::ShadowMapError;
use shadowfit_wgpu::exact_edges::EdgeOutcome;
use wgpu::util::DeviceExt;

use crate::live::{LiveInput, LiveTruth};
use crate::maps::{measured, picture_maps};
use crate::picture::{FrameBefore, factors};
use crate::{JudgeJob, Judging, PicturePair, PreparedScene, SceneRays, SharedTruth, View};

/// Draws a technique's maps and the scene with their shadows, and judges the picture.
#[derive(Debug)]
pub struct Evaluator {
    /// Renderer of the maps and the pictures.
    pub renderer: Renderer,
    /// Settings for judging pictures.
    pub judging: Judging,
    targets: Option<ProbeTargets>,
    /// Targets of the previous frame's probe.
    targets_before: Option<ProbeTargets>,
    picture: Option<RenderTarget>,
    before: Option<Before>,
    /// The maps that were drawn last.
    drawn: Vec<FittedMap>,
}

/// The maps of the previous frame, and the eye and view direction for selecting among them.
#[derive(Debug)]
struct Before {
    maps: Vec<FittedMap>,
    eye: DVec3,
    forward: Vec3,
}

/// A view that is drawn as a probe.
#[derive(Clone, Copy, Debug)]
struct Probed<'a> {
    view: &'a View,
    maps: &'a [FittedMap],
    /// The eye and the view direction for selecting among the maps, if they differ from the camera's.
    choice: Option<(DVec3, Vec3)>,
}

impl Evaluator {
    /// Creates an evaluator that has judged no picture yet.
    pub fn new(renderer: Renderer, judging: Judging) -> Self {
        Self { renderer, judging, targets: None, targets_before: None, picture: None, before: None, drawn: Vec::new() }
    }

    /// Returns the frame of a view. Rays of exact edges start at the judge's distance above the surface.
    fn frame<'a>(&self, view: &View, maps: &'a [FittedMap], atmosphere: &'a Atmosphere) -> Frame<'a> {
        Frame { ray_offset: self.judging.ray_offset as f32, ..view.frame(maps, atmosphere) }
    }

    /// Draws the maps of a frame and its shaded picture. Rays of exact edges start at the judge's distance
    /// above the surface.
    ///
    /// # Errors
    ///
    /// If a map does not match the shadow map. Nothing is drawn then.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        frame: &Frame<'_>,
        picture: &RenderTarget,
    ) -> Result<Statistics, ShadowMapError> {
        // Without rays edges are filtered, and the renderer reports it.
        let _rays = self.make_rays(gpu, scene);
        let frame = &Frame { ray_offset: self.judging.ray_offset as f32, ..*frame };
        let drawn = self.renderer.draw(gpu, &mut scene.gpu_scene, frame, picture)?;
        self.drawn.clear();
        self.drawn.extend_from_slice(frame.maps);
        Ok(drawn)
    }

    /// Prepares a scene for rays, if the technique traces edges.
    fn make_rays(&self, gpu: &Gpu, scene: &mut PreparedScene) -> Result<(), RayError> {
        if self.renderer.shadow_map().descriptor().edges.are_traced() { scene.make_gpu_rays(gpu) } else { Ok(()) }
    }

    /// Starts to read triangle and shadow factor of a pixel of a view, and the depths around a texel of a
    /// map. Does not wait. The view must be the one that was drawn last, because its maps are read.
    ///
    /// # Errors
    ///
    /// If the camera has no direction.
    pub fn read_pixel(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        query: &PixelQuery,
    ) -> Result<PixelRead> {
        let atmosphere = view.atmosphere();
        let frame = Frame { maps_stay: true, ..self.frame(view, &self.drawn, &atmosphere) };
        Ok(self.renderer.probe_pixel(gpu, &mut scene.gpu_scene, &frame, query)?)
    }

    /// Returns the maps that were drawn last.
    pub fn drawn_fits(&self) -> &[FittedMap] {
        &self.drawn
    }

    /// Draws the shaded picture of a view, in the judged size: sRGB pixels, four bytes each, rows from the
    /// top.
    ///
    /// # Errors
    ///
    /// As for [`Self::draw`].
    pub fn picture(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[FittedMap],
    ) -> Result<Vec<u8>> {
        let atmosphere = view.atmosphere();
        self.read_picture(gpu, scene, &view.frame(maps, &atmosphere))
    }

    fn read_picture(&mut self, gpu: &Gpu, scene: &mut PreparedScene, frame: &Frame<'_>) -> Result<Vec<u8>> {
        let kept = self.picture.take().filter(|picture| picture.size == self.judging.size);
        let picture = kept.unwrap_or_else(|| self.renderer.target(gpu, self.judging.size));
        self.draw(gpu, scene, frame, &picture)?;
        let pixels = picture.read(gpu);
        self.picture = Some(picture);
        Ok(pixels?)
    }

    /// Draws a frame with these shadow factors, rows from the top, and reads it.
    fn read_with_factors(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        frame: &Frame<'_>,
        factors: &[f32],
    ) -> Result<Vec<u8>> {
        let factors = factors_texture(gpu, factors, self.judging.size);
        self.read_picture(gpu, scene, &Frame { factors: Some(&factors), ..*frame })
    }

    /// Returns the mean ꟻLIP error of the shaded picture of a view against the same picture with true shadows, which is
    /// drawn once for all techniques of a frame. Surfaces that face away from the light have no light in it.
    fn flip(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[FittedMap],
        truth: &mut SharedTruth,
    ) -> Result<f64> {
        let mapped = self.picture(gpu, scene, view, maps)?;
        if let (None, Some(traced)) = (&truth.picture, truth.get()) {
            let lit = |point: &Option<TruthPoint>| point.map_or(-1.0, |point: TruthPoint| point.lit);
            let lit: Vec<f32> = traced.points.iter().map(lit).collect();
            let atmosphere = view.atmosphere();
            let picture = self.read_with_factors(gpu, scene, &view.frame(maps, &atmosphere), &lit)?;
            truth.picture = Some(FlipReference::new(&picture, self.judging.size));
        }
        Ok(truth.picture.as_ref().map_or(0.0, |reference| reference.mean_error(&mapped)))
    }

    /// Draws the shaded picture of a view twice, in the judged size: with the shadow factors of maps, and with true ones.
    /// Factors are 0 to 1, rows from the top. Pixels with a negative factor are shaded with the maps.
    ///
    /// # Errors
    ///
    /// As for [`Self::draw`].
    ///
    /// # Panics
    ///
    /// If there are fewer factors than pixels.
    pub fn picture_pair(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[FittedMap],
        [mapped, truth]: [&[f32]; 2],
    ) -> Result<PicturePair> {
        let atmosphere = view.atmosphere();
        let frame = view.frame(maps, &atmosphere);
        let mapped = self.read_with_factors(gpu, scene, &frame, mapped)?;
        let truth = self.read_with_factors(gpu, scene, &Frame { maps_stay: true, ..frame }, truth)?;
        Ok(PicturePair { mapped, truth, size: self.judging.size })
    }

    /// Draws the maps of a view and judges their shadows.
    ///
    /// # Errors
    ///
    /// If a map does not match the shadow map, or the device was lost.
    pub fn judge(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[FittedMap],
        truth: &mut SharedTruth,
    ) -> Result<Judged> {
        pollster::block_on(self.judge_async(gpu, scene, view, maps, truth))
    }

    /// Judges like [`Self::judge`]. A browser can do other work while the GPU draws.
    ///
    /// # Errors
    ///
    /// As for [`Self::judge`].
    pub async fn judge_async(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[FittedMap],
        truth: &mut SharedTruth,
    ) -> Result<Judged> {
        let rays = scene.shared_rays();
        let (mut job, seen) = self.seen_job(gpu, scene, view, maps, rays).await?;
        self.targets = Some(seen);
        truth.or_trace(|| job.trace());
        // The shadow map still holds this frame's maps here. Crawl draws the previous frame's.
        let flip = if self.judging.flip { Some(self.flip(gpu, scene, view, maps, truth)?) } else { None };
        job.before = self.frame_before(gpu, scene, view).await?;
        self.note_view(view, maps);
        let mut judged = job.judge_by(truth.or_trace(|| job.trace()));
        if let Some(mean) = flip {
            judged.tally.add_flip(mean);
        }
        Ok(judged)
    }

    /// Creates the job of a view for a [`BackgroundJudge`](crate::BackgroundJudge): draws its maps and its
    /// probe, and waits for them. As for [`Self::judge`], crawl is measured against the previous view. Also
    /// returns the probe, whose [depth buffer](ProbeTargets::depth_view) shows a later frame which surfaces
    /// are visible ([`JudgedPicture::depth`](shadowfit_render::JudgedPicture::depth)).
    ///
    /// # Errors
    ///
    /// As for [`Self::judge`].
    pub fn judge_job(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[FittedMap],
        rays: Arc<SceneRays>,
    ) -> Result<(JudgeJob, ProbeTargets)> {
        pollster::block_on(self.job(gpu, scene, view, maps, rays))
    }

    async fn job(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[FittedMap],
        rays: Arc<SceneRays>,
    ) -> Result<(JudgeJob, ProbeTargets)> {
        let (mut job, seen) = self.seen_job(gpu, scene, view, maps, rays).await?;
        job.before = self.frame_before(gpu, scene, view).await?;
        self.note_view(view, maps);
        Ok((job, seen))
    }

    /// Creates the job of a view without the previous frame.
    async fn seen_job(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[FittedMap],
        rays: Arc<SceneRays>,
    ) -> Result<(JudgeJob, ProbeTargets)> {
        if view.is_first {
            self.before = None;
        }
        let seen = self.draw_probe(gpu, scene, &Probed { view, maps, choice: None })?;
        let pixels = seen.arrive(gpu).await?.pixels;
        let traced = self.renderer.edge_result() == EdgeOutcome::Traced;
        let traced = self.renderer.take_edge_counts().filter(|_| traced);
        let job = JudgeJob {
            rays,
            pixels,
            view: *view,
            judging: self.judging,
            maps: maps.to_vec(),
            descriptor: *self.renderer.shadow_map().descriptor(),
            counted: scene.counted_instances(self.judging.subject_only),
            before: None,
            traced,
        };
        Ok((job, seen))
    }

    /// Returns the maps of the previous view, and their shadow factors at the points of this one, if crawl is
    /// measured.
    async fn frame_before(&mut self, gpu: &Gpu, scene: &mut PreparedScene, view: &View) -> Result<Option<FrameBefore>> {
        let Some(Before { maps, eye, forward }) = self.before.take().filter(|_| self.judging.crawl) else {
            return Ok(None);
        };
        let probed = Probed { view, maps: &maps, choice: Some((eye, forward)) };
        let factors = factors(&self.probe(gpu, scene, &probed).await?);
        Ok(Some(FrameBefore { maps, eye, forward, factors }))
    }

    /// Draws a view and judges it on the GPU. All pixels count, regardless of [`Judging::subject_only`].
    ///
    /// # Errors
    ///
    /// As for [`Self::judge`], and if the sun has a radius.
    pub fn judge_live(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[FittedMap],
        live: &mut LiveTruth,
    ) -> Result<Vec<GpuPixel>> {
        self.with_live_input(gpu, scene, view, maps, None, |input| live.judge(gpu, input))
    }

    /// Returns the mean time of judging a view on the GPU, without drawing it, in milliseconds.
    ///
    /// # Errors
    ///
    /// As for [`Self::judge_live`].
    pub fn time_live(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[FittedMap],
        live: &mut LiveTruth,
        repeats: u32,
    ) -> Result<f64> {
        self.with_live_input(gpu, scene, view, maps, None, |input| live.time(gpu, input, repeats))
    }

    /// Draws a view's maps and its probe, and records the passes that judge it on the GPU, without waiting.
    /// [`LiveTruth::classes`] is the picture of classes. [`LiveTruth::take`] returns its sums some frames
    /// later. A picture of the same view can reuse the maps. If [`Judging::crawl`] is set, crawl is measured
    /// against the previous view.
    ///
    /// # Errors
    ///
    /// As for [`Self::judge_live`].
    pub fn judge_in_place(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[FittedMap],
        live: &mut LiveTruth,
    ) -> Result<()> {
        let before = self.before.take().filter(|_| self.judging.crawl && !view.is_first);
        self.with_live_input(gpu, scene, view, maps, before.as_ref(), |input| live.submit(gpu, input))?;
        self.note_view(view, maps);
        Ok(())
    }

    /// Takes the probe of the view that was judged last, whose depth buffer shows its visible surfaces. The
    /// next probe gets new targets.
    pub fn take_probe(&mut self) -> Option<ProbeTargets> {
        self.targets.take()
    }

    /// Records a view as the previous one, to measure crawl against it. Judged views are recorded without
    /// this call.
    pub fn note_view(&mut self, view: &View, maps: &[FittedMap]) {
        let forward = view.camera.forward.normalize();
        self.before = Some(Before { maps: maps.to_vec(), eye: view.camera.eye, forward });
    }

    /// Forgets the previous view. The next view starts a path, and its crawl is not measured.
    pub fn forget_view(&mut self) {
        self.before = None;
    }

    /// Draws the probe of a view, and the probe of the previous frame's maps if there is one, and judges
    /// them.
    fn with_live_input<T>(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        view: &View,
        maps: &[FittedMap],
        before: Option<&Before>,
        judge: impl FnOnce(&LiveInput<'_>) -> Result<T>,
    ) -> Result<T> {
        let targets = match before {
            Some(Before { maps, eye, forward }) => {
                let targets = self.targets_before.take();
                let probed = Probed { view, maps, choice: Some((*eye, *forward)) };
                Some(self.draw_probe_into(gpu, scene, &probed, targets)?)
            }
            None => None,
        };
        let seen = self.draw_probe(gpu, scene, &Probed { view, maps, choice: None })?;
        let descriptor = self.renderer.shadow_map().descriptor();
        let measure = |maps: &[FittedMap]| measured(maps, descriptor, view.direction, scene.origin());
        let here = measure(maps);
        let there = before.map_or_else(Vec::new, |before| measure(&before.maps));
        let maps_before = before.map(|before| picture_maps(&there, &before.maps, descriptor));
        let before = before.zip(maps_before.as_ref()).zip(targets.as_ref());
        let judged = judge(&LiveInput {
            camera: self.judging.pixel_camera(scene.origin(), view),
            settings: self.judging.truth_settings(view),
            maps: picture_maps(&here, maps, descriptor),
            seen: &seen.view,
            before: before.map(|((before, maps), targets)| GpuBefore {
                maps,
                eye: before.eye - scene.origin(),
                forward: before.forward.as_dvec3(),
                seen: &targets.view,
            }),
        });
        (self.targets, self.targets_before) = (Some(seen), targets.or(self.targets_before.take()));
        judged
    }

    /// Returns triangle and shadow factor of each pixel.
    async fn probe(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        probed: &Probed<'_>,
    ) -> Result<Vec<Option<ProbePixel>>> {
        let targets = self.draw_probe(gpu, scene, probed)?;
        let probe = targets.arrive(gpu).await;
        self.targets = Some(targets);
        Ok(probe?.pixels)
    }

    /// Draws a probe into targets that the caller must put back.
    fn draw_probe(&mut self, gpu: &Gpu, scene: &mut PreparedScene, probed: &Probed<'_>) -> Result<ProbeTargets> {
        let kept = self.targets.take();
        self.draw_probe_into(gpu, scene, probed, kept)
    }

    /// Draws a probe into these targets if they have the right size, otherwise into new ones.
    fn draw_probe_into(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        probed: &Probed<'_>,
        targets: Option<ProbeTargets>,
    ) -> Result<ProbeTargets> {
        let kept = targets.filter(|targets| targets.size == self.judging.size);
        let targets = kept.unwrap_or_else(|| ProbeTargets::new(&gpu.device, self.judging.size));
        let Probed { view, maps, choice } = *probed;
        let atmosphere = view.atmosphere();
        let frame = Frame { reader: choice, ..self.frame(view, maps, &atmosphere) };
        self.make_rays(gpu, scene)?;
        self.renderer.draw_probe(gpu, &mut scene.gpu_scene, &frame, &targets)?;
        Ok(targets)
    }
}

/// Uploads a picture's shadow factors, rows from the top.
fn factors_texture(gpu: &Gpu, factors: &[f32], [width, height]: [u32; 2]) -> wgpu::TextureView {
    let factors: Vec<u8> = factors.iter().flat_map(|factor| factor.to_le_bytes()).collect();
    let descriptor = wgpu::TextureDescriptor {
        label: Some("shadow factors"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    };
    let order = wgpu::util::TextureDataOrder::LayerMajor;
    let texture = gpu.device.create_texture_with_data(&gpu.queue, &descriptor, order, &factors);
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
