//! The formats of the textures of ambient occlusion.

/// Positions in view space, 1 in w where there is a surface. Half floats would be too coarse: 1/64 m at 20 m.
pub(super) const POSITION_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// Unit normals in view space.
pub(super) const NORMAL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Occlusion; can be blended, which takes the greater of two radii.
pub(super) const OCCLUSION_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;

/// A format among these that an adapter cannot draw to, such as that of a browser without `EXT_color_buffer_float`.
pub(crate) fn missing_format(adapter: &wgpu::Adapter) -> Option<wgpu::TextureFormat> {
    let can_draw_to = |format: &wgpu::TextureFormat| {
        let usages = adapter.get_texture_format_features(*format).allowed_usages;
        usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING)
    };
    [POSITION_FORMAT, NORMAL_FORMAT, OCCLUSION_FORMAT].into_iter().find(|format| !can_draw_to(format))
}
