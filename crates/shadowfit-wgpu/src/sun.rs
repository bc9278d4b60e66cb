//! Shadows of one sun, from camera and bounding boxes to the bind group: the one object that an engine needs.
//!
//! ```text
//!   update(frame) = fit ──▶ prepare: which parts are kept ──▶ passes: the engine draws casters by number
//!        ▲                                                        │
//!        └──── record_demand(depth buffer) ◀──── its own passes with receiver_group() and the WGSL
//! ```

mod descriptor;
mod error;
mod foreign_maps;
mod frame;
mod other_set;
mod steps;
mod tools;

use shadowfit::glam::{DVec3, Mat4, Vec3};
use shadowfit::{Aabb, DepthConvention, FittedMap, ShadowFitter, ViewFrustum, VisibleDemand};

use crate::demand::{DemandPass, DemandPassError, DemandView, supported};
use crate::maps::cached_maps::CachedMaps;
use crate::{
    Culling, CullingRegion, DrawRegion, ShadowMap, ShadowMapDescriptor, ShadowMapError, ShadowPass, UpdateSchedule,
};

use other_set::OtherSet;
use steps::StepState;

pub use descriptor::SunShadowsDescriptor;
pub use error::SunShadowsError;
pub use frame::SunFrame;
pub use steps::LightSteps;

/// Shadows of one directional light: its maps, their cached regions, and the visible demand of recent frames.
///
/// Make one for each sun. It does not know the scene, starts no thread, has no global state, and never waits
/// for the GPU except in [`Self::wait_for_demand`].
#[derive(Debug)]
pub struct SunShadows {
    device: wgpu::Device,
    queue: wgpu::Queue,
    fitter: ShadowFitter,
    maps: CachedMaps,
    steps: Option<StepState>,
    /// Maps of the sun's next or previous direction, if light steps cross-fade.
    other: Option<OtherSet>,
    demand: Demand,
    last: Option<LastFrame>,
}

/// Counter of the visible points of depth buffers.
#[derive(Debug)]
struct Demand {
    /// Whether the device supports the pass.
    is_supported: bool,
    pass: Option<DemandPass>,
    samples: u32,
}

/// View and light of the last prepared frame, for [`SunShadows::record_demand`].
#[derive(Clone, Copy, Debug)]
struct LastFrame {
    view: ViewFrustum,
    direction: Vec3,
}

