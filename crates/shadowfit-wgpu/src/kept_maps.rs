//! Shadow maps of which is kept what stands still: the drawing half of [`SunShadows`](crate::SunShadows), for engines
//! that fit their maps by themselves.

mod passes;
mod updates;

use shadowfit::choice::MapOrder;
use shadowfit::glam::DVec3;
use shadowfit::{Aabb, CasterVolume};

use crate::cache::{CacheFrame, CacheSettings, FramePlan, MapCache};
use crate::layers::Layers;
use crate::{Culling, MapFit, MapView, ShadowMap, ShadowMapDescriptor, ShadowMapError, SunFrame, UpdateSchedule};

pub use passes::{ShadowPass, ShadowPiece};
pub use updates::{MapUpdate, UpdateContent};

/// The shadow maps of one light, with what is kept of them from frame to frame.
#[derive(Debug)]
pub struct KeptMaps {
    /// Which maps may wait for another frame.
    pub schedule: UpdateSchedule,
    /// Whether what stands still is kept; else every map is drawn anew in every frame. Pictures are the same either way.
    pub keeps: bool,
    /// Which casters are drawn.
    pub culling: Culling,
    device: wgpu::Device,
    map: ShadowMap,
    layers: Layers,
    cache: MapCache,
    plan: FramePlan,
    /// What is read in this frame.
    maps: Vec<MapFit>,
    /// What the boxes of its plan are relative to, in world space, in metres.
    origin: DVec3,
}

impl KeptMaps {
    /// Makes the maps.
    ///
    /// # Errors
    ///
    /// As [`ShadowMap::new`].
    pub fn new(device: &wgpu::Device, descriptor: &ShadowMapDescriptor) -> Result<Self, ShadowMapError> {
        let map = ShadowMap::new(device, descriptor)?;
        let layers = Layers::new(device, &map);
        Ok(Self {
            schedule: UpdateSchedule::default(),
            keeps: true,
            culling: Culling::default(),
            device: device.clone(),
            map,
            layers,
            cache: MapCache::default(),
            plan: FramePlan::default(),
            maps: Vec::new(),
            origin: DVec3::ZERO,
        })
    }

    /// The maps on the GPU: layouts and states for the engine's pipelines.
    pub fn map(&self) -> &ShadowMap {
        &self.map
    }

    /// The maps that are read in this frame, those that wait as they were drawn.
    pub fn maps(&self) -> &[MapFit] {
        &self.maps
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

    /// Finds what must be drawn of a frame's maps, and writes the uniforms. [`Self::passes`] then has what is to be
    /// drawn in this frame; it counts as drawn from the next call on.
    ///
    /// Maps with a [`MapFit::anchor`] can be kept; others are drawn anew. [`MapFit::volume`] and [`MapFit::wrap`] are
    /// ignored. The frame's receivers are not looked at.
    ///
    /// # Errors
    ///
    /// As [`ShadowMap::prepare`], and [`ShadowMapError::View`] for views that make no sense. There is nothing to draw
    /// then, and the shaders read what they read before.
    pub fn update(
        &mut self,
        queue: &wgpu::Queue,
        frame: &SunFrame<'_>,
        fitted: &[MapFit],
    ) -> Result<(), ShadowMapError> {
        self.skip();
        let view = frame.map_view();
        crate::map_fit::check(self.map.descriptor(), &view, fitted)?;
        // 1. Which of them are drawn now, and which are read as they are.
        self.cache.settings = self.cache_settings();
        self.cache.schedule = self.schedule;
        let cached = CacheFrame {
            fitted,
            casters: &frame.casters,
            coarsest: MapOrder::new(self.map.descriptor().choice, fitted.iter().map(|map| &map.fit)).iter().last(),
            direction: frame.direction,
            origin: frame.origin,
        };
        let choice = self.cache.choose(&cached);
        if self.cache.is_split() && self.layers.split(&self.device, &self.map).is_err() {
            // Without memory for layers of their own, static casters are drawn with what moves.
            (self.keeps, self.cache) = (false, MapCache::default());
            return self.update(queue, frame, fitted);
        }
        // 2. The casters of each, and the passes.
        self.origin = frame.origin;
        self.maps.clone_from(&choice.maps);
        let volumes = if self.cache.needs_volumes(&choice) { self.volumes(frame, &view)? } else { Vec::new() };
        self.cache.plan(&choice, &cached, &volumes, &mut self.plan);
        // 3. What the shaders read.
        for (index, map) in self.maps.iter_mut().enumerate() {
            map.wrap = self.cache.wrap(index);
        }
        self.map.prepare(queue, &view, &self.maps)?;
        self.layers.prepare(&self.device, queue, &self.plan);
        Ok(())
    }

    /// Casters of each map for what is in view, relative to the maps' origin.
    fn volumes(&mut self, frame: &SunFrame<'_>, view: &MapView) -> Result<Vec<CasterVolume>, ShadowMapError> {
        for map in &mut self.maps {
            map.volume = match self.culling {
                Culling::Off => Some(CasterVolume::everywhere(map.fit.origin)),
                Culling::Swept | Culling::WholeMap => None,
            };
        }
        let descriptor = self.map.descriptor();
        if self.culling == Culling::Swept {
            MapFit::sweep(&mut self.maps, view, frame.views, descriptor).map_err(ShadowMapError::View)?;
        }
        let is_uncut = self.culling == Culling::Off || descriptor.depth_clamp;
        Ok(self.maps.iter().map(|map| crate::map::volume(map, is_uncut)).collect())
    }

    fn cache_settings(&self) -> CacheSettings {
        let descriptor = self.map.descriptor();
        CacheSettings {
            // Colours are drawn with a depth buffer that is not stored.
            keeps: self.keeps && descriptor.format.is_depth(),
            can_mend: Layers::can_mend(&self.device),
            culling: self.culling,
            depth_clamp: descriptor.depth_clamp,
            choice: descriptor.choice,
            layer: descriptor.resolution.into(),
        }
    }
}
