//! The formats of the textures of ambient occlusion.

/// Positions in view space, with 1 in w where there is a surface. Half floats would be too coarse: 1/64 m at
/// 20 m.
pub(super) const POSITION_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// Unit normals in view space.
pub(super) const NORMAL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Occlusion. Blending is supported, to take the maximum over two radii.
pub(super) const OCCLUSION_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;

/// Returns one of these formats that an adapter cannot draw to, such as in a browser without
/// `EXT_color_buffer_float`.
pub(crate) fn missing_format(adapter: &wgpu::Adapter) -> Option<wgpu::TextureFormat> {
    let can_draw_to = |format: &wgpu::TextureFormat| {
        let usages = adapter.get_texture_format_features(*format).allowed_usages;
        usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING)
    };
    [POSITION_FORMAT, NORMAL_FORMAT, OCCLUSION_FORMAT].into_iter().find(|format| !can_draw_to(format))
}
