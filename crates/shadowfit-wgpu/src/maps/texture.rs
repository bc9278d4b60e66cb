//! Textures of the engine that contain maps, such as a frame graph's texture or one that two suns share.

use crate::{MapTextureError, ShadowMapDescriptor, ShadowMapError};

/// Layers of a texture that hold shadow maps, one per map, from [`Self::base_layer`] on.
///
/// ```no_run
/// # fn demo(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<(), shadowfit_wgpu::SunShadowsError> {
/// use shadowfit::Technique;
/// use shadowfit_wgpu::{MapTexture, ShadowMapDescriptor, SunShadows, SunShadowsDescriptor};
///
/// // Four maps of the sun and two of the moon, in one array.
/// let (by_day, by_night) = (Technique::default(), Technique::default().with_count(2));
/// let mut descriptor = ShadowMapDescriptor::from(&by_day).texture();
/// descriptor.size.depth_or_array_layers = 6;
/// let texture = device.create_texture(&descriptor);
/// let layers = |base_layer| Some(MapTexture { texture: texture.clone(), base_layer });
/// let in_layers = SunShadowsDescriptor { texture: layers(0), ..by_day.into() };
/// let sun = SunShadows::new(device, queue, &in_layers)?;
/// let behind_them = SunShadowsDescriptor { texture: layers(4), first_binding: 3, ..by_night.into() };
/// let moon = SunShadows::new(device, queue, &behind_them)?;
/// # Ok(()) }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MapTexture {
    /// Texture that [`ShadowMapDescriptor::texture`] describes.
    pub texture: wgpu::Texture,
    /// Layer of the first map. It must be 0 on OpenGL. The layers must not overlap with another sun's layers.
    pub base_layer: u32,
}

impl MapTexture {
    /// Creates a view of the first mip level of some maps.
    pub(crate) fn view(&self, dimension: wgpu::TextureViewDimension, first: u32, count: u32) -> wgpu::TextureView {
        self.texture.create_view(&wgpu::TextureViewDescriptor {
            label: Some("shadowfit map"),
            dimension: Some(dimension),
            mip_level_count: Some(1),
            base_array_layer: self.base_layer + first,
            array_layer_count: Some(count),
            ..Default::default()
        })
    }

    /// Refuses a texture that cannot hold the maps of a descriptor.
    pub(crate) fn check(&self, device: &wgpu::Device, descriptor: &ShadowMapDescriptor) -> Result<(), ShadowMapError> {
        let backend = device.adapter_info().backend;
        self.check_shape(descriptor)
            .and_then(|()| check_base_layer(self.base_layer, backend))
            .and_then(|()| self.check_array(backend))
            .map_err(ShadowMapError::Texture)
    }

    fn check_array(&self, backend: wgpu::Backend) -> Result<(), MapTextureError> {
        let layers = self.texture.depth_or_array_layers();
        let is_array = is_array([self.texture.width(), self.texture.height()], layers, backend);
        if is_array { Ok(()) } else { Err(MapTextureError::NoArray(layers)) }
    }

    fn check_shape(&self, descriptor: &ShadowMapDescriptor) -> Result<(), MapTextureError> {
        let Self { texture, base_layer } = self;
        let (base_layer, needed) = (*base_layer, descriptor.texture());
        let size = [texture.width(), texture.height()];
        let (layers, maps) = (texture.depth_or_array_layers(), descriptor.layers());
        let missing = needed.usage - texture.usage();
        if texture.dimension() != needed.dimension {
            return Err(MapTextureError::Dimension(texture.dimension()));
        }
        if texture.format() != needed.format {
            return Err(MapTextureError::Format { texture: texture.format(), maps: needed.format });
        }
        if size != descriptor.resolution {
            return Err(MapTextureError::Size { texture: size, maps: descriptor.resolution });
        }
        if texture.sample_count() != needed.sample_count {
            return Err(MapTextureError::Samples(texture.sample_count()));
        }
        if base_layer.checked_add(maps).is_none_or(|end| end > layers) {
            return Err(MapTextureError::Layers { texture: layers, base_layer, maps });
        }
        if missing.is_empty() { Ok(()) } else { Err(MapTextureError::Usages { missing }) }
    }
}

/// Returns whether shaders can read a texture of this size as an array. With wgpu's OpenGL backend, a single
/// layer becomes a plain texture, and square layers whose number is divisible by six become a cube.
pub(crate) fn is_array([width, height]: [u32; 2], layers: u32, backend: wgpu::Backend) -> bool {
    backend != wgpu::Backend::Gl || (layers > 1 && !(layers.is_multiple_of(6) && width == height))
}

/// Refuses a base layer that shaders cannot read.
fn check_base_layer(base_layer: u32, backend: wgpu::Backend) -> Result<(), MapTextureError> {
    if backend == wgpu::Backend::Gl && base_layer > 0 { Err(MapTextureError::BaseLayer(base_layer)) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opengl_has_arrays_of_all_layers_but_one_and_the_sixes_of_cubes() {
        for layers in 1..=16 {
            let is_square_array = !matches!(layers, 1 | 6 | 12);
            assert_eq!(is_array([512; 2], layers, wgpu::Backend::Gl), is_square_array, "{layers}");
            assert_eq!(is_array([512, 256], layers, wgpu::Backend::Gl), layers > 1, "{layers}");
            assert!(is_array([512; 2], layers, wgpu::Backend::Vulkan));
        }
    }

    #[test]
    fn opengl_reads_textures_from_their_first_layer_on_only() {
        assert_eq!(check_base_layer(0, wgpu::Backend::Gl), Ok(()));
        assert_eq!(check_base_layer(2, wgpu::Backend::Vulkan), Ok(()));
        let error = check_base_layer(2, wgpu::Backend::Gl).expect_err("another layer");
        assert_eq!(error, MapTextureError::BaseLayer(2));
        assert!(error.to_string().contains("layer 2") && error.to_string().contains("layer 0"), "{error}");
    }
}
