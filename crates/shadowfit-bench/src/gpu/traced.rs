//! Exact edges: finding the pixels without agreement and tracing their rays, compared with the look-up alone
//! and with rays for all pixels. Also the time of moving instances.

use std::time::Instant;

use anyhow::Result;
use glam::{Affine3A, DVec3, Mat4, Quat, Vec3};
use shadowfit::settings::{Edges, FilterKind};
use shadowfit::{Aabb, DepthConvention, PerspectiveCamera, Technique};
use shadowfit_rays::{MeshId, RayInstance, RayMesh, RayScene, RayWgslOptions, rays_wgsl};
use shadowfit_render::{GpuProfilerQuery, GpuTimer, bindings};
use shadowfit_wgpu::exact_edges::{EdgeCounts, EdgePass, EdgeView};
use shadowfit_wgpu::{ShadowMap, WgslOptions, receiver_wgsl};

use super::Bench;
use super::engine::{self, Engine};
use super::scene::BenchScene;
use super::timer::Timer;
use crate::cuboid::triangles;
use crate::table::{Table, ms, share};
use crate::times::median;

/// Heights of the pictures, in pixels, unless the command line sets one. The pictures are 16:9.
const HEIGHTS: [u32; 2] = [720, 1080];

/// Number of instances, of moving instances per frame, and of frames.
const INSTANCES: usize = 10_000;
const MOVING: usize = 1_000;
const FRAMES: usize = 200;

/// Pixels along a side of a workgroup, as in the WGSL.
const SQUARE: u32 = 8;

/// A picture of factors from a depth buffer. FACTOR is the expression for a point that faces the light.
const SHADER: &str = "
struct Picture {
    world_from_pixel: mat4x4<f32>,
    // Unit direction to the light.
    to_light: vec4<f32>,
}
@group(0) @binding(0) var<uniform> picture: Picture;
@group(0) @binding(1) var depths: texture_depth_2d;
@group(0) @binding(2) var factors: texture_storage_2d<r32float, write>;

// Position relative to the eye, in metres, from the depth.
fn position(pixel: vec2<i32>, depth: f32) -> vec3<f32> {
    let homogeneous = picture.world_from_pixel * vec4<f32>(vec2<f32>(pixel) + 0.5, depth, 1.0);
    return homogeneous.xyz / homogeneous.w;
}

// Change of the position to the next pixel along an axis, on the side with the smaller depth difference.
fn step_along(pixel: vec2<i32>, axis: vec2<i32>, depth: f32, p: vec3<f32>) -> vec3<f32> {
    let next = textureLoad(depths, pixel + axis, 0);
    let previous = textureLoad(depths, max(pixel - axis, vec2<i32>(0)), 0);
    if abs(next - depth) < abs(depth - previous) {
        return position(pixel + axis, next) - p;
    }
    return p - position(pixel - axis, previous);
}

@compute @workgroup_size(8, 8) fn factor(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= textureDimensions(factors)) {
        return;
    }
    let pixel = vec2<i32>(id.xy);
    let depth = textureLoad(depths, pixel, 0);
    var factor = 0.0;
    if depth > 0.0 {
        let p = position(pixel, depth);
        let right = step_along(pixel, vec2<i32>(1, 0), depth, p);
        let down = step_along(pixel, vec2<i32>(0, 1), depth, p);
        let crossed = normalize(cross(down, right));
        let normal = select(crossed, -crossed, dot(crossed, p) > 0.0);
        if dot(normal, picture.to_light.xyz) > 0.0 {
            factor = FACTOR;
        }
    }
    textureStore(factors, pixel, vec4<f32>(factor));
}
";

/// Filters, and rays for each pixel without agreement.
const TRACED: [(FilterKind, u32); 3] =
    [(FilterKind::Pcf5x5, 1), (FilterKind::Pcf5x5, Edges::USUAL_SAMPLES), (FilterKind::Pcss, 8)];

/// The look-up, and the rays of a pixel: one for each of PLACES. A ray starts at an offset on the pixel's
/// surface, in pixels from its centre, and points to an offset in the sun's disc, as a share of the distance.
const LOOK_UP: &str = "shadowfit_factor_at(p, normal, vec2<f32>(id.xy))";
const RAYS: &str = "
fn lit(p: vec3<f32>, right: vec3<f32>, down: vec3<f32>, normal: vec3<f32>) -> f32 {
    let to_light = picture.to_light.xyz;
    let x = normalize(cross(to_light, select(vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(1.0, 0.0, 0.0), abs(to_light.y) > 0.9)));
    let y = cross(to_light, x);
    var places = PLACES;
    var count = 0.0;
    for (var at = 0u; at < RAY_COUNT; at += 1u) {
        let place = places[at];
        let start = p + right * place.x + down * place.y + normal * 0.001;
        count += select(1.0, 0.0, shadowfit_rays_blocked(start, normalize(to_light + x * place.z + y * place.w)));
    }
    return count / f32(RAY_COUNT);
}
";

