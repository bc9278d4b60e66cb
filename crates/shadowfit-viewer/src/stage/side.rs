//! A technique on the stage: its maps, its renderer, and the judge of its pictures.

use shadowfit::settings::CasterPolicy;
use shadowfit::{Camera, DepthConvention, FittedMap, LightProjection, PerspectiveCamera, Seen, Technique};
use shadowfit_params::Inputs;
use shadowfit_params::tool::{ErrorMarks, InsetMaps, Settings, ViewMode};
use shadowfit_render::{Culling, Frame, Gpu, Marks, Overlay, RenderTarget, Renderer, Statistics};
use shadowfit_study::{Evaluator, Judging, RayUse, View, atmosphere};
use shadowfit_wgpu::resolve::EdgeResult;
use shadowfit_wgpu::{RESOLUTIONS, ShadowMapDescriptor, ShadowMapError, SunShadows, SunShadowsError};

use super::fitted::Fitted;
use super::live::Live;
use super::outside;
use super::shot::Shot;
use super::{boards, demand_view, inset};

/// A technique's maps, with their renderer and judge.
#[derive(Debug)]
pub(super) struct Side {
    pub(super) evaluator: Evaluator,
    /// The last fit. Each frame fits again, unless the fit is frozen.
    pub(super) fitted: Option<Fitted>,
    /// What it was given.
    inputs: Inputs,
    pub(super) statistics: Statistics,
    pub(super) live: Live,
    /// Whether pictures follow each other in a window: nothing waits for rays then.
    follows: bool,
    /// Camera of the picture that was drawn last, until its depth buffer is read.
    unread: Option<Camera>,
    /// What was drawn last, where it is known.
    pub(super) shown: Option<Shown>,
    /// Why the settings cannot be shown as they are.
    pub(super) problem: Option<String>,
    /// The maps that the device had no memory for last, and the largest that it had some for.
    no_room: Option<[ShadowMapDescriptor; 2]>,
}

/// All that a picture depends on.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Shown {
    settings: Settings,
    camera: Camera,
    sight: f32,
    blink: f32,
    pose: u64,
    maps: Vec<FittedMap>,
    judged: Option<wgpu::TextureView>,
    target: wgpu::Texture,
}

/// Why edges are filtered, where the technique traces them.
pub(super) fn filtered_edges(settings: &Settings, result: EdgeResult) -> Option<String> {
    let wants = settings.technique.edges.are_traced() && settings.view.shadows;
    let EdgeResult::Filtered(why) = result else { return None };
    wants.then(|| format!("Edges are filtered: {why}"))
}

/// Makes a shadow map, or where the device has no memory for it, the first that it has some for of those with half the
/// texels a side, a quarter, and so on.
fn within_memory<T>(
    wanted: &ShadowMapDescriptor,
    mut make: impl FnMut(&ShadowMapDescriptor) -> Result<T, ShadowMapError>,
) -> Result<(T, ShadowMapDescriptor), ShadowMapError> {
    let mut descriptor = *wanted;
    loop {
        let least = *RESOLUTIONS.start();
        match make(&descriptor) {
            Err(ShadowMapError::OutOfMemory { .. }) if descriptor.resolution.iter().any(|side| *side > least) => {
                descriptor.resolution = descriptor.resolution.map(|side| (side / 2).max(least));
            }
            made => return made.map(|made| (made, descriptor)),
        }
    }
}

