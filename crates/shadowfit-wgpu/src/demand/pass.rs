//! The demand pass: pipeline, dispatch, and read-back of the counts.

use shadowfit::demand::{CELLS, LEVELS, MIN_FACING, SIDE};
use shadowfit::demand::{CLASSES, COUNTS, DEPTHS, VisibleDemand, VisibleDemandSpace};
use shadowfit_gpu::bindings::{UNIFORM, group, layout, storage, texture, uniform_buffer};
use shadowfit_gpu::{ReadBackRing, catch_errors, compute_pipeline, wgsl_module};

use super::error::{DemandPassError, Unsupported};
use super::view::{DemandUniform, DemandView};
use crate::pixels::check;

/// Number of frames whose counts may be on their way back at once: graphics APIs let the CPU be up to three
/// frames ahead, and one more is being recorded.
const FRAMES: usize = 4;

/// Label of the pass's resources, for graphics debuggers.
const LABEL: &str = "shadowfit demand";

/// Threads per workgroup, as in the WGSL.
const WORKGROUP_THREADS: u32 = 256;
/// Width of a workgroup's square of points, as in the WGSL.
const SQUARE: u32 = 32;
/// Workgroup memory in bytes, as in the WGSL.
const WORKGROUP_BYTES: u32 = 2 * 4 * WORKGROUP_THREADS;

/// Pass that counts the visible points of a depth buffer; see the [module](super).
#[derive(Debug)]
pub struct DemandPass {
    device: wgpu::Device,
    queue: wgpu::Queue,
    samples: u32,
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
    counts: wgpu::Buffer,
    /// One uniform for each frame on its way.
    uniforms: Vec<wgpu::Buffer>,
    read_backs: ReadBackRing<VisibleDemandSpace>,
}

impl DemandPass {
    /// Creates a pass for depth textures with `samples` per pixel.
    ///
    /// # Errors
    ///
    /// [`DemandPassError::Unsupported`] if the device has no compute shaders or storage buffers, or uses
    /// OpenGL, whose shaders cannot load depth. Fit from bounding boxes then. [`DemandPassError::Device`] if
    /// the device is out of memory.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, samples: u32) -> Result<Self, DemandPassError> {
        supported(&device.limits(), device.adapter_info().backend).map_err(DemandPassError::Unsupported)?;
        caught(device, || {
            let depths = texture(wgpu::TextureSampleType::Depth, samples > 1);
            let layout = layout(device, LABEL, wgpu::ShaderStages::COMPUTE, &[UNIFORM, depths, storage(false)]);
            let module = wgsl_module(device, LABEL, demand_wgsl(samples));
            let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
            let size = (COUNTS * size_of::<u32>()) as u64;
            let counts = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(LABEL),
                size,
                usage,
                mapped_at_creation: false,
            });
            Self {
                device: device.clone(),
                queue: queue.clone(),
                samples,
                pipeline: compute_pipeline(device, LABEL, &[Some(&layout)], &module, "count_demand"),
                layout,
                uniforms: (0..FRAMES).map(|_| uniform_buffer::<DemandUniform>(device, LABEL)).collect(),
                read_backs: ReadBackRing::new(device, "shadowfit read back", size, FRAMES),
                counts,
            }
        })
    }

    /// Returns the samples per pixel of the supported depth textures.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Records the pass and the read-back of its counts. Call it after the pass that fills the depth buffer.
    /// `depth` is a view of the depth aspect of the whole texture, of any depth format, with usage
    /// `TEXTURE_BINDING`. Its depths must be stored (`StoreOp::Store`). `timestamps` may time the pass.
    ///
    /// Returns whether the pass was recorded. It is skipped while the counts of too many earlier frames have
    /// not arrived; fits then use the previous counts. It is also skipped for a view that begins beyond the
    /// shadow distance.
    ///
    /// # Errors
    ///
    /// [`DemandPassError`] for an invalid view or texture, and if the device is out of memory. The pass is
    /// not recorded then. A lost device is reported by [`Self::take`].
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
        view: &DemandView,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
    ) -> Result<bool, DemandPassError> {
        check(depth.texture(), &[self.samples], view.rectangle)?;
        // A view with invalid depths is refused below.
        let is_view = view.frustum.near <= view.frustum.far;
        if is_view && !view.frustum.begins_before(view.max_distance) {
            return Ok(false);
        }
        let space = view.space()?;
        let uniform = view.uniform(&space)?;
        let Some(buffer) = self.read_backs.free().map(|index| &self.uniforms[index]) else { return Ok(false) };
        let group = caught(&self.device, || {
            self.queue.write_buffer(buffer, 0, bytemuck::bytes_of(&uniform));
            let depth = wgpu::BindingResource::TextureView(depth);
            let resources = [buffer.as_entire_binding(), depth, self.counts.as_entire_binding()];
            group(&self.device, LABEL, &self.layout, &resources)
        })?;
        encoder.clear_buffer(&self.counts, 0, None);
        {
            let mut pass = encoder
                .begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(LABEL), timestamp_writes: timestamps });
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &group, &[]);
            let [x, y] = uniform.size.map(|side| side.div_ceil(uniform.step * SQUARE));
            pass.dispatch_workgroups(x, y, 1);
        }
        Ok(self.read_backs.record(encoder, &self.counts, space))
    }

    /// Returns the counts of the newest frame that the GPU has finished. The counts of a frame are returned
    /// once. `None` if no new counts have arrived. Never waits.
    ///
    /// # Errors
    ///
    /// [`DemandPassError::Lost`] if the device was lost.
    pub fn take(&mut self) -> Result<Option<VisibleDemand>, DemandPassError> {
        // This only polls. The read-backs below show which frames are finished.
        let _status = self.device.poll(wgpu::PollType::Poll);
        self.newest()
    }

    /// Waits for the counts of the last submitted frame, then returns them like [`Self::take`]. Use it in
    /// headless runs and tests whose images must be reproducible.
    ///
    /// # Errors
    ///
    /// [`DemandPassError::Lost`] if the device was lost or does not respond.
    pub fn wait(&mut self) -> Result<Option<VisibleDemand>, DemandPassError> {
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|_| DemandPassError::Lost)?;
        self.newest()
    }

    /// Drops the counts that have not arrived yet. Call it after a camera cut, together with
    /// [`ShadowFitter::reset`](shadowfit::ShadowFitter::reset).
    pub fn reset(&mut self) {
        self.read_backs.forget();
    }

    fn newest(&mut self) -> Result<Option<VisibleDemand>, DemandPassError> {
        let taken = self.read_backs.take(bytemuck::pod_collect_to_vec).map_err(|_| DemandPassError::Lost)?;
        taken.map(|(space, counts)| VisibleDemand::from_counts(space, counts).ok_or(DemandPassError::Lost)).transpose()
    }
}

