//! A renderer of a few lines around `shadowfit-wgpu` alone, as an engine would write it: it draws casters into a shadow
//! map, and reads back what the receiver's WGSL computes at given points.

use shadowfit::glam::{DVec3, Vec2, Vec3};
use shadowfit::settings::BiasSettings;
use shadowfit::{Bias, FittedMap, LightProjection};
use shadowfit_render::Gpu;
use shadowfit_wgpu::{MapView, ShadowMap, ShadowMapDescriptor, WgslOptions, caster_wgsl, receiver_wgsl, stored_wgsl};

use super::read_back::texels;

/// A point that is asked about: position relative to the origin, in metres, and unit normal.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct Point {
    pub(super) position: [f32; 3],
    pub(super) normal: [f32; 3],
}

/// What the WGSL makes of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Answer {
    /// Texture coordinates and depth by `shadowfit_project` in the map asked for.
    pub(super) projected: Vec3,
    /// The plane's change of depth over a texel.
    pub(super) gradient: Vec2,
    /// `shadowfit_factor` over all maps.
    pub(super) factor: f32,
    /// `shadowfit_stored` at the texel of the point's index: x runs over a row.
    pub(super) stored: f32,
}

/// Which map the WGSL reads at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Choice {
    /// `shadowfit_map_index`.
    pub(super) map: i32,
    /// `shadowfit_view_depth`, in metres.
    pub(super) view_depth: f32,
}

/// Points in a row of the picture of answers; a power of two keeps the pixels' centres exact.
pub(super) const ROW: u32 = 256;

/// Format of a picture of answers.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// Casters at plain positions, as a depth format wants them, and where fragment shaders clamp.
const CASTER: &str = "
struct Caster {
    @builtin(position) clip: vec4<f32>,
    @location(0) depth: f32,
}
@vertex fn vs(@location(0) position: vec3<f32>) -> Caster {
    return Caster(shadowfit_caster_position(position), shadowfit_caster_depth(position));
}
@fragment fn fs_clamped(in: Caster) -> @builtin(frag_depth) f32 {
    return shadowfit_clamped_depth(in.depth);
}
";

/// The colour for the formats that need one.
const CASTER_COLOR: &str = "
struct Color {
    @location(0) color: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}
@fragment fn fs_color(in: Caster) -> @location(0) vec4<f32> {
    return shadowfit_caster_color(in.clip.z);
}
@fragment fn fs_clamped_color(in: Caster) -> Color {
    let depth = shadowfit_clamped_depth(in.depth);
    return Color(shadowfit_caster_color(depth), depth);
}
";

/// One pixel a point; its index is the instance's.
const RECEIVER: &str = "
struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) position: vec3<f32>,
    @location(1) @interpolate(flat) normal: vec3<f32>,
}
struct Answer {
    @location(0) one: vec4<f32>,
    @location(1) other: vec4<f32>,
}
@vertex fn vs(
    @builtin(instance_index) index: u32, @location(0) position: vec3<f32>, @location(1) normal: vec3<f32>,
) -> Varying {
    let pixel = vec2<f32>(f32(index % ROW), f32(index / ROW)) + 0.5;
    let ndc = pixel / vec2<f32>(ROW, ROWS) * vec2<f32>(2.0, -2.0) + vec2<f32>(-1.0, 1.0);
    return Varying(vec4<f32>(ndc, 0.0, 1.0), position, normal);
}
";

/// What [`Harness::ask`] asks.
const LOOK_UP: &str = "
@fragment fn fs(in: Varying) -> Answer {
    let found = shadowfit_project(shadowfit_receiver.maps[MAP], in.position, in.normal);
    let projected = vec3<f32>(found.texel / shadowfit_receiver.maps[MAP].size, found.depth);
    let gradient = found.gradient;
    let stored = shadowfit_stored(i32(MAP), vec2<i32>(in.clip.xy));
    return Answer(vec4<f32>(projected, shadowfit_factor(in.position, in.normal)), vec4<f32>(stored, gradient, 0.0));
}
";

/// What [`Harness::turned`] asks.
const TURNED: &str = "
@fragment fn fs(in: Varying) -> Answer {
    let factor = shadowfit_factor_at(in.position, in.normal, in.clip.xy);
    return Answer(vec4<f32>(factor, 0.0, 0.0, 0.0), vec4<f32>(0.0));
}
";