impl Side {
    /// A side whose pictures have `samples` per pixel.
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
            shown: None,
            problem: None,
            no_room: None,
        })
    }

    /// The same on another device, with nothing drawn yet; a frozen fit stays.
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

    /// From now on pictures follow each other in a window: visible points are counted in depth buffers, and not by
    /// rays. Counts come a frame or two late, whenever the GPU is done, so pictures may differ from run to run. Rays
    /// are still used where the GPU cannot count, and for the first view after a cut. Static casters are kept in the
    /// shadow maps, too.
    pub(super) fn follow(&mut self) {
        self.sun_mut().set_caching(true);
        self.follows = true;
    }

    /// The side's sun.
    pub(super) fn sun(&self) -> &SunShadows {
        self.evaluator.renderer.sun()
    }

    fn sun_mut(&mut self) -> &mut SunShadows {
        self.evaluator.renderer.sun_mut()
    }

    /// Whether visible points are counted in depth buffers.
    fn reads_depths(&self) -> bool {
        self.follows && self.sun().can_record_demand()
    }

    /// Forgets all frames, for another scene.
    pub(super) fn scene_changed(&mut self) {
        self.sun_mut().reset();
        (self.fitted, self.shown) = (None, None);
        self.live.forget();
    }

    /// Starts again with a view that is unrelated to the one before; a frozen fit stays.
    pub(super) fn cut(&mut self, is_frozen: bool) {
        self.fitted = self.fitted.take().filter(|_| is_frozen);
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

    /// Whether the present shadow map can hold fitted maps.
    fn holds(&self, fitted: &Fitted) -> bool {
        let map = self.evaluator.renderer.shadow_map().descriptor();
        let fits_into_a_layer =
            |fit: &LightProjection| fit.resolution.cmple(map.resolution.into()).all() && fit.depth == map.depth;
        fitted.maps.len() <= map.maps as usize && fitted.maps.iter().all(|map| fits_into_a_layer(&map.projection))
    }

    /// The technique of the settings, with its shadow map recreated as needed. Where that is impossible, the old one
    /// stays in use, and [`Self::problem`] says why.
    fn drawable_technique(&mut self, shot: &Shot<'_>) -> Technique {
        let mut technique = shot.settings.technique;
        if technique.fit.depth == DepthConvention::NegativeOneToOne {
            self.problem = Some("depth -1 to 1 is OpenGL's: wgpu draws the map with 0 to 1 instead".to_owned());
            technique.fit.depth = DepthConvention::ZeroToOne;
        }
        let wanted = ShadowMapDescriptor::from(&technique);
        let Err(error) = self.set_shadow_map(shot.gpu, &wanted) else { return technique };
        let map = *self.evaluator.renderer.shadow_map().descriptor();
        self.problem = Some(match error {
            ShadowMapError::OutOfMemory { .. } => {
                let [width, height] = map.resolution;
                format!("{error}. They are drawn with {width} × {height} texels: choose that to keep it")
            }
            _ => error.to_string(),
        });
        technique = technique.with_count(technique.maps.count().min(map.maps));
        let fit = &mut technique.fit;
        (fit.resolution, fit.depth) = (map.resolution.into(), map.depth);
        if fit.casters == CasterPolicy::DepthClamp && !map.depth_clamp {
            fit.casters = CasterPolicy::PerObject;
        }
        technique
    }

    /// Sets the shadow map. Where there is no memory for it, the next smaller one is set, and the error says so.
    fn set_shadow_map(&mut self, gpu: &Gpu, wanted: &ShadowMapDescriptor) -> Result<(), ShadowMapError> {
        // What there was no memory for is not tried again in each frame.
        let first = self.no_room.filter(|[refused, _]| refused == wanted).map_or(*wanted, |[_, smaller]| smaller);
        let renderer = &mut self.evaluator.renderer;
        let ((), set) = within_memory(&first, |descriptor| renderer.set_shadow_map(gpu, descriptor))?;
        self.no_room = (set != *wanted).then_some([*wanted, set]);
        let ShadowMapDescriptor { resolution, format, .. } = *wanted;
        if self.no_room.is_some() {
            return Err(ShadowMapError::OutOfMemory { resolution, maps: wanted.maps, format });
        }
        Ok(())
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
        // A camera that shows nothing has no maps either; the fit reports that.
        if recorded == Ok(true) {
            gpu.submit([encoder.finish()]);
        }
    }

    /// Share of the pixels whose edges were traced of those that face the light, in per cent; a frame or two late.
    pub(super) fn traced_share(&mut self) -> Option<f32> {
        let renderer = &mut self.evaluator.renderer;
        let counts = renderer.take_edge_counts().or(renderer.edge_counts())?;
        let traced = f64::from(counts.traced) * 100.0;
        (counts.facing > 0).then(|| (traced / f64::from(counts.facing)) as f32)
    }

    /// Fits, judges and draws the view that the settings ask for.
    pub(super) fn draw(&mut self, shot: &mut Shot<'_>, target: &RenderTarget) {
        self.problem = None;
        self.evaluator.judging.ray_offset = shot.ray_offset();
        self.draw_anew(shot, target);
        let result = self.evaluator.renderer.edge_result();
        self.problem =
            self.problem.take().or_else(|| filtered_edges(shot.settings, result)).or_else(|| self.live.notice());
    }

    /// Draws the view unless it would be as it was last.
    fn draw_anew(&mut self, shot: &mut Shot<'_>, target: &RenderTarget) {
        let fitted = self.fit(shot);
        let maps = fitted.maps.to_vec();
        let seen = shot.view();
        // A frozen fit was made for another camera, whose view depths may still choose among its maps.
        let view = View { camera: fitted.camera.unwrap_or(seen.camera), ..seen };
        let is_frozen = view.camera != seen.camera;
        let mut maps_stay = false;
        if shot.wants_rays(self.reads_depths() || self.live.waits) && !is_frozen {
            let judged = self.live.judge(&mut self.evaluator, shot, &view, &maps, target.size);
            match judged {
                Ok(drawn) => maps_stay = drawn,
                Err(error) => self.problem = Some(format!("{error:#}")),
            }
        }
        let shown = self.shown_by(shot, &maps, target);
        if shown.is_some() && shown == self.shown {
            return;
        }
        self.shown = shown;
        match shot.settings.view.mode {
            ViewMode::Outside => self.draw_outside(shot, (&fitted, &maps, false), target),
            ViewMode::Demand => self.draw_demand(shot, &fitted, &maps, target),
            ViewMode::Updates => self.draw_boards(shot, (&view, &maps, maps_stay), target),
            mode => self.draw_view(shot, &view, &maps, (Overlay::of(mode), maps_stay), target),
        }
        if !is_frozen && !matches!(shot.settings.view.mode, ViewMode::Outside | ViewMode::Demand) {
            self.unread = Some(view.camera);
            self.evaluator.note_view(&view, &maps);
        }
    }

    /// What a whole picture is made from, where pictures are made one by one: the same once more would only take time.
    /// Views that show how the maps themselves were found or drawn go by more than that.
    fn shown_by(&self, shot: &Shot<'_>, maps: &[FittedMap], target: &RenderTarget) -> Option<Shown> {
        let is_known = !matches!(shot.settings.view.mode, ViewMode::Demand | ViewMode::Updates);
        let is_alone = self.live.waits && !self.follows && shot.scissor.is_none();
        (is_alone && is_known).then(|| Shown {
            settings: *shot.settings,
            camera: shot.camera,
            sight: shot.sight,
            blink: shot.blink,
            pose: shot.scene.gpu_scene.pose(),
            maps: maps.to_vec(),
            judged: self.live.judged_view(),
            target: target.texture().clone(),
        })
    }

    /// Draws the camera's picture.
    fn draw_view(
        &mut self,
        shot: &mut Shot<'_>,
        view: &View,
        maps: &[FittedMap],
        (overlay, maps_stay): (Overlay, bool),
        target: &RenderTarget,
    ) {
        let settings = &shot.settings.view;
        let shown = match settings.inset {
            InsetMaps::Off => 0..0,
            InsetMaps::One => {
                let index = settings.inset_index(maps.len() as u32);
                index..(index + 1).min(maps.len())
            }
            InsetMaps::All => 0..maps.len(),
        };
        let bounds = shot.scene.bounds();
        let left = shot.scissor.map_or(0, |[x, ..]| x);
        let insets = inset::insets(shown, maps, &bounds, settings.inset_depths, (left, target.size));
        let judged = self.live.picture();
        let marks = (settings.marks != ErrorMarks::Off && judged.is_some()).then(|| Marks {
            outline: settings.marks == ErrorMarks::Outline,
            strength: if settings.marks == ErrorMarks::Blink { shot.blink } else { 1.0 },
            classes: [true; 4],
        });
        let atmosphere = atmosphere(shot.sight);
        let frame = Frame {
            overlay,
            judged,
            marks,
            insets: &insets,
            shadows: settings.shadows,
            maps_stay,
            scissor: shot.scissor,
            ..view.frame(maps, &atmosphere)
        };
        // Maps that are themselves looked at from elsewhere hold all their casters, not only those of this picture's
        // shadows.
        let frame = if view.camera == shot.camera {
            frame
        } else {
            Frame { culling: Culling::WholeMap, ..frame.seen_through(shot.camera) }
        };
        let drawn = self.evaluator.draw(shot.gpu, shot.scene, &frame, target);
        self.take_statistics(drawn);
    }

    fn take_statistics(&mut self, drawn: Result<Statistics, ShadowMapError>) {
        match drawn {
            Ok(statistics) => self.statistics = statistics,
            Err(error) => (self.problem, self.shown) = (Some(error.to_string()), None),
        }
    }

    /// Draws the camera, its maps and their casters, from outside. `maps_stay` where the maps were just drawn for the
    /// camera itself.
    pub(super) fn draw_outside(
        &mut self,
        shot: &mut Shot<'_>,
        (fitted, maps, maps_stay): (&Fitted, &[FittedMap], bool),
        target: &RenderTarget,
    ) {
        let seen = shot.camera;
        let aspect = target.size[0] as f32 / target.size[1] as f32;
        let camera = PerspectiveCamera { aspect, ..outside::camera(&Camera { aspect, ..seen }, fitted) };
        let descriptor = *self.evaluator.renderer.shadow_map().descriptor();
        let lines = outside::lines(fitted, maps, &descriptor);
        let view = View { camera: fitted.camera.unwrap_or(seen), ..shot.view() };
        let atmosphere = atmosphere(camera.far.max(shot.sight));
        let frame = Frame {
            culling: Culling::WholeMap,
            overlay: Overlay::Casters,
            maps_stay,
            lines: &lines,
            shadows: shot.settings.view.shadows,
            scissor: shot.scissor,
            ..view.frame(maps, &atmosphere).seen_through(camera)
        };
        let drawn = self.evaluator.draw(shot.gpu, shot.scene, &frame, target);
        self.take_statistics(drawn);
    }

    /// Draws the scene from the light's direction, with the demand grid and the outlines of the maps.
    fn draw_demand(&mut self, shot: &mut Shot<'_>, fitted: &Fitted, maps: &[FittedMap], target: &RenderTarget) {
        let shown = shot.settings.view.inset_index(maps.len() as u32);
        let Some(from_light) = demand_view::FromLight::new(fitted, shown, shot.scene.bounds(), target.size) else {
            return self.draw_view(shot, &shot.view(), maps, (Overlay::None, false), target);
        };
        let demand = self.sun().fitter().seen().map(Seen::demand);
        let quads = demand_view::quads(&from_light, fitted, demand);
        let lines = demand_view::lines(fitted);
        let view = View { camera: fitted.camera.unwrap_or(shot.camera), ..shot.view() };
        // No haze between the light and the scene.
        let atmosphere = atmosphere(f32::MAX);
        let frame = Frame {
            culling: Culling::WholeMap,
            quads: &quads,
            lines: &lines,
            shadows: shot.settings.view.shadows,
            scissor: shot.scissor,
            ..view.frame(maps, &atmosphere).seen_through(from_light.camera)
        };
        let drawn = self.evaluator.draw(shot.gpu, shot.scene, &frame, target);
        self.take_statistics(drawn);
    }

    /// Draws all maps side by side, with the parts that were redrawn. `maps_stay`: whether they were drawn for the
    /// judge.
    fn draw_boards(
        &mut self,
        shot: &mut Shot<'_>,
        (view, maps, maps_stay): (&View, &[FittedMap], bool),
        target: &RenderTarget,
    ) {
        let bounds = shot.scene.bounds();
        let boards = boards::Boards::new(maps, &bounds, shot.settings.view.inset_depths, target.size);
        // The updates of the frame before, unless the maps stay: those of this frame are known only after it is drawn.
        let quads = boards.quads(&self.sun().updates());
        let atmosphere = atmosphere(shot.sight);
        let frame = Frame {
            insets: &boards.insets,
            quads: &quads,
            maps_stay,
            scissor: shot.scissor,
            ..view.frame(maps, &atmosphere)
        };
        let drawn = self.evaluator.draw(shot.gpu, shot.scene, &frame, target);
        self.take_statistics(drawn);
    }
}
