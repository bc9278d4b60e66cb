//! A minimal engine that the tests share: a device, its buffers, textures and pipelines, and values read
//! back. Tests add their scenes. [`casters`] draws into maps, [`points`] evaluates WGSL at points, and
//! [`picture`] draws images and depth buffers.

pub(crate) mod casters;
pub(crate) mod picture;
pub(crate) mod points;

use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock};

use bytemuck::{NoUninit, Pod};
use shadowfit::settings::FilterKind;
use shadowfit_testing::{Lent, TestGpu, lacking, open_test_gpu, read_back, require_fine_steps};
use shadowfit_wgpu::ShadowMapDescriptor;
use wgpu::util::DeviceExt;

/// A device of the software adapter. One test uses it at a time, and reuses the pipelines of earlier tests:
/// most tests draw with few shaders, and compiling one takes longer than drawing with it.
#[derive(Clone)]
pub(crate) struct Engine {
    pub(crate) adapter: wgpu::Adapter,
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    /// Pipelines by their WGSL and their states.
    draws: Made<wgpu::RenderPipeline>,
    computes: Made<wgpu::ComputePipeline>,
    /// Whether the device compiles compute shaders, once this was tested.
    compiles_compute: Arc<OnceLock<bool>>,
}

/// A small compute shader that uses a feature of all the tests' compute shaders: a storage buffer of any
/// length.
const COMPUTE: &str = "
@group(0) @binding(0) var<storage, read_write> values: array<u32>;
@compute @workgroup_size(1) fn write_one() {
    values[0] = 1u;
}
";

/// Objects by the text that they were created from.
type Made<T> = Arc<Mutex<HashMap<String, T>>>;

/// Returns the object for a text, and creates it if it is missing.
fn made<T: Clone>(all: &Made<T>, text: String, make: impl FnOnce() -> T) -> T {
    let found = all.lock().expect("no thread panics with the lock").get(&text).cloned();
    found.unwrap_or_else(|| {
        let new = make();
        all.lock().expect("no thread panics with the lock").insert(text, new.clone());
        new
    })
}

impl Engine {
    /// Returns this test's device with depth clamp, the same each time.
    pub(crate) fn shared() -> Self {
        static FREE: Mutex<Vec<Engine>> = Mutex::new(Vec::new());
        fn open() -> Engine {
            Engine::of(open_test_gpu(wgpu::Features::DEPTH_CLIP_CONTROL, wgpu::Limits::default()))
        }
        std::thread_local! {
            static LENT: Lent<Engine> = Lent::new(&FREE, open);
        }
        LENT.with(Lent::get)
    }

    /// Returns this test's device without depth clamp, the same each time.
    pub(crate) fn without_clamp() -> Self {
        static FREE: Mutex<Vec<Engine>> = Mutex::new(Vec::new());
        std::thread_local! {
            static LENT: Lent<Engine> = Lent::new(&FREE, || Engine::open(wgpu::Limits::default()));
        }
        LENT.with(Lent::get)
    }

    /// Ends a test whose counts need corners that are rounded to 1/256 pixel: coarser steps make different
    /// pixels unsure.
    pub(crate) fn require_fine_steps(&self) {
        require_fine_steps(&self.adapter.get_info());
    }

    /// Ends a test whose shaders read depth textures as numbers. OpenGL cannot: naga writes every depth
    /// texture as a comparison sampler, and GLSL cannot load texels from one.
    pub(crate) fn require_depth_loads(&self) {
        self.require_other_than_opengl("loads from depth textures in shaders");
    }

    /// Ends a test with maps that do not begin at the first layer of a texture. wgpu's OpenGL backend has no
    /// texture views: its shaders read a texture from layer 0 on.
    pub(crate) fn require_base_layers(&self) {
        self.require_other_than_opengl("bind groups of a texture's later layers");
    }

