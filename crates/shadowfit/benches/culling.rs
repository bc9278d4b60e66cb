//! Culling of boxes against the volumes of four maps: one by one, as an engine would write it by hand, and
//! batched.
//!
//! Each call gets other boxes than the one before, as in real frames. With the same 1,000 boxes in each call,
//! a branch predictor learns every outcome, which never happens in an engine. The last group shows the
//! difference.

use std::hint::black_box;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use shadowfit::culling::{Sweep, cull};
use shadowfit::glam::{DVec2, DVec3, Vec3, Vec4};
use shadowfit::{
    Aabb, CasterVolume, FitInput, FitState, FittedMaps, PerspectiveCamera, Scratch, Technique, ViewFrustum,
};

/// Boxes in the pool; calls cycle through them.
const POOL: usize = 1 << 20;

/// Planes of a volume in hand-written loops.
const SIX: usize = 6;

fn views() -> [ViewFrustum; 1] {
    let camera = PerspectiveCamera {
        eye: DVec3::ZERO,
        forward: Vec3::new(0.3, -0.1, -1.0),
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: 16.0 / 9.0,
        near: 0.1,
        far: 200.0,
    };
    [camera.frustum().expect("a good camera")]
}

fn fitted() -> FittedMaps {
    let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
    let settings = Technique::preset("calm-4").expect("a preset");
    let settings = Technique { fit: settings.fit.with_max_distance(200.0), ..settings };
    let (views, direction) = (views(), Vec3::new(0.4, -0.8, 0.3));
    let input = FitInput::new(&views, direction);
    FitState::new().fit(&input, &settings, &mut Scratch::new(&mut storage)).expect("a good view")
}

fn swept(fitted: &FittedMaps) -> Vec<CasterVolume> {
    let views = views();
    let sweep = |near, far| Sweep { near, far, ..Sweep::new(&views) };
    let volumes = fitted.iter().map(|map| {
        let range = map.depths.expect("a range");
        let [near, far] = [range.covered_from.expect("a cascade"), range.far.unwrap_or(f64::from(f32::MAX))];
        CasterVolume::swept(&map.projection, &sweep(near as f32, far as f32))
    });
    volumes.collect::<Result<_, _>>().expect("good sweeps")
}

/// Order of the boxes.
#[derive(Clone, Copy, PartialEq)]
enum Order {
    Random,
    /// Neighbours in the list are neighbours in the world, as in a scene that is split into cells.
    Spatial,
}

/// Returns boxes of up to 10 m, at random in a square with a side of this many metres around the camera.
fn boxes(side: f32, order: Order) -> Vec<Aabb> {
    // G. Marsaglia, "Xorshift RNGs", 2003.
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut share = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 40) as f32 / (1 << 24) as f32
    };
    let mut vector = || Vec3::new(share(), share(), share());
    let mut boxes: Vec<_> = (0..POOL)
        .map(|_| {
            let (centre, half) = ((vector() - 0.5) * Vec3::new(side, 60.0, side), vector() * 5.0 + 0.1);
            Aabb::new(centre - half, centre + half)
        })
        .collect();
    if order == Order::Spatial {
        let cell = |v: f32| ((v / side + 0.5) * 64.0) as i32;
        boxes.sort_by_cached_key(|b| (cell(b.min.x), cell(b.min.z)));
    }
    boxes
}

/// Culls by hand, as an engine would: each box against each volume, plane by plane, until one culls it.
fn by_hand(volumes: &[[Vec4; SIX]], boxes: &[Aabb], masks: &mut [u8]) {
    for (b, mask) in boxes.iter().zip(masks) {
        *mask = 0;
        for (i, planes) in volumes.iter().enumerate() {
            let is_behind = |plane: &Vec4| {
                let x = if plane.x < 0.0 { b.min.x } else { b.max.x };
                let y = if plane.y < 0.0 { b.min.y } else { b.max.y };
                let z = if plane.z < 0.0 { b.min.z } else { b.max.z };
                plane.x * x + plane.y * y + plane.z * z + plane.w < 0.0
            };
            if !planes.iter().any(is_behind) {
                *mask |= 1 << i;
            }
        }
    }
}

/// Calls the single test in a loop.
fn one_by_one(volumes: &[CasterVolume], boxes: &[Aabb], masks: &mut [u8]) {
    for (b, mask) in boxes.iter().zip(masks) {
        *mask = 0;
        for (i, volume) in volumes.iter().enumerate() {
            *mask |= u8::from(volume.intersects_aabb(b.min, b.max)) << i;
        }
    }
}

/// Measures one way of culling, over boxes that change from call to call or stay the same.
fn measure(
    group: &mut BenchmarkGroup<WallTime>,
    name: &str,
    boxes: &[Aabb],
    (count, changes): (usize, bool),
    mut cull: impl FnMut(&[Aabb], &mut [u8]),
) {
    let (mut masks, mut start) = (vec![0; count], 0);
    group.throughput(Throughput::Elements(count as u64));
    group.bench_function(BenchmarkId::new(name, count), |bencher| {
        bencher.iter(|| {
            cull(black_box(&boxes[start..start + count]), black_box(&mut masks));
            start = if changes && start + 2 * count <= POOL { start + count } else { 0 };
        });
    });
}

fn compare(criterion: &mut Criterion, name: &str, boxes: &[Aabb], counts: &[usize], changes: bool) {
    let fitted = fitted();
    let maps: Vec<_> = fitted.iter().map(|map| map.projection.caster_volume()).collect();
    let swept = swept(&fitted);
    let six: Vec<[Vec4; SIX]> = maps.iter().map(|volume| std::array::from_fn(|i| volume.planes[i])).collect();
    let mut group = criterion.benchmark_group(name);
    for count in counts {
        let each = (*count, changes);
        measure(&mut group, "by hand, six planes", boxes, each, |boxes, masks| by_hand(&six, boxes, masks));
        measure(&mut group, "one by one, swept", boxes, each, |boxes, masks| one_by_one(&swept, boxes, masks));
        measure(&mut group, "batched, six planes", boxes, each, |boxes, masks| {
            cull(&maps, DVec3::ZERO, boxes, masks);
        });
        measure(&mut group, "batched, swept", boxes, each, |boxes, masks| cull(&swept, DVec3::ZERO, boxes, masks));
    }
    group.finish();
}

fn culling(criterion: &mut Criterion) {
    let counts = [1_000, 10_000, 100_000, 1_000_000];
    let around = boxes(400.0, Order::Random);
    compare(criterion, "boxes around the view", &around, &counts, true);
    compare(criterion, "boxes in spatial order", &boxes(400.0, Order::Spatial), &counts[2..3], true);
    compare(criterion, "boxes of a large world", &boxes(4000.0, Order::Random), &counts[2..3], true);
    compare(criterion, "boxes of a large world in spatial order", &boxes(4000.0, Order::Spatial), &counts[2..3], true);
    compare(criterion, "the same boxes each time", &around, &counts[..2], false);
}

fn sweeping(criterion: &mut Criterion) {
    let (fitted, views) = (fitted(), views());
    criterion.bench_function("sweep of one map", |bencher| {
        bencher.iter(|| CasterVolume::swept(black_box(&fitted[0].projection), &Sweep::new(black_box(&views))));
    });
}

criterion_group!(benches, culling, sweeping);
criterion_main!(benches);
