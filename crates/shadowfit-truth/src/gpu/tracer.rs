//! A tracer's triangles, hierarchy and cut-outs in buffers.

use glam::{DVec3, Vec3};

use super::error::GpuTruthError;
use super::pipeline::{buffer, group, group_layout};
use super::uniform::{CutOutRecord, ImageRecord, NodeRecord, TriangleRecord};
use crate::cut_out::{CutOut, CutOuts};
use crate::tracer::Tracer;

/// Levels of the hierarchy that the shader's stack can follow; `STACK` in `tracer.wgsl`.
const MAX_DEPTH: usize = 64;

/// What each buffer holds, for its label and for errors; the order is that of the bindings.
const CONTENTS: [&str; 6] =
    ["hierarchy nodes", "triangles", "triangle indices", "cut-outs", "cut-out images", "cut-out texels"];

/// Label of the bind group and its layout.
const LABEL: &str = "traced scene";

/// A tracer's scene on the GPU.
#[derive(Debug)]
pub struct GpuTracer {
    buffers: [wgpu::Buffer; 6],
    group: wgpu::BindGroup,
    origin: DVec3,
    triangles: u32,
}

impl GpuTracer {
    /// Uploads a tracer. Triangles are stored in f32 relative to `origin` (world space, metres), which
    /// should be near what is judged. With an origin of zero they equal the CPU's to the last bit.
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
        let contents = contents(tracer, origin)?;
        let limits = device.limits();
        let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        for (what, content) in CONTENTS.iter().zip(&contents) {
            if content.len() as u64 > limit {
                return Err(GpuTruthError::TooLarge { what, bytes: content.len() as u64, limit });
            }
        }
        let mut index = 0;
        let buffers = contents.map(|content| {
            let buffer = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(CONTENTS[index]),
                size: content.len() as u64,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            queue.write_buffer(&buffer, 0, &content);
            index += 1;
            buffer
        });
        let resources = buffers.each_ref().map(wgpu::Buffer::as_entire_binding);
        let group = group(device, LABEL, &scene_layout(device), resources);
        Ok(Self { buffers, group, origin, triangles: tracer.len() as u32 })
    }

    /// Uploads a tracer whose triangles have moved, or another tracer. Buffers are created again only when
    /// their sizes change.
    ///
    /// # Errors
    ///
    /// As for [`Self::new`]; the scene is unchanged then.
    pub fn update(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, tracer: &Tracer) -> Result<(), GpuTruthError> {
        let contents = contents(tracer, self.origin)?;
        let fits = |(buffer, content): (&wgpu::Buffer, &Vec<u8>)| buffer.size() == content.len() as u64;
        if !self.buffers.iter().zip(&contents).all(fits) {
            *self = Self::new(device, queue, tracer, self.origin)?;
            return Ok(());
        }
        for (buffer, content) in self.buffers.iter().zip(&contents) {
            queue.write_buffer(buffer, 0, content);
        }
        Ok(())
    }

    /// The point that triangles are stored relative to, world space, metres.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Number of triangles.
    pub fn triangles(&self) -> u32 {
        self.triangles
    }

    /// Bytes on the GPU.
    pub fn bytes(&self) -> u64 {
        self.buffers.iter().map(wgpu::Buffer::size).sum()
    }

    pub(crate) fn group(&self) -> &wgpu::BindGroup {
        &self.group
    }
}

/// Layout of the scene's bind group.
pub(crate) fn scene_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    group_layout(device, LABEL, CONTENTS.map(|_| buffer(wgpu::BufferBindingType::Storage { read_only: true })))
}

