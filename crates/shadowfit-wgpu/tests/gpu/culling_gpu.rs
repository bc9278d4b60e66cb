//! Culling in WGSL equals culling in Rust: the same masks for boxes, spheres and oriented boxes, except where
//! a shape lies within rounding of a plane.

use shadowfit::culling::{OrientedBox, Sphere, Sweep, cull};
use shadowfit::glam::{DVec2, DVec3, Mat3, Vec3};
use shadowfit::selection::DepthRange;
use shadowfit::{Aabb, CasterVolume, FitInput, FitState, PerspectiveCamera, Scratch, Technique};
use shadowfit_wgpu::{CullingRegion, WgslOptions, culling_wgsl};

use super::engine::{Engine, dispatch};

/// Number of compared shapes; a multiple of the workgroup's size.
const SHAPES: usize = 4096;

/// Relative rounding within which a shape may be on either side of a plane: WGSL does not prescribe the order
/// of f32 operations. Both implementations count a shape as touching from 1e-6 on.
const ROUNDING: f32 = 2e-6;

/// A shape for the shader: an oriented box, whose first half axis also contains the sphere's radius.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Shape {
    centre: [f32; 4],
    half_axes: [[f32; 4]; 3],
    low: [f32; 4],
    high: [f32; 4],
}

const SHADER: &str = "
struct Shape {
    centre: vec4<f32>,
    half_axes: array<vec4<f32>, 3>,
    low: vec4<f32>,
    high: vec4<f32>,
}
@group(1) @binding(0) var<storage, read> shapes: array<Shape>;
@group(1) @binding(1) var<storage, read_write> masks: array<vec4<u32>>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let shape = shapes[id.x];
    let axes = mat3x3<f32>(shape.half_axes[0].xyz, shape.half_axes[1].xyz, shape.half_axes[2].xyz);
    var spheres = 0u;
    var boxes = 0u;
    var upright = 0u;
    for (var region = 0u; region < arrayLength(&shadowfit_regions); region += 1u) {
        let bit = 1u << region;
        let moves = (id.x & 1u) == 1u;
        upright |= select(0u, bit, shadowfit_draws_box(region, moves, shape.low.xyz, shape.high.xyz));
        spheres |= select(0u, bit, shadowfit_draws_sphere(region, moves, shape.centre.xyz, shape.half_axes[0].w));
        boxes |= select(0u, bit, shadowfit_draws_oriented_box(region, moves, shape.centre.xyz, axes));
    }
    masks[id.x] = vec4<u32>(upright, spheres, boxes, 0u);
}
";

/// Position of the eye. Shapes are relative to another position.
const EYE: DVec3 = DVec3::new(1000.0, 20.0, -3000.0);

/// Returns the swept and the whole caster volumes of two cascades.
fn volumes() -> Vec<CasterVolume> {
    let camera = PerspectiveCamera {
        eye: EYE,
        forward: Vec3::new(0.3, -0.2, -1.0),
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: 1.6,
        near: 0.1,
        far: 100.0,
    };
    let views = [camera.frustum().expect("a good camera")];
    let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
    let settings = Technique::preset("calm-4").expect("a preset").with_count(2);
    let input = FitInput::new(&views, Vec3::new(0.4, -0.8, 0.3));
    let maps = FitState::new().fit(&input, &settings, &mut Scratch::new(&mut storage)).expect("a good view");
    let swept = maps.iter().map(|map| {
        let DepthRange { far, covered_from, .. } = map.depths.expect("a range");
        let [near, far] =
            [covered_from.expect("a cascade"), far.unwrap_or(f64::from(f32::MAX))].map(|depth| depth as f32);
        CasterVolume::swept(&map.projection, &Sweep { near, far, ..Sweep::new(&views) })
    });
    let swept = swept.map(|volume| volume.expect("a good sweep"));
    swept.chain(maps.iter().map(|map| map.projection.caster_volume())).collect()
}

/// Returns numbers in 0..1 that fill the cube evenly.
fn evenly(index: usize, axis: i32) -> f32 {
    (0.5 + (index as f64 + 1.0) * 1.167_303_978_261_418_7_f64.powi(-axis)).fract() as f32
}

/// Returns shapes in and around the view, small and large, and some empty boxes.
fn shapes() -> Vec<Shape> {
    (0..SHAPES)
        .map(|i| {
            let [x, y, z, a, b, c] = [1, 2, 3, 4, 5, 6].map(|axis| evenly(i, axis));
            let centre = (Vec3::new(x, y, z) - 0.5) * Vec3::new(200.0, 80.0, 200.0);
            let half = Vec3::new(a, b, c) * if i % 3 == 0 { 20.0 } else { 2.0 };
            let turned = Mat3::from_axis_angle(Vec3::new(a, b, 1.0).normalize(), c * 3.0) * Mat3::from_diagonal(half);
            let high = if i % 50 == 0 { centre - half * 0.1 } else { centre + half };
            Shape {
                centre: centre.extend(0.0).to_array(),
                half_axes: [0, 1, 2].map(|axis| turned.col(axis).extend(half.min_element()).to_array()),
                low: (centre - half).extend(0.0).to_array(),
                high: high.extend(0.0).to_array(),
            }
        })
        .collect()
}

