//! Blocking measurement of the times of a frame's passes.

use anyhow::{Context, Result};
use shadowfit_render::{Gpu, GpuTimer};

/// A compute pass of about a millisecond. A GPU that idles between two frames lowers its clock, and would run
/// the second frame at half of its speed.
const SPIN: &str = "
@group(0) @binding(0) var<storage, read_write> result: array<f32>;

@compute @workgroup_size(256) fn spin(@builtin(global_invocation_id) id: vec3<u32>) {
    var x = f32(id.x);
    for (var turn = 0u; turn < 100000u; turn++) {
        x = fma(x, 0.5, 1.0);
    }
    if x < 0.0 {
        result[0] = x;
    }
}
";
/// Workgroups of that pass: several for each compute unit of a large GPU.
const SPIN_GROUPS: u32 = 256;
/// Repetitions of that pass before a frame.
const SPINS: usize = 2;

/// Times frames, one after the other.
pub(crate) struct Timer {
    timer: GpuTimer,
    /// `None` on software adapters, which have no clock to keep up.
    spin: Option<(wgpu::ComputePipeline, wgpu::BindGroup)>,
}

impl Timer {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        Self { timer: GpuTimer::new(&gpu.device, 1), spin: (!gpu.is_software()).then(|| spin(&gpu.device)) }
    }

    /// Records and submits a frame. Returns the time from the start of its first timed pass to the end of the
    /// last one, in milliseconds, or 0 if none was timed.
    pub(crate) fn frame(
        &mut self,
        gpu: &Gpu,
        record: impl FnOnce(&mut wgpu::CommandEncoder, &GpuTimer) -> Result<()>,
    ) -> Result<f64> {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        if let Some((pipeline, group)) = &self.spin {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, group, &[]);
            for _ in 0..SPINS {
                pass.dispatch_workgroups(SPIN_GROUPS, 1, 1);
            }
        }
        record(&mut encoder, &self.timer)?;
        self.timer.resolve(&mut encoder);
        gpu.queue.submit([encoder.finish()]);
        self.timer.end_frame(gpu);
        gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
        self.timer.take_ms(gpu).context("the times of the frame did not come back")
    }
}

/// Creates the compute pass and its bind group.
fn spin(device: &wgpu::Device) -> (wgpu::ComputePipeline, wgpu::BindGroup) {
    let source = wgpu::ShaderSource::Wgsl(SPIN.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("spin"),
        compilation_options: Default::default(),
        cache: None,
    });
    let usage = wgpu::BufferUsages::STORAGE;
    let buffer =
        device.create_buffer(&wgpu::BufferDescriptor { label: None, size: 16, usage, mapped_at_creation: false });
    let entries = [wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }];
    let layout = &pipeline.get_bind_group_layout(0);
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries });
    (pipeline, group)
}
