//! Shadow maps that keep the parts where nothing moved: the drawing half of [`SunShadows`](crate::SunShadows).

mod passes;

#[cfg(feature = "rays")]
use shadowfit::cache::StaleMap;
use shadowfit::cache::{CacheFrame, CacheSettings, MapCache};
use shadowfit::glam::DVec3;
use shadowfit::{Aabb, FittedMap};

use super::static_layers::Layers;
use crate::{Casters, Culling, MapTexture, MapView, ShadowMap, ShadowMapDescriptor, ShadowMapError, UpdateSchedule};
use shadowfit::cache::UpdatedRect;

pub use passes::{DrawRegion, ShadowPass};

/// The shadow maps of one light, and the parts of them that are kept from frame to frame.
#[derive(Debug)]
pub(crate) struct CachedMaps {
    /// Which maps may wait for another frame.
    pub(crate) schedule: UpdateSchedule,
    /// Whether static casters are kept; without that every map is redrawn in every frame. Pictures are the same either
    /// way, up to rounding.
    pub(crate) caching: bool,
    /// Which casters are drawn.
    pub(crate) culling: Culling,
    /// Whether the look-up reads these maps first. Maps that are faded out, or not read yet, leave it as it is.
    pub(crate) is_present: bool,
    device: wgpu::Device,
    map: ShadowMap,
    layers: Layers,
    cache: MapCache,
    /// How often each map was drawn.
    #[cfg(feature = "rays")]
    drawn: [u64; crate::MAX_MAPS],
    /// From where the look-up reads them.
    view: Option<MapView>,
    /// What maps that wait show wrongly.
    #[cfg(feature = "rays")]
    stale: Vec<StaleMap>,
    /// Whether the light gives nothing.
    is_off: bool,
}

impl CachedMaps {
    /// Makes the maps: in a texture of the engine's, if there is one.
    ///
    /// # Errors
    ///
    /// As [`ShadowMap::in_texture`].
    pub(crate) fn new(
        device: &wgpu::Device,
        descriptor: &ShadowMapDescriptor,
        texture: Option<&MapTexture>,
    ) -> Result<Self, ShadowMapError> {
        let map = match texture {
            Some(texture) => ShadowMap::in_texture(device, descriptor, texture),
            None => ShadowMap::new(device, descriptor),
        }?;
        Ok(Self::of(device, map))
    }

    /// The second set of maps of a descriptor that cross-fades, drawn by the same rules. The look-up does not read it.
    pub(crate) fn second(&self) -> Self {
        let (schedule, caching, culling) = (self.schedule, self.caching, self.culling);
        Self { schedule, caching, culling, is_present: false, ..Self::of(&self.device, self.map.second(&self.device)) }
    }

    fn of(device: &wgpu::Device, map: ShadowMap) -> Self {
        Self {
            schedule: UpdateSchedule::default(),
            caching: true,
            culling: Culling::default(),
            is_present: true,
            device: device.clone(),
            layers: Layers::new(device, &map),
            map,
            cache: MapCache::default(),
            #[cfg(feature = "rays")]
            drawn: [0; crate::MAX_MAPS],
            view: None,
            #[cfg(feature = "rays")]
            stale: Vec::new(),
            is_off: false,
        }
    }

    /// Moves the view depths between which shadows fade, in metres.
    pub(crate) fn set_fade(&mut self, fade: [f32; 2]) {
        self.map.set_fade(fade);
    }

    /// The maps on the GPU: layouts and states for the engine's pipelines.
    pub(crate) fn map(&self) -> &ShadowMap {
        &self.map
    }

    /// The maps that are read in this frame. A map that waits is the one that was drawn last.
    pub(crate) fn maps(&self) -> &[FittedMap] {
        &self.cache.plan().maps
    }

    /// From where the look-up reads them; `None` before the first frame, and while the light gives nothing.
    pub(crate) fn view(&self) -> Option<&MapView> {
        self.view.as_ref()
    }

    /// How often each map was drawn: a number that changes with what it holds.
    #[cfg(feature = "rays")]
    pub(crate) fn drawn(&self) -> &[u64; crate::MAX_MAPS] {
        &self.drawn
    }

    /// What maps that wait for another frame show wrongly.
    #[cfg(feature = "rays")]
    pub(crate) fn stale(&self) -> &[StaleMap] {
        &self.stale
    }

    /// Redraws static casters in a box in the next frame: for one that changed its shape and not its box. The box is in
    /// metres, relative to an origin in world space.
    pub(crate) fn invalidate(&mut self, aabb: &Aabb, origin: DVec3) {
        self.cache.invalidate(aabb, origin);
    }