/// Returns the offsets of rays: for a soft sun a spiral in its disc from the pixel's centre, otherwise a
/// rotated grid in the pixel, or its centre.
fn places(filter: FilterKind, samples: u32, tangent: f32) -> String {
    let golden = core::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
    let place = |index: u32| {
        let (radius, angle) = (((index as f32 + 0.5) / samples as f32).sqrt() * tangent, index as f32 * golden);
        match (filter.is_soft(), samples) {
            (true, _) => [0.0, 0.0, radius * angle.cos(), radius * angle.sin()],
            (false, 1) => [0.0; 4],
            (false, _) => {
                let [x, y] = [[-0.125, -0.375], [0.375, -0.125], [-0.375, 0.125], [0.125, 0.375]][index as usize % 4];
                [x, y, 0.0, 0.0]
            }
        }
    };
    let list: Vec<String> =
        (0..samples).map(place).map(|[x, y, z, w]| format!("vec4<f32>({x}, {y}, {z}, {w})")).collect();
    format!("array<vec4<f32>, {samples}>({})", list.join(", "))
}

/// Passes over a picture.
struct Pictures {
    depth: wgpu::TextureView,
    uniform: wgpu::Buffer,
    group: wgpu::BindGroup,
    look_up: wgpu::ComputePipeline,
    rays: wgpu::ComputePipeline,
    size: [u32; 2],
}

impl Pictures {
    fn new(bench: &Bench, size: [u32; 2], map: &ShadowMap, rays: &RayScene) -> Self {
        let device = &bench.gpu.device;
        let depth = engine::target(device, size, shadowfit_render::passes::DEPTH_FORMAT);
        let factors = wgpu::BindingType::StorageTexture {
            access: wgpu::StorageTextureAccess::WriteOnly,
            format: wgpu::TextureFormat::R32Float,
            view_dimension: wgpu::TextureViewDimension::D2,
        };
        let types = [bindings::UNIFORM, bindings::texture(wgpu::TextureSampleType::Depth, false), factors];
        let layout = bindings::layout(device, "picture", wgpu::ShaderStages::COMPUTE, &types);
        let uniform = bindings::uniform_buffer::<[f32; 20]>(device, "picture");
        let usage = wgpu::TextureUsages::STORAGE_BINDING;
        let texture = bindings::plain_texture(device, "factors", size, wgpu::TextureFormat::R32Float, usage);
        let view = texture.create_view(&Default::default());
        let [depths, factors] = [&depth, &view].map(wgpu::BindingResource::TextureView);
        let group = bindings::group(device, "picture", &layout, &[uniform.as_entire_binding(), depths, factors]);
        let look_up = receiver_wgsl(map.descriptor(), &WgslOptions::group(1)) + &SHADER.replace("FACTOR", LOOK_UP);
        let all = SHADER.replace("FACTOR", "lit(p, right, down, normal)");
        let descriptor = map.descriptor();
        let samples = descriptor.edges.samples();
        let count = format!("const RAY_COUNT: u32 = {samples}u;\n");
        let each = RAYS.replace("PLACES", &places(descriptor.filter, samples, descriptor.softness.tangent()));
        let all = [rays_wgsl(&RayWgslOptions::group(1)).as_str(), &count, &each, &all].concat();
        Self {
            look_up: pipeline(device, [&layout, map.receiver_layout()], look_up),
            rays: pipeline(device, [&layout, rays.layout()], all),
            depth,
            uniform,
            group,
            size,
        }
    }

    /// Sets a camera, and the direction of travel of the light.
    fn look(&self, queue: &wgpu::Queue, camera: &PerspectiveCamera, direction: Vec3) {
        let [width, height] = self.size.map(|side| side as f32);
        let clip_from_pixel = Mat4::from_translation(Vec3::new(-1.0, 1.0, 0.0))
            * Mat4::from_scale(Vec3::new(2.0 / width, -2.0 / height, 1.0));
        let world_from_pixel = camera.clip_from_world(DepthConvention::Reversed).inverse() * clip_from_pixel;
        let mut uniform = [0.0; 20];
        uniform[..16].copy_from_slice(&world_from_pixel.to_cols_array());
        uniform[16..19].copy_from_slice(&(-direction.normalize()).to_array());
        queue.write_buffer(&self.uniform, 0, bytemuck::cast_slice(&uniform));
    }

