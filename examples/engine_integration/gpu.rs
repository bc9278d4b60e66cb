//! The engine's wgpu code: a device, targets, pipelines and read-back of pixels.

use anyhow::Result;
use shadowfit_adapter::{AdapterChoice, instance};
use wgpu::util::DeviceExt;

/// Size of the picture, in pixels. The width is a multiple of 64, so that rows are read back without padding.
pub(crate) const SIZE: wgpu::Extent3d = wgpu::Extent3d { width: 960, height: 540, depth_or_array_layers: 1 };

/// Number of MSAA samples per pixel.
pub(crate) const SAMPLES: u32 = 4;

/// Format of the linear HDR colours.
pub(crate) const HDR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Format of the final picture.
pub(crate) const SRGB: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Format of the depth buffer. Depth is reversed: 1 near, 0 far.
pub(crate) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Device and queue.
pub(crate) struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
}

/// Description of a pipeline from one WGSL text with the entry point `vs` and, if it writes a colour, `fs`.
pub(crate) struct Pipeline<'a> {
    pub(crate) wgsl: String,
    pub(crate) groups: &'a [Option<&'a wgpu::BindGroupLayout>],
    pub(crate) vertices: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    pub(crate) primitive: wgpu::PrimitiveState,
    pub(crate) depth: Option<wgpu::DepthStencilState>,
    /// `None` for a depth-only pipeline.
    pub(crate) color: Option<wgpu::TextureFormat>,
    pub(crate) samples: u32,
}

impl Gpu {
    /// Opens the adapter that the environment variable `SHADOWFIT_ADAPTER` names, or the fastest one.
    pub(crate) async fn open() -> Result<Self> {
        let choice = AdapterChoice::from_env().unwrap_or_default();
        let adapter = choice.find(&instance(), None).await?;
        let (device, queue) = adapter.request_device(&wgpu::DeviceDescriptor::default()).await?;
        Ok(Self { device, queue })
    }

    pub(crate) fn pipeline(&self, pipeline: Pipeline<'_>) -> wgpu::RenderPipeline {
        let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(pipeline.wgsl.into()),
        });
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: pipeline.groups,
            immediate_size: 0,
        });
        let targets = [pipeline.color.map(Into::into)];
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs"),
                compilation_options: Default::default(),
                buffers: pipeline.vertices,
            },
            primitive: pipeline.primitive,
            depth_stencil: pipeline.depth,
            multisample: wgpu::MultisampleState { count: pipeline.samples, ..Default::default() },
            fragment: pipeline.color.is_some().then_some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fs"),
                compilation_options: Default::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    /// Creates a depth-only pipeline with one sample per pixel.
    pub(crate) fn depth_pipeline(
        &self,
        wgsl: String,
        group: &wgpu::BindGroupLayout,
        vertices: &[Option<wgpu::VertexBufferLayout<'_>>],
        (primitive, depth): (wgpu::PrimitiveState, wgpu::DepthStencilState),
    ) -> wgpu::RenderPipeline {
        let groups = &[Some(group)];
        self.pipeline(Pipeline { wgsl, groups, vertices, primitive, depth: Some(depth), color: None, samples: 1 })
    }

    /// Creates a layout with a single binding, number 0.
    pub(crate) fn layout(&self, ty: wgpu::BindingType) -> wgpu::BindGroupLayout {
        self.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty,
                count: None,
            }],
        })
    }

    pub(crate) fn group(&self, layout: &wgpu::BindGroupLayout, resource: wgpu::BindingResource) -> wgpu::BindGroup {
        let entries = &[wgpu::BindGroupEntry { binding: 0, resource }];
        self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries })
    }

    pub(crate) fn buffer(&self, contents: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let usage = usage | wgpu::BufferUsages::COPY_DST;
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
    }

    /// Creates a target of the picture's size and returns a view of it.
    pub(crate) fn target(&self, format: wgpu::TextureFormat, sample_count: u32) -> wgpu::TextureView {
        let read = if format == SRGB { wgpu::TextureUsages::COPY_SRC } else { wgpu::TextureUsages::TEXTURE_BINDING };
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: SIZE,
            mip_level_count: 1,
            sample_count,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | read,
            view_formats: &[],
        });
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    }

    /// Waits for all work and returns the pixels of the picture.
    pub(crate) fn read(&self, picture: &wgpu::TextureView) -> Result<Vec<u8>> {
        let row = SIZE.width * 4;
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(row * SIZE.height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let destination = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_texture_to_buffer(picture.texture().as_image_copy(), destination, SIZE);
        self.queue.submit([encoder.finish()]);
        buffer.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        Ok(buffer.slice(..).get_mapped_range()?.to_vec())
    }
}
