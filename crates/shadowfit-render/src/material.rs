//! Materials on the GPU: uniforms, textures with all mip levels, samplers, and one bind group each.

use std::borrow::Cow;
use std::collections::HashMap;

use shadowfit_scene::{Image, Material, Scene, Texture, Wrap};

use crate::attachment::cleared;
use crate::maker::{Maker, Shape};
use crate::uniform::MaterialUniform;
use crate::upload::Upload;
use crate::{Gpu, bindings, shaders};

/// Anisotropy of the texture filter, which keeps floors sharp at grazing angles. Not used on software
/// adapters: Mesa's visits every texel that a pixel covers, which takes seconds for a single edge-on sliver.
const ANISOTROPY: u16 = 8;

/// Debug label of the objects that create texture levels.
const LEVELS: &str = "texture levels";

/// Bindings of a filtered colour texture and its sampler.
const COLORS: wgpu::BindingType = bindings::texture(wgpu::TextureSampleType::Float { filterable: true }, false);
const SAMPLER: wgpu::BindingType = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);

/// Creates the layout of a material's bind group, the same in the shaded and the shadow pass.
pub fn material_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let types = [bindings::UNIFORM, COLORS, SAMPLER, COLORS, SAMPLER];
    bindings::layout(device, "material", wgpu::ShaderStages::FRAGMENT, &types)
}

/// Creates the bind group of every material of a scene, with textures of at most `side` texels per side.
pub(crate) fn upload_materials(
    upload: &Upload<'_>,
    layout: &wgpu::BindGroupLayout,
    scene: &Scene,
    side: u32,
) -> Vec<wgpu::BindGroup> {
    let mut uploader = Uploader::new(upload, scene, side);
    scene.materials.iter().map(|material| uploader.material(layout, material)).collect()
}

struct Uploader<'a> {
    upload: &'a Upload<'a>,
    scene: &'a Scene,
    /// Greatest side of a texture, in texels.
    side: u32,
    levels: LevelMaker,
    views: HashMap<(usize, bool), wgpu::TextureView>,
    white: wgpu::TextureView,
}

impl<'a> Uploader<'a> {
    fn new(upload: &'a Upload<'a>, scene: &'a Scene, side: u32) -> Self {
        let device = &upload.gpu.device;
        let side = side.min(device.limits().max_texture_dimension_2d);
        let levels = LevelMaker::new(device);
        let pixel = Image { name: String::new(), width: 1, height: 1, rgba: vec![255; 4] };
        // If there is no memory for a single pixel, the texture is never used.
        let white = upload_image(upload, &levels, &pixel, false, side).unwrap_or_else(|| single_pixel(device));
        Self { upload, scene, side, levels, views: HashMap::new(), white }
    }

    /// Returns the view of a texture's image; white if it is missing.
    fn view(&mut self, texture: Option<Texture>, srgb: bool) -> wgpu::TextureView {
        let Some((index, image)) = texture.and_then(|t| Some((t.image, self.scene.images.get(t.image)?))) else {
            return self.white.clone();
        };
        let (upload, levels, side, white) = (self.upload, &self.levels, self.side, &self.white);
        let view = || upload_image(upload, levels, image, srgb, side).unwrap_or_else(|| white.clone());
        self.views.entry((index, srgb)).or_insert_with(view).clone()
    }

    fn material(&mut self, layout: &wgpu::BindGroupLayout, material: &Material) -> wgpu::BindGroup {
        let Gpu { device, queue, .. } = self.upload.gpu;
        let uniform = bindings::uniform_buffer::<MaterialUniform>(device, "material");
        queue.write_buffer(&uniform, 0, bytemuck::bytes_of(&MaterialUniform::new(material)));
        let base = self.view(material.base_color_texture, true);
        let normal = self.view(material.normal_texture, false);
        let samplers = [material.base_color_texture, material.normal_texture].map(|t| sampler(self.upload.gpu, t));
        let resources = [
            uniform.as_entire_binding(),
            wgpu::BindingResource::TextureView(&base),
            wgpu::BindingResource::Sampler(&samplers[0]),
            wgpu::BindingResource::TextureView(&normal),
            wgpu::BindingResource::Sampler(&samplers[1]),
        ];
        bindings::group(device, &material.name, layout, &resources)
    }
}

fn sampler(gpu: &Gpu, texture: Option<Texture>) -> wgpu::Sampler {
    let wrap = texture.map_or([Wrap::Repeat; 2], |t| t.wrap).map(|wrap| match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
        Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
    });
    let nearest = texture.is_some_and(|t| t.nearest);
    // Anisotropy requires linear filters throughout.
    let anisotropy_clamp = if nearest || gpu.is_software() { 1 } else { ANISOTROPY };
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("material"),
        address_mode_u: wrap[0],
        address_mode_v: wrap[1],
        mag_filter: if nearest { wgpu::FilterMode::Nearest } else { wgpu::FilterMode::Linear },
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        anisotropy_clamp,
        ..Default::default()
    })
}

