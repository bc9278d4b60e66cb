//! A small wgpu engine of its own that takes its sun shadows from `shadowfit` and `shadowfit-wgpu` and nothing else of
//! this workspace: own vertex buffers, own pipelines, own WGSL. It walks a few frames without a window, and the last
//! one is the picture.
//!
//! ```sh
//! cargo run --example engine_integration              # writes out/engine_integration.png
//! cargo run --example engine_integration -- some.png
//! ```
//!
//! What the engine has to do is marked with STEP 1 to STEP 7. The scene stands 50 km from the world's origin, to show
//! that shadows stand still there: shaders get positions relative to the eye.

use std::path::PathBuf;

use anyhow::{Context, Result};
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::need::NeedGrid;
use shadowfit::{Aabb, Boxes, DepthConvention, FitInput, MapFitter, PerspectiveCamera, Technique, Workspace};
use shadowfit_wgpu::need::{NeedPass, NeedView, SeenNeed};
use shadowfit_wgpu::{MapFit, MapView, ShadowMap, ShadowMapDescriptor, WgslOptions, caster_wgsl, receiver_wgsl};
use wgpu::util::DeviceExt;

/// Size of the picture, in pixels; rows of a multiple of 64 pixels are read back without padding.
const SIZE: wgpu::Extent3d = wgpu::Extent3d { width: 960, height: 540, depth_or_array_layers: 1 };
const SAMPLES: u32 = 4;
const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
const SKY: wgpu::Color = wgpu::Color { r: 0.35, g: 0.55, b: 0.85, a: 1.0 };
/// Frames until the picture, and metres that the camera walks in each.
const FRAMES: u32 = 8;
const STEP: f32 = 0.02;
/// Middle of the scene in world space, in metres.
const PLACE: DVec3 = DVec3::new(50_000.0, 0.0, -20_000.0);
/// The way the sun's light travels.
const DIRECTION: Vec3 = Vec3::new(0.55, -0.7, -0.45);

/// View depth at which shadows end, in metres.
const SHADOW_DISTANCE: f32 = 50.0;
/// Bind group of the map's matrix in the shadow pass and of the maps in the shaded one. Any will do: this engine has
/// its camera at group 0 in every pass.
const SHADOW_GROUP: u32 = 1;

/// What the engine's passes have in common: a unit cube, placed and scaled by its instance.
const VERTEX_WGSL: &str = "
struct Vertex {
    @location(0) corner: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) center: vec3<f32>,
    @location(3) half_size: vec3<f32>,
    @location(4) color: vec3<f32>,
}

// Relative to the eye, in metres.
fn position(vertex: Vertex) -> vec3<f32> {
    return vertex.center + vertex.corner * vertex.half_size;
}
";

/// The shadow pass: all that shadowfit asks of it is the position.
const CASTER_WGSL: &str = "
@vertex
fn vs_caster(vertex: Vertex) -> @builtin(position) vec4<f32> {
    return shadowfit_caster_position(position(vertex));
}
";

/// The shaded pass: the sun's part of the light is multiplied by `shadowfit_factor`.
const SCENE_WGSL: &str = "
struct Camera {
    clip_from_world: mat4x4<f32>,
    to_light: vec4<f32>,
}

@group(0) @binding(0) var<uniform> camera: Camera;

struct Varyings {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) color: vec3<f32>,
}

@vertex
fn vs_scene(vertex: Vertex) -> Varyings {
    let position = position(vertex);
    let clip = camera.clip_from_world * vec4<f32>(position, 1.0);
    return Varyings(clip, position, vertex.normal, vertex.color);
}

@fragment
fn fs_scene(in: Varyings) -> @location(0) vec4<f32> {
    let normal = normalize(in.normal);
    let sun = saturate(dot(normal, camera.to_light.xyz)) * shadowfit_factor(in.position, normal);
    let sky = mix(0.06, 0.16, normal.y * 0.5 + 0.5);
    return vec4<f32>(in.color * (sun * vec3<f32>(0.95, 0.88, 0.75) + sky * vec3<f32>(0.7, 0.95, 1.4)), 1.0);
}
";

/// A box of the scene.
struct Block {
    /// World space, in metres.
    center: DVec3,
    /// Half its size, in metres.
    half_size: Vec3,
    /// Linear colour.
    color: [f32; 3],
}

impl Block {
    /// Its bounds relative to a place in world space, in metres. The difference is taken in f64.
    fn bounds(&self, origin: DVec3) -> Aabb {
        let center = (self.center - origin).as_vec3();
        Aabb::new(center - self.half_size, center + self.half_size)
    }
}

