//! A picture that was judged against rays, as overlays and marks look it up.

use glam::DMat4;
use shadowfit::{DepthConvention, PerspectiveCamera};

use crate::frame::Frame;
use crate::uniform::JudgedUniform;
use crate::{Gpu, bindings};

/// A judged picture: of this frame, or of an earlier one, whose classes then stick to the surfaces. What the judged
/// camera did not see for a nearer surface has the class of that one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JudgedPicture<'a> {
    /// Class of each pixel, an `R32Uint` of at least [`Self::size`]: bits 0 to 2 are 0 where it was not judged, 1 right,
    /// 2 false shadow, 3 false light, 4 hole, 5 edge; bit 3 is set where the light reaches it in truth. Other bits are
    /// ignored.
    pub classes: &'a wgpu::TextureView,
    /// Width and height of the picture, in pixels.
    pub size: [u32; 2],
    /// Camera that it was judged with.
    pub camera: PerspectiveCamera,
}

/// What binds judged pictures.
#[derive(Debug)]
pub(crate) struct JudgedInput {
    pub(crate) layout: wgpu::BindGroupLayout,
    uniform: wgpu::Buffer,
    /// Shown where there is no judged picture: a pixel that was not judged.
    nothing: wgpu::TextureView,
}

impl JudgedInput {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let types = [bindings::UNIFORM, bindings::texture(wgpu::TextureSampleType::Uint, false)];
        let format = wgpu::TextureFormat::R32Uint;
        let usage = wgpu::TextureUsages::TEXTURE_BINDING;
        let nothing = bindings::plain_texture(device, "nothing judged", [1, 1], format, usage);
        Self {
            layout: bindings::layout(device, LABEL, wgpu::ShaderStages::FRAGMENT, &types),
            uniform: bindings::uniform_buffer::<JudgedUniform>(device, LABEL),
            nothing: nothing.create_view(&Default::default()),
        }
    }

    /// The bind group of a frame's judged picture, for a picture of `size` pixels.
    pub(crate) fn bind(&self, gpu: &Gpu, frame: &Frame<'_>, size: [u32; 2]) -> wgpu::BindGroup {
        let uniform = frame.judged.map(|judged| JudgedUniform::new(&judged, frame.camera, size)).unwrap_or_default();
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        let classes = frame.judged.map_or(&self.nothing, |judged| judged.classes);
        let resources = [self.uniform.as_entire_binding(), wgpu::BindingResource::TextureView(classes)];
        bindings::group(&gpu.device, LABEL, &self.layout, &resources)
    }
}

const LABEL: &str = "judged picture";

impl JudgedUniform {
    /// The uniform of a judged picture, for a picture of `viewport` pixels through a camera.
    pub fn new(judged: &JudgedPicture<'_>, camera: &PerspectiveCamera, viewport: [u32; 2]) -> Self {
        let clip = |camera: &PerspectiveCamera| camera.clip_from_world(DepthConvention::Reversed).as_dmat4();
        let clip_from_world = clip(&judged.camera) * DMat4::from_translation(camera.eye - judged.camera.eye);
        let clip_from_ndc = clip_from_world * clip(camera).inverse();
        let size = judged.size.map(|side| side as f32);
        let is_same = judged.camera == *camera;
        let scale = [0, 1].map(|i| if is_same { size[i] / viewport[i] as f32 } else { 0.0 });
        Self {
            clip_from_world: clip_from_world.as_mat4().to_cols_array_2d(),
            clip_from_ndc: clip_from_ndc.as_mat4().to_cols_array_2d(),
            size,
            scale,
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Mat4, Vec3, Vec4};

    use super::*;

    fn camera(eye: DVec3) -> PerspectiveCamera {
        PerspectiveCamera {
            eye,
            forward: Vec3::new(0.2, -0.1, -1.0),
            up: Vec3::Y,
            fov_y: 0.8,
            aspect: 1.5,
            near: 0.1,
            far: 100.0,
        }
    }

    #[test]
    fn a_point_of_the_picture_is_found_where_the_judged_camera_saw_it() {
        let (now, before) = (camera(DVec3::new(1e5, 2.0, 3.0)), camera(DVec3::new(1e5 - 0.5, 2.25, 4.0)));
        let point = now.eye + DVec3::new(1.0, -0.5, -8.0);
        let clip = |camera: &PerspectiveCamera| {
            camera.clip_from_world(DepthConvention::Reversed) * (point - camera.eye).as_vec3().extend(1.0)
        };
        let ndc = |clip: Vec4| clip.truncate() / clip.w;
        let (of_now, expected) = (ndc(clip(&now)), ndc(clip(&before)));
        let clip_from_world = before.clip_from_world(DepthConvention::Reversed).as_dmat4()
            * DMat4::from_translation(now.eye - before.eye);
        let from_world = clip_from_world.as_mat4() * (point - now.eye).as_vec3().extend(1.0);
        let inverse = now.clip_from_world(DepthConvention::Reversed).as_dmat4().inverse();
        let from_ndc: Mat4 = (clip_from_world * inverse).as_mat4();
        for found in [ndc(from_world), ndc(from_ndc * of_now.extend(1.0))] {
            // Pixels of a picture of 4000 are 5e-4 apart.
            assert!((found - expected).length() < 2e-5, "{found} is not {expected}");
        }
    }
}