/// # Every frame
impl SunShadows {
    /// Fits the maps to a frame, finds the regions that must be drawn, and writes the uniforms. Afterwards
    /// [`Self::passes`] returns the passes of this frame. They count as drawn from the next call on. If all
    /// views begin beyond the [shadow distance](shadowfit::settings::MapSettings::max_distance), the frame
    /// has no maps and no passes, and all factors are 1. This method calls [`Self::fit`] and
    /// [`Self::prepare`], with the held direction if the sun has [light steps](Self::set_light_steps).
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Fit`] for invalid views, light or boxes, [`SunShadowsError::Map`] for maps that the
    /// layers cannot hold, and [`SunShadowsError::Demand`] if the device was lost. Then the frame has no
    /// passes, and shaders read the maps of the previous frame.
    pub fn update(&mut self, queue: &wgpu::Queue, frame: &SunFrame<'_>) -> Result<(), SunShadowsError> {
        self.skip();
        frame.check()?;
        let step = self.step(frame)?;
        let held = SunFrame { direction: step.now, ..*frame };
        self.fit(&held.input())?;
        let fitted = *self.fitter.fitted();
        self.prepare_present(queue, &held, &fitted)?;
        // The visible points of this frame are for the newest maps, even while shaders do not read them yet.
        if let (Some(last), Some(steps)) = (&mut self.last, &self.steps) {
            last.direction = steps.newest().unwrap_or(last.direction);
        }
        self.update_other(queue, &held, &step).inspect_err(|_| {
            // The passes of the present set are dropped, too.
            self.invalidate_all();
            self.skip();
        })
    }

    /// Returns the maps on the GPU, with layouts and states for the engine's pipelines.
    pub fn map(&self) -> &ShadowMap {
        self.maps.map()
    }

    /// Records all passes of this frame. `draw` is called for each region that has casters. It must set the
    /// engine's pipeline and buffers and draw the region's casters. The map's matrix is bound at `group`.
    /// Viewport and scissor rectangle are already set and must not change.
    pub fn render(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        group: u32,
        mut draw: impl FnMut(&mut wgpu::RenderPass<'_>, &DrawRegion<'_>),
    ) {
        for pass in self.passes() {
            pass.render(encoder, group, &mut draw);
        }
    }

    /// Returns the bind group that [`receiver_wgsl`](crate::receiver_wgsl) reads.
    pub fn receiver_group(&self) -> &wgpu::BindGroup {
        self.maps.map().receiver_group()
    }

    /// Counts the visible points of a frame, for the fits of the next frames. Call it after the pass that
    /// fills the depth buffer. `depth` is a view of the depth aspect of the whole texture. The frame must
    /// fill the texture, its depths must be stored, and its usages must include `TEXTURE_BINDING`.
    /// `clip_from_world` and `convention` are the matrix and the depth convention that the depth buffer was
    /// drawn with. The matrix takes positions relative to the eye, which is the [`ViewFrustum::origin`] of
    /// the first view.
    ///
    /// Returns whether the count was recorded. Devices that [cannot count](Self::can_record_demand) never
    /// record it, and the bounding boxes place their maps. It is skipped for a frame that was refused or
    /// whose first view begins beyond the shadow distance, and while the counts of many earlier frames have
    /// not arrived.
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Demand`] for an invalid matrix or texture, and if the device is out of memory.
    pub fn record_demand(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
        clip_from_world: Mat4,
        convention: DepthConvention,
    ) -> Result<bool, SunShadowsError> {
        let Some(LastFrame { view, direction }) = self.last.filter(|_| self.can_record_demand()) else {
            return Ok(false);
        };
        let (texture, settings) = (depth.texture(), self.fitter.technique().fit);
        let pass = self.demand.pass(&self.device, &self.queue, texture.sample_count())?;
        let seen = DemandView {
            frustum: view,
            clip_from_world,
            depth: convention,
            direction,
            up: settings.up,
            max_distance: settings.max_distance,
            rectangle: [0, 0, texture.width(), texture.height()],
        };
        Ok(pass.record(encoder, depth, &seen, None)?)
    }

    /// Returns whether the device can count the visible points of depth buffers. OpenGL devices cannot.
    pub fn can_record_demand(&self) -> bool {
        self.demand.is_supported
    }

    /// Forgets the earlier views and their visible points, after a camera cut. Static casters stay in the
    /// maps. A light step in progress ends with the next frame.
    pub fn cut(&mut self) {
        self.end_step();
        self.fitter.reset();
        if let Some(pass) = &mut self.demand.pass {
            pass.reset();
        }
    }

    /// Forgets all earlier frames and redraws all maps in the next one, such as when a new level begins.
    pub fn reset(&mut self) {
        self.cut();
        self.steps.iter_mut().for_each(StepState::reset);
        self.maps.invalidate_all();
    }

    /// Turns the sun off: at night, behind clouds, in a cellar. Call it instead of [`Self::update`]. Until
    /// the next [`Self::update`] all factors are 0, no map is fitted or drawn, and [`Self::record_demand`]
    /// records nothing. The next update begins as after a [cut](Self::cut), with correct maps. The passes of
    /// the previous frame count as drawn.
    ///
    /// The sun is never turned off because of its direction: worlds without a ground are lit from below.
    pub fn turn_off(&mut self, queue: &wgpu::Queue) {
        self.skip();
        if !self.is_off() {
            self.cut();
            self.maps.turn_off(queue);
        }
    }

    /// Returns whether the sun is off: from [`Self::turn_off`] to the next [`Self::update`].
    pub fn is_off(&self) -> bool {
        self.maps.is_off()
    }
}

/// # Passes that the engine schedules
impl SunShadows {
    /// Returns the passes of this frame, in draw order.
    pub fn passes(&self) -> impl ExactSizeIterator<Item = ShadowPass<'_>> {
        self.all_passes()
    }

    /// Opens a pass, for engines that schedule passes themselves. The layer is cleared or restored, and the
    /// map's matrix is bound at `group`. Then [set](DrawRegion::set) and draw each of its regions.
    pub fn begin_pass<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        pass: &ShadowPass<'_>,
        group: u32,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'encoder> {
        pass.begin(encoder, group, timestamps)
    }

    /// Returns a record for each [`DrawRegion`] of [`Self::passes`], by its [number](DrawRegion::number). A
    /// shader finds the region's casters with it ([`culling_wgsl`](crate::culling_wgsl)), for engines that
    /// keep their casters on the GPU. Planes are relative to [`SunFrame::origin`].
    pub fn culling_regions(&self) -> impl Iterator<Item = CullingRegion> {
        self.passes().flat_map(|pass| pass.culling_regions())
    }
}

/// # Caching
impl SunShadows {
    /// Sets whether static casters are kept from frame to frame. Default: `true`. Results are identical
    /// except for 3 in 100,000 edge pixels, where matrix rounding differs.
    pub fn set_caching(&mut self, caching: bool) {
        self.each_set(|maps| maps.caching = caching);
    }

    /// Spreads redraws over several frames; see [`UpdateSchedule`].
    pub fn set_schedule(&mut self, schedule: UpdateSchedule) {
        self.each_set(|maps| maps.schedule = schedule);
    }

    /// Sets the rule that decides which casters are drawn; see [`Culling`]. Results are identical.
    pub fn set_culling(&mut self, culling: Culling) {
        self.each_set(|maps| maps.culling = culling);
    }

    /// Redraws the static casters in a box in the next frame. Call it if a caster changed its shape but not
    /// its bounding box. The box is in metres, relative to `origin` in world space.
    pub fn invalidate(&mut self, aabb: &Aabb, origin: DVec3) {
        self.each_set(|maps| maps.invalidate(aabb, origin));
    }

