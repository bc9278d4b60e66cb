//! The formulas of ambient occlusion in WGSL against their Rust versions.

use bytemuck::{Pod, Zeroable};
use glam::{UVec2, Vec2, Vec3};
use shadowfit_classics::occlusion::formula;
use shadowfit_render::Gpu;
use shadowfit_testing::renderer_gpu;

/// Number of cases: a multiple of 16, the number of random vectors and of points.
const CASES: u32 = 192;

/// Allowed difference: WGSL allows sine and cosine an absolute error of 2⁻¹¹, and the results are at most 1.
const TOLERANCE: f32 = 1.0 / 2048.0;

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Case {
    normal: [f32; 3],
    scale: f32,
    position: [f32; 3],
    bias: f32,
    neighbour: [f32; 3],
    radius: f32,
    depth: f32,
    far: f32,
    detail: f32,
    intensity: f32,
    pixel: [u32; 2],
    index: u32,
    padding: u32,
}

type Answer = [[f32; 4]; 5];

const ASK: &str = "
struct Case {
    normal: vec3<f32>,
    scale: f32,
    position: vec3<f32>,
    bias: f32,
    neighbour: vec3<f32>,
    radius: f32,
    depth: f32,
    far: f32,
    detail: f32,
    intensity: f32,
    pixel: vec2<u32>,
    index: u32,
    padding: u32,
}
@group(0) @binding(0) var<storage, read> cases: array<Case>;
@group(0) @binding(1) var<storage, read_write> answers: array<array<vec4<f32>, 5>>;
@compute @workgroup_size(64) fn ask(@builtin(global_invocation_id) id: vec3<u32>) {
    let case_ = cases[id.x];
    let term = occlusion_term(case_.normal, case_.position, case_.neighbour, case_.scale, case_.bias);
    let count = occlusion_directions(case_.depth, case_.far, case_.detail);
    let sum = occlusion_sum(term * 7.0, term * 3.0, case_.intensity, count);
    let behind = occlusion_behind(case_.depth, case_.depth - case_.position.x, case_.radius);
    let random = occlusion_random(case_.pixel);
    let step = occlusion_step(occlusion_direction(case_.index % 6u), random, case_.radius, case_.depth);
    let neighbour = case_.index % 4u;
    answers[id.x] = array<vec4<f32>, 5>(
        vec4<f32>(term, f32(count), sum, behind),
        vec4<f32>(random, step),
        vec4<f32>(occlusion_offset(step, neighbour, 0.0), occlusion_offset(step, neighbour, 1.0)),
        vec4<f32>(occlusion_random_3d(case_.pixel), 0.0),
        vec4<f32>(occlusion_sphere(case_.index), 0.0));
}
";

/// Returns numbers in 0..1 that fill the space of all columns evenly: the fractional parts of multiples of
/// the powers of a number (Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018).
fn evenly(index: u32, column: i32) -> f32 {
    (0.5 + f64::from(index + 1) * 1.051_7_f64.powi(-column - 1)).fract() as f32
}

fn case(index: u32) -> Case {
    let number = |column| evenly(index, column);
    let vector = |column| Vec3::new(number(column), number(column + 1), number(column + 2)) * 2.0 - 1.0;
    Case {
        normal: vector(0).normalize().to_array(),
        scale: number(3) * 4.0,
        position: (vector(4) * 2.0).to_array(),
        bias: number(7) * 0.3,
        // Every eighth neighbour is the point itself.
        neighbour: (vector(4) * 2.0 + vector(8) * if index % 8 == 7 { 0.0 } else { 3.0 }).to_array(),
        radius: 0.1 + number(11),
        depth: 0.5 + number(12) * 60.0,
        far: 50.0,
        detail: (index % 2) as f32,
        intensity: number(13) * 4.0,
        pixel: [index % 7, index / 7],
        index: index % 16,
        padding: 0,
    }
}

fn twin(case: &Case) -> Answer {
    let [normal, position, neighbour] = [case.normal, case.position, case.neighbour].map(Vec3::from);
    let term = formula::term(normal, position, neighbour, case.scale, case.bias);
    let count = formula::directions(case.depth, case.far, case.detail > 0.0);
    let sum = formula::sum(term * 7.0, term * 3.0, case.intensity, count);
    let behind = formula::behind(case.depth, case.depth - position.x, case.radius);
    let pixel = UVec2::from(case.pixel);
    let random = formula::random_vector(pixel);
    let step = formula::step(formula::DIRECTIONS[(case.index % 6) as usize], random, case.radius, case.depth);
    let [front, back] = [false, true].map(|is_back| formula::offset(step, case.index % 4, is_back));
    let pair = |a: Vec2, b: Vec2| [a.x, a.y, b.x, b.y];
    [
        [term, count as f32, sum, behind],
        pair(random, step),
        pair(front, back),
        formula::random_vector_3d(pixel).extend(0.0).to_array(),
        formula::sphere_point(case.index).extend(0.0).to_array(),
    ]
}

/// Returns the results of the shader's functions.
fn ask(gpu: &Gpu, cases: &[Case]) -> Vec<Answer> {
    compute(gpu, &[include_str!("../../src/occlusion/formula.wgsl"), ASK].concat(), cases)
}

/// Runs the entry point `ask` of a module on the cases and returns its results. The number of cases is a
/// multiple of 64.
pub(crate) fn compute<C: bytemuck::Pod, A: bytemuck::Pod>(gpu: &Gpu, source: &str, cases: &[C]) -> Vec<A> {
    let device = &gpu.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("formulas"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("formulas"),
        layout: None,
        module: &module,
        entry_point: Some("ask"),
        compilation_options: Default::default(),
        cache: None,
    });
    let buffer = |size: usize, usage| {
        let size = size as u64;
        device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
    };
    let storage = wgpu::BufferUsages::STORAGE;
    let asked = buffer(size_of_val(cases), storage | wgpu::BufferUsages::COPY_DST);
    gpu.queue.write_buffer(&asked, 0, bytemuck::cast_slice(cases));
    let size = cases.len() * size_of::<A>();
    let answers = buffer(size, storage | wgpu::BufferUsages::COPY_SRC);
    let read = buffer(size, wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ);
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: asked.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: answers.as_entire_binding() },
        ],
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(cases.len() as u32 / 64, 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&answers, 0, &read, 0, size as u64);
    gpu.submit([encoder.finish()]);
    read.slice(..).map_async(wgpu::MapMode::Read, |_| {});
    device.poll(wgpu::PollType::wait_indefinitely()).expect("the work is done");
    let mapped = read.slice(..).get_mapped_range().expect("a mapped buffer");
    bytemuck::pod_collect_to_vec(&mapped)
}

#[test]
fn occlusion_is_the_same_in_wgsl_and_rust() {
    let cases: Vec<Case> = (0..CASES).map(case).collect();
    let mut worst = 0.0_f32;
    let mut hidden = 0;
    for (case, answer) in cases.iter().zip(ask(&renderer_gpu(), &cases)) {
        let expected = twin(case);
        for (found, expected) in answer.iter().flatten().zip(expected.iter().flatten()) {
            worst = worst.max((found - expected).abs());
            assert!((found - expected).abs() <= TOLERANCE, "{case:?}: {answer:?}, not {expected:?}");
        }
        hidden += usize::from(expected[0][0] > 0.0 && expected[0][3] > 0.0);
    }
    println!("off by at most {worst}");
    // The cases include occluding and non-occluding neighbours, and both kinds of points.
    assert!(hidden > 10 && hidden < CASES as usize / 2, "{hidden}");
}
