//! A picture that was judged against rays, as input of overlays and marks.

use glam::DMat4;
use shadowfit::{Camera, DepthConvention};

use crate::formats::DEPTH_FORMAT;
use crate::uniform::JudgedUniform;
use crate::{Gpu, bindings};

/// A judged picture of this frame, or of an earlier one whose classes then stick to the surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JudgedPicture<'a> {
    /// Class of each pixel, an `R32Uint` texture of at least [`Self::size`]. Bits 0 to 2 are 0 for not
    /// judged, 1 right, 2 false shadow, 3 false light, 4 hole, 5 edge. Bit 3 is set if the light reaches the
    /// pixel in truth. Other bits are ignored.
    pub classes: &'a wgpu::TextureView,
    /// Width and height of the picture, in pixels.
    pub size: [u32; 2],
    /// Camera that it was judged with.
    pub camera: Camera,
    /// Its depth buffer, of one sample, for example
    /// [`ProbeTargets::depth_view`](crate::ProbeTargets::depth_view) of the judged probe. With it, surfaces
    /// that were hidden from the judged camera count as not judged. Without it, or if the camera is
    /// orthographic, they get the class of the surface that hid them. Not needed if the frame has the same
    /// camera.
    pub depth: Option<&'a wgpu::TextureView>,
}

/// Uploads the classes of a picture of `size` pixels, rows from the top, as a texture for
/// [`JudgedPicture::classes`].
///
/// # Panics
///
/// If there are fewer classes than pixels.
pub fn classes_texture(gpu: &Gpu, classes: &[u32], size: [u32; 2]) -> wgpu::TextureView {
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::COPY_SRC;
    let texture = bindings::plain_texture(&gpu.device, "classes", size, wgpu::TextureFormat::R32Uint, usage);
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(size[0] * 4), rows_per_image: None };
    gpu.queue.write_texture(texture.as_image_copy(), bytemuck::cast_slice(classes), layout, texture.size());
    texture.create_view(&Default::default())
}

/// Bindings of judged pictures.
#[derive(Debug)]
pub(crate) struct JudgedInput {
    pub(crate) layout: wgpu::BindGroupLayout,
    uniform: wgpu::Buffer,
    /// Placeholders if there is no judged picture: a pixel that was not judged, and its depth.
    nothing: [wgpu::TextureView; 2],
    nearest: wgpu::Sampler,
}

/// Sample type of depth buffers. OpenGL's shaders cannot load from bindings of depth type.
pub(crate) const DEPTHS: wgpu::TextureSampleType = wgpu::TextureSampleType::Float { filterable: false };

impl JudgedInput {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let textures = [wgpu::TextureSampleType::Uint, DEPTHS];
        let [classes, depth] = textures.map(|sampled| bindings::texture(sampled, false));
        let nearest = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering);
        let nothing = [wgpu::TextureFormat::R32Uint, DEPTH_FORMAT].map(|format| {
            let usage = wgpu::TextureUsages::TEXTURE_BINDING;
            bindings::plain_texture(device, "nothing judged", [1, 1], format, usage).create_view(&Default::default())
        });
        let types = [bindings::UNIFORM, classes, depth, nearest];
        Self {
            layout: bindings::layout(device, LABEL, wgpu::ShaderStages::FRAGMENT, &types),
            uniform: bindings::uniform_buffer::<JudgedUniform>(device, LABEL),
            nothing,
            nearest: device.create_sampler(&wgpu::SamplerDescriptor { label: Some(LABEL), ..Default::default() }),
        }
    }

    /// Returns the bind group of a judged picture, if there is one, for a picture of `size` pixels through a
    /// camera.
    pub(crate) fn bind(
        &self,
        gpu: &Gpu,
        judged: Option<JudgedPicture<'_>>,
        camera: &Camera,
        size: [u32; 2],
    ) -> wgpu::BindGroup {
        let uniform = judged.map(|judged| JudgedUniform::new(&judged, camera, size)).unwrap_or_default();
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        let [no_classes, no_depth] = &self.nothing;
        let classes = judged.map_or(no_classes, |judged| judged.classes);
        let depth = judged.and_then(|judged| judged.depth).unwrap_or(no_depth);
        let [classes, depth] = [classes, depth].map(wgpu::BindingResource::TextureView);
        let nearest = wgpu::BindingResource::Sampler(&self.nearest);
        let resources = [self.uniform.as_entire_binding(), classes, depth, nearest];
        bindings::group(&gpu.device, LABEL, &self.layout, &resources)
    }

    /// Returns the depth of a picture without surfaces.
    pub(crate) fn no_depth(&self) -> &wgpu::TextureView {
        &self.nothing[1]
    }
}

const LABEL: &str = "judged picture";

impl JudgedUniform {
    /// Creates the uniform of a judged picture, for a picture of `viewport` pixels through a camera.
    pub fn new(judged: &JudgedPicture<'_>, camera: &Camera, viewport: [u32; 2]) -> Self {
        let clip = |camera: &Camera| camera.clip_from_world(DepthConvention::Reversed).as_dmat4();
        let clip_from_world = clip(&judged.camera) * DMat4::from_translation(camera.eye - judged.camera.eye);
        let world_from_ndc = clip(camera).inverse();
        let size = judged.size.map(|side| side as f32);
        let is_same = judged.camera == *camera;
        let reads_depths = judged.depth.is_some() && !is_same && !judged.camera.lens.is_orthographic();
        let scale = [0, 1].map(|i| if is_same { size[i] / viewport[i] as f32 } else { 0.0 });
        Self {
            clip_from_world: clip_from_world.as_mat4().to_cols_array_2d(),
            world_from_ndc: world_from_ndc.as_mat4().to_cols_array_2d(),
            size,
            scale,
            // With the same camera the same surfaces are visible. The shader can only use depths of
            // perspectives.
            near: if reads_depths { judged.camera.near } else { 0.0 },
            far: judged.camera.far,
            viewport: viewport.map(|side| side as f32),
        }
    }
}
