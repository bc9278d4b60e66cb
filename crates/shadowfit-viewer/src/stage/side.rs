//! A technique on the stage: its maps, its renderer, and the judge of its pictures.

pub(super) mod draw;
mod shadow_map;

use shadowfit::{Camera, DepthConvention, LightProjection, Technique};
use shadowfit_params::Inputs;
use shadowfit_render::{Gpu, RenderTarget, Renderer, Statistics};
use shadowfit_study::{Evaluator, Judging, RayUse};
use shadowfit_wgpu::{ShadowMapDescriptor, ShadowMapError, SunShadows, SunShadowsError};

use super::fitted::Fitted;
use super::live::Live;
use super::shot::Shot;
use draw::PictureKey;
use shadow_map::{NoRoom, within_memory};

/// A technique's maps, with their renderer and judge.
#[derive(Debug)]
pub(super) struct Side {
    pub(super) evaluator: Evaluator,
    /// The last fit. Each frame fits again, unless the fit is frozen.
    pub(super) fitted: Option<Fitted>,
    /// Inputs of the last fit.
    inputs: Inputs,
    pub(super) statistics: Statistics,
    pub(super) live: Live,
    /// Whether pictures are consecutive frames of a window. Then nothing waits for rays.
    follows: bool,
    /// Camera of the last drawn picture, until its depth buffer is read.
    unread: Option<Camera>,
    /// The last drawn picture, if it is known.
    picture: Option<PictureKey>,
    /// Reason why the settings cannot be shown unchanged.
    pub(super) problem: Option<String>,
    /// The last maps that the device had no memory for.
    no_room: Option<NoRoom>,
}

impl Side {
    /// Makes a side whose pictures have `samples` per pixel.
    ///
    /// # Errors
    ///
    /// [`ShadowMapError`] if the shadow map cannot be made.
    pub(super) fn new(gpu: &Gpu, technique: &Technique, samples: u32) -> Result<Self, ShadowMapError> {
        let wanted = ShadowMapDescriptor::from(technique);
        let (renderer, _) = within_memory(&wanted, |descriptor| Renderer::new(gpu, descriptor, samples))?;
        Ok(Self {
            evaluator: Evaluator::new(renderer, Judging { crawl: false, ..Judging::default() }),
            fitted: None,
            inputs: Inputs::default(),
            statistics: Statistics::default(),
            live: Live::new(gpu),
            follows: false,
            unread: None,
            picture: None,
            problem: None,
            no_room: None,
        })
    }

    /// Makes the same side on another device, with nothing drawn yet. A frozen fit stays.
    ///
    /// # Errors
    ///
    /// [`ShadowMapError`] if the device has no memory for the shadow map.
    pub(super) fn anew(&self, gpu: &Gpu, samples: u32) -> Result<Self, ShadowMapError> {
        let mut side = Self::new(gpu, &Technique::default(), samples)?;
        (side.fitted, side.live.waits) = (self.fitted.clone(), self.live.waits);
        if self.follows {
            side.follow();
        }
        Ok(side)
    }

    /// Treats pictures as consecutive frames of a window from now on. Visible points are counted in depth
    /// buffers, and not by rays. Counts arrive a frame or two late, as soon as the GPU is done, so pictures
    /// may differ from run to run. Rays are still used if the GPU cannot count, and for the first view after
    /// a cut. Static casters are kept in the shadow maps, too.
    pub(super) fn follow(&mut self) {
        self.sun_mut().set_caching(true);
        self.follows = true;
    }

    /// Returns the side's sun.
    pub(super) fn sun(&self) -> &SunShadows {
        self.evaluator.renderer.sun()
    }

    fn sun_mut(&mut self) -> &mut SunShadows {
        self.evaluator.renderer.sun_mut()
    }

    /// Returns whether visible points are counted in depth buffers.
    fn reads_depths(&self) -> bool {
        self.follows && self.sun().can_record_demand()
    }

    /// Discards all frames, for another scene.
    pub(super) fn scene_changed(&mut self) {
        self.sun_mut().reset();
        (self.fitted, self.picture) = (None, None);
        self.live.forget();
    }

