//! The shadows of one sun, from camera and boxes to bind group: the one object that an engine needs.
//!
//! ```text
//!   update(frame) ──▶ fits ──▶ what can be kept ──▶ passes: the engine draws casters by number
//!        ▲                                                        │
//!        └──── record_need(depth buffer) ◀──── its own passes with receiver_group() and the WGSL
//! ```

mod error;

use shadowfit::glam::{DVec2, DVec3, Mat4, Vec3};
use shadowfit::need::NeedGrid;
use shadowfit::verify::{Certificate, CoverageQuery, verify};
use shadowfit::{Aabb, DepthConvention, FittedMap, FittedMaps, MapFitter, Technique, ViewFrustum, Workspace};

use crate::need::{NeedPass, NeedPassError, NeedView, SeenNeed};
use crate::{
    Culling, KeptMaps, MapFit, ShadowMap, ShadowMapDescriptor, ShadowPass, ShadowPiece, SunFrame, UpdateSchedule,
};

pub use error::SunShadowsError;

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
    fitter: MapFitter,
    fitted: FittedMaps,
    storage: Vec<DVec2>,
    maps: KeptMaps,
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

/// What [`SunShadows::record_need`] takes from a frame that was fitted.
#[derive(Clone, Copy, Debug)]
struct LastFrame {
    view: ViewFrustum,
    direction: Vec3,
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
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            technique: *technique,
            fitter: MapFitter::new(),
            fitted: FittedMaps::default(),
            storage: Vec::new(),
            maps: KeptMaps::new(device, &ShadowMapDescriptor::from(technique))?,
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
        self.maps.map()
    }

    /// The maps that were fitted to this frame.
    pub fn fitted(&self) -> &FittedMaps {
        &self.fitted
    }

    /// The drawing half: what is kept, and the passes.
    pub fn kept(&self) -> &KeptMaps {
        &self.maps
    }

    /// The bind group that [`receiver_wgsl`](crate::receiver_wgsl) reads.
    pub fn receiver_group(&self) -> &wgpu::BindGroup {
        self.maps.map().receiver_group()
    }

    /// Has maps wait for other frames; see [`UpdateSchedule`].
    pub fn set_schedule(&mut self, schedule: UpdateSchedule) {
        self.maps.schedule = schedule;
    }

    /// Whether what stands still is kept from frame to frame, as it is by default. Pictures are the same either way.
    pub fn set_keeps(&mut self, keeps: bool) {
        self.maps.keeps = keeps;
    }

    /// Which casters are drawn; see [`Culling`]. Pictures are the same either way.
    pub fn set_culling(&mut self, culling: Culling) {
        self.maps.culling = culling;
    }

    /// Goes on with another technique, and returns whether the maps were made anew: then the engine's pipelines and its
    /// WGSL must be made anew too. On an error everything stays as it is.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn set_technique(&mut self, technique: &Technique) -> Result<bool, SunShadowsError> {
        let descriptor = ShadowMapDescriptor::from(technique);
        let is_new = descriptor != *self.map().descriptor();
        if is_new {
            let mut maps = KeptMaps::new(&self.device, &descriptor)?;
            (maps.schedule, maps.keeps, maps.culling) = (self.maps.schedule, self.maps.keeps, self.maps.culling);
            self.maps = maps;
        }
        self.technique = *technique;
        Ok(is_new)
    }

    /// Forgets all earlier frames: after a camera cut, or when a new level begins.
    pub fn reset(&mut self) {
        self.fitter.reset();
        self.maps.invalidate_all();
        self.need.seen = None;
        if let Some(pass) = &mut self.need.pass {
            pass.reset();
        }
    }

    /// Has static casters in a box, in metres relative to an origin in world space, drawn anew in the next frame: where
    /// one changed its shape, and not its box.
    pub fn invalidate(&mut self, aabb: &Aabb, origin: DVec3) {
        self.maps.invalidate(aabb, origin);
    }

    /// Has all maps drawn anew in the next frame, such as after a frame whose passes were not submitted.
    pub fn invalidate_all(&mut self) {
        self.maps.invalidate_all();
    }

    /// Fits the maps to a frame, finds what must be drawn of them, and writes the uniforms. [`Self::passes`] then has
    /// what is to be drawn in this frame; it counts as drawn from the next call on.
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Fit`] for views, light and boxes that make no sense; [`SunShadowsError::Map`] for maps that the
    /// layers cannot hold; [`SunShadowsError::Need`] if the device was lost. There is nothing to draw then, and the
    /// shaders read what they read before.
    pub fn update(&mut self, queue: &wgpu::Queue, frame: &SunFrame<'_>) -> Result<(), SunShadowsError> {
        self.maps.skip();
        self.last = None;
        frame.check()?;
        if let Some(pass) = &mut self.need.pass {
            self.need.seen = pass.take()?.or(self.need.seen.take());
        }
        self.fit(frame)?;
        let maps: Vec<MapFit> = self.fitted.iter().map(MapFit::from).collect();
        self.maps.update(queue, frame, &maps)?;
        self.last = frame.views.first().map(|view| LastFrame { view: *view, direction: frame.direction });
        Ok(())
    }

    fn fit(&mut self, frame: &SunFrame<'_>) -> Result<(), SunShadowsError> {
        let seen = self.need.seen.as_ref();
        let grids: Vec<NeedGrid<'_>> = seen.map(SeenNeed::grid).into_iter().collect();
        let mut input = frame.input();
        (input.need, input.histogram) = (&grids, seen.map(SeenNeed::histogram));
        self.storage.resize(Workspace::required(frame.boxes(), frame.views.len() + VIEWS_AHEAD), DVec2::ZERO);
        self.fitter.fit_into(&input, &self.technique, &mut Workspace::new(&mut self.storage), &mut self.fitted)?;
        Ok(())
    }

    /// The passes of this frame, in the order in which they must be drawn.
    pub fn passes(&self) -> impl ExactSizeIterator<Item = ShadowPass<'_>> {
        self.maps.passes()
    }

    /// Records all passes of this frame; see [`KeptMaps::render`].
    pub fn render(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        group: u32,
        draw: impl FnMut(&mut wgpu::RenderPass<'_>, &ShadowPiece<'_>),
    ) {
        self.maps.render(encoder, group, draw);
    }

    /// Opens a pass, for engines that schedule passes themselves; see [`KeptMaps::begin_pass`].
    pub fn begin_pass<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        pass: &ShadowPass<'_>,
        group: u32,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'encoder> {
        self.maps.begin_pass(encoder, pass, group, timestamps)
    }

    /// Proves that no map has a hole, for the frame that was given to [`Self::update`]: for debug assertions. The first map
    /// that fails decides. It counts in that shaders round positions relative to [`SunFrame::origin`].
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Fit`] as [`verify`]; [`SunShadowsError::NoFrame`] before the first frame.
    pub fn verify(&mut self, frame: &SunFrame<'_>) -> Result<Certificate, SunShadowsError> {
        let input = frame.input();
        let mut certificate = Err(SunShadowsError::NoFrame);
        for (fitted, read) in self.fitted.iter().zip(self.maps.maps()) {
            // A map that waits is read as it was drawn. Shaders round positions relative to the frame's origin.
            let map = FittedMap { fit: read.fit.relative_to(frame.origin), bias: read.bias, ..*fitted };
            let reach = self.technique.softness.reach_in(self.technique.filter, &map.fit);
            let query = CoverageQuery::of_map(&map, &self.technique, reach).with_normal_offset(map.bias.normal_offset);
            let found = verify(&input, &map.fit, &query, &mut Workspace::new(&mut self.storage))?;
            if !found.is_proven() {
                return Ok(found);
            }
            certificate = Ok(found);
        }
        certificate
    }

    /// Counts what a picture shows, for the fits of the next frames: after the pass that fills the depth buffer. `depth`
    /// is a view of the depth aspect of the whole texture, which fills the picture, is stored, and has the usage
    /// `TEXTURE_BINDING`; `clip_from_world` and `convention` are what it was drawn with, from positions relative to the
    /// eye, [`ViewFrustum::origin`] of the first view.
    ///
    /// Returns whether it was recorded: never on devices that cannot count, such as OpenGL's, where maps are placed by the
    /// boxes; nor for a frame that [`Self::update`] refused, nor while many pictures are still on their way.
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Need`] for the matrix, the texture, and a device out of memory.
    pub fn record_need(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
        clip_from_world: Mat4,
        convention: DepthConvention,
    ) -> Result<bool, SunShadowsError> {
        let Some(LastFrame { view, direction }) = self.last else { return Ok(false) };
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
