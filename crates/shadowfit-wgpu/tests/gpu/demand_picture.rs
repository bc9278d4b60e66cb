//! Depth buffers of a few planes and boxes, and the compute pass over them.

use shadowfit::VisibleDemand;
use shadowfit::glam::{Mat4, Vec3, Vec4};
use shadowfit_wgpu::demand::{DemandPass, DemandView, Depths};

use super::engine::Engine;
use super::engine::picture::{DepthPicture, SeenCorner};

/// Settings for drawing a depth buffer.
#[derive(Clone, Copy)]
pub(super) struct Drawing {
    /// Width and height of the texture, in pixels.
    pub(super) size: [u32; 2],
    pub(super) samples: u32,
    /// Mask of the drawn samples.
    pub(super) mask: u64,
}

impl Drawing {
    /// Returns settings for a texture with one sample per pixel.
    pub(super) fn new(size: [u32; 2]) -> Self {
        Self { size, samples: 1, mask: !0 }
    }
}

/// Returns the triangles of a quad, whose corners are in order.
pub(super) fn quad(corners: [Vec3; 4]) -> [Vec3; 6] {
    let [a, b, c, d] = corners;
    [a, b, c, a, c, d]
}

/// Counts of a view.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Counts {
    pub(super) cells: Vec<u32>,
    pub(super) bins: Vec<u32>,
}

/// Returns the triangles of a box.
pub(super) fn cuboid(low: Vec3, high: Vec3) -> Vec<Vec3> {
    let at = |bits: usize| {
        Vec3::from_array([0, 1, 2].map(|axis| if bits >> axis & 1 == 1 { high[axis] } else { low[axis] }))
    };
    let faces = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
    faces.iter().flat_map(|face| quad(face.map(at))).collect()
}

/// Draws triangles, relative to the eye, into the view's part of a depth texture.
pub(super) fn draw(gpu: &Engine, view: &DemandView, triangles: &[Vec3], drawing: &Drawing) -> wgpu::TextureView {
    let Drawing { size, samples, mask } = *drawing;
    let clip = view.clip_from_world.as_dmat4();
    let corner = |p: &Vec3| SeenCorner { clip: (clip * p.as_dvec3().extend(1.0)).as_vec4(), normal: Vec4::ZERO };
    let corners: Vec<SeenCorner> = triangles.iter().map(corner).collect();
    let whole = DepthPicture::new(size, view.depth);
    gpu.draw_depths(&DepthPicture { part: view.rectangle, samples, mask, ..whole }, &corners)
}

/// Reads back a texture with one sample per pixel.
pub(super) fn read(gpu: &Engine, depth: &wgpu::TextureView) -> Depths {
    Depths { width: depth.texture().width(), values: gpu.texels(depth.texture()) }
}

/// Creates the pass for depth textures with this number of samples.
pub(super) fn demand_pass(gpu: &Engine, samples: u32) -> DemandPass {
    gpu.require_depth_loads();
    DemandPass::new(&gpu.device, &gpu.queue, samples).expect("a device that computes")
}

/// Runs the pass over a texture, and waits for it.
pub(super) fn seen(gpu: &Engine, view: &DemandView, depth: &wgpu::TextureView) -> VisibleDemand {
    let mut pass = demand_pass(gpu, depth.texture().sample_count());
    record(gpu, &mut pass, view, depth);
    pass.wait().expect("the device works").expect("a frame was recorded")
}

/// Records a view and submits it.
pub(super) fn record(gpu: &Engine, pass: &mut DemandPass, view: &DemandView, depth: &wgpu::TextureView) {
    let mut encoder = gpu.encoder();
    assert_eq!(pass.record(&mut encoder, depth, view, None), Ok(true));
    gpu.submit(encoder);
}

impl From<&VisibleDemand> for Counts {
    fn from(seen: &VisibleDemand) -> Self {
        Self { cells: seen.demand().counts.to_vec(), bins: seen.histogram().bins.to_vec() }
    }
}

/// Returns a perspective with an infinite far plane and reversed depth.
pub(super) fn infinite(clip_from_view: Mat4, near: f32) -> Mat4 {
    let mut matrix = clip_from_view;
    matrix.z_axis.z = 0.0;
    matrix.w_axis.z = near;
    matrix
}