/// What [`Harness::choices`] asks.
const CHOICE: &str = "
@fragment fn fs(in: Varying) -> Answer {
    let map = f32(shadowfit_map_index(in.position));
    return Answer(vec4<f32>(map, shadowfit_view_depth(in.position), 0.0, 0.0), vec4<f32>(0.0));
}
";

/// A shadow map with its casters drawn.
pub(super) struct Harness<'a> {
    gpu: &'a Gpu,
    map: ShadowMap,
}

impl<'a> Harness<'a> {
    /// Draws `casters`, triangles relative to `origin`, into every map; `casters[i]` into map i. Points of all view
    /// depths read the first map that covers them.
    pub(super) fn new(
        gpu: &'a Gpu,
        descriptor: &ShadowMapDescriptor,
        origin: DVec3,
        fits: &[LightProjection],
        bias: &BiasSettings,
        casters: &[Vec<Vec3>],
    ) -> Self {
        let map = |fit: &LightProjection| {
            FittedMap::new(*fit, Bias::from_texels(bias, descriptor.format, fit)).ending_at(f32::MAX)
        };
        let maps: Vec<FittedMap> = fits.iter().map(map).collect();
        Self::with_maps(gpu, descriptor, &MapView::from_eye(origin, Vec3::NEG_Z), &maps, casters)
    }

    /// The same for maps that are chosen by view depth.
    pub(super) fn with_maps(
        gpu: &'a Gpu,
        descriptor: &ShadowMapDescriptor,
        view: &MapView,
        maps: &[FittedMap],
        casters: &[Vec<Vec3>],
    ) -> Self {
        Self::with_caster_group(gpu, descriptor, view, maps, casters, 0)
    }

    /// The same with the map's matrix at a bind group of the shadow pass.
    pub(super) fn with_caster_group(
        gpu: &'a Gpu,
        descriptor: &ShadowMapDescriptor,
        view: &MapView,
        maps: &[FittedMap],
        casters: &[Vec<Vec3>],
        group: u32,
    ) -> Self {
        let mut map = ShadowMap::new(&gpu.device, descriptor).expect("a possible shadow map");
        map.prepare(&gpu.queue, view, maps).expect("fits of this map");
        let pipeline = caster_pipeline(gpu, &map, group);
        let buffers: Vec<wgpu::Buffer> =
            casters.iter().map(|corners| vertex_buffer(gpu, &positions(corners))).collect();
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        map.render(&mut encoder, group, |pass, index, _volume| {
            if casters[index].is_empty() {
                return;
            }
            pass.set_pipeline(&pipeline);
            pass.set_vertex_buffer(0, buffers[index].slice(..));
            pass.draw(0..casters[index].len() as u32, 0..1);
        });
        gpu.queue.submit([encoder.finish()]);
        Self { gpu, map }
    }

    /// Asks the WGSL about points, at most [`ROW`]² of them; projections are those of map `index`.
    pub(super) fn ask(&self, index: u32, points: &[Point]) -> Vec<Answer> {
        let [projected, stored] = self.draw(&LOOK_UP.replace("MAP", &format!("{index}u")), points);
        let answer = |(p, s): (&[f32; 4], &[f32; 4])| Answer {
            projected: Vec3::new(p[0], p[1], p[2]),
            gradient: Vec2::new(s[1], s[2]),
            factor: p[3],
            stored: s[0],
        };
        projected.iter().zip(&stored).map(answer).collect()
    }

    /// `shadowfit_factor_at` for points, at most [`ROW`]² of them; point i is pixel (i mod [`ROW`], i / [`ROW`]).
    pub(super) fn turned(&self, points: &[Point]) -> Vec<f32> {
        let [factors, _] = self.draw(TURNED, points);
        factors.iter().map(|factor| factor[0]).collect()
    }

    /// The stored depths of a map of [`ROW`]² texels, rows from the top.
    pub(super) fn stored(&self, index: u32) -> Vec<f32> {
        let nowhere = vec![Point { position: [0.0; 3], normal: [0.0, 1.0, 0.0] }; (ROW * ROW) as usize];
        self.ask(index, &nowhere).iter().map(|answer| answer.stored).collect()
    }

    /// Asks the WGSL which map it reads at points, at most [`ROW`]² of them.
    pub(super) fn choices(&self, points: &[Point]) -> Vec<Choice> {
        let [choices, _] = self.draw(CHOICE, points);
        choices.iter().map(|choice| Choice { map: choice[0] as i32, view_depth: choice[1] }).collect()
    }

