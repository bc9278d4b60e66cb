//! The only place where a technique's pictures are drawn and judged.

use std::sync::Arc;

use anyhow::Result;
use glam::{DVec3, Vec3};
use shadowfit::FittedMap;
use shadowfit_render::{
    Atmosphere, Frame, Gpu, PixelQuery, PixelRead, ProbePixel, ProbeTargets, RayError, RenderTarget, Renderer,
    Statistics,
};
use shadowfit_truth::Judged;
use shadowfit_truth::gpu::{GpuBefore, GpuPixel};
use shadowfit_wgpu::ShadowMapError;
use shadowfit_wgpu::exact_edges::EdgeOutcome;

use crate::live::{LiveInput, LiveTruth};
use crate::maps::{measured, picture_maps};
use crate::picture::{FrameBefore, factors};
use crate::{JudgeJob, Judging, PreparedScene, SceneRays, SharedTruth, View};

/// Draws a technique's maps and the scene shadowed by them, and judges the picture.
#[derive(Debug)]
pub struct Evaluator {
    /// Draws the maps into its shadow map, and the pictures.
    pub renderer: Renderer,
    /// How pictures are judged.
    pub judging: Judging,
    targets: Option<ProbeTargets>,
    /// Targets of the probe of the frame before.
    targets_before: Option<ProbeTargets>,
    picture: Option<RenderTarget>,
    before: Option<Before>,
    /// The maps that were drawn last.
    drawn: Vec<FittedMap>,
}

/// The maps of the frame before, and the eye and forward direction that chose among them.
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
    /// The eye and the forward direction that choose among the maps, if they are not the camera's.
    choice: Option<(DVec3, Vec3)>,
}

