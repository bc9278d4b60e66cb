//! A small wgpu engine that uses `shadowfit-wgpu` for its sun shadows: four maps, placed where they improve
//! the most visible pixels and cached where nothing moves. It renders a short camera walk without a window
//! and saves the last frame.
//!
//! ```sh
//! cargo run --example engine_integration              # writes out/engine_integration.png
//! cargo run --example engine_integration -- some.png
//! cargo run --example engine_integration -- --exact   # writes out/engine_integration_exact.png
//! ```
//!
//! The engine does not know shadowfit. It uses the maths crate ultraviolet, whose types are converted through
//! mint. Its shaders use f32 positions relative to the kilometre cell of the world that contains the camera.
//! Its depth buffer is reversed and has no far plane. It renders HDR colours with 4× MSAA, and a separate
//! pass maps them to the screen. The scene is 50 km from the world's origin, to show that shadows do not
//! jitter there.
//!
//! STEP 1 to STEP 10 mark the code that the engine needs for its shadows. Each part begins at its comment and
//! ends at the next empty line. The option `--exact` turns on exact edges: rays decide the pixels where the
//! maps are unsure. EXACT marks the code for it; most of it is in `engine_integration/exact.rs`. A test
//! counts the lines of both.

#[path = "engine_integration/exact.rs"]
mod exact;
#[path = "engine_integration/gpu.rs"]
mod gpu;
#[path = "engine_integration/scene.rs"]
mod scene;

use std::path::PathBuf;

use anyhow::{Context, Result};
use ultraviolet::projection::rh_yup::perspective_reversed_infinite_z_wgpu_dx_gl as perspective;
use ultraviolet::{DVec3, Mat4, Vec3, Vec4};

use exact::Exact;
use gpu::{DEPTH, Gpu, HDR, Pipeline, SAMPLES, SIZE, SRGB};
use scene::{PLACE, Scene, relative};

// STEP 1: use the two crates. If the engine's maths is not glam, enable the feature `mint` of the first one.
use shadowfit::mint::{dvec3, frustum_from_eye_from_clip, mat4, vec3};
use shadowfit::{Aabb, Boxes, DepthConvention, Technique};
use shadowfit_wgpu::{Casters, SunFrame, SunShadows, WgslOptions, caster_wgsl, receiver_wgsl};

// EXACT edges: import the setting.
use shadowfit::settings::Edges;

/// Command-line option for exact edges.
const EXACT: &str = "--exact";
/// Number of frames before the picture is saved.
const FRAMES: u32 = 12;
/// Direction of travel of the sunlight.
const SUNLIGHT: Vec3 = Vec3 { x: 0.72, y: -0.55, z: -0.28 };
/// View depth up to which shadows are drawn, in metres.
const DISTANCE: f32 = 90.0;

/// WGSL of the engine's vertices: a mesh, placed and scaled by its instance, relative to the cell of the
/// world.
const VERTEX: &str = "
struct Vertex {
    @location(0) corner: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) center: vec3<f32>,
    @location(3) half_size: vec3<f32>,
    @location(4) color: vec4<f32>,
}
";

// STEP 3: write a vertex shader for the casters. It only has to output the position.
const CASTER: &str = "
@vertex fn vs(vertex: Vertex) -> @builtin(position) vec4<f32> {
    return shadowfit_caster_position(vertex.center + vertex.corner * vertex.half_size);
}
";

/// WGSL that draws HDR colours. Alpha is 1 where a surface was drawn.
const SHADED: &str = "
struct Camera {
    clip_from_cell: mat4x4<f32>,
    eye: vec4<f32>,
    to_light: vec4<f32>,
}
@group(0) @binding(0) var<uniform> camera: Camera;

struct Varyings {
    @builtin(position) @invariant clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) color: vec4<f32>,
}

@vertex fn vs(vertex: Vertex) -> Varyings {
    let position = vertex.center + vertex.corner * vertex.half_size;
    let clip = camera.clip_from_cell * vec4<f32>(position, 1.0);
    return Varyings(clip, position, vertex.normal / vertex.half_size, vertex.color);
}

