//! The shadows of one sun, from camera and boxes to bind group: the one object that an engine needs.
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

/// The shadows of one directional light: its maps, the parts of them that are kept, and what the last frames showed.
///
/// Make one for each sun. It does not know the scene, starts no thread, has no global state, and never waits for the
/// GPU except in [`Self::wait_for_demand`].
#[derive(Debug)]
pub struct SunShadows {
    device: wgpu::Device,
    queue: wgpu::Queue,
    fitter: ShadowFitter,
    maps: CachedMaps,
    steps: Option<StepState>,
    /// The maps of the sun's next direction or of the one before, where steps cross-fade.
    other: Option<OtherSet>,
    demand: Demand,
    last: Option<LastFrame>,
}

/// Counts the visible points of depth buffers.
#[derive(Debug)]
struct Demand {
    /// Whether the device can do that.
    is_supported: bool,
    pass: Option<DemandPass>,
    samples: u32,
}

/// The view and light of the frame that was prepared last, for [`SunShadows::record_demand`].
#[derive(Clone, Copy, Debug)]
struct LastFrame {
    view: ViewFrustum,
    direction: Vec3,
}

/// # In each frame
impl SunShadows {
    /// Fits the maps to a frame, finds which parts must be drawn, and writes the uniforms. Where all views begin beyond the
    /// [shadow distance](shadowfit::settings::MapSettings::max_distance) there are no maps and no passes, and all factors
    /// are 1. [`Self::passes`] then has
    /// the passes of this frame; they count as drawn from the next call on. It is [`Self::fit`] and [`Self::prepare`]
    /// in one, for the direction that is held where the sun has [light steps](Self::set_light_steps).
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Fit`] for views, light and boxes that make no sense; [`SunShadowsError::Map`] for maps that
    /// the layers cannot hold; [`SunShadowsError::Demand`] if the device was lost. There is nothing to draw then, and the
    /// shaders read the maps of the frame before.
    pub fn update(&mut self, queue: &wgpu::Queue, frame: &SunFrame<'_>) -> Result<(), SunShadowsError> {
        self.skip();
        frame.check()?;
        let step = self.step(frame)?;
        let held = SunFrame { direction: step.now, ..*frame };
        self.fit(&held.input())?;
        let fitted = *self.fitter.fitted();
        self.prepare_present(queue, &held, &fitted)?;
        // What this frame shows serves the newest maps, also before they are read.
        if let (Some(last), Some(steps)) = (&mut self.last, &self.steps) {
            last.direction = steps.newest().unwrap_or(last.direction);
        }
        self.update_other(queue, &held, &step).inspect_err(|_| {
            // The passes of the other half are not drawn either.
            self.invalidate_all();
            self.skip();
        })
    }

    /// The maps on the GPU: layouts and states for the engine's pipelines.
    pub fn map(&self) -> &ShadowMap {
        self.maps.map()
    }

    /// Records all passes of this frame. `draw` is called for each part that has casters: it sets the engine's
    /// pipeline and buffers, and draws the part's casters. The map's matrix is bound at `group`; viewport and scissor
    /// rectangle are set, and must stay.
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

    /// The bind group that [`receiver_wgsl`](crate::receiver_wgsl) reads.
    pub fn receiver_group(&self) -> &wgpu::BindGroup {
        self.maps.map().receiver_group()
    }

    /// Counts the visible points of a picture, for the fits of the next frames. Call it after the pass that fills the
    /// depth buffer. `depth` is a view of the depth aspect of the whole texture, which fills the picture, is stored,
    /// and has the usage `TEXTURE_BINDING`; `clip_from_world` and `convention` are those that it was drawn with, for
    /// positions relative to the eye, [`ViewFrustum::origin`] of the first view.
    ///
    /// Returns whether it was recorded: never on devices that [cannot count](Self::can_record_demand), where maps are placed
    /// by the boxes; nor for a frame that was refused, or whose first view begins beyond the shadow distance; nor while
    /// many pictures are still on their way.
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Demand`] for the matrix, the texture, and a device out of memory.
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

    /// Whether the device can count the visible points of depth buffers: those of OpenGL cannot.
    pub fn can_record_demand(&self) -> bool {
        self.demand.is_supported
    }

    /// Forgets the earlier views and what they showed: after a camera cut. Static casters stay in the maps. A step of
    /// the sun that is under way ends with the next frame.
    pub fn cut(&mut self) {
        self.end_step();
        self.fitter.reset();
        if let Some(pass) = &mut self.demand.pass {
            pass.reset();
        }
    }

    /// Forgets all earlier frames and redraws all maps in the next one: when a new level begins.
    pub fn reset(&mut self) {
        self.cut();
        self.steps.iter_mut().for_each(StepState::reset);
        self.maps.invalidate_all();
    }

    /// Says that the sun gives nothing, instead of [`Self::update`]: at night, behind clouds, in a cellar. All factors
    /// are 0 then, there are no maps, no passes and nothing to fit, and [`Self::record_demand`] records nothing, until the
    /// next [`Self::update`]. That one begins as after a [cut](Self::cut), and its maps are right. The passes of the
    /// frame before count as drawn.
    ///
    /// It is never guessed from the sun's direction: worlds without a ground are lit from below.
    pub fn turn_off(&mut self, queue: &wgpu::Queue) {
        self.skip();
        if !self.is_off() {
            self.cut();
            self.maps.turn_off(queue);
        }
    }

    /// Whether the sun gives nothing: from [`Self::turn_off`] to the next [`Self::update`].
    pub fn is_off(&self) -> bool {
        self.maps.is_off()
    }
}

