//! An engine of a few lines: boxes that cast, a ground that is looked up from above, and a device that reports no error.

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::{Aabb, Boxes, PerspectiveCamera, ViewFrustum};
use shadowfit_render::Gpu;
use shadowfit_wgpu::{Casters, SunFrame, SunShadows, WgslOptions, caster_wgsl, receiver_wgsl};
use wgpu::util::DeviceExt;

use crate::shaders::read_back::texels;
use crate::support::software_gpu;

/// The camera's eye.
pub(super) const EYE: DVec3 = DVec3::new(0.0, 6.0, 9.0);

/// The ways that two suns' light travels.
pub(super) const SUN: Vec3 = Vec3::new(0.5, -1.0, 0.0);
pub(super) const MOON: Vec3 = Vec3::new(-0.5, -1.0, 0.0);

/// The ground, a block over its middle, and a post at its side.
pub(super) const BOXES: [Aabb; 3] = [
    Aabb { min: Vec3::new(-10.0, -0.5, -10.0), max: Vec3::new(10.0, 0.0, 10.0) },
    Aabb { min: Vec3::new(-0.75, 1.5, -0.75), max: Vec3::new(0.75, 2.5, 0.75) },
    Aabb { min: Vec3::new(-6.0, 0.0, -4.0), max: Vec3::new(-5.0, 2.0, -3.0) },
];

/// Pixels along a side of a picture, and metres of the ground.
pub(super) const SIDE: u32 = 64;
const GROUND: f32 = 16.0;

const CASTER: &str = "
@vertex fn vs_PREFIX(
    @location(0) corner: vec3<f32>, @location(1) low: vec3<f32>, @location(2) high: vec3<f32>,
) -> @builtin(position) vec4<f32> {
    return PREFIX_caster_position(mix(low, high, corner));
}
";

/// What colour formats need beside it.
const COLOR: &str = "
@fragment fn fs_PREFIX(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    return PREFIX_caster_color(at.z);
}
";

/// Factors at a pixel of the ground.
const FACTORS_WGSL: &str = "
fn factors(pixel: vec2<f32>) -> vec4<f32> {
    let place = (pixel / SIDE - 0.5) * GROUND;
    let position = vec3<f32>(place.x, 0.0, place.y);
    let normal = vec3<f32>(0.0, 1.0, 0.0);
    return vec4<f32>(FACTORS);
}
";

const GROUND_WGSL: &str = "
@vertex fn vs(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}
@fragment fn fs(@builtin(position) pixel: vec4<f32>) -> @location(0) vec4<f32> {
    return factors(pixel.xy);
}
";

pub(super) fn camera(eye: DVec3) -> PerspectiveCamera {
    PerspectiveCamera {
        eye,
        forward: (-eye).as_vec3().normalize(),
        up: Vec3::Y,
        fov_y: 1.2,
        aspect: 1.5,
        near: 0.1,
        far: 60.0,
    }
}

/// A frame of boxes that stand still, all of which cast and receive. Positions in shaders are world space.
pub(super) fn frame_of<'a>(views: &'a [ViewFrustum], direction: Vec3, boxes: &'a [Aabb]) -> SunFrame<'a> {
    let boxes = Boxes { origin: DVec3::ZERO, boxes };
    SunFrame::new(views, direction, boxes, Casters::fixed(boxes)).with_origin(DVec3::ZERO)
}

/// A device.
pub(super) struct Device {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
}

impl From<Gpu> for Device {
    fn from(gpu: Gpu) -> Self {
        Self { device: gpu.device, queue: gpu.queue }
    }
}

impl Device {
    /// The software adapter with no more than WebGL2 has.
    pub(super) fn with_webgl2_limits() -> Self {
        let (device, queue) = pollster::block_on(software_gpu().adapter.request_device(&wgpu::DeviceDescriptor {
            required_limits: wgpu::Limits::downlevel_webgl2_defaults(),
            ..Default::default()
        }))
        .expect("a device of fewer limits");
        assert_eq!(device.features(), wgpu::Features::empty());
        assert_eq!(device.limits().max_compute_workgroups_per_dimension, 0);
        Self { device, queue }
    }

    /// A view of a depth buffer.
    pub(super) fn depth_texture(&self) -> wgpu::TextureView {
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT;
        self.texture(wgpu::TextureFormat::Depth32Float, usage).create_view(&wgpu::TextureViewDescriptor::default())
    }

