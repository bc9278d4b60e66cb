//! An engine of a few lines around the resolve pass: triangles that cast and are seen, a depth pre-pass, and what the pass
//! and the look-up say of each pixel.

use shadowfit::glam::{Affine3A, DVec3, Vec3, Vec4};
use shadowfit::settings::Edges;
use shadowfit::{Aabb, Boxes, DepthConvention, PerspectiveCamera, Technique};
use shadowfit_rays::{MeshId, RayInstance, RayMesh, RayScene};
use shadowfit_render::Gpu;
use shadowfit_wgpu::resolve::{
    EdgeResult, NormalEncoding, ResolveCounts, ResolveError, ResolvePass, ResolveView, resolved_wgsl,
};
use shadowfit_wgpu::{Casters, SunFrame, SunShadows, WgslOptions, caster_wgsl, receiver_wgsl};
use wgpu::util::DeviceExt;

use crate::shaders::read_back::texels;
use crate::support::software_gpu;

/// Triangles that are drawn together.
#[derive(Clone, Debug, Default)]
pub(super) struct Thing {
    /// Three corners a triangle; world space, metres.
    pub(super) corners: Vec<Vec3>,
    /// By how much it is moved, in metres.
    pub(super) shift: Vec3,
    pub(super) moves: bool,
    /// Whether the rays lack it.
    pub(super) is_lacking: bool,
}

impl Thing {
    /// An axis-aligned box.
    pub(super) fn solid(min: Vec3, max: Vec3) -> Self {
        Self { corners: super::super::demand_picture::cuboid(min, max), ..Self::default() }
    }

    pub(super) fn bounds(&self) -> Aabb {
        let [least, most] = [Vec3::min, Vec3::max].map(|pick: fn(Vec3, Vec3) -> Vec3| {
            self.corners.iter().copied().reduce(pick).expect("a thing has corners") + self.shift
        });
        Aabb::new(least, most)
    }
}

/// How a picture is taken.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    pub(super) camera: PerspectiveCamera,
    pub(super) direction: Vec3,
    pub(super) size: [u32; 2],
    pub(super) samples: u32,
    pub(super) convention: DepthConvention,
    /// Of the depth buffer.
    pub(super) format: wgpu::TextureFormat,
    pub(super) normals: Option<NormalEncoding>,
    pub(super) number: u32,
}

impl Look {
    pub(super) fn aspect(size: [u32; 2]) -> f32 {
        size[0] as f32 / size[1] as f32
    }
}

/// What a picture was drawn into.
#[derive(Debug)]
pub(super) struct Drawn {
    pub(super) depth: wgpu::TextureView,
    pub(super) normals: Option<wgpu::TextureView>,
}

/// Everything that a picture needs.
pub(super) struct Stage {
    pub(super) gpu: Gpu,
    pub(super) sun: SunShadows,
    pub(super) pass: ResolvePass,
    pub(super) rays: RayScene,
    pub(super) things: Vec<Thing>,
    meshes: Vec<MeshId>,
}

/// The technique with traced edges.
pub(super) fn traced(technique: Technique, samples: u32) -> Technique {
    technique.with_edges(Edges::Traced { samples })
}

const CASTER: &str = "
@vertex fn vs(@location(0) position: vec3<f32>) -> @builtin(position) vec4<f32> {
    return shadowfit_caster_position(position);
}
";

/// What colour formats need beside it.
const COLOR: &str = "
@fragment fn fs(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    return shadowfit_caster_color(at.z);
}
";

/// Positions are in clip space already.
const SURFACE: &str = "
struct Surface {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) normal: vec4<f32>,
}
@vertex fn vs(@location(0) clip: vec4<f32>, @location(1) normal: vec4<f32>) -> Surface {
    return Surface(clip, normal);
}
@fragment fn fs(in: Surface) -> @location(0) vec4<f32> {
    return in.normal;
}
";

