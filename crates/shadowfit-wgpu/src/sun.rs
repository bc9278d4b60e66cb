//! The shadows of one sun, from camera and boxes to bind group: the one object that an engine needs.
//!
//! ```text
//!   update(frame) = fit ──▶ prepare: which parts are kept ──▶ passes: the engine draws casters by number
//!        ▲                                                        │
//!        └──── record_demand(depth buffer) ◀──── its own passes with receiver_group() and the WGSL
//! ```

mod descriptor;
mod error;
mod frame;
mod other_set;
mod steps;

use shadowfit::glam::{DVec2, DVec3, Mat4, Vec3};
use shadowfit::proof::{CoverageProof, CoverageQuery, Margins, prove};
use shadowfit::{
    Aabb, DepthConvention, FitInput, FittedMap, FittedMaps, Scratch, Seen, ShadowFitter, Technique, ViewFrustum,
};

use crate::cached_maps::CachedMaps;
use crate::demand::{DemandPass, DemandPassError, DemandView, supported};
use crate::{
    Casters, Culling, CullingPiece, MapUpdate, MapView, ShadowMap, ShadowMapDescriptor, ShadowMapError, ShadowPass,
    ShadowPiece, UpdateSchedule,
};

use other_set::OtherSet;
use steps::StepState;

pub use descriptor::SunShadowsDescriptor;
pub use error::SunShadowsError;
pub use frame::SunFrame;
pub use steps::SunSteps;

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

impl SunShadows {
    /// The technique.
    pub fn technique(&self) -> &Technique {
        self.fitter.technique()
    }

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

    /// The fitter of the maps.
    pub fn fitter(&self) -> &ShadowFitter {
        &self.fitter
    }

    /// The fitter of the maps, for visible points that were [found](ShadowFitter::see) by other means than
    /// [`Self::record_demand`], or for another technique with the same layers, such as one with fewer maps.
    pub fn fitter_mut(&mut self) -> &mut ShadowFitter {
        &mut self.fitter
    }

    /// The maps on the GPU: layouts and states for the engine's pipelines.
    pub fn map(&self) -> &ShadowMap {
        self.maps.map()
    }

    /// The maps that were fitted last.
    pub fn fitted(&self) -> &FittedMaps {
        self.fitter.fitted()
    }

    /// The maps that shaders read in this frame. A map that waits for another frame is the one that was drawn last.
    pub fn maps(&self) -> &[FittedMap] {
        self.maps.maps()
    }

    /// From where shaders read them: the origin of positions, and the eye and direction that view depths are counted from.
    /// `None` before the first frame, and while the sun is [off](Self::turn_off).
    pub fn map_view(&self) -> Option<&MapView> {
        self.maps.view()
    }

    /// The bind group that [`receiver_wgsl`](crate::receiver_wgsl) reads.
    pub fn receiver_group(&self) -> &wgpu::BindGroup {
        self.maps.map().receiver_group()
    }

    /// Spreads redraws over frames; see [`UpdateSchedule`].
    pub fn set_schedule(&mut self, schedule: UpdateSchedule) {
        self.each_set(|maps| maps.schedule = schedule);
    }

    /// Whether static casters are kept from frame to frame. They are by default. Pictures are the same either way
    /// but for 3 in 100,000 factors, at edges that were drawn with a matrix that is rounded otherwise.
    pub fn set_caching(&mut self, caching: bool) {
        self.each_set(|maps| maps.caching = caching);
    }

    /// Which casters are drawn; see [`Culling`]. Pictures are the same either way.
    pub fn set_culling(&mut self, culling: Culling) {
        self.each_set(|maps| maps.culling = culling);
    }

    fn each_set(&mut self, mut set: impl FnMut(&mut CachedMaps)) {
        set(&mut self.maps);
        self.other.iter_mut().for_each(|other| set(&mut other.maps));
    }

