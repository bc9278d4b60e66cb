//! Bind groups and their layouts with consecutive binding numbers, and the buffers and textures for them.

/// Binding of a whole uniform buffer.
pub const UNIFORM: wgpu::BindingType = buffer(wgpu::BufferBindingType::Uniform);

/// Returns the binding of a whole buffer.
pub const fn buffer(ty: wgpu::BufferBindingType) -> wgpu::BindingType {
    wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None }
}

/// Returns the binding of a whole storage buffer.
pub const fn storage(read_only: bool) -> wgpu::BindingType {
    buffer(wgpu::BufferBindingType::Storage { read_only })
}

/// Returns the binding of a two-dimensional texture that shaders read.
pub const fn texture(sample_type: wgpu::TextureSampleType, multisampled: bool) -> wgpu::BindingType {
    wgpu::BindingType::Texture { sample_type, view_dimension: wgpu::TextureViewDimension::D2, multisampled }
}

/// Returns the binding of an array of two-dimensional textures that shaders read.
pub const fn texture_array(sample_type: wgpu::TextureSampleType) -> wgpu::BindingType {
    let view_dimension = wgpu::TextureViewDimension::D2Array;
    wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false }
}

/// Returns the binding of a two-dimensional texture that shaders only write.
pub const fn written_texture(format: wgpu::TextureFormat) -> wgpu::BindingType {
    let (access, view_dimension) = (wgpu::StorageTextureAccess::WriteOnly, wgpu::TextureViewDimension::D2);
    wgpu::BindingType::StorageTexture { access, format, view_dimension }
}

/// Returns the entries of a layout with consecutive bindings from `first` on, visible to these stages.
pub fn layout_entries(
    first: u32,
    visibility: wgpu::ShaderStages,
    types: &[wgpu::BindingType],
) -> Vec<wgpu::BindGroupLayoutEntry> {
    let entry = |(number, ty): (u32, &wgpu::BindingType)| wgpu::BindGroupLayoutEntry {
        binding: first.saturating_add(number),
        visibility,
        ty: *ty,
        count: None,
    };
    (0..).zip(types).map(entry).collect()
}

/// Creates a layout with consecutive bindings from 0 on, visible to these stages.
pub fn layout(
    device: &wgpu::Device,
    label: &str,
    visibility: wgpu::ShaderStages,
    types: &[wgpu::BindingType],
) -> wgpu::BindGroupLayout {
    layout_from(device, label, 0, visibility, types)
}

/// Creates a layout with consecutive bindings from `first` on, visible to these stages.
pub fn layout_from(
    device: &wgpu::Device,
    label: &str,
    first: u32,
    visibility: wgpu::ShaderStages,
    types: &[wgpu::BindingType],
) -> wgpu::BindGroupLayout {
    let entries = layout_entries(first, visibility, types);
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
}

/// Returns the entries of a bind group with consecutive bindings from `first` on.
pub fn group_entries<'a>(first: u32, resources: &[wgpu::BindingResource<'a>]) -> Vec<wgpu::BindGroupEntry<'a>> {
    let entry = |(number, resource): (u32, &wgpu::BindingResource<'a>)| wgpu::BindGroupEntry {
        binding: first.saturating_add(number),
        resource: resource.clone(),
    };
    (0..).zip(resources).map(entry).collect()
}

/// Creates a bind group with consecutive bindings from 0 on.
pub fn group(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    resources: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    group_from(device, label, 0, layout, resources)
}

/// Creates a bind group with consecutive bindings from `first` on.
pub fn group_from(
    device: &wgpu::Device,
    label: &str,
    first: u32,
    layout: &wgpu::BindGroupLayout,
    resources: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    let entries = group_entries(first, resources);
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
}

/// Creates a uniform buffer for a value of type `T`.
pub fn uniform_buffer<T>(device: &wgpu::Device, label: &str) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: size_of::<T>() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// Creates a texture with one layer, one mip level and one sample. `size` is its width and height.
pub fn plain_texture(
    device: &wgpu::Device,
    label: &str,
    size: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}