    /// Redraws all maps in the next frame, such as after a frame whose passes were not submitted.
    pub(crate) fn invalidate_all(&mut self) {
        self.cache.invalidate_all();
    }

    /// Whether the light gives nothing.
    pub(crate) fn is_off(&self) -> bool {
        self.is_off
    }

    /// Makes all factors 0 until the next [`Self::update`]. What the layers hold stays.
    pub(crate) fn turn_off(&mut self, queue: &wgpu::Queue) {
        self.cache.turn_off();
        self.view = None;
        self.map.turn_off(queue);
        self.is_off = true;
    }

    /// Finds which parts of a frame's maps must be drawn, and writes the uniforms for shaders that read them from `view`.
    /// [`Self::pass`] then returns the passes of this frame. They count as drawn from the next call on.
    ///
    /// Maps with a [grid position](FittedMap::grid_position) can be kept; others are redrawn in each frame.
    pub(crate) fn update(
        &mut self,
        queue: &wgpu::Queue,
        frame: &CacheFrame<'_>,
        view: &MapView,
    ) -> Result<(), ShadowMapError> {
        self.skip();
        super::view::check(self.map.descriptor(), view, frame.maps)?;
        // 1. The passes.
        self.cache.settings = self.cache_settings();
        self.cache.update(frame).map_err(ShadowMapError::View)?;
        if self.cache.has_static_layers() && self.layers.split(&self.device, &self.map).is_err() {
            // Without memory for separate layers, static casters are drawn together with moving ones.
            (self.caching, self.cache) = (false, MapCache::default());
            return self.update(queue, frame, view);
        }
        #[cfg(feature = "rays")]
        self.cache.find_stale(&frame.casters, &mut self.stale);
        #[cfg(feature = "rays")]
        self.cache.plan().passes.iter().for_each(|pass| self.drawn[pass.map] += 1);
        // 2. The uniforms of the shaders.
        self.write_uniforms(queue, view)?;
        self.is_off = false;
        self.layers.prepare(&self.device, queue, self.cache.plan());
        Ok(())
    }

    fn write_uniforms(&mut self, queue: &wgpu::Queue, view: &MapView) -> Result<(), ShadowMapError> {
        self.view = Some(*view);
        let maps = &self.cache.plan().maps;
        if self.is_present { self.map.prepare(queue, view, maps) } else { self.map.prepare_casters(queue, view, maps) }
    }

    /// Lets the look-up mix another set of maps into these, after [`Self::update`] of both. `share`: that of these.
    pub(crate) fn fade_from(&self, queue: &wgpu::Queue, before: &Self, view: &MapView, share: f32) {
        self.map.fade_from(queue, &before.map, before.maps(), view, share);
    }

    /// The rectangles that are drawn in this frame, in the order of the passes. Some may overlap.
    pub(crate) fn updates(&self) -> Vec<UpdatedRect> {
        self.cache.updates()
    }

    /// Whether the static casters of a map, by its number, are kept for later frames.
    pub(crate) fn is_cached(&self, map: usize) -> bool {
        self.cache.is_kept(map)
    }

    /// Which maps hold each caster, by its number; see [`MapCache::maps_by_caster`].
    pub(crate) fn maps_by_caster(&self, casters: &Casters<'_>) -> Vec<u8> {
        self.cache.maps_by_caster(casters)
    }

    /// Writes the uniforms for another picture with the same maps, whose positions are relative to another origin or
    /// whose view depths are counted from another eye. The maps stay as they were drawn: their passes must not be drawn
    /// after this. A light that is off gives nothing from anywhere.
    ///
    /// # Errors
    ///
    /// [`ShadowMapError::Forward`] for a direction that is not of unit length; nothing is written then.
    pub(crate) fn set_view(&mut self, queue: &wgpu::Queue, view: &MapView) -> Result<(), ShadowMapError> {
        if self.is_off { Ok(()) } else { self.write_uniforms(queue, view) }
    }

    fn cache_settings(&self) -> CacheSettings {
        let descriptor = self.map.descriptor();
        CacheSettings {
            // Colours are drawn with a depth buffer that is not stored.
            caching: self.caching && descriptor.format.is_depth(),
            culling: self.culling,
            schedule: self.schedule,
            depth_clamp: descriptor.depth_clamp,
            reading: descriptor.reading(),
            layer: descriptor.resolution.into(),
        }
    }
}
