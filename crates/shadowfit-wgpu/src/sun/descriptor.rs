//! Creation of a sun's shadows, and their recreation for another technique, size, format or texture.

use shadowfit::{ShadowFitter, Technique};

use super::other_set::OtherSet;
use super::{Demand, SunShadows};
use crate::maps::cached_maps::CachedMaps;
use crate::{MapTexture, ShadowMapDescriptor, ShadowMapError};

/// Description of a sun's shadows, for [`SunShadows::new`].
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
    /// Technique of the shadows: [`Technique::default`] or one of [`PRESETS`](shadowfit::PRESETS), with any
    /// changes.
    pub technique: Technique,
    /// First binding of the caster's and the receiver's bind group. Use a number other than 0 if the look-up
    /// shares its bind group with another sun or with the engine's own resources
    /// ([`ShadowMap::receiver_entries`](crate::ShadowMap::receiver_entries)).
    pub first_binding: u32,
    /// Texture of the engine that holds the maps, such as a frame graph's texture or an array that two suns
    /// share. `None` creates textures. [`ShadowMapDescriptor::texture`] describes the required texture.
    ///
    /// Only the layers from [`MapTexture::base_layer`] on are cleared, written and read: one per map, or two
    /// per map if [light steps](SunShadows::set_light_steps) fade. Maps are kept from frame to frame. If
    /// other code writes these layers in between, turn [caching](SunShadows::set_caching) off.
    pub texture: Option<MapTexture>,
    /// Size, number, format and filter of maps that other code fits ([`SunShadows::prepare`]). `None` takes
    /// the values of the technique. Two of its fields are ignored: `first_binding`, in favour of the field
    /// above, and `cross_fades`, which the light steps decide.
    pub maps: Option<ShadowMapDescriptor>,
}

impl SunShadowsDescriptor {
    /// Returns the description of the maps.
    fn maps(&self, cross_fades: bool) -> ShadowMapDescriptor {
        let maps = self.maps.unwrap_or_else(|| ShadowMapDescriptor::from(&self.technique));
        ShadowMapDescriptor { first_binding: self.first_binding, cross_fades, ..maps }
    }
}

/// Describes maps of a technique in new textures, with bindings from 0 on.
impl From<Technique> for SunShadowsDescriptor {
    fn from(technique: Technique) -> Self {
        Self { technique, ..Self::default() }
    }
}

/// # Creating and changing the maps
impl SunShadows {
    /// Creates the shadows of a sun.
    ///
    /// # Errors
    ///
    /// [`ShadowMapError`] if the device does not support the size, number, format or filter of the maps, is
    /// out of memory, or if the given texture cannot hold the maps.
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

    /// Changes the technique, with the same texture and bindings. Returns whether the maps were recreated.
    /// The engine must then recreate its pipelines, its WGSL and its own bind groups. On an error nothing
    /// changes.
    ///
    /// # Errors
    ///
    /// The errors of [`Self::new`].
    pub fn set_technique(&mut self, technique: &Technique) -> Result<bool, ShadowMapError> {
        self.set_descriptor(&SunShadowsDescriptor {
            technique: *technique,
            first_binding: self.map().descriptor().first_binding,
            texture: self.map().texture().cloned(),
            maps: None,
        })
    }

    /// Changes the description, and keeps the visible demand of earlier frames. Returns whether the maps were
    /// recreated, as [`Self::set_technique`] does. Another texture always recreates them. On an error nothing
    /// changes.
    ///
    /// # Errors
    ///
    /// The errors of [`Self::new`].
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

    /// Recreates the maps if their descriptor changes. Returns whether it did.
    pub(super) fn replace_maps(&mut self, descriptor: &ShadowMapDescriptor) -> Result<bool, ShadowMapError> {
        let now = *self.map().descriptor();
        if *descriptor == now {
            return Ok(false);
        }
        descriptor.check(&self.device)?;
        // The fade is in a uniform that is written in each frame, so that it needs no new maps.
        if (ShadowMapDescriptor { fade: now.fade, ..*descriptor }) == now {
            self.each_set(|maps| maps.set_fade(descriptor.fade));
            return Ok(false);
        }
        let texture = self.map().texture().cloned();
        self.recreate(descriptor, texture.as_ref())?;
        Ok(true)
    }

    /// Recreates the maps.
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
