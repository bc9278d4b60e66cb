//! A sky on a cube around the eye, seen from inside. It is looked up by position, independent of the camera's
//! position, and drawn at the far plane without writing depth. Its picture is generated, with the sun in the
//! direction of the light.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use shadowfit::{DepthConvention, PerspectiveCamera};

use shadowfit_render::passes::{ENCODED_FORMAT, Maker, Shape, culled, depth};
use shadowfit_render::{Gpu, bindings};

use super::picture::SkyPicture;

/// The sky box's shader. Uniform, cube and sampler are group 0.
pub const WGSL: &str = include_str!("sky_box.wgsl");

/// Width and height of a face, in texels. A texel is about a sixth of a degree wide.
const FACE_SIZE: u32 = 512;

/// Vertices of a cube of two triangles a side.
const VERTICES: u32 = 36;

/// A sky box on the GPU.
#[derive(Debug)]
pub struct SkyBox {
    to_light: Vec3,
    texture: wgpu::Texture,
    pipeline: wgpu::RenderPipeline,
    uniform: wgpu::Buffer,
    group: wgpu::BindGroup,
}

/// Uniform of the sky box's shader: `SkyBox` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SkyBoxUniform {
    /// Matrix to clip space (reversed depth) from positions relative to the eye.
    pub clip_from_world: [[f32; 4]; 4],
}

impl SkyBox {
    /// Creates a sky for targets with `samples` samples per pixel (1 or 4), with the sun in the direction
    /// `to_light` (world axes, y up, any length).
    pub fn new(gpu: &Gpu, to_light: Vec3, samples: u32) -> Self {
        let device = &gpu.device;
        let texture = cube(device);
        let cube = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::Cube,
            multisampled: false,
        };
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let stages = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let layout = bindings::layout(device, "sky box", stages, &[bindings::UNIFORM, cube, sampler]);
        let uniform = bindings::uniform_buffer::<SkyBoxUniform>(device, "sky box");
        let view = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::Cube),
            ..Default::default()
        });
        let linear = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("sky box"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let resources = [
            uniform.as_entire_binding(),
            wgpu::BindingResource::TextureView(&view),
            wgpu::BindingResource::Sampler(&linear),
        ];
        let group = bindings::group(device, "sky box", &layout, &resources);
        let sky = Self { to_light, texture, pipeline: pipeline(device, &layout, samples), uniform, group };
        sky.upload(gpu);
        sky
    }

    /// Moves the sun to a direction (world axes, any length). Redraws the picture if the direction changed,
    /// which takes a few tenths of a second on up to six cores.
    pub fn set_light(&mut self, gpu: &Gpu, to_light: Vec3) {
        if self.to_light != to_light {
            self.to_light = to_light;
            self.upload(gpu);
        }
    }

    /// Sets the camera that the sky is seen through, before [`Self::draw`]. Its eye is ignored.
    pub fn prepare(&self, gpu: &Gpu, camera: &PerspectiveCamera) {
        let clip_from_world = camera.clip_from_world(DepthConvention::Reversed).to_cols_array_2d();
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&SkyBoxUniform { clip_from_world }));
    }

    /// Draws the sky behind all surfaces, in display values, into a pass over the [`ENCODED_FORMAT`] view of
    /// a [`RenderTarget`](shadowfit_render::RenderTarget) with its depth, which must have been cleared to the
    /// far value 0. It sets group 0.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..VERTICES, 0..1);
    }

    fn upload(&self, gpu: &Gpu) {
        let picture = SkyPicture::new(self.to_light, FACE_SIZE);
        for (face, texels) in (0..).zip(&picture.faces) {
            let mut layer = self.texture.as_image_copy();
            layer.origin.z = face;
            let row =
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(FACE_SIZE * 4), rows_per_image: None };
            let size = wgpu::Extent3d { width: FACE_SIZE, height: FACE_SIZE, depth_or_array_layers: 1 };
            gpu.queue.write_texture(layer, bytemuck::cast_slice(texels), row, size);
        }
    }
}

fn cube(device: &wgpu::Device) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("sky box"),
        size: wgpu::Extent3d { width: FACE_SIZE, height: FACE_SIZE, depth_or_array_layers: 6 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: ENCODED_FORMAT,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

fn pipeline(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, samples: u32) -> wgpu::RenderPipeline {
    let maker = Maker { device, samples };
    let module = maker.module("sky box", WGSL.to_owned());
    maker.pipeline(&Shape {
        targets: &[Some(ENCODED_FORMAT.into())],
        // The cube's sides face outward, and the camera sees their back.
        primitive: culled(Some(wgpu::Face::Front)),
        depth: depth(false, wgpu::CompareFunction::GreaterEqual),
        samples,
        ..Shape::new("sky box", &maker.layout(&[layout]), &module, ["vs_sky_box", "fs_sky_box"])
    })
}