@fragment fn fs(in: Varyings) -> @location(0) vec4<f32> {
    let normal = normalize(in.normal);
    let distance = length(in.position - camera.eye.xyz);
    let tile = vec2<i32>(floor(in.position.xz / 2.0));
    let contrast = in.color.a * exp(-distance / 40.0) * step(0.5, normal.y);
    let color = in.color.rgb * (1.0 + contrast * f32(((tile.x + tile.y) & 1) * 2 - 1));
    var sun = vec3<f32>(9.5, 7.6, 5.2) * saturate(dot(normal, camera.to_light.xyz));
    // STEP 6: multiply the sun's light by the shadow factor.
    sun *= shadowfit_factor(in.position, normal);

    let sky = mix(vec3<f32>(0.55, 0.42, 0.30), vec3<f32>(0.75, 1.05, 1.70), normal.y * 0.5 + 0.5);
    let haze = 1.0 - exp(-max(distance - 30.0, 0.0) / 260.0);
    return vec4<f32>(mix(color * (sun + sky), vec3<f32>(2.2, 2.5, 2.9), haze), 1.0);
}
";

/// WGSL that maps HDR colours to the screen, over a sky. The curve is Krzysztof Narkowicz's fit of ACES,
/// 2015.
const TONE: &str = "
@group(0) @binding(0) var hdr: texture_2d<f32>;

@vertex fn vs(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment fn fs(@builtin(position) pixel: vec4<f32>) -> @location(0) vec4<f32> {
    let texel = textureLoad(hdr, vec2<i32>(pixel.xy), 0);
    let height = saturate(1.0 - pixel.y / f32(textureDimensions(hdr).y) * 2.0);
    let sky = mix(vec3<f32>(2.2, 2.5, 2.9), vec3<f32>(0.55, 1.05, 2.4), sqrt(height));
    let x = (texel.rgb + sky * (1.0 - texel.a)) * 0.15;
    return vec4<f32>(saturate(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)), 1.0);
}
";

/// The camera.
struct Camera {
    /// World space, in metres.
    eye: DVec3,
    forward: Vec3,
}

impl Camera {
    /// Returns the matrix from positions relative to the eye to clip space.
    fn clip_from_eye(&self) -> Mat4 {
        let turn = Mat4::look_at(Vec3::zero(), self.forward, Vec3::unit_y());
        perspective(0.75, SIZE.width as f32 / SIZE.height as f32, 0.1) * turn
    }

    /// Returns the origin of the kilometre cell that contains the camera. Positions in shaders are relative
    /// to it.
    fn cell(&self) -> DVec3 {
        self.eye.map(|x| (x / 1024.0).floor() * 1024.0)
    }
}

/// Render targets.
struct Targets {
    multisampled: wgpu::TextureView,
    depth: wgpu::TextureView,
    hdr: wgpu::TextureView,
    picture: wgpu::TextureView,
}

struct Engine {
    gpu: Gpu,
    scene: Scene,
    targets: Targets,
    /// The camera's uniform buffer and its bind group.
    camera: (wgpu::Buffer, wgpu::BindGroup),
    scene_pipeline: wgpu::RenderPipeline,
    tone: (wgpu::RenderPipeline, wgpu::BindGroup),
    exact: Option<Exact>,
    // STEP 2: store one object for each sun, and the pipeline for casters.
    sun: SunShadows,
    caster_pipeline: wgpu::RenderPipeline,
}

fn main() -> Result<()> {
    let (options, files): (Vec<String>, Vec<String>) = std::env::args().skip(1).partition(|word| word == EXACT);
    let is_exact = !options.is_empty();
    let usual = if is_exact { "out/engine_integration_exact.png" } else { "out/engine_integration.png" };
    let path = PathBuf::from(files.first().map_or(usual, String::as_str));
    let forward = Vec3::new(0.26, -0.14, -1.0).normalized();
    let mut camera = Camera { eye: PLACE + DVec3::new(-8.0, 3.4, 15.5), forward };
    let mut engine = Engine::new(pollster::block_on(Gpu::open())?, is_exact)?;
    for frame in 0..FRAMES {
        camera.eye += DVec3::new(0.02, 0.0, -0.02);
        let drawn = engine.draw(&camera, frame)?;
        println!("frame {frame}: {drawn} draws into the maps, of {} objects", engine.scene.objects.len());
        if let Some(exact) = &mut engine.exact {
            println!("  edges: {}", exact.report());
        }
    }
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).with_context(|| format!("cannot create {}", folder.display()))?;
    }
    let pixels = engine.gpu.read(&engine.targets.picture)?;
    image::save_buffer(&path, &pixels, SIZE.width, SIZE.height, image::ColorType::Rgba8)
        .with_context(|| format!("cannot write {}", path.display()))?;
    println!("wrote {}", path.display());
    Ok(())
}

