//! Outputs of the passes: the texture of factors, and the list of pixels to trace.

use shadowfit_gpu::bindings::{UNIFORM, group, layout, plain_texture, storage, texture};
use shadowfit_gpu::catch_errors;

use super::error::EdgeError;
use super::noise::RANKS;
use super::shader::TRACE_THREADS;

/// Counters at the beginning of a list: listed pixels, facing pixels, facing pixels that the filter decides,
/// and listed pixels before the budget removed some.
pub(super) const COUNTS: usize = 4;

/// Bytes per pixel on a list: `Listed` in WGSL.
const LISTED: u64 = 12;

/// Offset of the dispatch arguments of the pass that finds triangles, in bytes. The arguments of the pass
/// that traces come first.
pub(super) const SURFACE_GROUPS: u64 = 16;

/// Textures and buffers whose size depends on the view's size.
#[derive(Debug)]
pub(super) struct Target {
    pub(super) size: [u32; 2],
    /// Texture view that the passes write to.
    pub(super) factors: wgpu::TextureView,
    pub(super) list: wgpu::Buffer,
    /// Dispatch arguments of the passes that trace and find triangles.
    pub(super) groups: wgpu::Buffer,
    pub(super) group: wgpu::BindGroup,
    pub(super) arguments: wgpu::BindGroup,
    /// Created for the first frame with a budget of traced pixels.
    pub(super) kept: Option<Kept>,
}

/// Resources of the pixels that are traced in a frame with a budget.
#[derive(Debug)]
pub(super) struct Kept {
    pub(super) list: wgpu::Buffer,
    budget: wgpu::Buffer,
    pub(super) group: wgpu::BindGroup,
    pub(super) arguments: wgpu::BindGroup,
}

/// Bind group layouts that do not depend on the maps.
#[derive(Debug)]
pub(super) struct Layouts {
    /// Layout for the shader of the engine's main pass.
    pub(super) read: wgpu::BindGroupLayout,
    /// Layout for the pass that counts workgroups.
    pub(super) arguments: wgpu::BindGroupLayout,
    /// Layout for the pass that applies the budget.
    pub(super) select: wgpu::BindGroupLayout,
}

/// Float texture that is read with `textureLoad`.
pub(super) const FLOATS: wgpu::BindingType = texture(wgpu::TextureSampleType::Float { filterable: false }, false);

impl Layouts {
    /// Creates all layouts if the device `computes`; otherwise only the layout for the engine's main pass.
    pub(super) fn new(device: &wgpu::Device, computes: bool) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let stages = wgpu::ShaderStages::FRAGMENT | compute;
        let arguments = [storage(true), storage(false)];
        let select = [storage(true), storage(false), storage(true), UNIFORM];
        // Devices without storage buffers refuse layouts that contain them.
        let used = if computes { usize::MAX } else { 0 };
        Self {
            read: layout(device, "shadowfit exact factors", stages, &[FLOATS]),
            arguments: layout(device, "shadowfit edges arguments", compute, &arguments[..used.min(arguments.len())]),
            select: layout(device, "shadowfit edges select", compute, &select[..used.min(select.len())]),
        }
    }

    fn arguments(&self, device: &wgpu::Device, list: &wgpu::Buffer, groups: &wgpu::Buffer) -> wgpu::BindGroup {
        let resources = [list.as_entire_binding(), groups.as_entire_binding()];
        group(device, "shadowfit edges arguments", &self.arguments, &resources)
    }

    /// Creates the bind group for the engine's main pass.
    pub(super) fn group(&self, device: &wgpu::Device, factors: &wgpu::TextureView) -> wgpu::BindGroup {
        let resources = [wgpu::BindingResource::TextureView(factors)];
        group(device, "shadowfit exact factors", &self.read, &resources)
    }
}

impl Target {
    pub(super) fn new(device: &wgpu::Device, layouts: &Layouts, size: [u32; 2]) -> Result<Self, EdgeError> {
        let made = || {
            let factors = factors(device, size);
            let list = list(device, size);
            let groups = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("shadowfit edges groups"),
                size: 2 * SURFACE_GROUPS,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT,
                mapped_at_creation: false,
            });
            let arguments = layouts.arguments(device, &list, &groups);
            let group = layouts.group(device, &factors);
            Self { size, factors, list, groups, group, arguments, kept: None }
        };
        catch_errors(device, made).map_err(|error| EdgeError::Device(error.to_string()))
    }
}

impl Target {
    /// Creates the resources that limit the number of traced pixels, and writes the budget of the frame.
    pub(super) fn keep(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        layouts: &Layouts,
        budget: u32,
        frame: u32,
    ) -> Result<(), EdgeError> {
        if self.kept.is_none() {
            let made = catch_errors(device, || Kept::new(device, queue, layouts, self));
            self.kept = Some(made.map_err(|error| EdgeError::Device(error.to_string()))?);
        }
        if let Some(kept) = &self.kept {
            queue.write_buffer(&kept.budget, 0, bytemuck::bytes_of(&[budget, frame, 0, 0]));
        }
        Ok(())
    }
}

impl Kept {
    fn new(device: &wgpu::Device, queue: &wgpu::Queue, layouts: &Layouts, target: &Target) -> Self {
        let buffer = |size: usize, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("shadowfit edges budget"),
                size: size as u64,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let noise = buffer(size_of_val(&RANKS[..]), wgpu::BufferUsages::STORAGE);
        queue.write_buffer(&noise, 0, bytemuck::cast_slice(&RANKS));
        let budget = buffer(16, wgpu::BufferUsages::UNIFORM);
        let list = list(device, target.size);
        let resources = [&target.list, &list, &noise, &budget].map(|buffer: &wgpu::Buffer| buffer.as_entire_binding());
        let group = group(device, "shadowfit edges select", &layouts.select, &resources);
        let arguments = layouts.arguments(device, &list, &target.groups);
        Self { list, budget, group, arguments }
    }
}

/// Creates a texture of factors.
pub(super) fn factors(device: &wgpu::Device, size: [u32; 2]) -> wgpu::TextureView {
    let usage = wgpu::TextureUsages::STORAGE_BINDING
        | wgpu::TextureUsages::TEXTURE_BINDING
        | wgpu::TextureUsages::COPY_SRC
        | wgpu::TextureUsages::COPY_DST;
    let texture = plain_texture(device, "shadowfit factors", size, wgpu::TextureFormat::R32Float, usage);
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// Creates a list with room for all pixels of a view.
fn list(device: &wgpu::Device, [width, height]: [u32; 2]) -> wgpu::Buffer {
    let pixels = (u64::from(width) * u64::from(height)).next_multiple_of(u64::from(TRACE_THREADS));
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("shadowfit edges list"),
        size: COUNTS as u64 * 4 + pixels * LISTED,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