/// The engine: its own buffers and pipelines, and the shadow map beside them.
struct Engine {
    device: wgpu::Device,
    queue: wgpu::Queue,
    technique: Technique,
    fitter: MapFitter,
    shadow_map: ShadowMap,
    /// Reads the depth buffer, where the GPU can; and what it found last.
    need_pass: Option<NeedPass>,
    seen: Option<SeenNeed>,
    caster_pipeline: wgpu::RenderPipeline,
    scene_pipeline: wgpu::RenderPipeline,
    camera_uniform: wgpu::Buffer,
    camera_group: wgpu::BindGroup,
    cube: wgpu::Buffer,
}

fn main() -> Result<()> {
    let path = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("out/engine_integration.png"), PathBuf::from);
    let mut camera = PerspectiveCamera {
        eye: PLACE + DVec3::new(-3.0, 5.5, 14.5),
        forward: Vec3::new(0.12, -0.26, -1.0).normalize(),
        up: Vec3::Y,
        fov_y: 0.8,
        aspect: SIZE.width as f32 / SIZE.height as f32,
        near: 0.1,
        far: 200.0,
    };
    let mut engine = pollster::block_on(Engine::new())?;
    let blocks = blocks();
    let mut pixels = engine.draw(&camera, &blocks)?;
    for _ in 1..FRAMES {
        camera.eye += (camera.forward * STEP).as_dvec3();
        pixels = engine.draw(&camera, &blocks)?;
    }
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    }
    image::save_buffer(&path, &pixels, SIZE.width, SIZE.height, image::ColorType::Rgba8)
        .with_context(|| format!("cannot write {}", path.display()))?;
    println!("wrote {}", path.display());
    Ok(())
}

/// A floor, a gate, a crate, a row of posts, and a tower that is out of the picture but whose shadow is in it.
fn blocks() -> Vec<Block> {
    let block = |center: [f64; 3], size: [f32; 3], color| Block {
        center: PLACE + DVec3::from(center),
        half_size: Vec3::from(size) * 0.5,
        color,
    };
    let mut blocks = vec![
        block([0.0, -0.25, 0.0], [60.0, 0.5, 60.0], [0.42, 0.38, 0.30]),
        block([-3.0, 2.0, 0.0], [1.0, 4.0, 1.0], [0.70, 0.64, 0.52]),
        block([3.0, 2.0, 0.0], [1.0, 4.0, 1.0], [0.70, 0.64, 0.52]),
        block([0.0, 4.4, 0.0], [8.0, 0.8, 1.4], [0.60, 0.16, 0.09]),
        block([5.5, 0.75, 4.0], [1.5, 1.5, 1.5], [0.10, 0.28, 0.55]),
        block([-15.0, 6.0, 9.0], [2.0, 12.0, 2.0], [0.70, 0.64, 0.52]),
    ];
    blocks.extend(
        (0..9).map(|index| block([f64::from(index) * 2.0 - 8.0, 0.6, -5.0], [0.25, 1.2, 0.25], [0.16, 0.36, 0.12])),
    );
    blocks
}

impl Engine {
    async fn new() -> Result<Self> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let adapter = instance.request_adapter(&wgpu::RequestAdapterOptions::default()).await?;
        let (device, queue) = adapter.request_device(&wgpu::DeviceDescriptor::default()).await?;

        // STEP 1: choose a technique and make its shadow maps, and the pass that reads the engine's depth buffer for the
        // next frame's. The recommended technique has four maps of 2048² texels with 32-bit depth, and a tent of 5×5.
        let technique = Technique::default().with_max_distance(SHADOW_DISTANCE);
        let shadow_map = ShadowMap::new(&device, &ShadowMapDescriptor::from(&technique))?;
        // OpenGL cannot: maps are placed by the boxes then, which is slower and less sharp.
        let need_pass = NeedPass::new(&device, &queue, SAMPLES).ok();