    /// Ends a test on OpenGL.
    fn require_other_than_opengl(&self, what: &str) {
        let info = self.adapter.get_info();
        if info.backend == wgpu::Backend::Gl {
            lacking(&info, what);
        }
    }

    /// Ends a test with shadow maps that the adapter cannot draw, or whose depths its shaders cannot read for
    /// PCSS.
    pub(crate) fn require_map(&self, map: &ShadowMapDescriptor) {
        let texture = map.texture();
        self.require(texture.format, texture.usage);
        if map.filter == FilterKind::Pcss && map.format.is_depth() {
            self.require_depth_loads();
        }
    }

    /// Ends a test with compute shaders on devices without them.
    pub(crate) fn require_compute(&self) {
        if !self.compiles_compute() && !self.is_complete() {
            lacking(&self.adapter.get_info(), "compute shaders");
        }
    }

    /// Ends a test whose shader has several uniforms or textures, if wgpu binds all of them as the first one.
    /// In its OpenGL backend, shaders state their binding numbers if the driver lists compute shaders, but
    /// naga writes the numbers only from GLSL 4.20 on. A context of OpenGL 3.3 whose driver lists compute
    /// shaders fails both ways.
    pub(crate) fn require_bindings(&self) {
        let info = self.adapter.get_info();
        let flags = self.adapter.get_downlevel_capabilities().flags;
        let is_old = opengl_version(&info).is_some_and(|version| version < [4, 2]);
        if is_old && flags.contains(wgpu::DownlevelFlags::COMPUTE_SHADERS) {
            lacking(&info, "bindings that shaders number, as GLSL 4.20 does");
        }
    }

    /// Returns whether the adapter has all WebGPU capabilities. If so, a compute shader that does not compile
    /// is an error.
    fn is_complete(&self) -> bool {
        self.adapter.get_downlevel_capabilities().is_webgpu_compliant()
    }