impl Engine {
    fn new(gpu: Gpu, is_exact: bool) -> Result<Self> {
        let scene = Scene::new(&gpu);
        let uniform = wgpu::BufferBindingType::Uniform;
        let camera_layout =
            gpu.layout(wgpu::BindingType::Buffer { ty: uniform, has_dynamic_offset: false, min_binding_size: None });
        let camera_uniform = gpu.buffer(&[0; 96], wgpu::BufferUsages::UNIFORM);
        let camera_group = gpu.group(&camera_layout, camera_uniform.as_entire_binding());
        let camera = (camera_uniform, camera_group);
        let targets = Targets {
            multisampled: gpu.target(HDR, SAMPLES),
            depth: gpu.target(DEPTH, SAMPLES),
            hdr: gpu.target(HDR, 1),
            picture: gpu.target(SRGB, 1),
        };
        let tone_layout = gpu.layout(wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        });
        let tone_group = gpu.group(&tone_layout, wgpu::BindingResource::TextureView(&targets.hdr));
        let tone = (tone_pipeline(&gpu, &tone_layout), tone_group);

        // STEP 2: choose a technique. The recommended one has four maps of 2048² texels and a 5×5 tent
        // filter.
        let technique = Technique::default().with_max_distance(DISTANCE);
        let mut sun = SunShadows::new(&gpu.device, &gpu.queue, &technique.into())?;

        if is_exact {
            // EXACT edges: choose traced edges before creating pipelines. Four rays per pixel make the edges
            // smooth.
            sun.set_technique(&technique.with_edges(Edges::Traced { samples: 4 }))?;
        }

        // STEP 4: create a pipeline for the casters, with the engine's vertices and the map's states. The
        // engine chooses the bind group of the map's matrix. The pass writes only depth.
        let map = sun.map();
        let wgsl = [&caster_wgsl(map.descriptor(), &WgslOptions::group(0)), VERTEX, CASTER].concat();
        let states = (map.primitive_state(), map.depth_stencil_state());
        let caster_pipeline = gpu.depth_pipeline(wgsl, map.caster_layout(), &Scene::LAYOUT, states);

        // STEP 5: paste the look-up into the engine's shader, and add the maps' layout to its pipeline.
        let look_up = receiver_wgsl(sun.map().descriptor(), &WgslOptions::group(1));
        let groups = [Some(&camera_layout), Some(sun.map().receiver_layout())];