/// Returns the WGSL of the pass for depth textures with this number of samples per pixel.
pub fn demand_wgsl(samples: u32) -> String {
    let texture = if samples > 1 { "texture_depth_multisampled_2d" } else { "texture_depth_2d" };
    format!(
        "alias DepthTexture = {texture};
const CELLS: u32 = {CELLS}u;
const LEVELS: i32 = {LEVELS};
const SIDE: u32 = {SIDE}u;
const DEPTHS: u32 = {DEPTHS}u;
const CLASSES: u32 = {CLASSES}u;
const MIN_FACING: f32 = {MIN_FACING};
{}",
        include_str!("demand.wgsl")
    )
}

/// Returns an error if the device lacks a capability for the pass.
pub(crate) fn supported(limits: &wgpu::Limits, backend: wgpu::Backend) -> Result<(), Unsupported> {
    let has_compute = limits.max_storage_buffers_per_shader_stage > 0
        && limits.max_compute_invocations_per_workgroup >= WORKGROUP_THREADS
        && limits.max_compute_workgroup_storage_size >= WORKGROUP_BYTES;
    match (has_compute, backend) {
        (false, _) => Err(Unsupported::Compute),
        (true, wgpu::Backend::Gl) => Err(Unsupported::DepthLoads),
        (true, _) => Ok(()),
    }
}

/// Runs `work`, and returns errors that would otherwise end the program, such as lack of memory.
fn caught<T>(device: &wgpu::Device, work: impl FnOnce() -> T) -> Result<T, DemandPassError> {
    catch_errors(device, work).map_err(|error| DemandPassError::Device(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn devices_without_compute_or_loads_of_depth_are_refused_with_what_to_do() {
        let limits = wgpu::Limits::default();
        assert_eq!(supported(&limits, wgpu::Backend::Vulkan), Ok(()));
        assert_eq!(supported(&limits, wgpu::Backend::Gl), Err(Unsupported::DepthLoads));
        let without = wgpu::Limits::downlevel_webgl2_defaults();
        assert_eq!(supported(&without, wgpu::Backend::Gl), Err(Unsupported::Compute));
        for lack in [Unsupported::Compute, Unsupported::DepthLoads, Unsupported::StorageBuffers] {
            let text = DemandPassError::Unsupported(lack).to_string();
            assert!(text.contains("this device cannot") && text.ends_with("fit from boxes"), "{text}");
        }
    }
}