/// Answers about points: the filter's factor, and what an engine reads after the pass.
const READ: &str = "
@group(2) @binding(0) var<storage, read> points: array<array<vec4<f32>, 2>>;
@group(2) @binding(1) var<storage, read_write> answers: array<vec2<f32>>;
@compute @workgroup_size(64) fn answer(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < arrayLength(&points) {
        let pixel = vec2<f32>(f32(id.x % WIDTH), f32(id.x / WIDTH)) + 0.5;
        let position = points[id.x][0].xyz;
        let normal = points[id.x][1].xyz;
        answers[id.x] = vec2<f32>(
            shadowfit_factor_at(position, normal, pixel), shadowfit_resolved(position, normal, pixel));
    }
}
";

/// The values of a texture's texels, layer by layer and row by row.
const LOAD: &str = "
@group(0) @binding(0) var loaded: TEXTURE;
@group(0) @binding(1) var<storage, read_write> values: array<f32>;
@compute @workgroup_size(64) fn load(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(loaded);
    let count = size.x * size.y;
    if id.x < count * COUNT {
        let at = vec2<u32>(id.x % count % size.x, id.x % count / size.x);
        let index = id.x / count;
        values[id.x] = LOAD;
    }
}
";

impl Stage {
    pub(super) fn new(technique: &Technique, things: Vec<Thing>) -> Self {
        let gpu = software_gpu();
        let sun = SunShadows::new(&gpu.device, &gpu.queue, technique).expect("maps");
        let pass = ResolvePass::new(&gpu.device, &gpu.queue).expect("a device that computes");
        let mut rays = RayScene::new(&gpu.device, &gpu.queue).expect("a device that traces");
        let mesh = |thing: &Thing| {
            let mesh = RayMesh::from_triangles(thing.corners.as_chunks::<3>().0.iter().copied()).expect("a mesh");
            rays.add_mesh(&mesh).expect("room")
        };
        let meshes = things.iter().map(mesh).collect();
        let mut stage = Self { gpu, sun, pass, rays, things, meshes };
        stage.place();
        stage
    }

    /// Tells the rays where everything is.
    fn place(&mut self) {
        let things = self.things.iter().zip(&self.meshes).filter(|(thing, _)| !thing.is_lacking);
        let instance =
            |(thing, mesh): (&Thing, &MeshId)| RayInstance::new(*mesh, Affine3A::from_translation(thing.shift));
        let instances: Vec<_> = things.map(instance).collect();
        self.rays.set_instances(DVec3::ZERO, &instances).expect("room");
    }

    /// Draws the maps of a frame, and its surfaces.
    pub(super) fn draw(&mut self, look: &Look) -> Drawn {
        self.place();
        self.draw_maps(look);
        self.draw_surfaces(look)
    }

    fn draw_maps(&mut self, look: &Look) {
        let aabbs: Vec<Aabb> = self.things.iter().map(Thing::bounds).collect();
        let moves: Vec<bool> = self.things.iter().map(|thing| thing.moves).collect();
        let boxes = Boxes { origin: DVec3::ZERO, boxes: &aabbs };
        let views = [look.camera.frustum().expect("a camera")];
        let casters = Casters { moves: &moves, ..Casters::fixed(boxes) };
        let frame = SunFrame::new(&views, look.direction, boxes, casters).with_origin(DVec3::ZERO);
        self.sun.update(&self.gpu.queue, &SunFrame { number: look.number, ..frame }).expect("a good frame");
        let pipeline = self.caster_pipeline();
        let buffers: Vec<wgpu::Buffer> = self
            .things
            .iter()
            .map(|thing| {
                let corners: Vec<Vec3> = thing.corners.iter().map(|corner| *corner + thing.shift).collect();
                self.buffer(bytemuck::cast_slice(&corners), wgpu::BufferUsages::VERTEX)
            })
            .collect();
        let mut encoder = self.encoder();
        self.sun.render(&mut encoder, 0, |pass, piece| {
            pass.set_pipeline(&pipeline);
            for number in piece.casters {
                pass.set_vertex_buffer(0, buffers[*number as usize].slice(..));
                pass.draw(0..self.things[*number as usize].corners.len() as u32, 0..1);
            }
        });
        self.gpu.queue.submit([encoder.finish()]);
    }