    /// Returns whether wgpu compiles a small compute shader. In OpenGL, flags and limits follow from the
    /// driver's extensions, but wgpu may get GLSL 3.30, which has no compute shaders.
    fn compiles_compute(&self) -> bool {
        *self.compiles_compute.get_or_init(|| {
            // Outside the error scopes: invalid WGSL must not look like a missing capability.
            let module = self.module(COMPUTE);
            let scopes = [wgpu::ErrorFilter::Validation, wgpu::ErrorFilter::Internal]
                .map(|filter| self.device.push_error_scope(filter));
            let _tried = self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: None,
                layout: None,
                module: &module,
                entry_point: Some("write_one"),
                compilation_options: Default::default(),
                cache: None,
            });
            let errors = scopes.into_iter().rev().map(|scope| pollster::block_on(scope.pop()));
            errors.flatten().count() == 0
        })
    }

    /// Opens a separate device without optional features.
    pub(crate) fn open(limits: wgpu::Limits) -> Self {
        Self::of(open_test_gpu(wgpu::Features::empty(), limits))
    }

    pub(crate) fn of(TestGpu { adapter, device, queue }: TestGpu) -> Self {
        Self {
            adapter,
            device,
            queue,
            draws: Made::default(),
            computes: Made::default(),
            compiles_compute: Arc::default(),
        }
    }

    pub(crate) fn encoder(&self) -> wgpu::CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    pub(crate) fn submit(&self, encoder: wgpu::CommandEncoder) {
        self.queue.submit([encoder.finish()]);
    }

    pub(crate) fn buffer<T: NoUninit>(&self, contents: &[T], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        // An empty buffer cannot be bound.
        let contents: &[u8] = if contents.is_empty() { &[0; 32] } else { bytemuck::cast_slice(contents) };
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
    }

    pub(crate) fn texture(
        &self,
        [width, height]: [u32; 2],
        samples: u32,
        format: wgpu::TextureFormat,
        usage: wgpu::TextureUsages,
    ) -> wgpu::TextureView {
        self.require(format, usage);
        // wgpu's OpenGL backend supports several samples only in render buffers: it creates multisampled
        // textures with the target `GL_TEXTURE_2D`, which OpenGL refuses.
        if samples > 1 && usage.contains(wgpu::TextureUsages::TEXTURE_BINDING) {
            self.require_other_than_opengl("multisampled textures that shaders read");
        }
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: samples,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        });
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    }

    /// Ends a test that uses a format in a way that the adapter does not support, although all WebGPU devices
    /// do.
    fn require(&self, format: wgpu::TextureFormat, usage: wgpu::TextureUsages) {
        let missing = usage - self.adapter.get_texture_format_features(format).allowed_usages;
        if !missing.is_empty() {
            lacking(&self.adapter.get_info(), &format!("{missing:?} of {format:?}"));
        }
    }

    fn module(&self, wgsl: &str) -> wgpu::ShaderModule {
        let source = wgpu::ShaderSource::Wgsl(wgsl.into());
        self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source })
    }

    pub(crate) fn layout(&self, groups: &[Option<&wgpu::BindGroupLayout>]) -> wgpu::PipelineLayout {
        self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: groups,
            immediate_size: 0,
        })
    }

    /// Binds resources to the bindings from 0 on.
    pub(crate) fn group<'a>(
        &self,
        layout: &wgpu::BindGroupLayout,
        resources: impl IntoIterator<Item = wgpu::BindingResource<'a>>,
    ) -> wgpu::BindGroup {
        let entry = |(binding, resource)| wgpu::BindGroupEntry { binding, resource };
        let entries: Vec<_> = (0..).zip(resources).map(entry).collect();
        self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
    }

    /// Compiles a compute shader, whose text names its only entry point. Without a layout, the bind group
    /// layouts follow from the shader.
    pub(crate) fn compute_pipeline(
        &self,
        layout: Option<&wgpu::PipelineLayout>,
        wgsl: &str,
        entry: &str,
    ) -> wgpu::ComputePipeline {
        self.require_compute();
        made(&self.computes, wgsl.to_owned(), || {
            self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: None,
                layout,
                module: &self.module(wgsl),
                entry_point: Some(entry),
                compilation_options: Default::default(),
                cache: None,
            })
        })
    }

    /// Returns the texels of all layers of a texture, row by row.
    pub(crate) fn texels<T: Pod>(&self, texture: &wgpu::Texture) -> Vec<T> {
        let flags = self.adapter.get_downlevel_capabilities().flags;
        let copies_depth = flags.contains(wgpu::DownlevelFlags::DEPTH_TEXTURE_AND_BUFFER_COPIES);
        if texture.format().is_depth_stencil_format() && !copies_depth {
            lacking(&self.adapter.get_info(), "copies of depth textures");
        }
        read_back::texels(&self.device, &self.queue, texture)
    }

    /// Submits commands, and returns the final values of a buffer.
    pub(crate) fn values<T: Pod>(&self, mut encoder: wgpu::CommandEncoder, buffer: &wgpu::Buffer) -> Vec<T> {
        let read = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: buffer.size(),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        encoder.copy_buffer_to_buffer(buffer, 0, &read, 0, buffer.size());
        self.submit(encoder);
        read.slice(..).map_async(wgpu::MapMode::Read, |result| result.expect("the buffer can be read"));
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device works");
        bytemuck::pod_collect_to_vec(&read.slice(..).get_mapped_range().expect("the buffer is mapped"))
    }
}

/// Returns the version of OpenGL; `None` for OpenGL ES, and for other backends.
fn opengl_version(info: &wgpu::AdapterInfo) -> Option<[u32; 2]> {
    let mut numbers = info.driver_info.split(['.', ' ']).map(str::parse);
    let version = [numbers.next()?.ok()?, numbers.next()?.ok()?];
    (info.backend == wgpu::Backend::Gl).then_some(version)
}

