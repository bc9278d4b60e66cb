//! The fits, compared with plain transcriptions of the two best-known ones: the XNA sample's steps and Bevy's
//! cascades.
//!
//! The transcriptions take the shortest way that glam offers in f32, like their sources. All start from
//! camera parameters and a light direction, and end with the matrices that a renderer uploads.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use shadowfit::Clusters;
use shadowfit::demand::{CELLS, DemandGrid, DemandSpace, PIXELS};
use shadowfit::glam::{DVec2, DVec3, Mat4, Vec2, Vec3, Vec3Swizzles, Vec4};
use shadowfit::settings::{CasterPolicy, FitKind, FitSettings, MapSettings, Shape, SplitScheme, Stabilise};
use shadowfit::{Aabb, Boxes, Cascades, FitInput, FitState, FittedMaps, PerspectiveCamera, Scratch, Technique, fit};

/// Returns a camera that turns a little with each call, so that no result can be reused.
fn camera(turn: &mut f32) -> PerspectiveCamera {
    *turn = (*turn + 0.001) % 1.0;
    PerspectiveCamera {
        eye: DVec3::new(f64::from(*turn), 1.7, 5.0),
        forward: Vec3::new(*turn, -0.2, -1.0),
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: 16.0 / 9.0,
        near: 0.1,
        far: 100.0,
    }
}

const DIRECTION: Vec3 = Vec3::new(0.3, -0.8, 0.2);

mod xna {
    //! The sample's `CreateLightViewProjectionMatrix`, with the frustum that XNA's `BoundingFrustum` computes
    //! from the camera's matrix.

    use super::{Mat4, PerspectiveCamera, Vec3, Vec3Swizzles, Vec4, look_at, orthographic, perspective};

    pub(super) fn fit(camera: &PerspectiveCamera, direction: Vec3) -> Mat4 {
        let eye = camera.eye.as_vec3();
        let view = look_at(eye, eye + camera.forward, camera.up);
        let frustum = corners(perspective(camera) * view);
        let light_rotation = look_at(Vec3::ZERO, direction, Vec3::Y);
        let (mut min, mut max) = (Vec3::MAX, Vec3::MIN);
        for corner in frustum {
            let corner = light_rotation.transform_point3(corner);
            (min, max) = (min.min(corner), max.max(corner));
        }
        let size = max - min;
        let half = size * 0.5;
        let mut position = min + half;
        position.z = min.z;
        let position = light_rotation.inverse().transform_point3(position);
        let light_view = look_at(position, position + direction, Vec3::Y);
        orthographic(size.xy(), -size.z, size.z) * light_view
    }

    /// Returns the corners where three planes of a clip space meet, like `BoundingFrustum`.
    fn corners(clip_from_world: Mat4) -> [Vec3; 8] {
        let m = clip_from_world.transpose();
        let plane = |p: Vec4| p / p.truncate().length();
        let [near, far] = [plane(m.z_axis), plane(m.w_axis - m.z_axis)];
        let [left, right] = [plane(m.w_axis + m.x_axis), plane(m.w_axis - m.x_axis)];
        let [bottom, top] = [plane(m.w_axis + m.y_axis), plane(m.w_axis - m.y_axis)];
        let meet = |a: Vec4, b: Vec4, c: Vec4| {
            let (n, o, p) = (a.truncate(), b.truncate(), c.truncate());
            -(o.cross(p) * a.w + p.cross(n) * b.w + n.cross(o) * c.w) / n.dot(o.cross(p))
        };
        let face = |z: Vec4| [meet(z, left, top), meet(z, right, top), meet(z, right, bottom), meet(z, left, bottom)];
        let ([a, b, c, d], [e, f, g, h]) = (face(near), face(far));
        [a, b, c, d, e, f, g, h]
    }
}

fn look_at(eye: Vec3, target: Vec3, up: Vec3) -> Mat4 {
    let back = (eye - target).normalize();
    let right = up.cross(back).normalize();
    let up = back.cross(right);
    let rotation = Mat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), Vec4::W).transpose();
    rotation * Mat4::from_translation(-eye)
}

fn perspective(camera: &PerspectiveCamera) -> Mat4 {
    let h = 1.0 / (camera.fov_y * 0.5).tan();
    let r = camera.far / (camera.near - camera.far);
    Mat4::from_cols(
        Vec4::new(h / camera.aspect, 0.0, 0.0, 0.0),
        Vec4::new(0.0, h, 0.0, 0.0),
        Vec4::new(0.0, 0.0, r, -1.0),
        Vec4::new(0.0, 0.0, r * camera.near, 0.0),
    )
}