    /// Draws depths, and normals if the look has them.
    pub(super) fn draw_surfaces(&self, look: &Look) -> Drawn {
        let vertices = self.vertices(look);
        let depth = self.surface_pass(look, &vertices, (look.samples, look.size, [0, 0]), None);
        let normals = look.normals.map(|_| {
            let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
            self.texture(look.size, wgpu::TextureFormat::Rgba32Float, 1, usage | wgpu::TextureUsages::COPY_SRC)
        });
        if let Some(normals) = &normals {
            self.surface_pass(look, &vertices, (1, look.size, [0, 0]), Some(normals));
        }
        Drawn { depth, normals }
    }

    /// Draws depths at a corner of a texture of another size.
    pub(super) fn draw_part(&self, look: &Look, texture: [u32; 2], corner: [u32; 2]) -> Drawn {
        let depth = self.surface_pass(look, &self.vertices(look), (look.samples, texture, corner), None);
        Drawn { depth, normals: None }
    }

    /// Positions in clip space, and normals.
    fn vertices(&self, look: &Look) -> Vec<[Vec4; 2]> {
        let clip = look.camera.clip_from_world(look.convention).as_dmat4();
        let mut vertices: Vec<[Vec4; 2]> = Vec::new();
        for thing in &self.things {
            for [a, b, c] in thing.corners.as_chunks::<3>().0 {
                let normal = (*b - *a).cross(*c - *a).normalize_or_zero();
                let stored = match look.normals {
                    Some(NormalEncoding::Unsigned) => normal * 0.5 + 0.5,
                    _ => normal,
                };
                vertices.extend([a, b, c].map(|corner| {
                    let relative = (*corner + thing.shift).as_dvec3() - look.camera.eye;
                    [(clip * relative.extend(1.0)).as_vec4(), stored.extend(0.0)]
                }));
            }
        }
        vertices
    }

    fn surface_pass(
        &self,
        look: &Look,
        vertices: &[[Vec4; 2]],
        (samples, size, [left, top]): (u32, [u32; 2], [u32; 2]),
        normals: Option<&wgpu::TextureView>,
    ) -> wgpu::TextureView {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let depth = self.texture(size, look.format, samples, usage);
        let pipeline = self.surface_pipeline(look, samples, normals.is_some());
        let buffer = self.buffer(bytemuck::cast_slice(vertices), wgpu::BufferUsages::VERTEX);
        let mut encoder = self.encoder();
        let color = normals.map(|view| wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store },
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: if color.is_some() { core::slice::from_ref(&color) } else { &[] },
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(look.convention.far()),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        let [x, y, width, height] = [left, top, look.size[0], look.size[1]].map(|pixels| pixels as f32);
        pass.set_viewport(x, y, width, height, 0.0, 1.0);
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(0..vertices.len() as u32, 0..1);
        drop(pass);
        self.gpu.queue.submit([encoder.finish()]);
        depth
    }

    /// Resolves a picture that was drawn. `edit` changes how.
    pub(super) fn resolve<'a>(
        &mut self,
        look: &Look,
        drawn: &'a Drawn,
        edit: impl FnOnce(&mut ResolveView<'a>),
    ) -> Result<EdgeResult, ResolveError> {
        let clip_from_eye = look.camera.clip_from_world(look.convention);
        let mut view = ResolveView::new(&drawn.depth, clip_from_eye, look.convention, look.camera.eye);
        if let (Some(normals), Some(encoding)) = (&drawn.normals, look.normals) {
            view = view.with_normals(normals, encoding);
        }
        edit(&mut view);
        let mut encoder = self.encoder();
        let result = self.pass.record(&mut encoder, &self.sun, Some(&self.rays), &view);
        self.gpu.queue.submit([encoder.finish()]);
        result
    }

    /// The factors of the picture that was resolved last; it must be traced.
    pub(super) fn factors(&self) -> Vec<f32> {
        assert_eq!(self.pass.result(), EdgeResult::Traced);
        texels(&self.gpu.device, &self.gpu.queue, self.pass.factors().texture())
    }

