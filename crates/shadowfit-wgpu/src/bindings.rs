//! Bind groups and their layouts, whose bindings follow each other from a number on.

/// A uniform that is bound as a whole.
pub(crate) const UNIFORM: wgpu::BindingType = buffer(wgpu::BufferBindingType::Uniform);

/// A buffer that is bound as a whole.
pub(crate) const fn buffer(ty: wgpu::BufferBindingType) -> wgpu::BindingType {
    wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None }
}

/// A texture of depths.
pub(crate) const fn depths(view_dimension: wgpu::TextureViewDimension, multisampled: bool) -> wgpu::BindingType {
    wgpu::BindingType::Texture { sample_type: wgpu::TextureSampleType::Depth, view_dimension, multisampled }
}

/// Entries of a layout whose bindings are seen by these stages, and counted from `first`.
pub(crate) fn layout_entries(
    visibility: wgpu::ShaderStages,
    (first, types): (u32, &[wgpu::BindingType]),
) -> Vec<wgpu::BindGroupLayoutEntry> {
    let entry = |(binding, ty): (u32, &wgpu::BindingType)| wgpu::BindGroupLayoutEntry {
        binding: first.saturating_add(binding),
        visibility,
        ty: *ty,
        count: None,
    };
    (0..).zip(types).map(entry).collect()
}

/// A layout of such entries.
pub(crate) fn layout(
    device: &wgpu::Device,
    label: &str,
    visibility: wgpu::ShaderStages,
    types: (u32, &[wgpu::BindingType]),
) -> wgpu::BindGroupLayout {
    let entries = layout_entries(visibility, types);
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
}

/// Entries of a bind group of such a layout.
pub(crate) fn entries<'a>((first, resources): (u32, &[wgpu::BindingResource<'a>])) -> Vec<wgpu::BindGroupEntry<'a>> {
    let entry = |(binding, resource): (u32, &wgpu::BindingResource<'a>)| wgpu::BindGroupEntry {
        binding: first.saturating_add(binding),
        resource: resource.clone(),
    };
    (0..).zip(resources).map(entry).collect()
}

/// A bind group of such a layout.
pub(crate) fn group(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    resources: (u32, &[wgpu::BindingResource<'_>]),
) -> wgpu::BindGroup {
    let entries = entries(resources);
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
}
