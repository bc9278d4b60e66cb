//! Shadow maps whose unchanged regions are kept: the drawing half of [`SunShadows`](crate::SunShadows).

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

/// Shadow maps of one light, and the regions that are kept from frame to frame.
#[derive(Debug)]
pub(crate) struct CachedMaps {
    /// Maps that may wait for another frame.
    pub(crate) schedule: UpdateSchedule,
    /// Whether static casters are kept. If not, every map is redrawn in every frame, with identical results
    /// up to rounding.
    pub(crate) caching: bool,
    /// Which casters are drawn.
    pub(crate) culling: Culling,
    /// Whether the look-up reads these maps as its present set. If not, they fade out or are not read yet,
    /// and do not change the present set's uniform.
    pub(crate) is_present: bool,
    device: wgpu::Device,
    map: ShadowMap,
    layers: Layers,
    cache: MapCache,
    /// Number of times that each map was drawn.
    #[cfg(feature = "rays")]
    drawn: [u64; crate::MAX_MAPS],
    /// View of the look-ups.
    view: Option<MapView>,
    /// Casters whose movement is missing in maps that wait.
    #[cfg(feature = "rays")]
    stale: Vec<StaleMap>,
    /// Whether the light is off.
    is_off: bool,
}

impl CachedMaps {
    /// Creates the maps, in the engine's texture if there is one.
    ///
    /// # Errors
    ///
    /// The errors of [`ShadowMap::in_texture`].
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

    /// Creates the second set of maps for a descriptor that cross-fades, with the same settings. The look-up
    /// does not read it yet.
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

    /// Changes the view depths between which shadows fade, in metres.
    pub(crate) fn set_fade(&mut self, fade: [f32; 2]) {
        self.map.set_fade(fade);
    }

    /// Returns the maps on the GPU, with layouts and states for the engine's pipelines.
    pub(crate) fn map(&self) -> &ShadowMap {
        &self.map
    }

    /// Returns the maps that shaders read in this frame. For a map that waits, this is the map that was drawn
    /// last.
    pub(crate) fn maps(&self) -> &[FittedMap] {
        &self.cache.plan().maps
    }

    /// Returns the view of the look-ups; `None` before the first frame, and while the light is off.
    pub(crate) fn view(&self) -> Option<&MapView> {
        self.view.as_ref()
    }

    /// Returns the number of times that each map was drawn. It changes whenever the map's content changes.
    #[cfg(feature = "rays")]
    pub(crate) fn drawn(&self) -> &[u64; crate::MAX_MAPS] {
        &self.drawn
    }

    /// Returns the casters whose movement is missing in maps that wait for another frame.
    #[cfg(feature = "rays")]
    pub(crate) fn stale(&self) -> &[StaleMap] {
        &self.stale
    }

    /// Redraws the static casters in a box in the next frame. Call it if a caster changed its shape but not
    /// its bounding box. The box is in metres, relative to `origin` in world space.
    pub(crate) fn invalidate(&mut self, aabb: &Aabb, origin: DVec3) {
        self.cache.invalidate(aabb, origin);
    }

    /// Redraws all maps in the next frame, such as after a frame whose passes were not submitted.
    pub(crate) fn invalidate_all(&mut self) {
        self.cache.invalidate_all();
    }

    /// Returns whether the light is off.
    pub(crate) fn is_off(&self) -> bool {
        self.is_off
    }

    /// Makes all factors 0 until the next [`Self::update`]. The content of the layers is kept.
    pub(crate) fn turn_off(&mut self, queue: &wgpu::Queue) {
        self.cache.turn_off();
        self.view = None;
        self.map.turn_off(queue);
        self.is_off = true;
    }

    /// Finds the regions of a frame's maps that must be drawn, and writes the uniforms for shaders that read
    /// the maps from `view`. Afterwards [`Self::pass`] returns the passes of this frame. They count as drawn
    /// from the next call on.
    ///
    /// Maps with a [grid position](FittedMap::grid_position) can be kept. Others are redrawn in each frame.
    pub(crate) fn update(
        &mut self,
        queue: &wgpu::Queue,
        frame: &CacheFrame<'_>,
        view: &MapView,
    ) -> Result<(), ShadowMapError> {
        self.skip();
        super::view::check(self.map.descriptor(), view, frame.maps)?;
        // 1. Plan the passes.
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
        // 2. Write the uniforms of the shaders.
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

    /// Lets the look-up blend another set of maps into this one, after [`Self::update`] of both. `share` is
    /// the share of this set.
    pub(crate) fn fade_from(&self, queue: &wgpu::Queue, before: &Self, view: &MapView, share: f32) {
        self.map.fade_from(queue, &before.map, before.maps(), view, share);
    }

    /// Returns the rectangles that are drawn in this frame, in the order of the passes. Some may overlap.
    pub(crate) fn updates(&self) -> Vec<UpdatedRect> {
        self.cache.updates()
    }

    /// Returns whether the static casters of a map are kept for later frames. `map` is its index.
    pub(crate) fn is_cached(&self, map: usize) -> bool {
        self.cache.is_kept(map)
    }

    /// Returns the maps that contain each caster, by its number; see [`MapCache::maps_by_caster`].
    pub(crate) fn maps_by_caster(&self, casters: &Casters<'_>) -> Vec<u8> {
        self.cache.maps_by_caster(casters)
    }

    /// Writes the uniforms for another image with the same maps, relative to another origin or with view
    /// depths from another eye. The maps stay as they were drawn. Do not draw their passes after this call.
    /// It does nothing while the light is off.
    ///
    /// # Errors
    ///
    /// [`ShadowMapError::Forward`] for a direction that is not of unit length. On an error, no uniform is
    /// written.
    pub(crate) fn set_view(&mut self, queue: &wgpu::Queue, view: &MapView) -> Result<(), ShadowMapError> {
        if self.is_off { Ok(()) } else { self.write_uniforms(queue, view) }
    }

    fn cache_settings(&self) -> CacheSettings {
        let descriptor = self.map.descriptor();
        CacheSettings {
            // Colour formats are drawn with a depth buffer that is not stored, so that they cannot be kept.
            caching: self.caching && descriptor.format.is_depth(),
            culling: self.culling,
            schedule: self.schedule,
            depth_clamp: descriptor.depth_clamp,
            reading: descriptor.reading(),
            layer: descriptor.resolution.into(),
        }
    }
}
