//! Shadow maps that keep the parts where nothing moved: the drawing half of [`SunShadows`](crate::SunShadows).

mod culling;
mod passes;
mod updates;

use shadowfit::culling::caster_volumes;
use shadowfit::glam::DVec3;
use shadowfit::selection::MapOrder;
use shadowfit::{Aabb, CasterVolume, FitError, FittedMap};

#[cfg(feature = "rays")]
use crate::cache::StaleMap;
use crate::cache::{CacheFrame, CacheSettings, FramePlan, MapCache};
use crate::maps::shadow_map::stored_casters;
use crate::maps::static_layers::Layers;
use crate::{
    Culling, MAX_MAPS, MapTexture, MapView, ShadowMap, ShadowMapDescriptor, ShadowMapError, SunFrame, UpdateSchedule,
};

pub use passes::{ShadowPass, ShadowPiece};
pub use updates::{MapUpdate, UpdateContent};

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
    plan: FramePlan,
    /// The maps that are read in this frame.
    maps: Vec<FittedMap>,
    /// Their casters that can shadow something in view, where the passes depend on that; otherwise all that they can
    /// store.
    volumes: Vec<CasterVolume>,
    /// Origin of the boxes in the plan, in world space, in metres.
    origin: DVec3,
    /// How often each map was drawn.
    #[cfg(feature = "rays")]
    drawn: [u64; MAX_MAPS],
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
            plan: FramePlan::default(),
            maps: Vec::new(),
            volumes: Vec::new(),
            origin: DVec3::ZERO,
            #[cfg(feature = "rays")]
            drawn: [0; MAX_MAPS],
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
        &self.maps
    }

    /// From where the look-up reads them; `None` before the first frame, and while the light gives nothing.
    pub(crate) fn view(&self) -> Option<&MapView> {
        self.view.as_ref()
    }

    /// How often each map was drawn: a number that changes with what it holds.
    #[cfg(feature = "rays")]
    pub(crate) fn drawn(&self) -> &[u64; MAX_MAPS] {
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
        self.cache.reset();
    }

    /// Whether the light gives nothing.
    pub(crate) fn is_off(&self) -> bool {
        self.is_off
    }

    /// Makes all factors 0 until the next [`Self::update`]. What the layers hold stays.
    pub(crate) fn turn_off(&mut self, queue: &wgpu::Queue) {
        self.skip();
        self.maps.clear();
        self.volumes.clear();
        self.view = None;
        self.map.turn_off(queue);
        self.is_off = true;
    }

    /// Finds which parts of a frame's maps must be drawn, and writes the uniforms. [`Self::passes`] then has the passes
    /// of this frame; they count as drawn from the next call on.
    ///
    /// Maps with an [anchor](FittedMap::anchor) can be kept; others are redrawn in each frame.
    pub(crate) fn update(
        &mut self,
        queue: &wgpu::Queue,
        frame: &SunFrame<'_>,
        fitted: &[FittedMap],
    ) -> Result<(), ShadowMapError> {
        self.skip();
        let view = frame.map_view();
        crate::maps::view::check(self.map.descriptor(), &view, fitted)?;
        // 1. Which of them are drawn now, and which are read as they are.
        self.cache.settings = self.cache_settings();
        self.cache.schedule = self.schedule;
        let cached = CacheFrame {
            fitted,
            casters: &frame.casters,
            standing: frame.standing,
            coarsest: MapOrder::new(self.map.descriptor().selection, fitted.iter().map(|map| &map.projection))
                .iter()
                .last(),
            direction: frame.direction,
            origin: frame.origin,
        };
        self.cache.take(&cached);
        let is_due = self.due(frame, &view).map_err(ShadowMapError::View)?;
        let choice = self.cache.choose(&cached, is_due);
        if self.cache.is_split() && self.layers.split(&self.device, &self.map).is_err() {
            // Without memory for separate layers, static casters are drawn together with moving ones.
            (self.caching, self.cache) = (false, MapCache::default());
            return self.update(queue, frame, fitted);
        }
        #[cfg(feature = "rays")]
        self.cache.find_stale(&choice, &cached, &mut self.stale);
        // 2. The casters of each, and the passes.
        self.origin = frame.origin;
        self.maps.clone_from(&choice.maps);
        let by_view = self.cache.needs_volumes(&choice);
        self.find_volumes(frame, &view, by_view).map_err(ShadowMapError::View)?;
        let volumes = if by_view { &self.volumes[..] } else { &[] };
        self.cache.plan(&choice, &cached, volumes, &mut self.plan);
        #[cfg(feature = "rays")]
        self.plan.passes.iter().for_each(|pass| self.drawn[pass.map] += 1);
        // 3. The uniforms of the shaders.
        for (index, map) in self.maps.iter_mut().enumerate() {
            map.wrap = self.cache.wrap(index);
        }
        self.write_uniforms(queue, &view)?;
        self.is_off = false;
        self.layers.prepare(&self.device, queue, &self.plan);
        Ok(())
    }

    /// Which maps must be drawn now, whatever the schedule: those that show a static caster that is gone, in view.
    fn due(&self, frame: &SunFrame<'_>, view: &MapView) -> Result<[bool; MAX_MAPS], FitError> {
        let mut is_due = [false; MAX_MAPS];
        if self.schedule == UpdateSchedule::EveryFrame {
            return Ok(is_due);
        }
        for (index, drawn) in self.cache.outdated() {
            // As if it were the only map: which others are read beside it is not known yet.
            let mut volume = [CasterVolume::everywhere(drawn.projection.origin)];
            caster_volumes(
                core::slice::from_ref(drawn),
                &self.map.descriptor().reading(),
                &view.reader(),
                frame.views,
                &mut volume,
            )?;
            is_due[index] = self.cache.shows_gone(index, &volume[0]);
        }
        Ok(is_due)
    }

    fn write_uniforms(&mut self, queue: &wgpu::Queue, view: &MapView) -> Result<(), ShadowMapError> {
        self.view = Some(*view);
        if self.is_present {
            self.map.prepare(queue, view, &self.maps)
        } else {
            self.map.prepare_casters(queue, view, &self.maps)
        }
    }

    /// Lets the look-up mix another set of maps into these, after [`Self::update`] of both. `share`: that of these.
    pub(crate) fn fade_from(&self, queue: &wgpu::Queue, before: &Self, view: &MapView, share: f32) {
        self.map.fade_from(queue, (&before.map, &before.maps), view, share);
    }

    /// Finds the casters of each map, relative to its origin: those that can shadow something in view, or all that it
    /// can store.
    fn find_volumes(&mut self, frame: &SunFrame<'_>, view: &MapView, by_view: bool) -> Result<(), FitError> {
        let descriptor = self.map.descriptor();
        let clamps = descriptor.depth_clamp;
        self.volumes.clear();
        if by_view && self.culling == Culling::Off {
            self.volumes.extend(self.maps.iter().map(|map| CasterVolume::everywhere(map.projection.origin)));
            return Ok(());
        }
        let uncut = self.culling == Culling::Off || clamps;
        self.volumes.extend(self.maps.iter().map(|map| stored_casters(&map.projection, uncut)));
        if by_view && self.culling == Culling::Swept {
            caster_volumes(&self.maps, &descriptor.reading(), &view.reader(), frame.views, &mut self.volumes)?;
            if !clamps {
                for (volume, map) in self.volumes.iter_mut().zip(&self.maps) {
                    *volume = volume.cut_at_near_plane(&map.projection);
                }
            }
        }
        Ok(())
    }

    fn cache_settings(&self) -> CacheSettings {
        let descriptor = self.map.descriptor();
        CacheSettings {
            // Colours are drawn with a depth buffer that is not stored.
            caching: self.caching && descriptor.format.is_depth(),
            culling: self.culling,
            depth_clamp: descriptor.depth_clamp,
            by_coverage: descriptor.selection.is_by_coverage(),
            layer: descriptor.resolution.into(),
        }
    }
}
