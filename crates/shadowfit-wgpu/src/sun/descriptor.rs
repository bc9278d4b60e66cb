//! How a sun's shadows are made, and made again for another technique, size, format or texture.

use shadowfit::{ShadowFitter, Technique};

use super::other_set::OtherSet;
use super::{Demand, SunShadows};
use crate::maps::cached_maps::CachedMaps;
use crate::{MapTexture, ShadowMapDescriptor, ShadowMapError};

/// The description of a sun's shadows, for [`SunShadows::new`].
///
/// ```
/// use shadowfit::Technique;
/// use shadowfit_wgpu::SunShadowsDescriptor;
///
/// let eight = Technique::preset("windows-8").unwrap();
/// let descriptor = SunShadowsDescriptor { first_binding: 3, ..eight.into() };
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SunShadowsDescriptor {
    /// Look of the shadows: [`Technique::default`] or one of [`PRESETS`](shadowfit::PRESETS), changed as the engine likes.
    pub technique: Technique,
    /// First binding of the caster's and the receiver's bind group. Another number than 0 is for a bind group that the
    /// look-up shares with another sun's or with the engine's own resources
    /// ([`ShadowMap::receiver_entries`](crate::ShadowMap::receiver_entries)).
    pub first_binding: u32,
    /// Texture of the engine's that holds the maps, so that a frame graph counts their memory, or two suns share an array.
    /// `None` makes textures. [`ShadowMapDescriptor::texture`] describes the texture that is needed.
    ///
    /// Only the layers from [`MapTexture::base_layer`] on are cleared, written and read: one for each map, and two for each
    /// map where [light steps](SunShadows::set_light_steps) fade. Maps are kept from frame to frame. If something else
    /// writes these layers in between, turn [caching](SunShadows::set_caching) off.
    pub texture: Option<MapTexture>,
    /// Size, number, format and filter of maps that other code fits ([`SunShadows::prepare`]). `None` takes those of the
    /// technique. Its `first_binding` and `cross_fades` are replaced: the first by the field of that name above, the second
    /// by the light steps.
    pub maps: Option<ShadowMapDescriptor>,
}

impl SunShadowsDescriptor {
    /// The description of the maps, by whether they fade.
    fn maps(&self, cross_fades: bool) -> ShadowMapDescriptor {
        let maps = self.maps.unwrap_or_else(|| ShadowMapDescriptor::from(&self.technique));
        ShadowMapDescriptor { first_binding: self.first_binding, cross_fades, ..maps }
    }
}

/// Maps of a technique in textures of their own, with bindings from 0 on.
impl From<Technique> for SunShadowsDescriptor {
    fn from(technique: Technique) -> Self {
        Self { technique, ..Self::default() }
    }
}

/// # Making and changing the maps
impl SunShadows {
    /// Makes the shadows of a sun.
    ///
    /// # Errors
    ///
    /// [`ShadowMapError`] if the maps cannot be made on this device: their size, number, format or filter, too little
    /// memory, or a texture that cannot hold them.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        descriptor: &SunShadowsDescriptor,
    ) -> Result<Self, ShadowMapError> {
        let maps = CachedMaps::new(device, &descriptor.maps(false), descriptor.texture.as_ref())?;
        let mut fitter = ShadowFitter::default();
        fitter.set_technique(&descriptor.technique);
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            fitter,
            maps,
            steps: None,
            other: None,
            demand: Demand::new(device),
            last: None,
        })
    }

    /// Goes on with another technique, with the same texture and bindings. Returns whether the maps were recreated: the
    /// engine must then recreate its pipelines, its WGSL and bind groups of its own. On an error everything stays as it is.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn set_technique(&mut self, technique: &Technique) -> Result<bool, ShadowMapError> {
        self.set_descriptor(&SunShadowsDescriptor {
            technique: *technique,
            first_binding: self.map().descriptor().first_binding,
            texture: self.map().texture().cloned(),
            maps: None,
        })
    }

    /// Goes on with another description, and keeps what earlier frames showed. Returns whether the maps were recreated, as
    /// [`Self::set_technique`] does. Another texture always recreates them. On an error everything stays as it is.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn set_descriptor(&mut self, descriptor: &SunShadowsDescriptor) -> Result<bool, ShadowMapError> {
        let maps = descriptor.maps(self.map().descriptor().cross_fades);
        let is_new = if descriptor.texture.as_ref() == self.map().texture() {
            self.replace_maps(&maps)?
        } else {
            self.recreate(&maps, descriptor.texture.as_ref())?;
            true
        };
        let technique = &descriptor.technique;
        self.fitter.set_technique(technique);
        self.other.iter_mut().for_each(|other| other.fitter.set_technique(technique));
        Ok(is_new)
    }

    /// Makes maps of another descriptor, unless it is that of the present ones.
    pub(super) fn replace_maps(&mut self, descriptor: &ShadowMapDescriptor) -> Result<bool, ShadowMapError> {
        let now = *self.map().descriptor();
        if *descriptor == now {
            return Ok(false);
        }
        descriptor.check(&self.device)?;
        // Shaders read the end of shadows from a uniform that is written in each frame.
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