    /// Records a pass over all pixels, timed.
    fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pipeline: &wgpu::ComputePipeline,
        group: &wgpu::BindGroup,
        timer: &GpuTimer,
    ) {
        let query = timer.begin("picture", encoder);
        let timestamp_writes = query.as_ref().and_then(GpuProfilerQuery::compute_pass_timestamp_writes);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: None, timestamp_writes });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_bind_group(1, group, &[]);
        let [x, y] = self.size.map(|side| side.div_ceil(SQUARE));
        pass.dispatch_workgroups(x, y, 1);
        drop(pass);
        timer.end(query, encoder);
    }
}

fn pipeline(device: &wgpu::Device, groups: [&wgpu::BindGroupLayout; 2], wgsl: String) -> wgpu::ComputePipeline {
    let source = wgpu::ShaderSource::Wgsl(wgsl.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &groups.map(Some),
        immediate_size: 0,
    });
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: Some(&layout),
        module: &module,
        entry_point: Some("factor"),
        compilation_options: Default::default(),
        cache: None,
    })
}

/// The casters of a scene as separate ray meshes, relative to the eye.
struct Meshes {
    rays: RayScene,
    ids: Vec<MeshId>,
}

impl Meshes {
    fn new(bench: &Bench, scene: &BenchScene) -> Result<Self> {
        let mut rays = RayScene::new(&bench.gpu.device, &bench.gpu.queue)?;
        let mut ids = Vec::new();
        for caster in &scene.casters {
            let vertices = caster.vertices.start as usize..caster.vertices.end as usize;
            let corners = scene.vertices[vertices].as_chunks::<3>().0.iter().copied();
            ids.push(rays.add_mesh(&RayMesh::from_triangles(corners)?)?);
        }
        Ok(Self { rays, ids })
    }

    fn place(&mut self, scene: &BenchScene, frame: usize, eye: DVec3) -> Result<()> {
        let instance = |(number, mesh): (usize, &MeshId)| {
            let bob = if scene.casters[number].moves { BenchScene::bob(frame, number) } else { Vec3::ZERO };
            RayInstance::new(*mesh, Affine3A::from_translation(bob - eye.as_vec3()))
        };
        let instances: Vec<RayInstance> = self.ids.iter().enumerate().map(instance).collect();
        self.rays.set_instances(eye, &instances)?;
        Ok(())
    }
}

/// Times of a frame's passes, in milliseconds.
#[derive(Default)]
struct Times {
    look_up: Vec<f64>,
    classes: Vec<f64>,
    both: Vec<f64>,
    rays: Vec<f64>,
    counts: Vec<EdgeCounts>,
}

