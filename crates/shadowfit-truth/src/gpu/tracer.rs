//! A tracer's triangles, hierarchy and cut-outs in GPU buffers: a scene of [`shadowfit_rays`] with one
//! instance, and a table to look up a picture's triangles.

use glam::{Affine3A, DVec3, Vec3};
use shadowfit_gpu::bindings::{group, layout, storage};
use shadowfit_rays::{ImageId, MeshId, RayError, RayInstance, RayMesh, RayScene};

use super::error::GpuTruthError;
use crate::cut_out::AlphaImage;
use crate::tracer::Tracer;

/// Label of the slots' buffer, bind group and layout.
const LABEL: &str = "triangle slots";

/// A tracer's scene on the GPU.
#[derive(Debug)]
pub struct GpuTracer {
    scene: RayScene,
    mesh: MeshId,
    /// Images of the cut-outs, and their ids in the scene.
    images: (Vec<AlphaImage>, Vec<ImageId>),
    /// Position in leaf order of each triangle, by the triangle's index.
    slots: wgpu::Buffer,
    slots_group: wgpu::BindGroup,
}

impl GpuTracer {
    /// Uploads a tracer. Triangles are stored in f32 relative to `origin` (world space, metres), which should
    /// be near the judged points. If the origin is zero, they equal the CPU's triangles bit for bit.
    ///
    /// # Errors
    ///
    /// If the tracer has an alpha test other than cut-outs, or is too large for the device.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        tracer: &Tracer,
        origin: DVec3,
    ) -> Result<Self, GpuTruthError> {
        let mut scene = RayScene::new(device, queue)?;
        let images = upload_images(tracer.cut_outs().images(), &mut scene)?;
        let shape = shape(tracer, origin, &images)?;
        let mesh = scene.add_mesh(&shape)?;
        scene.set_instances(origin, &[RayInstance::new(mesh, Affine3A::IDENTITY)])?;
        let slots = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(LABEL),
            // An empty buffer cannot be bound.
            size: (tracer.len().max(1) * size_of::<u32>()) as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let slots_group = group(device, LABEL, &slots_layout(device), &[slots.as_entire_binding()]);
        let images = (tracer.cut_outs().images().to_vec(), images);
        let made = Self { scene, mesh, images, slots, slots_group };
        made.upload_slots(queue, &shape);
        Ok(made)
    }

    /// Uploads a tracer whose triangles have moved, or another tracer. Buffers are created again only if
    /// their sizes change, and images are uploaded again only if they change.
    ///
    /// # Errors
    ///
    /// As for [`Self::new`]. The scene is then unchanged.
    pub fn update(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, tracer: &Tracer) -> Result<(), GpuTruthError> {
        let (images, ids) = &self.images;
        if tracer.len() != self.triangles() as usize || tracer.cut_outs().images() != images {
            *self = Self::new(device, queue, tracer, self.origin())?;
            return Ok(());
        }
        let shape = shape(tracer, self.origin(), ids)?;
        self.scene.update_mesh(self.mesh, &shape)?;
        self.upload_slots(queue, &shape);
        Ok(())
    }

    fn upload_slots(&self, queue: &wgpu::Queue, shape: &RayMesh) {
        let mut slots = vec![0u32; shape.len()];
        for (slot, triangle) in self.scene.slots(self.mesh).unwrap_or_default().zip(shape.order()) {
            slots[triangle as usize] = slot;
        }
        queue.write_buffer(&self.slots, 0, bytemuck::cast_slice(&slots));
    }

    /// Returns the point that triangles are stored relative to, world space, metres.
    pub fn origin(&self) -> DVec3 {
        self.scene.origin()
    }

    /// Returns the number of triangles.
    pub fn triangles(&self) -> u32 {
        self.scene.triangles() as u32
    }

    /// Returns the size on the GPU, in bytes.
    pub fn bytes(&self) -> u64 {
        self.scene.bytes() + self.slots.size()
    }

    /// Returns the bind groups of the rays and of [`slots_layout`].
    pub(crate) fn groups(&self) -> [&wgpu::BindGroup; 2] {
        [self.scene.group(), &self.slots_group]
    }
}

/// Creates the layout of the bind group with the triangles' slots.
pub(crate) fn slots_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    layout(device, LABEL, wgpu::ShaderStages::COMPUTE, &[storage(true)])
}

/// Uploads the images of cut-outs.
fn upload_images(images: &[AlphaImage], scene: &mut RayScene) -> Result<Vec<ImageId>, RayError> {
    let mut upload = |image: &AlphaImage| {
        let [width, height] = image.size();
        scene.add_image(shadowfit_rays::AlphaImage::new(width, height, image.alpha())?)
    };
    images.iter().map(&mut upload).collect()
}

/// Returns the triangles, relative to the origin, with their hierarchy and their cut-outs.
fn shape(tracer: &Tracer, origin: DVec3, images: &[ImageId]) -> Result<RayMesh, GpuTruthError> {
    if tracer.has_alpha_test() {
        return Err(GpuTruthError::AlphaTest);
    }
    let relative = |corner: Vec3| (corner.as_dvec3() - origin).as_vec3();
    let corners = |triangle| tracer.corners(triangle).map(relative);
    let mesh = tracer.bvh().map(|bvh| RayMesh::from_bvh(bvh, corners)).unwrap_or_default();
    let cut_outs = tracer.cut_outs();
    if cut_outs.is_empty() {
        return Ok(mesh);
    }
    let cut_out = |triangle| {
        let cut_out = cut_outs.cut_outs()[cut_outs.index_of(triangle)? as usize];
        Some((triangle, cut_out.map_image(|image| images.get(image as usize).copied())))
    };
    Ok(mesh.with_cut_outs((0..tracer.len() as u32).filter_map(cut_out))?)
}