/// The bytes of the buffers. None is empty, since an empty buffer cannot be bound.
fn contents(tracer: &Tracer, origin: DVec3) -> Result<[Vec<u8>; 6], GpuTruthError> {
    if tracer.has_alpha_test() {
        return Err(GpuTruthError::AlphaTest);
    }
    let (nodes, order) = nodes(tracer, origin)?;
    let relative = |corner: Vec3| (corner.as_dvec3() - origin).as_vec3().to_array();
    let cut_outs = tracer.cut_outs();
    let mut slots = vec![0u32; tracer.len()];
    let mut triangles = Vec::with_capacity(order.len());
    for (slot, triangle) in (0u32..).zip(order) {
        slots[*triangle as usize] = slot;
        let [a, b, c] = tracer.corners(*triangle).map(relative);
        let cut_out = cut_outs.index_of(*triangle).map_or(0, |index| index + 1);
        triangles.push(TriangleRecord { a, cut_out, b, c, ..TriangleRecord::default() });
    }
    let (images, alphas) = images(cut_outs)?;
    let records: Vec<CutOutRecord> =
        cut_outs.cut_outs().iter().map(|cut_out| cut_out_record(cut_out, cut_outs.images().len())).collect();
    Ok([bytes(nodes), bytes(triangles), bytes(slots), bytes(records), bytes(images), alphas])
}

/// The hierarchy's nodes, and the indices of the triangles in leaf order.
fn nodes(tracer: &Tracer, origin: DVec3) -> Result<(Vec<NodeRecord>, &[u32]), GpuTruthError> {
    let Some(bvh) = tracer.bvh() else {
        // A leaf with a triangle of no area, which no ray meets.
        return Ok((vec![NodeRecord { least: [0.0; 3], count: 1, most: [0.0; 3], first: 0 }], &[]));
    };
    let depth = bvh.depth(0);
    if depth > MAX_DEPTH {
        return Err(GpuTruthError::TooDeep { depth, limit: MAX_DEPTH });
    }
    let records = bvh.nodes.iter().map(|node| {
        let [least, most] = [node.aabb().min, node.aabb().max].map(|corner| Vec3::from(corner).as_dvec3() - origin);
        NodeRecord {
            least: least.to_array().map(below),
            count: node.prim_count,
            most: most.to_array().map(above),
            first: node.first_index,
        }
    });
    Ok((records.collect(), &bvh.primitive_indices))
}

/// The greatest f32 that is not above a value, so that boxes hold their triangles after rounding.
fn below(value: f64) -> f32 {
    let rounded = value as f32;
    if f64::from(rounded) > value { rounded.next_down() } else { rounded }
}

/// The least f32 that is not below a value.
fn above(value: f64) -> f32 {
    let rounded = value as f32;
    if f64::from(rounded) < value { rounded.next_up() } else { rounded }
}

/// Where the images begin, and their alpha, four texels a word.
fn images(cut_outs: &CutOuts) -> Result<(Vec<ImageRecord>, Vec<u8>), GpuTruthError> {
    let mut alphas = Vec::new();
    let mut records = Vec::new();
    for image in cut_outs.images() {
        let too_large =
            |_| GpuTruthError::TooLarge { what: CONTENTS[5], bytes: alphas.len() as u64, limit: u64::from(u32::MAX) };
        let first = u32::try_from(alphas.len() + image.alpha().len())
            .map_err(too_large)
            .map(|end| end - image.alpha().len() as u32)?;
        let [width, height] = image.size().map(u32::cast_signed);
        records.push(ImageRecord { first, width, height, padding: 0 });
        alphas.extend_from_slice(image.alpha());
    }
    alphas.resize(alphas.len().next_multiple_of(4).max(4), 0);
    Ok((records, alphas))
}

fn cut_out_record(cut_out: &CutOut, images: usize) -> CutOutRecord {
    let [uv_a, uv_b, uv_c] = cut_out.uvs.map(Into::into);
    CutOutRecord {
        uv_a,
        uv_b,
        uv_c,
        base_alpha: cut_out.base_alpha,
        cutoff: cut_out.cutoff,
        alphas: cut_out.alphas,
        image: cut_out.image.filter(|image| (*image as usize) < images).map_or(0, |image| image + 1),
        wrap: cut_out.wrap.map(|wrap| wrap as u32),
        nearest: cut_out.nearest.into(),
        padding: 0,
    }
}

/// Records as bytes; one of zeros where there is none.
fn bytes<T: bytemuck::Pod>(mut records: Vec<T>) -> Vec<u8> {
    if records.is_empty() {
        records.push(T::zeroed());
    }
    bytemuck::cast_slice(&records).to_vec()
}