/// Times exact edges along the walk, in pictures of several heights.
pub(crate) fn time(bench: &Bench, scene: &BenchScene) -> Result<Table> {
    let mut rows = Vec::new();
    for height in bench.height.map_or(HEIGHTS.to_vec(), |height| vec![height]) {
        let size = [height * 16 / 9, height];
        for (filter, samples) in TRACED {
            let edges = Edges::Traced { samples };
            let technique = Technique::default().with_resolution(bench.map, bench.map).with_edges(edges);
            let name = if filter.is_soft() { format!("{samples} to the sun") } else { samples.to_string() };
            rows.push(row(size, name, walk(bench, scene, size, &technique.with_filter(filter))?));
        }
    }
    Ok(Table {
        title: "Exact edges",
        note: format!(
            "Compute passes over the depth buffer of the {}, medians along the walk: the look-up for every pixel (PCF \
             5×5, or PCSS for a sun with a radius of 0.27°), finding the pixels without agreement without a budget, \
             rays for each of these, and the same number of rays for every pixel that faces the light. Shares are of \
             the pixels. The ratio is both passes to rays for all.",
            scene.name
        ),
        columns: [
            "picture",
            "rays",
            "look-up",
            "classes",
            "their rays",
            "both",
            "all rays",
            "of all",
            "facing",
            "traced",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows,
    })
}

fn row([width, height]: [u32; 2], rays: String, times: Times) -> Vec<String> {
    let pixels = f64::from(width) * f64::from(height);
    let part = |count: fn(&EdgeCounts) -> u32| {
        let parts = times.counts.iter().map(|counts| f64::from(count(counts)) / pixels);
        format!("{:.1}%", 100.0 * median(parts.collect()))
    };
    let (facing, traced) = (part(|counts| counts.facing), part(|counts| counts.unsure));
    let difference = times.both.iter().zip(&times.classes).map(|(both, classes)| both - classes).collect();
    let [look_up, classes, both, all] = [times.look_up, times.classes, times.both, times.rays].map(median);
    let mut row = vec![format!("{width} × {height}"), rays];
    row.extend([look_up, classes, median(difference), both, all].map(ms));
    row.extend([share(both, all), facing, traced]);
    row
}

fn walk(bench: &Bench, scene: &BenchScene, size: [u32; 2], technique: &Technique) -> Result<Times> {
    let gpu = &bench.gpu;
    let mut engine = Engine::new(gpu, scene, technique)?;
    let mut meshes = Meshes::new(bench, scene)?;
    let pictures = Pictures::new(bench, size, engine.sun.map(), &meshes.rays);
    engine.depth = pictures.depth.clone();
    let mut edges = EdgePass::new(&gpu.device, &gpu.queue)?;
    let (mut timer, mut times) = (Timer::new(gpu), Times::default());
    for frame in 0..bench.frames + bench.frames / 5 {
        engine.update(frame)?;
        let camera = engine.camera(frame);
        meshes.place(scene, frame, camera.eye)?;
        pictures.look(&gpu.queue, &camera, engine.direction);
        timer.frame(gpu, |encoder, _| {
            engine.shadow_passes(encoder, None);
            engine.seen_pass(encoder, &camera)
        })?;
        let mut pass = |pipeline, group| {
            timer.frame(gpu, |encoder, timer| {
                pictures.record(encoder, pipeline, group, timer);
                Ok(())
            })
        };
        let look_up = pass(&pictures.look_up, engine.sun.map().receiver_group())?;
        let rays = pass(&pictures.rays, meshes.rays.group())?;
        let mut timed = |budget| {
            let clip_from_eye = camera.clip_from_world(DepthConvention::Reversed);
            let view = EdgeView::new(&pictures.depth, clip_from_eye, DepthConvention::Reversed, camera.eye);
            timer.frame(gpu, |encoder, timer| {
                let query = timer.begin("edges", encoder);
                let writes = query.as_ref().and_then(GpuProfilerQuery::compute_pass_timestamp_writes);
                let view = EdgeView { budget, ..view };
                let result = edges.record_timed(encoder, &engine.sun, Some(&meshes.rays), &view, writes);
                timer.end(query, encoder);
                result?;
                Ok(())
            })
        };
        let [both, classes] = [timed(None)?, timed(Some(0))?];
        let counts = edges.take_counts();
        if frame >= bench.frames / 5 {
            times.look_up.push(look_up);
            times.rays.push(rays);
            times.classes.push(classes);
            times.both.push(both);
            times.counts.extend(counts);
        }
    }
    Ok(times)
}

/// Times frames in which some of many boxes move, on the CPU and until the GPU has received them.
pub(crate) fn time_instances(bench: &Bench) -> Result<Table> {
    let mut rays = RayScene::new(&bench.gpu.device, &bench.gpu.queue)?;
    let mesh = rays.add_mesh(&RayMesh::from_triangles(triangles(&Aabb::new(Vec3::splat(-0.5), Vec3::splat(0.5))))?)?;
    let mut instances: Vec<RayInstance> = (0..INSTANCES).map(|number| RayInstance::new(mesh, place(number))).collect();
    rays.set_instances(DVec3::ZERO, &instances)?;
    let (mut times, mut until_done) = (Vec::new(), Vec::new());
    for frame in 0..FRAMES {
        for (number, instance) in instances.iter_mut().enumerate().step_by(INSTANCES / MOVING) {
            instance.world_from_mesh = place(number);
            instance.world_from_mesh.translation += glam::Vec3A::from(BenchScene::bob(frame, number));
        }
        let start = Instant::now();
        rays.set_instances(DVec3::ZERO, &instances)?;
        times.push(start.elapsed().as_secs_f64() * 1e3);
        bench.gpu.queue.submit([]);
        bench.gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
        until_done.push(start.elapsed().as_secs_f64() * 1e3);
    }
    let worst = times.iter().copied().fold(0.0, f64::max);
    Ok(Table {
        title: "Instances that move",
        note: format!(
            "`RayScene::set_instances` on the CPU, over {FRAMES} frames, and until the GPU has received the upload."
        ),
        columns: ["boxes", "of them move", "median", "worst", "with the GPU", "uploaded"].map(str::to_owned).to_vec(),
        rows: vec![vec![
            INSTANCES.to_string(),
            MOVING.to_string(),
            ms(median(times)),
            ms(worst),
            ms(median(until_done)),
            format!("{} KiB", rays.uploaded() / 1024),
        ]],
    })
}

/// Returns the place of a box: 100 rows of 100 on a field, each rotated.
fn place(number: usize) -> Affine3A {
    const ROW: usize = 100;
    let at = Vec3::new((number % ROW) as f32, 0.0, (number / ROW) as f32) * 2.0;
    Affine3A::from_rotation_translation(Quat::from_rotation_y(number as f32), at)
}