    /// Draws a fragment shader's answers about points.
    fn draw(&self, fragment: &str, points: &[Point]) -> [Vec<[f32; 4]>; 2] {
        let rows = (points.len() as u32).div_ceil(ROW);
        let source = [RECEIVER, fragment]
            .concat()
            .replace("ROWS", &format!("{rows}.0"))
            .replace("vec2<f32>(ROW", &format!("vec2<f32>({ROW}.0"))
            .replace("ROW", &format!("{ROW}u"));
        let (map, options) = (self.map.descriptor(), WgslOptions::group(0));
        let module = module(
            self.gpu,
            receiver_wgsl(map, &options) + &stored_wgsl(map, &options, self.gpu.adapter.get_info().backend) + &source,
        );
        let pipeline = receiver_pipeline(self.gpu, self.map.receiver_layout(), &module);
        let targets = [(); 2].map(|()| target(self.gpu, rows));
        let views = [0, 1].map(|index: usize| targets[index].create_view(&wgpu::TextureViewDescriptor::default()));
        let points_buffer = vertex_buffer(self.gpu, bytemuck::cast_slice(points));
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let attachments = views.each_ref().map(|view| {
                Some(wgpu::RenderPassColorAttachment {
                    view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Store,
                    },
                })
            });
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &attachments,
                ..Default::default()
            });
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, self.map.receiver_group(), &[]);
            pass.set_vertex_buffer(0, points_buffer.slice(..));
            pass.draw(0..1, 0..points.len() as u32);
        }
        self.gpu.queue.submit([encoder.finish()]);
        targets.each_ref().map(|texture| {
            let mut answers = read(self.gpu, texture);
            answers.truncate(points.len());
            answers
        })
    }
}

fn positions(corners: &[Vec3]) -> Vec<f32> {
    corners.iter().flat_map(Vec3::to_array).collect()
}

fn module(gpu: &Gpu, source: String) -> wgpu::ShaderModule {
    gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(source.into()),
    })
}

/// A pipeline layout with nothing but one bind group.
fn layout(gpu: &Gpu, group: u32, layout: &wgpu::BindGroupLayout) -> wgpu::PipelineLayout {
    let mut layouts = vec![None; group as usize];
    layouts.push(Some(layout));
    gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &layouts,
        immediate_size: 0,
    })
}

fn caster_pipeline(gpu: &Gpu, map: &ShadowMap, group: u32) -> wgpu::RenderPipeline {
    let color = [map.color_target()];
    let pieces = if color[0].is_some() { [CASTER, CASTER_COLOR] } else { [CASTER, ""] };
    let module = module(gpu, caster_wgsl(map.descriptor(), &WgslOptions::group(group)) + &pieces.concat());
    let entry = match (color[0].is_some(), map.clamps_in_fragment()) {
        (false, false) => None,
        (false, true) => Some("fs_clamped"),
        (true, false) => Some("fs_color"),
        (true, true) => Some("fs_clamped_color"),
    };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout(gpu, group, map.caster_layout())),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 12,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3],
            })],
        },
        primitive: map.primitive_state(),
        depth_stencil: Some(map.depth_stencil_state()),
        multisample: wgpu::MultisampleState::default(),
        fragment: entry.map(|entry| wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: if color[0].is_some() { &color } else { &[] },
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn receiver_pipeline(gpu: &Gpu, receiver: &wgpu::BindGroupLayout, module: &wgpu::ShaderModule) -> wgpu::RenderPipeline {
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout(gpu, 0, receiver)),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vs"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<Point>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3],
            })],
        },
        primitive: wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::PointList, ..Default::default() },
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("fs"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(FORMAT.into()), Some(FORMAT.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn vertex_buffer(gpu: &Gpu, floats: &[f32]) -> wgpu::Buffer {
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        // A buffer of no size cannot be bound.
        size: (size_of_val(floats) as u64).max(4),
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(floats));
    buffer
}

fn target(gpu: &Gpu, rows: u32) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: ROW, height: rows, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// Waits for a picture of answers.
pub(super) fn read(gpu: &Gpu, texture: &wgpu::Texture) -> Vec<[f32; 4]> {
    texels(&gpu.device, &gpu.queue, texture)
}