        let wgsl = look_up + VERTEX + SHADED;
        let vertices_alone = shaded(wgsl.clone(), &groups[..1]);
        let exact = is_exact.then(|| Exact::new(&gpu, vertices_alone)).transpose()?;
        let (wgsl, groups) = match &exact {
            Some(exact) => exact.shaded(&wgsl, groups.to_vec()),
            None => (wgsl, groups.to_vec()),
        };
        let scene_pipeline = gpu.pipeline(shaded(wgsl, &groups));
        // STEP 2: store both in the engine.
        Ok(Self { gpu, scene, targets, camera, scene_pipeline, tone, exact, sun, caster_pipeline })
    }

    /// Draws a frame and returns the number of draws into the maps.
    fn draw(&mut self, camera: &Camera, number: u32) -> Result<usize> {
        let (cell, clip_from_eye) = (camera.cell(), camera.clip_from_eye());
        self.scene.update(&self.gpu.queue, cell, number);
        self.write_camera(camera);
        // STEP 7: in each frame pass the views, the bounding boxes of casters and receivers, and flags for
        // the boxes that move. Boxes have an origin. Positions in the shaders are relative to the cell.
        let eye_from_clip = clip_from_eye.inversed();
        let views = [frustum_from_eye_from_clip(eye_from_clip, camera.eye, DepthConvention::Reversed, DISTANCE)?];
        let boxes: Vec<Aabb> = self.scene.bounds(cell).map(|[min, max]| Aabb::new(vec3(min), vec3(max))).collect();
        let boxes = Boxes { origin: dvec3(cell), boxes: &boxes };
        let casters = Casters { moves: &self.scene.moves, ..Casters::fixed(boxes) };
        let frame = SunFrame::new(&views, vec3(SUNLIGHT), boxes, casters).with_origin(dvec3(cell));
        self.sun.update(&self.gpu.queue, &frame)?;
        debug_assert!(self.sun.prove(&frame)?.is_proven(), "a map has a hole");

        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut drawn = 0;
        // STEP 8: draw the casters by number, where a map is new or a caster moves. The pass is already
        // cleared, and the map's matrix is bound.
        self.sun.render(&mut encoder, 0, |pass, region| {
            pass.set_pipeline(&self.caster_pipeline);
            drawn += self.scene.draw(pass, region.casters.iter().copied());
        });

        self.record_exact(&mut encoder, camera)?;
        self.scene_pass(&mut encoder);
        // STEP 10: record the visible demand from the depth buffer, for the next frames. The CPU does not wait
        // for it.
        self.sun.record_demand(&mut encoder, &self.targets.depth, mat4(clip_from_eye), DepthConvention::Reversed)?;

        self.tone_pass(&mut encoder);
        self.gpu.queue.submit([encoder.finish()]);
        Ok(drawn)
    }

    fn write_camera(&self, camera: &Camera) {
        let eye = relative(camera.eye, camera.cell());
        let clip_from_cell = camera.clip_from_eye() * Mat4::from_translation(-eye);
        let to_light = Vec4::from(-SUNLIGHT.normalized());
        let queue = &self.gpu.queue;
        queue.write_buffer(&self.camera.0, 0, clip_from_cell.as_byte_slice());
        queue.write_buffer(&self.camera.0, 64, Vec4::from(eye).as_byte_slice());
        queue.write_buffer(&self.camera.0, 80, to_light.as_byte_slice());
    }

    fn scene_pass(&self, encoder: &mut wgpu::CommandEncoder) {
        // EXACT pre-pass: reuse its depths in the shaded pass.
        let depths = if self.exact.is_some() { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(0.0) };

        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.targets.multisampled,
                depth_slice: None,
                resolve_target: Some(&self.targets.hdr),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Discard,
                },
            })],
            depth_stencil_attachment: Some(depth_attachment(&self.targets.depth, depths)),
            ..Default::default()
        });
        pass.set_pipeline(&self.scene_pipeline);
        pass.set_bind_group(0, &self.camera.1, &[]);
        // STEP 9: bind the maps at the group that the pasted WGSL uses.
        pass.set_bind_group(1, self.sun.receiver_group(), &[]);

        if let Some(exact) = &self.exact {
            exact.bind(&mut pass);
        }
        self.scene.draw(&mut pass, 0..self.scene.objects.len() as u32);
    }

    fn tone_pass(&self, encoder: &mut wgpu::CommandEncoder) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("tone mapping"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.targets.picture,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.tone.0);
        pass.set_bind_group(0, &self.tone.1, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Returns the shaded pass's pipeline. Its depth test accepts equal depths, so that it can follow a depth
/// pre-pass.
fn shaded<'a>(wgsl: String, groups: &'a [Option<&'a wgpu::BindGroupLayout>]) -> Pipeline<'a> {
    Pipeline {
        wgsl,
        groups,
        vertices: &Scene::LAYOUT,
        primitive: wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..Default::default() },
        depth: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        color: Some(HDR),
        samples: SAMPLES,
    }
}

fn depth_attachment(view: &wgpu::TextureView, load: wgpu::LoadOp<f32>) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    let depth_ops = Some(wgpu::Operations { load, store: wgpu::StoreOp::Store });
    wgpu::RenderPassDepthStencilAttachment { view, depth_ops, stencil_ops: None }
}

fn tone_pipeline(gpu: &Gpu, layout: &wgpu::BindGroupLayout) -> wgpu::RenderPipeline {
    gpu.pipeline(Pipeline {
        wgsl: TONE.to_owned(),
        groups: &[Some(layout)],
        vertices: &[],
        primitive: wgpu::PrimitiveState::default(),
        depth: None,
        color: Some(SRGB),
        samples: 1,
    })
}