/// # Passes of the engine's own
impl SunShadows {
    /// The passes of this frame, in the order in which they must be drawn.
    pub fn passes(&self) -> impl ExactSizeIterator<Item = ShadowPass<'_>> {
        self.all_passes()
    }

    /// Opens a pass, for engines that schedule passes themselves: cleared or mended, with the map's matrix bound at
    /// `group`. Each of its regions is then [set](DrawRegion::set) and drawn.
    pub fn begin_pass<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        pass: &ShadowPass<'_>,
        group: u32,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'encoder> {
        pass.begin(encoder, group, timestamps)
    }

    /// What a shader finds the casters of each region by ([`culling_wgsl`](crate::culling_wgsl)), for engines that keep
    /// their casters on the GPU: a record for each [`DrawRegion`] of [`Self::passes`], by its
    /// [number](DrawRegion::number). Planes are relative to [`SunFrame::origin`].
    pub fn culling_regions(&self) -> impl Iterator<Item = CullingRegion> {
        self.passes().flat_map(|pass| pass.culling_regions())
    }
}

/// # Caching
impl SunShadows {
    /// Whether static casters are kept from frame to frame. They are by default. Pictures are the same either way
    /// but for 3 in 100,000 factors, at edges that were drawn with a matrix that is rounded otherwise.
    pub fn set_caching(&mut self, caching: bool) {
        self.each_set(|maps| maps.caching = caching);
    }

    /// Spreads redraws over frames; see [`UpdateSchedule`].
    pub fn set_schedule(&mut self, schedule: UpdateSchedule) {
        self.each_set(|maps| maps.schedule = schedule);
    }

    /// Which casters are drawn; see [`Culling`]. Pictures are the same either way.
    pub fn set_culling(&mut self, culling: Culling) {
        self.each_set(|maps| maps.culling = culling);
    }

    /// Redraws static casters in a box in the next frame: for one that changed its shape and not its box. The box is in
    /// metres, relative to an origin in world space.
    pub fn invalidate(&mut self, aabb: &Aabb, origin: DVec3) {
        self.each_set(|maps| maps.invalidate(aabb, origin));
    }

    /// Redraws all maps in the next frame, such as after a frame whose passes were not submitted.
    pub fn invalidate_all(&mut self) {
        self.each_set(CachedMaps::invalidate_all);
    }

    /// Whether the static casters of a map, by its number, are kept for later frames.
    pub fn is_cached(&self, map: usize) -> bool {
        self.maps.is_cached(map)
    }
}

/// # A sun that moves
impl SunShadows {
    /// Holds the maps of a sun that moves: its **light steps**. [`Self::update`] is given the true direction in each
    /// frame, and makes the maps for a direction that it holds until a map's edge would be off by
    /// [some texels](LightSteps::texels), so that what is drawn is kept in between. Shading goes on with the true
    /// direction. `None`, as it is in the beginning, follows the sun in each frame.
    ///
    /// With a [fade](LightSteps::fade) there is a second set of maps, of as many bytes. When the sun steps, its maps are
    /// drawn one by one, a map in each frame, while the old ones are read; then the look-up reads both for as many
    /// frames as the fade has, and the new ones alone after that. Maps that cannot be kept are drawn all at once. While
    /// a step is under way no other begins, and windows follow [what is seen](Self::record_demand) in the new maps alone,
    /// so that they fade in, too. A sun that is farther from its maps than 2° was set elsewhere: there is no
    /// fade then, and all maps are drawn anew in that frame. So it is after a [cut](Self::cut).
    ///
    /// Returns whether the maps were recreated, as [`Self::set_technique`] does: where there is a fade now and was none,
    /// or the other way round.
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Fit`] for a number of texels that makes no sense, and as [`Self::new`]. Everything stays as
    /// it is then.
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

    /// The light steps.
    pub fn light_steps(&self) -> Option<LightSteps> {
        self.steps.map(|state| state.settings)
    }
}

impl SunShadows {
    /// The maps that are read, and what is kept of them.
    #[cfg(feature = "rays")]
    pub(crate) fn cached(&self) -> &CachedMaps {
        &self.maps
    }

    /// Whether two sets of maps are mixed.
    #[cfg(feature = "rays")]
    pub(crate) fn is_fading(&self) -> bool {
        self.faded().is_some()
    }

    fn each_set(&mut self, mut set: impl FnMut(&mut CachedMaps)) {
        set(&mut self.maps);
        self.other.iter_mut().for_each(|other| set(&mut other.maps));
    }

    /// Goes on with one set of maps, for the newest direction, from the next frame on.
    fn end_step(&mut self) {
        self.steps.iter_mut().for_each(StepState::cut);
    }

    /// [`Self::prepare`] of the maps that are read.
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

    /// Leaves the frame without passes.
    fn skip(&mut self) {
        self.each_set(CachedMaps::skip);
        self.last = None;
    }

    /// Tells what a picture showed to the maps of the newest direction. Those that are read before them, or are faded out,
    /// keep their windows where they are: a window that is replaced while it is read changes the shadow from one frame to
    /// the next.
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

    /// The pass for depth buffers of so many samples.
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