    pub(super) fn texture(&self, format: wgpu::TextureFormat, usage: wgpu::TextureUsages) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: SIDE, height: SIDE, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    }

    pub(super) fn module(&self, wgsl: String) -> wgpu::ShaderModule {
        let source = wgpu::ShaderSource::Wgsl(wgsl.into());
        self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source })
    }

    fn vertices(&self, vertices: &[Vec3]) -> wgpu::Buffer {
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: bytemuck::cast_slice(vertices),
            usage: wgpu::BufferUsages::VERTEX,
        })
    }

    pub(super) fn layout(&self, groups: &[Option<&wgpu::BindGroupLayout>]) -> wgpu::PipelineLayout {
        self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: groups,
            immediate_size: 0,
        })
    }
}

/// Takes note of what a device reports.
pub(super) struct Quiet {
    memory: wgpu::ErrorScopeGuard,
    validation: wgpu::ErrorScopeGuard,
    internal: wgpu::ErrorScopeGuard,
}

impl Quiet {
    pub(super) fn new(device: &Device) -> Self {
        let scope = |filter| device.device.push_error_scope(filter);
        let memory = scope(wgpu::ErrorFilter::OutOfMemory);
        let validation = scope(wgpu::ErrorFilter::Validation);
        Self { memory, validation, internal: scope(wgpu::ErrorFilter::Internal) }
    }

    /// Nothing was reported.
    pub(super) fn assert(self, what: &str) {
        for scope in [self.internal, self.validation, self.memory] {
            let error = pollster::block_on(scope.pop());
            assert!(error.is_none(), "{what}: {error:?}");
        }
    }
}

/// How the WGSL of a sun fits into a shader.
fn options(group: u32, prefix: &str) -> WgslOptions<'_> {
    WgslOptions::group(group).with_prefix(prefix).expect("a prefix")
}