fn orthographic(size: Vec2, near: f32, far: f32) -> Mat4 {
    let r = 1.0 / (near - far);
    Mat4::from_cols(
        Vec4::new(2.0 / size.x, 0.0, 0.0, 0.0),
        Vec4::new(0.0, 2.0 / size.y, 0.0, 0.0),
        Vec4::new(0.0, 0.0, r, 0.0),
        Vec4::new(0.0, 0.0, r * near, 1.0),
    )
}

mod bevy {
    //! Bevy's cascades: a cube of the slice's diagonal, rounded up to a metre, on a grid of texels.

    use super::{Mat4, PerspectiveCamera, Vec3, Vec3Swizzles, Vec4, look_at, perspective};

    /// Data that Bevy keeps for each cascade.
    pub(super) struct Map {
        pub(super) world_from_light_clip: Mat4,
        pub(super) clip_from_light_space: Mat4,
        pub(super) clip_from_world: Mat4,
        pub(super) texel_size: f32,
    }

    pub(super) fn cascades(camera: &PerspectiveCamera, direction: Vec3, bounds: [f32; 4]) -> [Map; 4] {
        let eye = camera.eye.as_vec3();
        let world_from_view = look_at(eye, eye + camera.forward, camera.up).inverse();
        let world_from_light = look_at(Vec3::ZERO, direction, Vec3::Y).inverse();
        let light_from_world = world_from_light.inverse();
        let light_from_view = light_from_world * world_from_view;
        let view_from_clip = perspective(camera).inverse();
        let mut near = camera.near;
        bounds.map(|far| {
            let corners = slice_corners(view_from_clip, near, far);
            near = far;
            cascade(corners, light_from_view, light_from_world)
        })
    }

    fn slice_corners(view_from_clip: Mat4, near: f32, far: f32) -> [Vec3; 8] {
        let ray = |x: f32, y: f32| {
            let p = view_from_clip.project_point3(Vec3::new(x, y, 0.5));
            p / -p.z
        };
        let rays = [ray(1.0, -1.0), ray(1.0, 1.0), ray(-1.0, 1.0), ray(-1.0, -1.0)];
        let [a, b, c, d] = rays.map(|r| r * near);
        let [e, f, g, h] = rays.map(|r| r * far);
        [a, b, c, d, e, f, g, h]
    }

    fn cascade(corners: [Vec3; 8], light_from_view: Mat4, light_from_world: Mat4) -> Map {
        let (mut min, mut max) = (Vec3::MAX, Vec3::MIN);
        for corner in corners {
            let corner = light_from_view.transform_point3(corner);
            (min, max) = (min.min(corner), max.max(corner));
        }
        let body = (corners[0] - corners[6]).length();
        let face = (corners[4] - corners[6]).length();
        let diameter = body.max(face).ceil();
        let texel_size = diameter / 2048.0;
        let centre = (min.xy() + max.xy()) * 0.5;
        let snapped = (centre / texel_size).floor() * texel_size;
        let near_centre = snapped.extend(max.z);
        let cascade_from_world = Mat4::from_translation(-near_centre) * light_from_world;
        let depth = 1.0 / (max.z - min.z);
        let clip_from_cascade = Mat4::from_cols(
            Vec4::new(2.0 / diameter, 0.0, 0.0, 0.0),
            Vec4::new(0.0, 2.0 / diameter, 0.0, 0.0),
            Vec4::new(0.0, 0.0, depth, 0.0),
            Vec4::new(0.0, 0.0, 1.0, 1.0),
        );
        Map {
            world_from_light_clip: cascade_from_world.inverse(),
            clip_from_light_space: clip_from_cascade,
            clip_from_world: clip_from_cascade * cascade_from_world,
            texel_size,
        }
    }
}

fn against_xna(c: &mut Criterion) {
    let mut group = c.benchmark_group("one map by the XNA sample's rule");
    let settings = FitSettings::default().with_kind(FitKind::XnaSample).with_max_distance(f32::MAX);
    let mut turn = 0.0;
    group.bench_function("shadowfit", |b| {
        b.iter(|| {
            let view = black_box(&camera(&mut turn)).frustum().expect("a good camera");
            fit(black_box(&view), black_box(DIRECTION), black_box(&settings)).expect("a good fit")
        });
    });
    group.bench_function("by hand", |b| {
        b.iter(|| xna::fit(black_box(&camera(&mut turn)), black_box(DIRECTION)));
    });
    group.finish();
}

