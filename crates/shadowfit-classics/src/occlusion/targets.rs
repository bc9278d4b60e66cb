//! The textures of ambient occlusion, all of the picture's size with one sample per pixel.

use shadowfit_render::bindings;
use shadowfit_render::passes::DEPTH_FORMAT;

use super::formats::{NORMAL_FORMAT, OCCLUSION_FORMAT, POSITION_FORMAT};
use super::pipelines::Layouts;

/// Textures of one size, and the bind groups for reading them.
#[derive(Debug)]
pub(super) struct Targets {
    pub(super) size: [u32; 2],
    has_backs: bool,
    pub(super) positions: wgpu::TextureView,
    pub(super) normals: wgpu::TextureView,
    /// Positions of back faces, or of front faces if back faces are not drawn.
    pub(super) backs: wgpu::TextureView,
    pub(super) depth: wgpu::TextureView,
    raw: wgpu::Texture,
    pub(super) raw_view: wgpu::TextureView,
    blurred: wgpu::Texture,
    pub(super) blurred_view: wgpu::TextureView,
    /// Positions, normals and back faces.
    pub(super) surfaces: wgpu::BindGroup,
    /// Positions, normals and occlusion.
    pub(super) blurring: wgpu::BindGroup,
    /// Occlusion, raw and blurred.
    shown: [wgpu::BindGroup; 2],
}

impl Targets {
    pub(super) fn new(device: &wgpu::Device, layouts: &Layouts, size: [u32; 2], has_backs: bool) -> Self {
        let texture = |label, format| {
            let usage = wgpu::TextureUsages::RENDER_ATTACHMENT
                | wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_SRC
                | if format == OCCLUSION_FORMAT { wgpu::TextureUsages::COPY_DST } else { wgpu::TextureUsages::empty() };
            bindings::plain_texture(device, label, size, format, usage)
        };
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let positions = view(&texture("positions", POSITION_FORMAT));
        let normals = view(&texture("normals", NORMAL_FORMAT));
        let backs = if has_backs { view(&texture("back faces", POSITION_FORMAT)) } else { positions.clone() };
        let depth = view(&texture("depth", DEPTH_FORMAT));
        let [raw, blurred] = ["occlusion", "blurred occlusion"].map(|label| texture(label, OCCLUSION_FORMAT));
        let [raw_view, blurred_view] = [view(&raw), view(&blurred)];
        let read = |third: &wgpu::TextureView| {
            let resources = [&positions, &normals, third].map(wgpu::BindingResource::TextureView);
            bindings::group(device, "view-space surfaces", &layouts.buffers, &resources)
        };
        let [surfaces, blurring] = [read(&backs), read(&raw_view)];
        let shown = [&raw_view, &blurred_view].map(|view| {
            bindings::group(device, "occlusion", &layouts.shown, &[wgpu::BindingResource::TextureView(view)])
        });
        Self {
            size,
            has_backs,
            positions,
            normals,
            backs,
            depth,
            raw,
            raw_view,
            blurred,
            blurred_view,
            surfaces,
            blurring,
            shown,
        }
    }

    /// Returns whether the textures have this size, and back faces if needed.
    pub(super) fn serves(&self, size: [u32; 2], has_backs: bool) -> bool {
        self.size == size && self.has_backs == has_backs
    }

    pub(super) fn occlusion(&self, is_blurred: bool) -> &wgpu::Texture {
        if is_blurred { &self.blurred } else { &self.raw }
    }

    pub(super) fn shown(&self, is_blurred: bool) -> &wgpu::BindGroup {
        &self.shown[usize::from(is_blurred)]
    }
}