    /// Holds the maps of a sun that moves: its **light steps**. [`Self::update`] is given the true direction in each
    /// frame, and makes the maps for a direction that it holds until a map's edge would be off by
    /// [some texels](SunSteps::texels), so that what is drawn is kept in between. Shading goes on with the true
    /// direction. `None`, as it is in the beginning, follows the sun in each frame.
    ///
    /// With a [fade](SunSteps::fade) there is a second set of maps, of as many bytes. When the sun steps, its maps are
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
    pub fn set_light_steps(&mut self, steps: Option<SunSteps>) -> Result<bool, SunShadowsError> {
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
    pub fn light_steps(&self) -> Option<SunSteps> {
        self.steps.map(|state| state.settings)
    }

    /// Forgets all earlier frames and redraws all maps in the next one: when a new level begins.
    pub fn reset(&mut self) {
        self.cut();
        self.steps.iter_mut().for_each(StepState::reset);
        self.maps.invalidate_all();
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

    /// Redraws static casters in a box in the next frame: for one that changed its shape and not its box. The box is in
    /// metres, relative to an origin in world space.
    pub fn invalidate(&mut self, aabb: &Aabb, origin: DVec3) {
        self.each_set(|maps| maps.invalidate(aabb, origin));
    }

    /// Redraws all maps in the next frame, such as after a frame whose passes were not submitted.
    pub fn invalidate_all(&mut self) {
        self.each_set(CachedMaps::invalidate_all);
    }

    /// Goes on with one set of maps, for the newest direction, from the next frame on.
    fn end_step(&mut self) {
        self.steps.iter_mut().for_each(StepState::cut);
    }

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

    /// Fits the maps to an input and to the counts that have arrived of earlier pictures: the first half of
    /// [`Self::update`], for engines that fit to other boxes than those of the casters that they draw, or look at the
    /// maps before they are drawn.
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Fit`] for views, light and boxes that make no sense; [`SunShadowsError::Demand`] if the device
    /// was lost.
    pub fn fit(&mut self, input: &FitInput<'_>) -> Result<&FittedMaps, SunShadowsError> {
        if let Some(pass) = &mut self.demand.pass
            && let Some(seen) = pass.take()?
        {
            self.see(seen);
        }
        Ok(self.fitter.fit(input)?)
    }

    /// Finds which parts of maps must be drawn, and writes the uniforms: the second half of [`Self::update`]. The maps
    /// are those of [`Self::fit`], or any others with as many texels: of a frozen frame, or fitted by other code. Maps
    /// that are read by view depth are in the order of their ends. Maps with an [anchor](FittedMap::anchor) can be
    /// kept; others are redrawn in each frame. Their [`wrap`](FittedMap::wrap) and the frame's receivers are ignored.
    ///
    /// # Errors
    ///
    /// As [`ShadowMap::prepare`], and [`ShadowMapError::View`] for views that make no sense. There is nothing to draw
    /// then, and the shaders read the maps of the frame before.
    pub fn prepare(
        &mut self,
        queue: &wgpu::Queue,
        frame: &SunFrame<'_>,
        maps: &[FittedMap],
    ) -> Result<(), ShadowMapError> {
        self.skip();
        self.end_step();
        self.prepare_present(queue, frame, maps)
    }

    /// [`Self::prepare`] of the maps that are read.
    fn prepare_present(
        &mut self,
        queue: &wgpu::Queue,
        frame: &SunFrame<'_>,
        maps: &[FittedMap],
    ) -> Result<(), ShadowMapError> {
        self.maps.update(queue, frame, maps)?;
        self.last = frame.views.first().map(|view| LastFrame { view: *view, direction: frame.direction });
        Ok(())
    }

    /// Leaves the frame without passes.
    fn skip(&mut self) {
        self.each_set(CachedMaps::skip);
        self.last = None;
    }

    /// Writes the uniforms for another picture with the same maps, whose positions are relative to another origin or
    /// whose view depths are counted from another eye. The maps stay as they were drawn: their passes must not be drawn
    /// after this.
    ///
    /// # Errors
    ///
    /// [`ShadowMapError::Forward`] for a direction that is not of unit length; nothing is written then.
    pub fn look_from(&mut self, queue: &wgpu::Queue, view: &MapView) -> Result<(), ShadowMapError> {
        self.maps.look_from(queue, view)?;
        if let Some((other, share)) = self.faded() {
            self.maps.fade_from(queue, &other.maps, view, share);
        }
        Ok(())
    }

    /// The passes of this frame, in the order in which they must be drawn.
    pub fn passes(&self) -> impl ExactSizeIterator<Item = ShadowPass<'_>> {
        self.all_passes()
    }

    /// Records all passes of this frame. `draw` is called for each part that has casters: it sets the engine's
    /// pipeline and buffers, and draws the part's casters. The map's matrix is bound at `group`; viewport and scissor
    /// rectangle are set, and must stay.
    pub fn render(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        group: u32,
        mut draw: impl FnMut(&mut wgpu::RenderPass<'_>, &ShadowPiece<'_>),
    ) {
        for pass in self.passes() {
            pass.render(encoder, group, &mut draw);
        }
    }

    /// What a shader finds the casters of each piece by ([`culling_wgsl`](crate::culling_wgsl)), for engines that keep
    /// their casters on the GPU: a record for each [`ShadowPiece`] of [`Self::passes`], by its
    /// [number](ShadowPiece::number). Planes are relative to [`SunFrame::origin`].
    pub fn culling_pieces(&self) -> impl Iterator<Item = CullingPiece> {
        self.passes().flat_map(|pass| pass.culling_pieces())
    }

    /// Opens a pass, for engines that schedule passes themselves: cleared or mended, with the map's matrix bound at
    /// `group`. Each of its pieces is then [set](ShadowPiece::set) and drawn.
    pub fn begin_pass<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        pass: &ShadowPass<'_>,
        group: u32,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'encoder> {
        pass.begin(encoder, group, timestamps)
    }

    /// The rectangles that are drawn in this frame, in the order of the passes, for tools that show them. Some may
    /// overlap. While the sun [steps](Self::set_light_steps), those of both sets of maps.
    pub fn updates(&self) -> Vec<MapUpdate> {
        let mut updates = self.maps.updates();
        updates.extend(self.other.iter().flat_map(|other| other.maps.updates()));
        updates
    }

    /// Whether the static casters of a map, by its number, are kept for later frames.
    pub fn is_cached(&self, map: usize) -> bool {
        self.maps.is_cached(map)
    }

    /// Which maps hold each caster, by its number: bit i of the mask stands for map i. A map that is kept holds all
    /// static casters over it; any other map those that can shadow something in view. Without maps all masks are 0.
    pub fn holders(&self, casters: &Casters<'_>) -> Vec<u8> {
        self.maps.holders(casters)
    }

    /// Proves that no map has a hole, for the frame that was given to [`Self::update`]: for debug assertions. Returns
    /// the proof of the first map that fails. It takes into account that shaders round positions relative to
    /// [`SunFrame::origin`].
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Fit`] as [`prove`]; [`SunShadowsError::NoFrame`] before the first frame, and while the sun
    /// is [off](Self::turn_off). A frame whose views all begin beyond the shadow distance needs no map.
    pub fn prove(&self, frame: &SunFrame<'_>) -> Result<CoverageProof, SunShadowsError> {
        let mut proof = Err(SunShadowsError::NoFrame);
        if self.map_view().is_some() && !self.is_shadowed(frame) {
            return Ok(CoverageProof::Proven(Margins { planes: [f32::INFINITY; 6], casters: f32::INFINITY }));
        }
        let faded = self.faded().map(|(other, _)| (&other.fitter, &other.maps));
        for (fitter, maps) in [(&self.fitter, &self.maps)].into_iter().chain(faded) {
            // Steps hold the direction.
            let held = fitter.fitted().first().filter(|_| self.steps.is_some());
            let direction = held.map_or(frame.direction, |map| map.projection.direction);
            let found = prove_set(&SunFrame { direction, ..*frame }, fitter, maps.maps());
            if !found.as_ref().is_ok_and(CoverageProof::is_proven) {
                return found;
            }
            proof = found;
        }
        proof
    }

    /// Whether a part of a frame's views lies before the shadow distance.
    fn is_shadowed(&self, frame: &SunFrame<'_>) -> bool {
        let distance = self.technique().fit.max_distance;
        frame.views.iter().any(|view| view.begins_before(distance))
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

    /// Tells what a picture showed to the maps of the newest direction. Those that are read before them, or are faded out,
    /// keep their windows where they are: a window that is replaced while it is read changes the shadow from one frame to
    /// the next.
    fn see(&mut self, seen: Seen) {
        match &mut self.other {
            Some(other) if self.steps.is_some_and(|steps| steps.is_drawing()) => other.fitter.see(seen),
            _ => self.fitter.see(seen),
        }
    }

    /// Whether the device can count the visible points of depth buffers: those of OpenGL cannot.
    pub fn can_record_demand(&self) -> bool {
        self.demand.is_supported
    }

    /// Waits for the GPU, so that the next [`Self::update`] knows what the last picture showed: for headless runs whose
    /// pictures have to be the same each time.
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Demand`] if the device was lost.
    pub fn wait_for_demand(&mut self) -> Result<(), SunShadowsError> {
        let seen = self.demand.pass.as_mut().map_or(Ok(None), DemandPass::wait)?;
        if let Some(seen) = seen {
            self.see(seen);
        }
        Ok(())
    }
}

/// Proves that no map of a set has a hole, for a frame that it was made for.
fn prove_set(
    frame: &SunFrame<'_>,
    fitter: &ShadowFitter,
    maps: &[FittedMap],
) -> Result<CoverageProof, SunShadowsError> {
    let mut storage = vec![DVec2::ZERO; frame.input().scratch()];
    let (technique, mut proof) = (fitter.technique(), Err(SunShadowsError::NoFrame));
    for (fitted, read) in fitter.fitted().iter().zip(maps) {
        // A map that waits is read as it was drawn. Shaders round positions relative to the frame's origin.
        let FittedMap { projection, bias, .. } = read.relative_to(frame.origin);
        let map = FittedMap { projection, bias, ..*fitted };
        let query = CoverageQuery::of_map(&map, technique, technique.reach_in(&map.projection))
            .with_normal_offset(map.bias.normal_offset);
        let found = prove(&frame.input(), &map.projection, &query, &mut Scratch::new(&mut storage))?;
        if !found.is_proven() {
            return Ok(found);
        }
        proof = Ok(found);
    }
    proof
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