impl Evaluator {
    /// An evaluator that has judged nothing yet.
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
    /// When a map does not suit the shadow map; nothing is drawn then.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        frame: &Frame<'_>,
        picture: &RenderTarget,
    ) -> Result<Statistics, ShadowMapError> {
        // Without rays edges are filtered, and the renderer says so.
        let _rays = self.make_rays(gpu, scene);
        let frame = &Frame { ray_offset: self.judging.ray_offset as f32, ..*frame };
        let drawn = self.renderer.draw(gpu, &mut scene.gpu_scene, frame, picture)?;
        self.drawn.clear();
        self.drawn.extend_from_slice(frame.maps);
        Ok(drawn)
    }

    /// Makes a scene ready for rays, where edges are traced.
    fn make_rays(&self, gpu: &Gpu, scene: &mut PreparedScene) -> Result<(), RayError> {
        if self.renderer.shadow_map().descriptor().edges.are_traced() { scene.make_gpu_rays(gpu) } else { Ok(()) }
    }

    /// Begins to read triangle and shadow factor of a pixel of a view, and the depths around a texel of a map, without
    /// waiting. The view must be the one that was drawn last, since its maps are read.
    ///
    /// # Errors
    ///
    /// When the camera has no direction.
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

    /// The maps that were drawn last.
    pub fn drawn_fits(&self) -> &[FittedMap] {
        &self.drawn
    }

    /// The shaded picture of a view, in the size that is judged: sRGB pixels, four bytes each, rows from the top.
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
        let kept = self.picture.take().filter(|picture| picture.size == self.judging.size);
        let picture = kept.unwrap_or_else(|| self.renderer.target(gpu, self.judging.size));
        let atmosphere = view.atmosphere();
        self.draw(gpu, scene, &view.frame(maps, &atmosphere), &picture)?;
        let pixels = picture.read(gpu);
        self.picture = Some(picture);
        Ok(pixels?)
    }

    /// Draws the maps of a view and judges the shadows that they give.
    ///
    /// # Errors
    ///
    /// When a map does not suit the shadow map, or the device was lost.
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

    /// The same, and lets a browser do other things while the GPU draws.
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
        let (job, seen) = self.job(gpu, scene, view, maps, rays).await?;
        self.targets = Some(seen);
        Ok(job.judge_by(truth.or_trace(|| job.trace())))
    }

    /// Makes the job of a view for a [`BackgroundJudge`](crate::BackgroundJudge): draws its maps and its probe, and
    /// waits for them. As for [`Self::judge`], crawl is measured against the view before. Also returns the probe, whose
    /// [depth buffer](ProbeTargets::depth_view) tells a later frame which surfaces the picture shows
    /// ([`JudgedPicture::depth`](shadowfit_render::JudgedPicture::depth)).
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
        if view.is_first {
            self.before = None;
        }
        let seen = self.draw_probe(gpu, scene, &Probed { view, maps, choice: None })?;
        let pixels = seen.arrive(gpu).await?.pixels;
        let traced = self.renderer.edge_result() == EdgeOutcome::Traced;
        let traced = self.renderer.take_edge_counts().filter(|_| traced);
        let before = self.frame_before(gpu, scene, view).await?;
        self.note_view(view, maps);
        let job = JudgeJob {
            rays,
            pixels,
            view: *view,
            judging: self.judging,
            maps: maps.to_vec(),
            descriptor: *self.renderer.shadow_map().descriptor(),
            counted: scene.counted_instances(self.judging.subject_only),
            before,
            traced,
        };
        Ok((job, seen))
    }

    /// The maps of the view before, and their shadow factors at the points of this one, if crawl is measured.
    async fn frame_before(&mut self, gpu: &Gpu, scene: &mut PreparedScene, view: &View) -> Result<Option<FrameBefore>> {
        let Some(Before { maps, eye, forward }) = self.before.take().filter(|_| self.judging.crawl) else {
            return Ok(None);
        };
        let probed = Probed { view, maps: &maps, choice: Some((eye, forward)) };
        let factors = factors(&self.probe(gpu, scene, &probed).await?);
        Ok(Some(FrameBefore { maps, eye, forward, factors }))
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
        maps: &[FittedMap],
        live: &mut LiveTruth,
    ) -> Result<Vec<GpuPixel>> {
        self.with_live_input(gpu, scene, view, maps, None, |input| live.judge(gpu, input))
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
        maps: &[FittedMap],
        live: &mut LiveTruth,
        repeats: u32,
    ) -> Result<f64> {
        self.with_live_input(gpu, scene, view, maps, None, |input| live.time(gpu, input, repeats))
    }

    /// Draws a view's maps and its probe, and records the passes that judge it on the GPU, without waiting:
    /// [`LiveTruth::classes`] is the picture of classes, and [`LiveTruth::take`] has its sums some frames later. The
    /// maps are left as a picture of the same view needs them. Crawl is measured against the view before, if
    /// [`Judging::crawl`] says so.
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

    /// The probe of the view that was judged last, whose depth buffer tells which surfaces it shows. The next one gets
    /// targets of its own.
    pub fn take_probe(&mut self) -> Option<ProbeTargets> {
        self.targets.take()
    }

    /// Notes a view as the one before: crawl is measured against it. Views that are judged are noted without this call.
    pub fn note_view(&mut self, view: &View, maps: &[FittedMap]) {
        let forward = view.camera.forward.normalize();
        self.before = Some(Before { maps: maps.to_vec(), eye: view.camera.eye, forward });
    }

    /// Forgets the view before: the next one begins a path, and its crawl is not measured.
    pub fn forget_view(&mut self) {
        self.before = None;
    }

    /// Draws the probe of a view, and that of the maps of the frame before where there is one, and judges them.
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

    /// Triangle and shadow factor of each pixel.
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

    /// Draws a probe into targets that the caller gives back.
    fn draw_probe(&mut self, gpu: &Gpu, scene: &mut PreparedScene, probed: &Probed<'_>) -> Result<ProbeTargets> {
        let kept = self.targets.take();
        self.draw_probe_into(gpu, scene, probed, kept)
    }

    /// The same into these targets where they have the right size, otherwise into new ones.
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
