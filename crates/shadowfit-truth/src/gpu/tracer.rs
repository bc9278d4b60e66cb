//! A tracer's triangles, hierarchy and cut-outs in buffers: a scene of [`shadowfit_rays`] with one instance, and what
//! finds the triangles that a picture names.

use glam::{Affine3A, DVec3, Vec3};
use shadowfit_rays::{AlphaImage, CutMaterial, ImageId, RayError, RayInstance, RayMesh, RayScene, Wrap};

use super::error::GpuTruthError;
use super::pipeline::{buffer, group, group_layout};
use crate::cut_out::{self, CutOut, CutOuts};
use crate::tracer::Tracer;

/// Label of the places' buffer, bind group and layout.
const LABEL: &str = "places of triangles";

/// A tracer's scene on the GPU.
#[derive(Debug)]
pub struct GpuTracer {
    scene: RayScene,
    /// Place in leaf order of each triangle by its own index.
    slots: wgpu::Buffer,
    slots_group: wgpu::BindGroup,
}

impl GpuTracer {
    /// Uploads a tracer; once, and again when its triangles have moved. Triangles are stored in f32 relative to `origin`
    /// (world space, metres), which should be near what is judged. With an origin of zero they equal the CPU's to the
    /// last bit.
    ///
    /// # Errors
    ///
    /// When the tracer has an alpha test other than cut-outs, or is too large for the device.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        tracer: &Tracer,
        origin: DVec3,
    ) -> Result<Self, GpuTruthError> {
        if tracer.has_alpha_test() {
            return Err(GpuTruthError::AlphaTest);
        }
        let mut scene = RayScene::new(device, queue)?;
        let mesh = with_cut_outs(mesh(tracer, origin), tracer, &mut scene)?;
        let id = scene.add_mesh(&mesh)?;
        scene.set_instances(origin, &[RayInstance::new(id, Affine3A::IDENTITY)])?;
        // An empty buffer cannot be bound.
        let mut slots = vec![0u32; tracer.len().max(1)];
        for (slot, triangle) in scene.slots(id).unwrap_or_default().zip(mesh.order()) {
            slots[triangle as usize] = slot;
        }
        let content: &[u8] = bytemuck::cast_slice(&slots);
        let slots = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(LABEL),
            size: content.len() as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        queue.write_buffer(&slots, 0, content);
        let slots_group = group(device, LABEL, &slots_layout(device), [slots.as_entire_binding()]);
        Ok(Self { scene, slots, slots_group })
    }

    /// The point that triangles are stored relative to, world space, metres.
    pub fn origin(&self) -> DVec3 {
        self.scene.origin()
    }

    /// Number of triangles.
    pub fn triangles(&self) -> u32 {
        self.scene.triangles() as u32
    }

    /// Bytes on the GPU.
    pub fn bytes(&self) -> u64 {
        self.scene.bytes() + self.slots.size()
    }

    /// The bind groups of rays and of [`slots_layout`].
    pub(crate) fn groups(&self) -> [&wgpu::BindGroup; 2] {
        [self.scene.group(), &self.slots_group]
    }
}

/// Layout of the bind group with the places of triangles.
pub(crate) fn slots_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    group_layout(device, LABEL, [buffer(wgpu::BufferBindingType::Storage { read_only: true })])
}

/// The triangles and their hierarchy, relative to the origin.
fn mesh(tracer: &Tracer, origin: DVec3) -> RayMesh {
    let relative = |corner: Vec3| (corner.as_dvec3() - origin).as_vec3();
    let corners = |triangle| tracer.corners(triangle).map(relative);
    tracer.bvh().map(|bvh| RayMesh::from_bvh(bvh, corners)).unwrap_or_default()
}

/// Uploads the images of the tracer's cut-outs, and gives these to its mesh.
fn with_cut_outs(mesh: RayMesh, tracer: &Tracer, scene: &mut RayScene) -> Result<RayMesh, RayError> {
    let cut_outs: &CutOuts = tracer.cut_outs();
    if cut_outs.is_empty() {
        return Ok(mesh);
    }
    let images: Result<Vec<ImageId>, RayError> = cut_outs
        .images()
        .iter()
        .map(|image| {
            let [width, height] = image.size();
            scene.add_image(AlphaImage::new(width, height, image.alpha())?)
        })
        .collect();
    let images = images?;
    let cut_out = |triangle| {
        let index = cut_outs.index_of(triangle)?;
        Some((triangle, converted(&cut_outs.cut_outs()[index as usize], &images)))
    };
    mesh.with_cut_outs((0..tracer.len() as u32).filter_map(cut_out))
}

fn converted(cut_out: &CutOut, images: &[ImageId]) -> shadowfit_rays::CutOut {
    let wrap = cut_out.wrap.map(|wrap| match wrap {
        cut_out::Wrap::Repeat => Wrap::Repeat,
        cut_out::Wrap::Clamp => Wrap::Clamp,
        cut_out::Wrap::Mirror => Wrap::Mirror,
    });
    let material = CutMaterial {
        image: cut_out.image.and_then(|image| images.get(image as usize).copied()),
        wrap,
        nearest: cut_out.nearest,
        base_alpha: cut_out.base_alpha,
        cutoff: cut_out.cutoff,
    };
    shadowfit_rays::CutOut { uvs: cut_out.uvs, alphas: cut_out.alphas, material }
}
