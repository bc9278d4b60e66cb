//! How a sun's maps are made, and made again for another technique, size, format or texture.

use shadowfit::{ShadowFitter, Technique};

use super::other_set::OtherSet;
use super::{Demand, SunShadows, SunShadowsError};
use crate::cached_maps::CachedMaps;
use crate::{MapTexture, ShadowMapDescriptor, ShadowMapError};

impl SunShadows {
    /// The shadows of a sun by a technique: [`Technique::default`] or one of [`PRESETS`](shadowfit::PRESETS), changed
    /// as the engine likes.
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Map`] if the maps cannot be made on this device: their size, number, format or filter, or too
    /// little memory.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, technique: &Technique) -> Result<Self, SunShadowsError> {
        Self::with_first_binding(device, queue, technique, 0)
    }

    /// As [`Self::new`], with bind groups that begin at another binding than 0: for a bind group that the look-up
    /// shares with another sun's or with the engine's own resources
    /// ([`ShadowMap::receiver_entries`](crate::ShadowMap::receiver_entries)). Other techniques keep the binding.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn with_first_binding(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        technique: &Technique,
        first_binding: u32,
    ) -> Result<Self, SunShadowsError> {
        let descriptor = ShadowMapDescriptor { first_binding, ..ShadowMapDescriptor::from(technique) };
        let mut sun = Self::from_descriptor(device, queue, &descriptor)?;
        sun.fitter.set_technique(technique);
        Ok(sun)
    }

    /// The shadows of a sun with maps of any size and format, for maps that are fitted by other code
    /// ([`Self::prepare`]). [`Self::fitter`] has [`Technique::default`] until it gets another.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn from_descriptor(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        descriptor: &ShadowMapDescriptor,
    ) -> Result<Self, ShadowMapError> {
        Self::made(device, queue, descriptor, None)
    }

    /// The shadows of a sun whose maps lie in a texture that the engine made and owns, so that a frame graph counts their
    /// memory, or two suns share an array. [`ShadowMapDescriptor::texture`] says what the texture must be like;
    /// `first_binding` is as in [`Self::with_first_binding`].
    ///
    /// Nothing but the layers from [`MapTexture::base_layer`] on is cleared, written or read, as many as the technique
    /// has maps, and twice as many where [light steps](Self::set_light_steps) fade. They are kept from frame to frame:
    /// where something else writes them in between, [`Self::set_caching`] has to be off. [`Self::set_technique`] stays in
    /// the texture.
    ///
    /// # Errors
    ///
    /// As [`Self::new`], and [`ShadowMapError::Texture`] if the texture cannot hold the maps.
    pub fn in_texture(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        technique: &Technique,
        first_binding: u32,
        texture: &MapTexture,
    ) -> Result<Self, SunShadowsError> {
        let descriptor = ShadowMapDescriptor { first_binding, ..ShadowMapDescriptor::from(technique) };
        let mut sun = Self::made(device, queue, &descriptor, Some(texture))?;
        sun.fitter.set_technique(technique);
        Ok(sun)
    }

    fn made(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        descriptor: &ShadowMapDescriptor,
        texture: Option<&MapTexture>,
    ) -> Result<Self, ShadowMapError> {
        let descriptor = ShadowMapDescriptor { cross_fades: false, ..*descriptor };
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            fitter: ShadowFitter::default(),
            maps: CachedMaps::new(device, &descriptor, texture)?,
            steps: None,
            other: None,
            demand: Demand::new(device),
            last: None,
        })
    }

    /// Goes on with another technique, and returns whether the maps were recreated: the engine must then recreate its
    /// pipelines and its WGSL too, and bind groups of its own. On an error everything stays as it is.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn set_technique(&mut self, technique: &Technique) -> Result<bool, SunShadowsError> {
        let first_binding = self.map().descriptor().first_binding;
        let descriptor = ShadowMapDescriptor { first_binding, ..ShadowMapDescriptor::from(technique) };
        let is_new = self.set_descriptor(&descriptor)?;
        self.fitter.set_technique(technique);
        self.other.iter_mut().for_each(|other| other.fitter.set_technique(technique));
        Ok(is_new)
    }

    /// As [`Self::set_technique`], in another texture of the engine's: for a technique whose maps the present one cannot
    /// hold. They are always recreated.
    ///
    /// # Errors
    ///
    /// As [`Self::in_texture`].
    pub fn set_technique_in(&mut self, technique: &Technique, texture: &MapTexture) -> Result<(), SunShadowsError> {
        let first_binding = self.map().descriptor().first_binding;
        let cross_fades = self.map().descriptor().cross_fades;
        let descriptor = ShadowMapDescriptor { cross_fades, first_binding, ..ShadowMapDescriptor::from(technique) };
        self.recreate(&descriptor, Some(texture))?;
        self.fitter.set_technique(technique);
        self.other.iter_mut().for_each(|other| other.fitter.set_technique(technique));
        Ok(())
    }

    /// Goes on with maps of another size or format, and returns whether they were recreated, as [`Self::set_technique`]
    /// does.
    ///
    /// # Errors
    ///
    /// As [`Self::from_descriptor`].
    pub fn set_descriptor(&mut self, descriptor: &ShadowMapDescriptor) -> Result<bool, ShadowMapError> {
        let cross_fades = self.map().descriptor().cross_fades;
        self.replace_maps(&ShadowMapDescriptor { cross_fades, ..*descriptor })
    }

    /// Makes maps of another descriptor, unless it is that of the present ones.
    pub(super) fn replace_maps(&mut self, descriptor: &ShadowMapDescriptor) -> Result<bool, ShadowMapError> {
        let now = *self.map().descriptor();
        if *descriptor == now {
            return Ok(false);
        }
        descriptor.check(&self.device)?;
        // Where shadows end is told to the shaders in each frame.
        if (ShadowMapDescriptor { fade: now.fade, ..*descriptor }) == now {
            self.each_set(|maps| maps.set_fade(descriptor.fade));
            return Ok(false);
        }
        let texture = self.map().texture().cloned();
        self.recreate(descriptor, texture.as_ref())?;
        Ok(true)
    }

    /// Makes the maps again.
    fn recreate(
        &mut self,
        descriptor: &ShadowMapDescriptor,
        texture: Option<&MapTexture>,
    ) -> Result<(), ShadowMapError> {
        let mut maps = CachedMaps::new(&self.device, descriptor, texture)?;
        (maps.schedule, maps.caching, maps.culling) = (self.maps.schedule, self.maps.caching, self.maps.culling);
        self.other = OtherSet::of(&maps);
        self.maps = maps;
        self.end_step();
        Ok(())
    }
}