fn against_bevy(c: &mut Criterion) {
    let mut group = c.benchmark_group("4 stable maps");
    let bounds = [10.0, 21.5, 46.4, 100.0];
    let mut splits = [0.0; 7];
    splits[..3].copy_from_slice(&bounds[..3]);
    let settings = settings(FitKind::Sphere, SplitScheme::Manual(splits), Stabilise::Snap { max_oversize: 1.8 });
    let settings = Technique { fit: settings.fit.with_casters(CasterPolicy::Extend), ..settings };
    let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
    let (mut fitter, mut maps) = (FitState::new(), FittedMaps::default());
    let mut turn = 0.0;
    group.bench_function("shadowfit", |b| {
        b.iter(|| {
            let views = [black_box(&camera(&mut turn)).frustum().expect("a good camera")];
            let input = FitInput::new(black_box(&views), black_box(DIRECTION));
            let mut scratch = Scratch::new(&mut storage);
            fitter.fit_into(&input, black_box(&settings), &mut scratch, &mut maps).expect("a good fit");
            black_box(&maps);
        });
    });
    group.bench_function("by hand", |b| {
        b.iter(|| {
            let cascades = bevy::cascades(black_box(&camera(&mut turn)), black_box(DIRECTION), black_box(bounds));
            cascades.map(|c| (c.world_from_light_clip, c.clip_from_light_space, c.clip_from_world, c.texel_size))
        });
    });
    group.finish();
}

fn settings(kind: FitKind, splits: SplitScheme, stabilise: Stabilise) -> Technique {
    let cascades = Cascades { shape: Shape::new(kind), splits, stabilise, ..Cascades::default() };
    let fit = MapSettings::default().with_casters(CasterPolicy::PerObject).with_max_distance(f32::MAX);
    Technique::default().with_maps(cascades).with_fit(fit)
}

/// Returns boxes of 2 to 6 m on a plain of 120 m around the camera.
fn objects(count: usize) -> Vec<Aabb> {
    let side = (count as f32).sqrt().ceil() as usize;
    let step = 120.0 / side as f32;
    (0..count)
        .map(|i| {
            let (x, z) = ((i % side) as f32 * step - 60.0, (i / side) as f32 * step - 60.0);
            let size = 2.0 + (i % 5) as f32;
            Aabb::new(Vec3::new(x, 0.0, z), Vec3::new(x + size, size * 0.7, z + size))
        })
        .collect()
}

fn focused(c: &mut Criterion) {
    let mut group = c.benchmark_group("4 focused maps");
    for (count, name) in [(200, "200 boxes"), (1024, "1024 boxes")] {
        let boxes = objects(count);
        let mut storage = vec![DVec2::ZERO; Scratch::required(count, 4)];
        for (splits, stabilise, kind) in [
            (SplitScheme::Logarithmic, Stabilise::Off, "logarithmic splits"),
            (SplitScheme::FromBoxes, Stabilise::Off, "splits from boxes each frame"),
            (SplitScheme::FromBoxes, Stabilise::default(), "held"),
        ] {
            let settings = settings(FitKind::Focused, splits, stabilise);
            let mut fitter = FitState::new();
            let mut turn = 0.0;
            group.bench_function(format!("{name}, {kind}"), |b| {
                b.iter(|| {
                    let views = [camera(&mut turn).frustum().expect("a good camera")];
                    let boxes = Boxes::world(&boxes);
                    let input =
                        FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, DIRECTION) };
                    fitter.fit(&input, black_box(&settings), &mut Scratch::new(&mut storage)).expect("a good fit")
                });
            });
        }
    }
    group.finish();
}

/// Frames of a walk along a circle, 18 cm and 0.7 degrees apart. The first frame follows the last.
const WALK: usize = 512;

/// Returns the camera of a frame of the walk, which looks ahead.
fn walk(frame: usize) -> PerspectiveCamera {
    let (sin, cos) = (std::f64::consts::TAU * frame as f64 / WALK as f64).sin_cos();
    let forward = DVec3::new(-sin, -0.1, cos).as_vec3();
    PerspectiveCamera { eye: DVec3::new(15.0 * cos, 1.7, 15.0 * sin), forward, ..camera(&mut 0.0) }
}

/// Rays across and down the picture, for counting demand.
const RAYS: (usize, usize) = (48, 27);

