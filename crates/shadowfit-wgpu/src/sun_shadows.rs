//! The shadows of one sun, from camera and boxes to bind group: the one object that an engine needs.
//!
//! ```text
//!   update(frame) ──▶ fits ──▶ cache ──▶ passes: the engine draws casters by number
//!        ▲                                              │
//!        └── record_need(depth buffer) ◀── its own passes with receiver_group() and the WGSL
//! ```

mod error;
mod frame;
mod passes;

use shadowfit::bias::Reach;
use shadowfit::choice::MapOrder;
use shadowfit::glam::{DVec2, DVec3, Mat4};
use shadowfit::need::NeedGrid;
use shadowfit::settings::MapChoice;
use shadowfit::verify::{Certificate, CoverageQuery, verify};
use shadowfit::{Aabb, CasterVolume, DepthConvention, FittedMap, FittedMaps, MapFitter, Technique, ViewFrustum, Workspace};

use crate::cache::{CacheFrame, CacheSettings, FramePlan, MapCache};
use crate::layers::Layers;
use crate::need::{NeedPass, NeedPassError, NeedView, SeenNeed};
use crate::{MapFit, MapView, ShadowMap, ShadowMapDescriptor, UpdateSchedule};

pub use error::SunShadowsError;
pub use frame::SunFrame;
pub use passes::{ShadowPass, ShadowPiece};

/// Views that a fit works with: held maps are fitted to the views of two frames ahead as well.
const VIEWS_AHEAD: usize = 2;

/// The shadows of one directional light: its maps, what is kept of them, and what the last frames showed.
///
/// One for each sun. It knows no scene, starts no thread and keeps no global state.
#[derive(Debug)]
pub struct SunShadows {
    device: wgpu::Device,
    queue: wgpu::Queue,
    technique: Technique,
    /// Which maps may wait for another frame.
    pub schedule: UpdateSchedule,
    /// Whether what stands still is kept from frame to frame. Pictures are the same either way.
    pub keeps: bool,
    fitter: MapFitter,
    fitted: FittedMaps,
    storage: Vec<DVec2>,
    map: ShadowMap,
    layers: Layers,
    cache: MapCache,
    plan: FramePlan,
    /// What is read in this frame.
    shown: Vec<FittedMap>,
    maps: Vec<MapFit>,
    need: Need,
    last: Option<LastFrame>,
}

/// What the depth buffers of earlier frames showed.
#[derive(Debug, Default)]
struct Need {
    pass: Option<NeedPass>,
    samples: u32,
    /// Whether the device cannot count.
    is_unsupported: bool,
    seen: Option<SeenNeed>,
}

/// What [`SunShadows::record_need`] takes from the frame.
#[derive(Clone, Copy, Debug)]
struct LastFrame {
    view: ViewFrustum,
    direction: shadowfit::glam::Vec3,
}