    /// Resolves a picture, and gives its factors and counts.
    pub(super) fn traced<'a>(
        &mut self,
        look: &Look,
        drawn: &'a Drawn,
        edit: impl FnOnce(&mut ResolveView<'a>),
    ) -> (Vec<f32>, ResolveCounts) {
        assert_eq!(self.resolve(look, drawn, edit), Ok(EdgeResult::Traced));
        let factors = self.factors();
        (factors, self.pass.take_counts().expect("the picture is finished"))
    }

    /// The filter's factor and what an engine reads, of points by pixel: position in world space and normal.
    pub(super) fn read(&self, points: &[[Vec4; 2]], width: u32) -> Vec<[f32; 2]> {
        let map = self.sun.map();
        let wgsl = receiver_wgsl(map.descriptor(), &WgslOptions::group(0))
            + &resolved_wgsl(&WgslOptions::group(1), 0)
            + &READ.replace("WIDTH", &format!("{width}u"));
        let points_buffer = self.buffer(bytemuck::cast_slice(points), wgpu::BufferUsages::STORAGE);
        let bytes = size_of::<[f32; 2]>() * points.len();
        let groups = [Some(map.receiver_layout()), Some(self.pass.layout())];
        let bound = [self.sun.receiver_group(), self.pass.group()];
        let input = (storage(true), points_buffer.as_entire_binding());
        let values = self.compute((&wgsl, "answer"), (&groups, &bound), input, bytes);
        bytemuck::pod_collect_to_vec(&values)
    }

    /// The depths of all samples of a texture: sample by sample, row by row.
    pub(super) fn depths(&self, view: &wgpu::TextureView) -> Vec<f32> {
        let texture = view.texture();
        let samples = texture.sample_count();
        let (kind, load) = if samples > 1 {
            ("texture_depth_multisampled_2d", "textureLoad(loaded, at, index)")
        } else {
            ("texture_depth_2d", "textureLoad(loaded, at, 0)")
        };
        self.loaded(view, (kind, load), texture.width() * texture.height(), samples)
    }

    /// The depths of all layers of the maps.
    pub(super) fn stored(&self) -> Vec<f32> {
        let map = self.sun.map();
        let ([width, height], layers) = (map.descriptor().resolution, map.descriptor().maps);
        let (kind, load) = if map.descriptor().format.is_depth() {
            ("texture_depth_2d_array", "textureLoad(loaded, at, index, 0)")
        } else {
            ("texture_2d_array<f32>", "textureLoad(loaded, at, index, 0).x")
        };
        self.loaded(map.view(), (kind, load), width * height, layers)
    }

    fn loaded(&self, view: &wgpu::TextureView, (kind, load): (&str, &str), texels: u32, count: u32) -> Vec<f32> {
        let wgsl = LOAD
            .replace("TEXTURE", kind)
            .replace("COUNT", &format!("{count}u"))
            .replace("= LOAD", &format!("= {load}"));
        let is_depth = kind.starts_with("texture_depth");
        let is_array = kind.contains("array");
        let ty = wgpu::BindingType::Texture {
            sample_type: if is_depth {
                wgpu::TextureSampleType::Depth
            } else {
                wgpu::TextureSampleType::Float { filterable: false }
            },
            view_dimension: if is_array { wgpu::TextureViewDimension::D2Array } else { wgpu::TextureViewDimension::D2 },
            multisampled: kind.contains("multisampled"),
        };
        let input = (ty, wgpu::BindingResource::TextureView(view));
        bytemuck::pod_collect_to_vec(&self.compute((&wgsl, "load"), (&[], &[]), input, (texels * count * 4) as usize))
    }