        let camera_uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("camera"),
            size: size_of::<[f32; 20]>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let camera_layout = camera_layout(&device);
        let camera_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("camera"),
            layout: &camera_layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: camera_uniform.as_entire_binding() }],
        });
        let cube = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("cube"),
            contents: bytemuck::cast_slice(&cube()),
            usage: wgpu::BufferUsages::VERTEX,
        });
        let caster_pipeline = caster_pipeline(&device, &camera_layout, &shadow_map);
        let scene_pipeline = scene_pipeline(&device, &camera_layout, &shadow_map);
        let fitter = MapFitter::new();
        Ok(Self {
            device,
            queue,
            technique,
            fitter,
            shadow_map,
            need_pass,
            seen: None,
            caster_pipeline,
            scene_pipeline,
            camera_uniform,
            camera_group,
            cube,
        })
    }

    /// Draws a picture and returns its sRGB pixels.
    fn draw(&mut self, camera: &PerspectiveCamera, blocks: &[Block]) -> Result<Vec<u8>> {
        self.fit_maps(camera, blocks)?;
        let clip_from_world = camera.clip_from_world(DepthConvention::ZeroToOne).to_cols_array();
        let to_light = (-DIRECTION.normalize()).extend(0.0).to_array();
        self.queue.write_buffer(&self.camera_uniform, 0, bytemuck::cast_slice(&clip_from_world));
        self.queue.write_buffer(&self.camera_uniform, 64, bytemuck::cast_slice(&to_light));
        let instances = self.instances(camera.eye, blocks);

        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.shadow_pass(&mut encoder, camera.eye, blocks, &instances);
        let (picture, depth) = self.scene_pass(&mut encoder, blocks.len() as u32, &instances);
        self.read_depth(&mut encoder, camera, &depth)?;
        self.read(encoder, &picture)
    }

    /// STEP 4: each frame, fit the maps to what the camera sees of the scene's boxes and hand them over, each with its
    /// bias, and with the origin that positions in the engine's shaders are relative to: here the eye, where f32 is
    /// most exact. What an earlier frame showed, as far as it has come back, says where fine texels help; the fitter
    /// keeps the maps still while the camera moves.
    fn fit_maps(&mut self, camera: &PerspectiveCamera, blocks: &[Block]) -> Result<()> {
        if let Some(pass) = &mut self.need_pass {
            self.seen = pass.take()?.or(self.seen.take());
        }
        let grids: Vec<NeedGrid> = self.seen.iter().map(SeenNeed::grid).collect();
        let views = [camera.frustum()?];
        let objects: Vec<Aabb> = blocks.iter().map(|block| block.bounds(PLACE)).collect();
        let boxes = Boxes { origin: PLACE, boxes: &objects };
        let input =
            FitInput { receivers: Some(boxes), casters: Some(boxes), need: &grids, ..FitInput::new(&views, DIRECTION) };
        let mut storage = vec![DVec2::ZERO; Workspace::required(objects.len(), views.len())];
        let fitted = self.fitter.fit(&input, &self.technique, &mut Workspace::new(&mut storage))?;

        let mut maps: Vec<MapFit> = fitted.iter().map(MapFit::from).collect();
        let view = MapView::from_eye(camera.eye, camera.forward);
        // Leave out casters whose shadows are not in view. Without this line each map draws all that it can store.
        MapFit::sweep(&mut maps, &view, &views, self.shadow_map.descriptor())?;
        self.shadow_map.prepare(&self.queue, &view, &maps)?;
        Ok(())
    }

    /// The blocks with their centres relative to the eye. The difference is taken in f64.
    fn instances(&self, eye: DVec3, blocks: &[Block]) -> wgpu::Buffer {
        let instances: Vec<[[f32; 3]; 3]> = blocks
            .iter()
            .map(|block| [(block.center - eye).as_vec3().to_array(), block.half_size.to_array(), block.color])
            .collect();
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("instances"),
            contents: bytemuck::cast_slice(&instances),
            usage: wgpu::BufferUsages::VERTEX,
        })
    }

    /// STEP 5: draw the casters into each map. The pass comes cleared, with the map's matrix bound.
    fn shadow_pass(&self, encoder: &mut wgpu::CommandEncoder, eye: DVec3, blocks: &[Block], instances: &wgpu::Buffer) {
        self.shadow_map.render(encoder, SHADOW_GROUP, |pass, _map, volume| {
            pass.set_pipeline(&self.caster_pipeline);
            pass.set_bind_group(0, &self.camera_group, &[]);
            pass.set_vertex_buffer(0, self.cube.slice(..));
            pass.set_vertex_buffer(1, instances.slice(..));
            for (index, block) in (0u32..).zip(blocks) {
                // The volume, like all positions, is relative to the eye.
                let bounds = block.bounds(eye);
                if volume.intersects_aabb(bounds.min, bounds.max) {
                    pass.draw(0..36, index..index + 1);
                }
            }
        });
    }

    /// The picture, and a view of its depth buffer.
    fn scene_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        count: u32,
        instances: &wgpu::Buffer,
    ) -> (wgpu::Texture, wgpu::TextureView) {
        let picture = self.target(COLOR, 1);
        let [view, multisampled, depth] = [&picture, &self.target(COLOR, SAMPLES), &self.target(DEPTH, SAMPLES)]
            .map(|texture| texture.create_view(&wgpu::TextureViewDescriptor::default()));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &multisampled,
                depth_slice: None,
                resolve_target: Some(&view),
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(SKY), store: wgpu::StoreOp::Discard },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.scene_pipeline);
        pass.set_bind_group(0, &self.camera_group, &[]);
        // STEP 6: bind the maps where the pasted WGSL looks for them.
        pass.set_bind_group(SHADOW_GROUP, self.shadow_map.receiver_group(), &[]);
        pass.set_vertex_buffer(0, self.cube.slice(..));
        pass.set_vertex_buffer(1, instances.slice(..));
        pass.draw(0..36, 0..count);
        drop(pass);
        (picture, depth)
    }

    /// STEP 7: count what the picture shows, for the fits of the next frames. The depth buffer must be stored and be a
    /// texture that shaders can read. Nothing waits: the counts come back a frame or two late.
    fn read_depth(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        camera: &PerspectiveCamera,
        depth: &wgpu::TextureView,
    ) -> Result<()> {
        let (fit, size) = (&self.technique.fit, [SIZE.width, SIZE.height]);
        let view = NeedView::from_camera(camera, DepthConvention::ZeroToOne, DIRECTION, fit, size)?;
        if let Some(pass) = &mut self.need_pass {
            pass.record(encoder, depth, &view, None)?;
        }
        Ok(())
    }

    fn target(&self, format: wgpu::TextureFormat, samples: u32) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("target"),
            size: SIZE,
            mip_level_count: 1,
            sample_count: samples,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                | if samples == 1 { wgpu::TextureUsages::COPY_SRC } else { wgpu::TextureUsages::TEXTURE_BINDING },
            view_formats: &[],
        })
    }

    /// Submits the frame, waits for it and copies its pixels.
    fn read(&self, mut encoder: wgpu::CommandEncoder, picture: &wgpu::Texture) -> Result<Vec<u8>> {
        let row = SIZE.width * 4;
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read back"),
            size: u64::from(row * SIZE.height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let destination = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(picture.as_image_copy(), destination, SIZE);
        self.queue.submit([encoder.finish()]);
        buffer.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        Ok(buffer.slice(..).get_mapped_range()?.to_vec())
    }
}