    /// Starts again with a view that is unrelated to the previous one. A frozen fit stays.
    pub(super) fn cut(&mut self, is_frozen: bool) {
        self.fitted = self.fitted.take().filter(|_| is_frozen);
    }

    /// Draws the next picture even if it would equal the last one.
    pub(super) fn forget_picture(&mut self) {
        self.picture = None;
    }

    /// Fits the view, unless the last fit is frozen.
    pub(super) fn fit(&mut self, shot: &mut Shot<'_>) -> Fitted {
        let technique = self.drawable_technique(shot);
        let is_frozen = shot.settings.view.freeze_fit;
        if let Some(frozen) = self.fitted.as_ref().filter(|fitted| is_frozen && self.holds(fitted)) {
            return Fitted { technique, ..frozen.clone() };
        }
        let fitted = self.fit_now(&technique, shot).unwrap_or_else(|error| {
            self.problem = Some(format!("no shadow map: {error}"));
            Fitted::default()
        });
        self.fitted = Some(fitted.clone());
        fitted
    }

    fn fit_now(&mut self, technique: &Technique, shot: &Shot<'_>) -> Result<Fitted, SunShadowsError> {
        let (view, inputs) = (shot.view(), shot.settings.inputs);
        let goes_on = self.fitted.as_ref().and_then(|fitted| fitted.camera).is_some_and(|last| {
            let same_lens = Camera { eye: last.eye, forward: last.forward, up: last.up, ..view.camera } == last;
            same_lens && self.sun().technique() == technique && self.inputs == inputs
        });
        if !goes_on {
            self.sun_mut().cut();
            self.sun_mut().fitter_mut().set_technique(technique);
            self.inputs = inputs;
            self.evaluator.forget_view();
            let rays = if self.follows { RayUse::IfReady } else { RayUse::Wait };
            shot.scene.see(self.sun_mut().fitter_mut(), inputs, &view, rays)?;
        }
        let views = [view.camera.frustum()?];
        let fitted = *self.sun_mut().fit(&shot.scene.input(inputs, &views, view.direction))?;
        if goes_on && !self.reads_depths() {
            let rays = match (self.follows, shot.plays) {
                (true, _) => RayUse::IfReady,
                (false, true) => RayUse::Late,
                (false, false) => RayUse::Wait,
            };
            shot.scene.see(self.sun_mut().fitter_mut(), inputs, &view, rays)?;
        }
        Ok(Fitted::new(view.camera, technique, &fitted))
    }

    /// Returns whether the current shadow map can hold fitted maps.
    fn holds(&self, fitted: &Fitted) -> bool {
        let map = self.evaluator.renderer.shadow_map().descriptor();
        let fits_into_a_layer =
            |fit: &LightProjection| fit.resolution.cmple(map.resolution.into()).all() && fit.depth == map.depth;
        fitted.maps.len() <= map.maps as usize && fitted.maps.iter().all(|map| fits_into_a_layer(&map.projection))
    }

    /// Counts the visible points of the picture that has just been drawn, if the technique uses them.
    pub(super) fn read_picture(&mut self, gpu: &Gpu, target: &RenderTarget) {
        let Some(camera) = self.unread.take() else { return };
        if !self.reads_depths() || !self.inputs.tell(self.sun().technique()) {
            return;
        }
        let depth = DepthConvention::Reversed;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let clip_from_world = camera.clip_from_world(depth);
        let recorded = self.sun_mut().record_demand(&mut encoder, target.depth_view(), clip_from_world, depth);
        // A camera that shows nothing has no maps either, which the fit reports.
        if recorded == Ok(true) {
            gpu.submit([encoder.finish()]);
        }
    }

    /// Returns the share of pixels with traced edges among the facing pixels, in per cent, a frame or two
    /// late.
    pub(super) fn traced_share(&mut self) -> Option<f32> {
        let renderer = &mut self.evaluator.renderer;
        let counts = renderer.take_edge_counts().or(renderer.edge_counts())?;
        let traced = f64::from(counts.traced) * 100.0;
        (counts.facing > 0).then(|| (traced / f64::from(counts.facing)) as f32)
    }
}