    /// Redraws all maps in the next frame, such as after a frame whose passes were not submitted.
    pub fn invalidate_all(&mut self) {
        self.each_set(CachedMaps::invalidate_all);
    }

    /// Returns whether the static casters of a map are kept for later frames. `map` is its index.
    pub fn is_cached(&self, map: usize) -> bool {
        self.maps.is_cached(map)
    }
}

/// # Moving sun
impl SunShadows {
    /// Sets the **light steps** of a moving sun. [`Self::update`] receives the true direction in each frame,
    /// but fits the maps to a held direction. The true direction replaces the held one once their difference
    /// moves a map's edge by more than [a number of texels](LightSteps::texels). Between two steps the drawn
    /// maps are kept. Shade with the true direction. With `None`, the default, the maps follow the sun in
    /// each frame.
    ///
    /// With a [fade](LightSteps::fade) there is a second set of maps of the same size in memory. When the sun
    /// steps, the new maps are drawn, one per frame, while shaders read the old ones. Then the look-up mixes
    /// both sets during the frames of the fade, and reads only the new set afterwards. Maps that cannot be
    /// kept are drawn all at once. No other step begins meanwhile. The [visible demand](Self::record_demand)
    /// moves only the windows of the new set, so that this change fades in, too. If the sun is more than 2°
    /// from the direction of its maps, it was moved elsewhere: all maps are redrawn in that frame, without a
    /// fade. A step right after a [cut](Self::cut) has no fade, either.
    ///
    /// Returns whether the maps were recreated, as [`Self::set_technique`] does. They are if a fade was added
    /// or removed.
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Fit`] for an invalid number of texels, and the errors of [`Self::new`]. On an
    /// error, the shadows do not change.
    pub fn set_light_steps(&mut self, steps: Option<LightSteps>) -> Result<bool, SunShadowsError> {
        if let Some(steps) = &steps {
            steps.check()?;
        }
        let cross_fades = steps.is_some_and(|steps| steps.fade > 0);
        let is_new = self.replace_maps(&ShadowMapDescriptor { cross_fades, ..*self.map().descriptor() })?;
        self.steps = steps.map(|settings| match self.steps {
            Some(state) => state.with_settings(settings),
            None => StepState::new(settings),
        });
        Ok(is_new)
    }

    /// Returns the light steps.
    pub fn light_steps(&self) -> Option<LightSteps> {
        self.steps.map(|state| state.settings)
    }
}

impl SunShadows {
    /// Returns the present maps with their cache.
    #[cfg(feature = "rays")]
    pub(crate) fn cached(&self) -> &CachedMaps {
        &self.maps
    }

    /// Returns whether the look-up mixes two sets of maps.
    #[cfg(feature = "rays")]
    pub(crate) fn is_fading(&self) -> bool {
        self.faded().is_some()
    }

    fn each_set(&mut self, mut set: impl FnMut(&mut CachedMaps)) {
        set(&mut self.maps);
        self.other.iter_mut().for_each(|other| set(&mut other.maps));
    }

    /// Keeps one set of maps, for the newest direction, from the next frame on.
    fn end_step(&mut self) {
        self.steps.iter_mut().for_each(StepState::cut);
    }

    /// Calls [`Self::prepare`] for the present maps.
    fn prepare_present(
        &mut self,
        queue: &wgpu::Queue,
        frame: &SunFrame<'_>,
        maps: &[FittedMap],
    ) -> Result<(), ShadowMapError> {
        self.maps.update(queue, &frame.cache_frame(maps), &frame.map_view())?;
        self.last = frame.views.first().map(|view| LastFrame { view: *view, direction: frame.direction });
        Ok(())
    }

    /// Gives the frame no passes.
    fn skip(&mut self) {
        self.each_set(CachedMaps::skip);
        self.last = None;
    }

    /// Passes visible demand to the maps of the newest direction. The older set keeps its windows in place:
    /// moving a window while shaders read it changes shadows from one frame to the next.
    fn see(&mut self, seen: VisibleDemand) {
        match &mut self.other {
            Some(other) if self.steps.is_some_and(|steps| steps.is_drawing()) => other.fitter.set_visible_demand(seen),
            _ => self.fitter.set_visible_demand(seen),
        }
    }
}

impl Demand {
    fn new(device: &wgpu::Device) -> Self {
        let is_supported = supported(&device.limits(), device.adapter_info().backend).is_ok();
        Self { is_supported, pass: None, samples: 0 }
    }

    /// Returns the pass for depth buffers of this sample count.
    fn pass(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        samples: u32,
    ) -> Result<&mut DemandPass, DemandPassError> {
        let made = match self.pass.take().filter(|_| self.samples == samples) {
            Some(pass) => pass,
            None => DemandPass::new(device, queue, samples)?,
        };
        self.samples = samples;
        Ok(self.pass.insert(made))
    }
}