/// Records a compute pass with one dispatch.
pub(crate) fn dispatch(
    encoder: &mut wgpu::CommandEncoder,
    pipeline: &wgpu::ComputePipeline,
    groups: &[&wgpu::BindGroup],
    workgroups: [u32; 2],
) {
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
    pass.set_pipeline(pipeline);
    for (index, group) in (0..).zip(groups) {
        pass.set_bind_group(index, *group, &[]);
    }
    pass.dispatch_workgroups(workgroups[0], workgroups[1], 1);
}

/// Varying parts of the tests' render pipelines.
#[derive(Debug)]
pub(crate) struct Pipeline<'a> {
    /// Pipeline layout. If `None`, the bind group layouts follow from the shaders.
    pub(crate) layout: Option<&'a wgpu::PipelineLayout>,
    pub(crate) wgsl: &'a str,
    pub(crate) vertex: &'a str,
    pub(crate) buffers: &'a [wgpu::VertexBufferLayout<'a>],
    pub(crate) fragment: Option<&'a str>,
    pub(crate) targets: &'a [Option<wgpu::ColorTargetState>],
    pub(crate) primitive: wgpu::PrimitiveState,
    pub(crate) depth: Option<wgpu::DepthStencilState>,
    pub(crate) multisample: wgpu::MultisampleState,
}

impl<'a> Pipeline<'a> {
    /// Returns a pipeline for triangles with the entry points `vs` and `fs`, without buffers, targets and
    /// depth.
    pub(crate) fn new(wgsl: &'a str) -> Self {
        Self {
            layout: None,
            wgsl,
            vertex: "vs",
            buffers: &[],
            fragment: Some("fs"),
            targets: &[],
            primitive: Default::default(),
            depth: None,
            multisample: Default::default(),
        }
    }

    /// Compiles the pipeline, or returns an earlier one. Pipelines with different layouts need different
    /// texts.
    pub(crate) fn make(mut self, engine: &Engine) -> wgpu::RenderPipeline {
        let layout = self.layout.take();
        let text = format!("{self:?}");
        made(&engine.draws, text, || Self { layout, ..self }.compile(engine))
    }

    fn compile(self, engine: &Engine) -> wgpu::RenderPipeline {
        for target in self.targets.iter().flatten() {
            engine.require(target.format, wgpu::TextureUsages::RENDER_ATTACHMENT);
        }
        let module = engine.module(self.wgsl);
        let fragment = self.fragment.map(|entry| wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets: self.targets,
        });
        engine.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: self.layout,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(self.vertex),
                compilation_options: Default::default(),
                buffers: &self.buffers.iter().cloned().map(Some).collect::<Vec<_>>(),
            },
            primitive: self.primitive,
            depth_stencil: self.depth,
            multisample: self.multisample,
            fragment,
            multiview_mask: None,
            cache: None,
        })
    }
}

/// Returns a vertex buffer layout with consecutive attributes.
pub(crate) fn vertices(
    attributes: &[wgpu::VertexAttribute],
    step_mode: wgpu::VertexStepMode,
) -> wgpu::VertexBufferLayout<'_> {
    let array_stride = attributes.iter().map(|attribute| attribute.format.size()).sum();
    wgpu::VertexBufferLayout { array_stride, step_mode, attributes }
}

/// Begins a render pass that clears its targets.
pub(crate) fn cleared<'encoder>(
    encoder: &'encoder mut wgpu::CommandEncoder,
    colors: &[&wgpu::TextureView],
    depth: Option<ClearedDepth<'_>>,
) -> wgpu::RenderPass<'encoder> {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store };
    let colors: Vec<_> = colors
        .iter()
        .map(|view| Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }))
        .collect();
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &colors,
        depth_stencil_attachment: depth.map(|depth| wgpu::RenderPassDepthStencilAttachment {
            view: depth.view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(depth.value), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}

/// A depth buffer, and its clear value.
#[derive(Clone, Copy)]
pub(crate) struct ClearedDepth<'a> {
    pub(crate) view: &'a wgpu::TextureView,
    pub(crate) value: f32,
}