    /// Runs a compute shader whose last group has what it reads and the storage buffer that it writes, of so many bytes.
    fn compute(
        &self,
        (wgsl, entry): (&str, &str),
        (layouts, groups): (&[Option<&wgpu::BindGroupLayout>], &[&wgpu::BindGroup]),
        (ty, input): (wgpu::BindingType, wgpu::BindingResource<'_>),
        bytes: usize,
    ) -> Vec<u8> {
        let device = &self.gpu.device;
        let buffer = |usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: bytes as u64,
                usage,
                mapped_at_creation: false,
            })
        };
        let output = buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
        let read = buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
        let own = own_layout(device, ty);
        let layouts: Vec<_> = layouts.iter().copied().chain([Some(&own)]).collect();
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &layouts,
            immediate_size: 0,
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: Some(&layout),
            module: &self.module(wgsl.to_owned()),
            entry_point: Some(entry),
            compilation_options: Default::default(),
            cache: None,
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &own,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: input },
                wgpu::BindGroupEntry { binding: 1, resource: output.as_entire_binding() },
            ],
        });
        let mut encoder = self.encoder();
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        for (index, group) in (0..).zip(groups.iter().copied().chain([&group])) {
            pass.set_bind_group(index, group, &[]);
        }
        // Four bytes a thread at least, 64 threads a group.
        pass.dispatch_workgroups((bytes as u32).div_ceil(4 * 64), 1, 1);
        drop(pass);
        encoder.copy_buffer_to_buffer(&output, 0, &read, 0, bytes as u64);
        self.gpu.queue.submit([encoder.finish()]);
        read.slice(..).map_async(wgpu::MapMode::Read, |result| result.expect("it can be read"));
        device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
        read.slice(..).get_mapped_range().expect("it is mapped").to_vec()
    }

    pub(super) fn encoder(&self) -> wgpu::CommandEncoder {
        self.gpu.device.create_command_encoder(&Default::default())
    }

    pub(super) fn texture(
        &self,
        [width, height]: [u32; 2],
        format: wgpu::TextureFormat,
        sample_count: u32,
        usage: wgpu::TextureUsages,
    ) -> wgpu::TextureView {
        let texture = self.gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        });
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    }

    pub(super) fn buffer(&self, contents: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        // A buffer of no size cannot be bound.
        let contents = if contents.is_empty() { &[0; 32] } else { contents };
        self.gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
    }

    fn module(&self, wgsl: String) -> wgpu::ShaderModule {
        let source = wgpu::ShaderSource::Wgsl(wgsl.into());
        self.gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source })
    }

    fn caster_pipeline(&self) -> wgpu::RenderPipeline {
        let map = self.sun.map();
        let color = map.color_target().map(Some);
        let text = [CASTER, if color.is_some() { COLOR } else { "" }].concat();
        let module = self.module(caster_wgsl(map.descriptor(), &WgslOptions::group(0)) + &text);
        let layout = self.gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(map.caster_layout())],
            immediate_size: 0,
        });
        self.gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs"),
                compilation_options: Default::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: 12,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &wgpu::vertex_attr_array![0 => Float32x3],
                })],
            },
            primitive: map.primitive_state(),
            depth_stencil: Some(map.depth_stencil_state()),
            multisample: Default::default(),
            fragment: color.as_ref().map(|color| wgpu::FragmentState {
                module: &module,
                entry_point: Some("fs"),
                compilation_options: Default::default(),
                targets: core::slice::from_ref(color),
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    fn surface_pipeline(&self, look: &Look, samples: u32, has_normals: bool) -> wgpu::RenderPipeline {
        let module = self.module(SURFACE.to_owned());
        let is_reversed = look.convention == DepthConvention::Reversed;
        let closer = if is_reversed { wgpu::CompareFunction::Greater } else { wgpu::CompareFunction::Less };
        let targets = [Some(wgpu::TextureFormat::Rgba32Float.into())];
        self.gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs"),
                compilation_options: Default::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: 32,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4],
                })],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: look.format,
                depth_write_enabled: Some(true),
                depth_compare: Some(closer),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
            fragment: has_normals.then(|| wgpu::FragmentState {
                module: &module,
                entry_point: Some("fs"),
                compilation_options: Default::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// The layout of what a compute shader reads, and of the buffer that it writes.
fn own_layout(device: &wgpu::Device, input: wgpu::BindingType) -> wgpu::BindGroupLayout {
    let entry = |(binding, ty)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty,
        count: None,
    };
    let entries = [(0, input), (1, storage(false))].map(entry);
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
}

pub(super) fn storage(read_only: bool) -> wgpu::BindingType {
    wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only },
        has_dynamic_offset: false,
        min_binding_size: None,
    }
}