/// Uploads an image with all mip levels, halved until no side exceeds `side` texels. `None` without memory.
fn upload_image(
    upload: &Upload<'_>,
    levels: &LevelMaker,
    image: &Image,
    srgb: bool,
    side: u32,
) -> Option<wgpu::TextureView> {
    let image = &halved_to_fit(image, side);
    let format = if srgb { wgpu::TextureFormat::Rgba8UnormSrgb } else { wgpu::TextureFormat::Rgba8Unorm };
    let size = wgpu::Extent3d { width: image.width, height: image.height, depth_or_array_layers: 1 };
    let descriptor = wgpu::TextureDescriptor {
        label: Some(&image.name),
        size,
        mip_level_count: size.max_mips(wgpu::TextureDimension::D2),
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_DST
            | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    };
    let texture = upload.texture(&descriptor, &image.rgba)?;
    levels.fill(upload.gpu, &texture);
    Some(texture.create_view(&wgpu::TextureViewDescriptor::default()))
}

/// Creates a texture of an arbitrary colour.
fn single_pixel(device: &wgpu::Device) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("no memory"),
        size: wgpu::Extent3d::default(),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn halved_to_fit(image: &Image, limit: u32) -> Cow<'_, Image> {
    let mut image = Cow::Borrowed(image);
    while image.width > limit || image.height > limit {
        let (width, height) = (image.width.div_ceil(2), image.height.div_ceil(2));
        let mut rgba = Vec::with_capacity(width as usize * height as usize * 4);
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            let at = (y as usize * 2 * image.width as usize + x as usize * 2) * 4;
            rgba.extend_from_slice(&image.rgba[at..at + 4]);
        }
        image = Cow::Owned(Image { name: image.name.clone(), width, height, rgba });
    }
    image
}

/// Draws each mip level of a texture from the level above it.
struct LevelMaker {
    sampler: wgpu::Sampler,
    layout: wgpu::BindGroupLayout,
    pipelines: [(wgpu::TextureFormat, wgpu::RenderPipeline); 2],
}

impl LevelMaker {
    fn new(device: &wgpu::Device) -> Self {
        let maker = Maker { device, samples: 1 };
        let module = maker.module(LEVELS, shaders::mip());
        let layout = bindings::layout(device, LEVELS, wgpu::ShaderStages::FRAGMENT, &[COLORS, SAMPLER]);
        let groups = maker.layout(&[&layout]);
        let pipeline = |format: wgpu::TextureFormat| {
            let targets = [Some(format.into())];
            maker.pipeline(&Shape { targets: &targets, ..Shape::new(LEVELS, &groups, &module, ["vs_mip", "fs_mip"]) })
        };
        let formats = [wgpu::TextureFormat::Rgba8UnormSrgb, wgpu::TextureFormat::Rgba8Unorm];
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Self { sampler, layout, pipelines: formats.map(|format| (format, pipeline(format))) }
    }

    fn fill(&self, gpu: &Gpu, texture: &wgpu::Texture) {
        let Some((_, pipeline)) = self.pipelines.iter().find(|(format, _)| *format == texture.format()) else {
            return;
        };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        for level in 1..texture.mip_level_count() {
            self.draw_level(gpu, pipeline, texture, level, &mut encoder);
        }
        gpu.queue.submit([encoder.finish()]);
    }

    fn draw_level(
        &self,
        gpu: &Gpu,
        pipeline: &wgpu::RenderPipeline,
        texture: &wgpu::Texture,
        level: u32,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let view = |base_mip_level| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                base_mip_level,
                mip_level_count: Some(1),
                ..Default::default()
            })
        };
        let source = view(level - 1);
        let resources = [wgpu::BindingResource::TextureView(&source), wgpu::BindingResource::Sampler(&self.sampler)];
        let group = bindings::group(&gpu.device, LEVELS, &self.layout, &resources);
        let target = view(level);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(LEVELS),
            color_attachments: &[Some(cleared(&target, None, wgpu::Color::BLACK))],
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_above_the_limit_is_halved_until_it_fits() {
        let image = Image { name: String::new(), width: 5, height: 2, rgba: (0..40).collect() };
        let fitted = halved_to_fit(&image, 3);
        assert_eq!((fitted.width, fitted.height, fitted.rgba.len()), (3, 1, 12));
        assert_eq!(fitted.rgba[4..8], [8, 9, 10, 11]);
    }
}