/// STEP 2: a pipeline for the casters, with the engine's own vertices, the map's depth state and, for colour formats,
/// its colour target. The map's matrix is at a bind group of the engine's choice. Both sides of the casters are drawn.
fn caster_pipeline(device: &wgpu::Device, camera: &wgpu::BindGroupLayout, map: &ShadowMap) -> wgpu::RenderPipeline {
    let module = module(
        device,
        [caster_wgsl(map.descriptor(), &WgslOptions::group(SHADOW_GROUP)).as_str(), VERTEX_WGSL, CASTER_WGSL].concat(),
    );
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("caster"),
        bind_group_layouts: &[Some(camera), Some(map.caster_layout())],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("caster"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs_caster"),
            compilation_options: Default::default(),
            buffers: &vertex_buffers(),
        },
        primitive: map.primitive_state(),
        depth_stencil: Some(map.depth_stencil_state()),
        multisample: wgpu::MultisampleState::default(),
        fragment: None, // The default format is a depth texture: nothing but depth is written.
        multiview_mask: None,
        cache: None,
    })
}

/// STEP 3: paste the look-up into the engine's own shader, in a bind group of its choice, and put the map's layout
/// into the pipeline.
fn scene_pipeline(device: &wgpu::Device, camera: &wgpu::BindGroupLayout, map: &ShadowMap) -> wgpu::RenderPipeline {
    let receiver = receiver_wgsl(map.descriptor(), &WgslOptions::group(SHADOW_GROUP));
    let module = module(device, [receiver.as_str(), VERTEX_WGSL, SCENE_WGSL].concat());
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("scene"),
        bind_group_layouts: &[Some(camera), Some(map.receiver_layout())],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("scene"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs_scene"),
            compilation_options: Default::default(),
            buffers: &vertex_buffers(),
        },
        primitive: wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState { count: SAMPLES, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fs_scene"),
            compilation_options: Default::default(),
            targets: &[Some(COLOR.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn camera_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("camera"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    })
}

fn module(device: &wgpu::Device, wgsl: String) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(wgsl.into()),
    })
}

/// Corners and normals from one buffer, instances from another.
fn vertex_buffers() -> [Option<wgpu::VertexBufferLayout<'static>>; 2] {
    const CUBE: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3];
    const INSTANCE: [wgpu::VertexAttribute; 3] =
        wgpu::vertex_attr_array![2 => Float32x3, 3 => Float32x3, 4 => Float32x3];
    [(wgpu::VertexStepMode::Vertex, 24, &CUBE[..]), (wgpu::VertexStepMode::Instance, 36, &INSTANCE[..])].map(
        |(step_mode, array_stride, attributes)| Some(wgpu::VertexBufferLayout { array_stride, step_mode, attributes }),
    )
}

/// The cube from -1 to 1: 36 corners with normals, counter-clockwise seen from outside.
fn cube() -> Vec<[[f32; 3]; 2]> {
    let normals = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    let faces = normals.map(|normal| {
        let right = Vec3::new(normal.y, normal.z, normal.x);
        let up = normal.cross(right);
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(u, v)| [(normal + right * u + up * v).to_array(), normal.to_array()])
    });
    faces.concat()
}