/// Counts the visible demand of a camera from boxes, as from its depth buffer.
fn demand(camera: &PerspectiveCamera, boxes: &[Aabb]) -> (DemandSpace, Vec<u32>) {
    let view = camera.frustum().expect("a good camera");
    let space = DemandSpace::new(&view, DIRECTION, Vec3::Y, f32::MAX).expect("a good view");
    let [left_top, right_top, _, left_bottom] = [4, 5, 6, 7].map(|i| view.corners[i] / view.far);
    let (across, down) = (right_top - left_top, left_bottom - left_top);
    let mut counts = vec![0; CELLS];
    for i in 0..RAYS.0 * RAYS.1 {
        let (x, y) = ((i % RAYS.0) as f32 + 0.5, (i / RAYS.0) as f32 + 0.5);
        let ray = left_top + across * (x / RAYS.0 as f32) + down * (y / RAYS.1 as f32);
        let hits = boxes.iter().filter_map(|aabb| hit(camera.eye.as_vec3(), ray, aabb));
        let Some((depth, normal)) = hits.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
        let step = |edge: Vec3| {
            let moved = ray + edge / PIXELS;
            moved * (normal.dot(ray) * depth / normal.dot(moved)) - ray * depth
        };
        if let Some(cell) = space.index(ray * depth, normal, step(across / camera.aspect), step(down)) {
            counts[cell] += 1;
        }
    }
    (space, counts)
}

/// Returns the distance at which a ray meets a box, in lengths of the ray, and the face's normal.
fn hit(eye: Vec3, ray: Vec3, aabb: &Aabb) -> Option<(f32, Vec3)> {
    let (a, b) = ((aabb.min - eye) / ray, (aabb.max - eye) / ray);
    let (enter, leave) = (a.min(b), a.max(b).min_element());
    let axis = enter.max_position();
    let normal = Vec3::AXES[axis] * -ray[axis].signum();
    (enter[axis] > 0.0 && enter[axis] < leave).then_some((enter[axis], normal))
}

/// Measures presets along a walk: windows with and without the last frame's visible demand, and the stillest
/// cascades.
fn windows(c: &mut Criterion) {
    let mut group = c.benchmark_group("4 windows beside stable maps");
    for (count, name) in [(200, "200 boxes"), (1024, "1024 boxes")] {
        let boxes = objects(count);
        let needs: Vec<_> = (0..WALK).map(|frame| demand(&walk(frame), &boxes)).collect();
        let boxes = Boxes::world(&boxes);
        let mut storage = vec![DVec2::ZERO; Scratch::required(count, 4)];
        for (case, preset, is_seen) in [
            ("windows-4", "windows-4", true),
            ("windows-4 by boxes alone", "windows-4", false),
            ("stable-4", "stable-4", true),
        ] {
            let technique = Technique::preset(preset).expect("a preset");
            let mut fitter = FitState::new();
            let mut frame = 0;
            group.bench_function(format!("{name}, {case}"), |b| {
                b.iter(|| {
                    let (space, counts) = &needs[frame];
                    frame = (frame + 1) % WALK;
                    let views = [walk(frame).frustum().expect("a good camera")];
                    let grids = [DemandGrid { space: *space, counts }];
                    let input = FitInput {
                        receivers: Some(boxes),
                        casters: Some(boxes),
                        demand: if is_seen { &grids } else { &[] },
                        ..FitInput::new(&views, DIRECTION)
                    };
                    fitter.fit(&input, black_box(&technique), &mut Scratch::new(&mut storage)).expect("a good fit")
                });
            });
        }
    }
    group.finish();
}

/// Returns a wavy plain of 2 · n² triangles.
fn terrain(n: usize) -> Vec<[Vec3; 3]> {
    let at = |i: usize, j: usize| {
        let (x, z) = (i as f32, j as f32);
        Vec3::new(x, (x * 0.21).sin() * 3.0 + (z * 0.17).cos() * 2.0, z)
    };
    let cell = |k: usize| {
        let (i, j) = (k % n, k / n);
        [[at(i, j), at(i, j + 1), at(i + 1, j)], [at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)]]
    };
    (0..n * n).flat_map(cell).collect()
}

fn clusters(c: &mut Criterion) {
    let mut group = c.benchmark_group("1,024 clusters");
    group.sample_size(10);
    let triangles = terrain(387);
    let objects: [&[[Vec3; 3]]; 1] = [&triangles];
    group.bench_function("build from 300,000 triangles", |b| {
        b.iter(|| Clusters::build(black_box(&objects), Clusters::DEFAULT_LIMIT).expect("good triangles"));
    });
    let mut built = Clusters::build(&objects, Clusters::DEFAULT_LIMIT).expect("good triangles");
    group.bench_function("refit", |b| b.iter(|| built.refit(black_box(&objects)).expect("the same triangles")));
    group.finish();
}

criterion_group!(benches, against_xna, against_bevy, focused, windows, clusters);
criterion_main!(benches);