/// WGSL of the function `factors`, which looks up to four suns up: each with its bind group and its prefix.
pub(super) fn factors_wgsl(suns: &[(&SunShadows, u32, &'static str)]) -> String {
    let look_up = |(sun, group, prefix): &(&SunShadows, u32, &str)| {
        receiver_wgsl(sun.map().descriptor(), &options(*group, prefix))
    };
    let mut factors: Vec<String> =
        suns.iter().map(|(_, _, prefix)| format!("{prefix}_factor(position, normal)")).collect();
    factors.resize(4, "1.0".to_owned());
    let wgsl = FACTORS_WGSL
        .replace("FACTORS", &factors.join(", "))
        .replace("SIDE", &format!("{SIDE}.0"))
        .replace("GROUND", &format!("{GROUND:?}"));
    suns.iter().map(look_up).collect::<String>() + &wgsl
}

/// Draws the casters of up to four suns, and the ground by their factors.
pub(super) struct Painter {
    casters: Vec<wgpu::RenderPipeline>,
    ground: wgpu::RenderPipeline,
    cube: wgpu::Buffer,
}

/// Factors of each sun over the ground.
#[derive(Debug, PartialEq)]
pub(super) struct Picture(Vec<[u8; 4]>);

impl Picture {
    /// At a place of the ground, in metres.
    pub(super) fn at(&self, place: [f32; 2]) -> [u8; 4] {
        let [x, y] = place.map(|metres| ((metres / GROUND + 0.5) * SIDE as f32) as usize);
        self.0[y * SIDE as usize + x]
    }

    /// All factors.
    pub(super) fn values(&self) -> impl Iterator<Item = u8> {
        self.0.iter().flatten().copied()
    }

    /// Those of one sun.
    pub(super) fn of(&self, sun: usize) -> impl Iterator<Item = u8> {
        self.0.iter().map(move |factors| factors[sun])
    }

    /// The greatest difference from another picture.
    pub(super) fn difference(&self, other: &Self) -> u8 {
        let pixels = self.0.iter().flatten().zip(other.0.iter().flatten());
        pixels.map(|(a, b)| a.abs_diff(*b)).max().unwrap_or_default()
    }
}

impl Painter {
    /// Pipelines for suns with the prefixes of their names, whose texts stand in one module, each at a bind group of
    /// its own.
    pub(super) fn new(device: &Device, suns: &[(&SunShadows, &'static str)]) -> Self {
        let at_groups: Vec<_> = (0..).zip(suns).map(|(group, (sun, prefix))| (*sun, group, *prefix)).collect();
        let groups: Vec<_> = suns.iter().map(|(sun, _)| Some(sun.map().receiver_layout())).collect();
        Self::with_layout(device, &at_groups, &device.layout(&groups))
    }

    /// The same for suns at any bind groups.
    pub(super) fn with_layout(
        device: &Device,
        suns: &[(&SunShadows, u32, &'static str)],
        layout: &wgpu::PipelineLayout,
    ) -> Self {
        let caster = |(sun, _, prefix): &(&SunShadows, u32, &str)| {
            let color = if sun.map().color_target().is_some() { COLOR } else { "" };
            caster_wgsl(sun.map().descriptor(), &options(0, prefix))
                + &[CASTER, color].concat().replace("PREFIX", prefix)
        };
        let module = device.module(suns.iter().map(caster).collect());
        let casters = suns.iter().map(|(sun, _, prefix)| caster_pipeline(device, &module, sun, prefix)).collect();
        let module = device.module(factors_wgsl(suns) + GROUND_WGSL);
        let ground = ground_pipeline(device, &module, layout);
        Self { casters, ground, cube: device.vertices(&cube()) }
    }

    /// Draws a frame of suns, each with the boxes that were given to it.
    pub(super) fn draw(&self, device: &Device, suns: &[(&SunShadows, &[Aabb])]) -> Picture {
        let groups: Vec<_> = suns.iter().map(|(sun, _)| sun.receiver_group()).collect();
        self.draw_with(device, suns, &groups)
    }

    /// The same with these bind groups for the ground.
    pub(super) fn draw_with(
        &self,
        device: &Device,
        suns: &[(&SunShadows, &[Aabb])],
        groups: &[&wgpu::BindGroup],
    ) -> Picture {
        let mut encoder = device.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.draw_casters(device, &mut encoder, suns);
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let picture = device.texture(wgpu::TextureFormat::Rgba8Unorm, usage);
        let view = picture.create_view(&wgpu::TextureViewDescriptor::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.ground);
        for (group, bound) in (0..).zip(groups) {
            pass.set_bind_group(group, *bound, &[]);
        }
        pass.draw(0..3, 0..1);
        drop(pass);
        read(device, encoder, &picture)
    }

    /// Draws the casters of suns into their maps.
    pub(super) fn draw_casters(
        &self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        suns: &[(&SunShadows, &[Aabb])],
    ) {
        for index in 0..suns.len() {
            self.draw_one(device, encoder, suns, index);
        }
    }

    /// Draws the casters of one of the suns.
    pub(super) fn draw_one(
        &self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        suns: &[(&SunShadows, &[Aabb])],
        index: usize,
    ) {
        let ((sun, boxes), pipeline) = (suns[index], &self.casters[index]);
        let corners: Vec<Vec3> = boxes.iter().flat_map(|aabb| [aabb.min, aabb.max]).collect();
        let instances = device.vertices(if corners.is_empty() { &[Vec3::ZERO; 2] } else { &corners });
        sun.render(encoder, 0, |pass, piece| {
            pass.set_pipeline(pipeline);
            pass.set_vertex_buffer(0, self.cube.slice(..));
            pass.set_vertex_buffer(1, instances.slice(..));
            for number in piece.casters {
                pass.draw(0..36, *number..number + 1);
            }
        });
    }
}

/// Submits what was recorded, and waits for the picture.
pub(super) fn read(device: &Device, encoder: wgpu::CommandEncoder, picture: &wgpu::Texture) -> Picture {
    device.queue.submit([encoder.finish()]);
    Picture(texels(&device.device, &device.queue, picture))
}

fn caster_pipeline(
    device: &Device,
    module: &wgpu::ShaderModule,
    sun: &SunShadows,
    prefix: &str,
) -> wgpu::RenderPipeline {
    let map = sun.map();
    let layout = device.layout(&[Some(map.caster_layout())]);
    let (color, entry) = (map.color_target().map(Some), format!("fs_{prefix}"));
    let buffer =
        |array_stride, step_mode, attributes| Some(wgpu::VertexBufferLayout { array_stride, step_mode, attributes });
    device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(&format!("vs_{prefix}")),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[
                buffer(12, wgpu::VertexStepMode::Vertex, &wgpu::vertex_attr_array![0 => Float32x3]),
                buffer(24, wgpu::VertexStepMode::Instance, &wgpu::vertex_attr_array![1 => Float32x3, 2 => Float32x3]),
            ],
        },
        primitive: map.primitive_state(),
        depth_stencil: Some(map.depth_stencil_state()),
        multisample: wgpu::MultisampleState::default(),
        fragment: color.as_ref().map(|color| wgpu::FragmentState {
            module,
            entry_point: Some(&entry),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: core::slice::from_ref(color),
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn ground_pipeline(
    device: &Device,
    module: &wgpu::ShaderModule,
    layout: &wgpu::PipelineLayout,
) -> wgpu::RenderPipeline {
    device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vs"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("fs"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::TextureFormat::Rgba8Unorm.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// The triangles of a cube from 0 to 1, of any winding.
fn cube() -> Vec<Vec3> {
    let face = |axis: usize, side: f32| {
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[u, v]| {
            let mut corner = [0.0; 3];
            (corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (side, u, v);
            Vec3::from(corner)
        })
    };
    (0..3).flat_map(|axis| [face(axis, 0.0), face(axis, 1.0)]).flatten().collect()
}