/// Returns the three masks of each shape from the shader.
fn ask(gpu: &Engine, regions: &[CullingRegion], shapes: &[Shape]) -> Vec<[u32; 4]> {
    let pipeline = gpu.compute_pipeline(None, &(culling_wgsl(&WgslOptions::group(0)) + SHADER), "main");
    let regions = gpu.buffer(regions, wgpu::BufferUsages::STORAGE);
    let masks = gpu.buffer(&vec![[0_u32; 4]; shapes.len()], wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let shapes_buffer = gpu.buffer(shapes, wgpu::BufferUsages::STORAGE);
    let group = |index: u32, buffers: &[&wgpu::Buffer]| {
        let resources = buffers.iter().map(|buffer| buffer.as_entire_binding());
        gpu.group(&pipeline.get_bind_group_layout(index), resources)
    };
    let groups = [group(0, &[&regions]), group(1, &[&shapes_buffer, &masks])];
    let mut encoder = gpu.encoder();
    dispatch(&mut encoder, &pipeline, &groups.each_ref(), [(shapes.len() / 64) as u32, 1]);
    gpu.values(encoder, &masks)
}

/// Returns the shape enlarged or reduced by a length, as a box, a sphere and an oriented box.
fn resized(shape: &Shape, by: f32) -> (Aabb, Sphere, OrientedBox) {
    let vector = |v: [f32; 4]| Vec3::new(v[0], v[1], v[2]);
    let half_axes = shape.half_axes.map(|axis| {
        let axis = vector(axis);
        axis + axis.normalize_or_zero() * by
    });
    let centre = vector(shape.centre);
    (
        Aabb::new(vector(shape.low) - by, vector(shape.high) + by),
        Sphere { centre, radius: shape.half_axes[0][3] + by },
        OrientedBox { centre, half_axes },
    )
}

#[test]
fn wgsl_culls_what_rust_culls() {
    let (gpu, volumes, shapes) = (Engine::shared(), volumes(), shapes());
    let origin = EYE + DVec3::new(4.0, -2.0, -2.0);
    let regions: Vec<_> = volumes.iter().map(|volume| CullingRegion::new([*volume], origin)).collect();
    let answers = ask(&gpu, &regions, &shapes);
    let masks_of = |by: f32| {
        let mut masks = [vec![0_u8; SHAPES], vec![0_u8; SHAPES], vec![0_u8; SHAPES]];
        let resized: Vec<_> = shapes.iter().map(|shape| resized(shape, by)).collect();
        cull(&volumes, origin, &resized.iter().map(|shape| shape.0).collect::<Vec<_>>(), &mut masks[0]);
        cull(&volumes, origin, &resized.iter().map(|shape| shape.1).collect::<Vec<_>>(), &mut masks[1]);
        cull(&volumes, origin, &resized.iter().map(|shape| shape.2).collect::<Vec<_>>(), &mut masks[2]);
        masks
    };
    // Coordinates sum to 500 m at most.
    let [exact, smaller, larger] = [0.0, -500.0 * ROUNDING, 500.0 * ROUNDING].map(masks_of);
    for kind in 0..3 {
        let (mut same, mut kept) = (0, 0);
        for i in 0..SHAPES {
            let answer = answers[i][kind] as u8;
            let (least, most) = (smaller[kind][i], larger[kind][i]);
            assert!(answer & !most == 0 && least & !answer == 0, "shape {i} of kind {kind}: {answer:04b}");
            same += usize::from(answer == exact[kind][i]);
            kept += answer.count_ones();
        }
        println!("kind {kind}: {same} of {SHAPES} masks are the same, {kept} bits are set");
        assert!(same + 8 >= SHAPES && kept > 200 && (kept as usize) < SHAPES * 2, "kind {kind}: {same}, {kept}");
    }
}

#[test]
fn a_piece_takes_what_stands_still_or_moves_and_all_of_its_volumes() {
    let (gpu, volumes, shapes) = (Engine::shared(), volumes(), shapes());
    let both = CullingRegion::new([volumes[1], volumes[2]], EYE);
    let planes = [volumes[1].count, volumes[1].count + volumes[2].count];
    assert_eq!([both.fixed_planes, both.moving_planes], [planes[1]; 2]);
    let single = |volume: usize| CullingRegion::new([volumes[volume]], EYE);
    let regions = [
        single(1),
        single(2),
        both,
        CullingRegion { moving: 0, ..both },
        CullingRegion { fixed: 0, ..both },
        CullingRegion { fixed_planes: planes[0], ..both },
    ];
    let mut found = [0; 6];
    for (number, masks) in ask(&gpu, &regions, &shapes).iter().enumerate() {
        for mask in &masks[..3] {
            let is_in = |region: u32| mask >> region & 1 == 1;
            let moves = number % 2 == 1;
            assert_eq!(is_in(2), is_in(0) && is_in(1));
            assert_eq!([is_in(3), is_in(4)], [is_in(2) && !moves, is_in(2) && moves]);
            assert_eq!(is_in(5), if moves { is_in(2) } else { is_in(0) });
            for (region, count) in (0..).zip(&mut found) {
                *count += u32::from(is_in(region));
            }
        }
    }
    assert!(
        found[2] < found[0] && found[2] < found[1] && found[3] > 5 && found[4] > 5 && found[5] > found[2],
        "{found:?}"
    );
}