impl SunShadows {
    /// The shadows of a sun by a technique: [`Technique::default`], or one of
    /// [`PRESETS`](shadowfit::PRESETS), with what the engine wants otherwise.
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Map`] if the maps cannot be made on this device: their size, number, format or filter, or too
    /// little memory.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, technique: &Technique) -> Result<Self, SunShadowsError> {
        Self::with_descriptor(device, queue, technique, &ShadowMapDescriptor::from(technique))
    }

    /// As [`Self::new`], with maps of a descriptor that differs from the technique's in what only the GPU needs.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn with_descriptor(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        technique: &Technique,
        descriptor: &ShadowMapDescriptor,
    ) -> Result<Self, SunShadowsError> {
        let map = ShadowMap::new(device, descriptor)?;
        let layers = Layers::new(device, &map);
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            technique: *technique,
            schedule: UpdateSchedule::default(),
            keeps: true,
            fitter: MapFitter::new(),
            fitted: FittedMaps::default(),
            storage: Vec::new(),
            map,
            layers,
            cache: MapCache::default(),
            plan: FramePlan::default(),
            shown: Vec::new(),
            maps: Vec::new(),
            need: Need::default(),
            last: None,
        })
    }

    /// The technique.
    pub fn technique(&self) -> &Technique {
        &self.technique
    }

    /// The maps on the GPU: layouts and states for the engine's pipelines.
    pub fn map(&self) -> &ShadowMap {
        &self.map
    }

    /// The maps that are read in this frame, those that wait as they were drawn.
    pub fn fitted(&self) -> &[FittedMap] {
        &self.shown
    }

    /// The bind group that [`receiver_wgsl`](crate::receiver_wgsl) reads.
    pub fn receiver_group(&self) -> &wgpu::BindGroup {
        self.map.receiver_group()
    }

    /// Goes on with another technique, and returns whether the engine's pipelines and WGSL must be made anew, and the
    /// receiver's bind group be bound anew. On an error everything stays as it is.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn set_technique(&mut self, technique: &Technique) -> Result<bool, SunShadowsError> {
        let descriptor = ShadowMapDescriptor { ..ShadowMapDescriptor::from(technique) };
        let is_new = descriptor != *self.map.descriptor();
        if is_new {
            let (schedule, keeps) = (self.schedule, self.keeps);
            let need = core::mem::take(&mut self.need);
            let anew = Self::with_descriptor(&self.device, &self.queue, technique, &descriptor);
            match anew {
                Ok(anew) => *self = Self { schedule, keeps, need, ..anew },
                Err(error) => {
                    self.need = need;
                    return Err(error);
                }
            }
        }
        self.technique = *technique;
        Ok(is_new)
    }

    /// Forgets all earlier frames: after a camera cut, or when a new level begins.
    pub fn reset(&mut self) {
        self.fitter.reset();
        self.cache.reset();
        self.need.seen = None;
        if let Some(pass) = &mut self.need.pass {
            pass.reset();
        }
    }

    /// Has static casters in a box, in metres relative to an origin in world space, drawn anew in the next frame: where
    /// one changed its shape, and not its box.
    pub fn invalidate(&mut self, aabb: &Aabb, origin: DVec3) {
        self.cache.invalidate(aabb, origin);
    }

    /// Has all maps drawn anew in the next frame, such as after a frame whose passes were not submitted.
    pub fn invalidate_all(&mut self) {
        self.cache.reset();
    }

    /// Fits the maps to a frame, finds what must be drawn of them, and writes the uniforms. [`Self::passes`] then has
    /// what is to be drawn in this frame; it counts as drawn from the next call on.
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Fit`] for views, light and boxes that make no sense; [`SunShadowsError::Map`] for maps that the
    /// layers cannot hold; [`SunShadowsError::Need`] if the device was lost. There is nothing to draw then, and the maps
    /// are those of the frame before.
    pub fn update(&mut self, queue: &wgpu::Queue, frame: &SunFrame<'_>) -> Result<(), SunShadowsError> {
        self.plan = FramePlan::default();
        // 1. The maps, by what earlier frames showed.
        self.fit(frame)?;
        // 2. Which of them are drawn now, and which are read as they are.
        self.cache.settings = self.cache_settings();
        self.cache.schedule = self.schedule;
        let cached = CacheFrame {
            fitted: &self.fitted,
            casters: &frame.casters,
            coarsest: self.coarsest(),
            direction: frame.direction,
            origin: frame.origin,
        };
        let choice = self.cache.choose(&cached);
        if self.cache.is_split() && self.layers.split(&self.device, &self.map).is_err() {
            // Without memory for layers of their own, static casters are drawn with what moves.
            self.keeps = false;
            self.cache.reset();
            return self.update(queue, frame);
        }
        // 3. The casters of each, and the passes.
        self.shown.clone_from(&choice.maps);
        self.maps.clear();
        self.maps.extend(choice.maps.iter().map(MapFit::from));
        let view = frame.map_view();
        MapFit::sweep(&mut self.maps, &view, frame.views, self.map.descriptor())?;
        let clamps = self.map.descriptor().depth_clamp;
        let volumes: Vec<CasterVolume> = self.maps.iter().map(|map| crate::map::volume(map, clamps)).collect();
        self.cache.plan(&choice, &cached, &volumes, &mut self.plan);
        // 4. What the shaders read.
        for (index, map) in self.maps.iter_mut().enumerate() {
            map.wrap = self.cache.wrap(index);
        }
        self.map.prepare(queue, &view, &self.maps)?;
        self.layers.prepare(&self.device, queue, &self.plan);
        self.last = frame.views.first().map(|view| LastFrame { view: *view, direction: frame.direction });
        Ok(())
    }

    fn fit(&mut self, frame: &SunFrame<'_>) -> Result<(), SunShadowsError> {
        if let Some(pass) = &mut self.need.pass {
            self.need.seen = pass.take()?.or(self.need.seen.take());
        }
        let grids: Vec<NeedGrid<'_>> = self.need.seen.iter().map(SeenNeed::grid).collect();
        let mut input = frame.input();
        input.need = &grids;
        input.histogram = self.need.seen.as_ref().and_then(SeenNeed::histogram);
        let boxes = frame.boxes();
        self.storage.resize(Workspace::required(boxes, frame.views.len() + VIEWS_AHEAD), DVec2::ZERO);
        let workspace = &mut Workspace::new(&mut self.storage);
        self.fitter.fit_into(&input, &self.technique, workspace, &mut self.fitted)?;
        Ok(())
    }

    fn cache_settings(&self) -> CacheSettings {
        let descriptor = self.map.descriptor();
        CacheSettings {
            // Colours are drawn with a depth buffer that is not stored.
            keeps: self.keeps && descriptor.format.is_depth(),
            can_mend: Layers::can_mend(&self.device),
            depth_clamp: descriptor.depth_clamp,
            by_coverage: self.technique.map_choice() == MapChoice::Coverage,
            layer: descriptor.resolution.into(),
        }
    }

    /// The map that holds what the others leave out.
    fn coarsest(&self) -> Option<usize> {
        MapOrder::new(self.technique.map_choice(), self.fitted.iter().map(|map| &map.fit)).iter().last()
    }

    /// Proves that no map of this frame has a hole, as of the frame that was given to [`Self::update`]: for debug
    /// assertions. The first map that fails decides.
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Fit`] as [`verify`].
    pub fn verify(&mut self, frame: &SunFrame<'_>) -> Result<Certificate, SunShadowsError> {
        let input = frame.input();
        let by_coverage = self.technique.map_choice() == MapChoice::Coverage;
        let coarsest = self.coarsest();
        let mut certificate = None;
        for (index, map) in self.shown.iter().enumerate() {
            let reach: Reach = self.technique.softness.reach_in(self.technique.filter, &map.fit);
            let query =
                CoverageQuery::of_map(map, &self.technique, reach).with_normal_offset(map.bias.normal_offset);
            let found = verify(&input, &map.fit, &query, &mut Workspace::new(&mut self.storage))?;
            if !found.is_proven() {
                return Ok(found);
            }
            if certificate.is_none() || !by_coverage || coarsest == Some(index) {
                certificate = Some(found);
            }
        }
        certificate.ok_or(SunShadowsError::NoFrame)
    }

    /// Counts what a picture shows, for the fits of the next frames: after the pass that fills the depth buffer. `depth`
    /// is a view of the depth aspect of the whole texture, which fills the picture, is stored, and has the usage
    /// `TEXTURE_BINDING`; `clip_from_world` and `convention` are what it was drawn with, from positions relative to the
    /// eye, [`ViewFrustum::origin`] of the first view.
    ///
    /// Returns whether it was recorded: never on devices that cannot count, such as OpenGL's, where maps are placed by the
    /// boxes, nor while many pictures are still on their way.
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::NoFrame`] before the first [`Self::update`]; [`SunShadowsError::Need`] for the matrix, the
    /// texture, and a device out of memory.
    pub fn record_need(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
        clip_from_world: Mat4,
        convention: DepthConvention,
    ) -> Result<bool, SunShadowsError> {
        let Some(LastFrame { view, direction }) = self.last else { return Err(SunShadowsError::NoFrame) };
        let texture = depth.texture();
        let Some(pass) = self.need.pass(&self.device, &self.queue, texture.sample_count())? else { return Ok(false) };
        let seen = NeedView {
            frustum: view,
            clip_from_world,
            depth: convention,
            direction,
            up: self.technique.fit.up,
            max_distance: self.technique.fit.max_distance,
            rectangle: [0, 0, texture.width(), texture.height()],
        };
        Ok(pass.record(encoder, depth, &seen, None)?)
    }

    /// Waits for the GPU, so that the next [`Self::update`] knows what the last picture showed: for headless runs whose
    /// pictures have to be the same each time.
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Need`] if the device was lost.
    pub fn wait_for_need(&mut self) -> Result<(), SunShadowsError> {
        if let Some(pass) = &mut self.need.pass {
            self.need.seen = pass.wait()?.or(self.need.seen.take());
        }
        Ok(())
    }
}

impl Need {
    /// The pass for depth buffers of so many samples; `None` where the device cannot count.
    fn pass(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        samples: u32,
    ) -> Result<Option<&mut NeedPass>, NeedPassError> {
        if self.is_unsupported {
            return Ok(None);
        }
        if self.pass.is_none() || self.samples != samples {
            match NeedPass::new(device, queue, samples) {
                Ok(pass) => (self.pass, self.samples) = (Some(pass), samples),
                Err(NeedPassError::Unsupported(_)) => {
                    self.is_unsupported = true;
                    return Ok(None);
                }
                Err(error) => return Err(error),
            }
        }
        Ok(self.pass.as_mut())
    }
}
