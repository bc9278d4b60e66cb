//! The device of the tests, and tracing of rays on it.

use shadowfit_rays::glam::Vec3;
use shadowfit_rays::{RayScene, RayWgslOptions, rays_wgsl};
use shadowfit_testing::{TestGpu, open_test_gpu, test_gpu};

/// A device and its queue.
pub(crate) struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
}

/// Returns a device that tests share one after the other.
pub(crate) fn gpu() -> Gpu {
    Gpu::from(test_gpu())
}

/// Opens a device with other limits.
pub(crate) fn with_limits(limits: wgpu::Limits) -> Gpu {
    Gpu::from(open_test_gpu(wgpu::Features::empty(), limits))
}

impl From<TestGpu> for Gpu {
    fn from(TestGpu { device, queue, .. }: TestGpu) -> Self {
        Self { device, queue }
    }
}

/// An origin and a direction.
pub(crate) type Ray = [Vec3; 2];

impl Gpu {
    pub(crate) fn scene(&self) -> RayScene {
        RayScene::new(&self.device, &self.queue).expect("a device that can trace")
    }

    /// Returns whether each ray is blocked.
    pub(crate) fn blocked(&self, scene: &RayScene, rays: &[Ray]) -> Vec<bool> {
        self.blocked_where(scene, rays, &RayWgslOptions::group(0))
    }

    pub(crate) fn blocked_where(&self, scene: &RayScene, rays: &[Ray], options: &RayWgslOptions<'_>) -> Vec<bool> {
        let words: Vec<f32> = rays.iter().flatten().flat_map(|v| [v.x, v.y, v.z, 0.0]).collect();
        let asked = self.buffer(bytemuck::cast_slice(&words), wgpu::BufferUsages::STORAGE);
        let answers = self.buffer(
            &vec![0; rays.len() * 4],
            wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
        );
        let pipeline = self.pipeline(scene, options);
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(1),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: asked.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: answers.as_entire_binding() },
            ],
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, scene.group(), &[]);
            pass.set_bind_group(1, &group, &[]);
            pass.dispatch_workgroups((rays.len() as u32).div_ceil(64), 1, 1);
        }
        self.queue.submit([encoder.finish()]);
        self.read(&answers).iter().map(|answer| *answer != 0).collect()
    }

    fn pipeline(&self, scene: &RayScene, options: &RayWgslOptions<'_>) -> wgpu::ComputePipeline {
        let device = &self.device;
        let types = [true, false].map(|read_only| wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only },
            has_dynamic_offset: false,
            min_binding_size: None,
        });
        let entries = [0, 1].map(|binding| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: types[binding as usize],
            count: None,
        });
        let own = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(scene.layout()), Some(&own)],
            immediate_size: 0,
        });
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl((rays_wgsl(options) + ASK).into()),
        });
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: Some(&layout),
            module: &module,
            entry_point: Some("ask"),
            compilation_options: Default::default(),
            cache: None,
        })
    }

    pub(crate) fn buffer(&self, content: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: content.len() as u64,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&buffer, 0, content);
        buffer
    }

    fn read(&self, buffer: &wgpu::Buffer) -> Vec<u32> {
        let mapped = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: buffer.size(),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &mapped, 0, buffer.size());
        self.queue.submit([encoder.finish()]);
        mapped.slice(..).map_async(wgpu::MapMode::Read, |result| result.expect("mapped"));
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("a device that answers");
        bytemuck::pod_collect_to_vec(&mapped.slice(..).get_mapped_range().expect("mapped"))
    }
}

/// Shader with one thread per ray.
const ASK: &str = "
struct AskedRay {
    origin: vec3<f32>,
    direction: vec3<f32>,
}
@group(1) @binding(0) var<storage, read> asked: array<AskedRay>;
@group(1) @binding(1) var<storage, read_write> answers: array<u32>;

@compute @workgroup_size(64) fn ask(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < arrayLength(&asked) {
        answers[id.x] = u32(shadowfit_rays_blocked(asked[id.x].origin, asked[id.x].direction));
    }
}
";
