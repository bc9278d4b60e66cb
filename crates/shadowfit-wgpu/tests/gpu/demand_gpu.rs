//! The compute pass over a depth buffer equals its reference in Rust, and skips the same points.

use shadowfit::demand::DemandSpace;
use shadowfit::demand::{CLASSES, DEPTHS};
use shadowfit::glam::{DVec3, DVec4, Mat4, Vec3};
use shadowfit::settings::MapSettings;
use shadowfit::{DepthConvention, PerspectiveCamera, ViewFrustum};
use shadowfit_testing::subpixel_step;
use shadowfit_wgpu::demand::{DemandPassError, DemandView, DepthBufferError, count_on_cpu};

use super::demand_picture::{Counts, Drawing, cuboid, demand_pass, draw, infinite, quad, read, record, seen};
use super::engine::Engine;

/// Width and height of the views, in pixels.
const SIZE: [u32; 2] = [160, 90];

/// Direction of travel of the light.
const DIRECTION: Vec3 = Vec3::new(0.3, -0.8, 0.25);

/// Share of the points that rounding may move into a neighbouring cell or bin. The shader computes in f32,
/// the reference in f64, from the same depths.
const ROUNDING: f64 = 0.001;

fn camera() -> PerspectiveCamera {
    PerspectiveCamera {
        eye: DVec3::new(40_000.0, 1.7, -12_000.0),
        forward: Vec3::new(0.2, -0.12, -1.0),
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: 16.0 / 9.0,
        near: 0.1,
        far: 300.0,
    }
}

fn view(depth: DepthConvention, size: [u32; 2]) -> DemandView {
    DemandView::from_camera(&camera(), depth, DIRECTION, &MapSettings::default(), size).expect("a good camera")
}

/// Returns ground, slopes, boxes and a wall, relative to the eye, with the sky above.
fn scene() -> Vec<Vec3> {
    let mut triangles = ground();
    triangles.extend(quad([
        Vec3::new(2.0, -1.7, -4.0),
        Vec3::new(5.0, -1.2, -5.0),
        Vec3::new(5.0, 0.4, -9.0),
        Vec3::new(2.0, -0.1, -8.0),
    ]));
    triangles.extend(quad([
        Vec3::new(-30.0, -1.7, -60.0),
        Vec3::new(10.0, -1.7, -70.0),
        Vec3::new(14.0, 25.0, -90.0),
        Vec3::new(-28.0, 22.0, -80.0),
    ]));
    triangles.extend(cuboid(Vec3::new(-3.0, -1.7, -7.0), Vec3::new(-1.5, 0.3, -5.5)));
    triangles.extend(cuboid(Vec3::new(0.2, -0.6, -2.1), Vec3::new(0.5, -0.3, -1.8)));
    triangles.extend(cuboid(Vec3::new(12.0, -1.7, -40.0), Vec3::new(20.0, 9.0, -30.0)));
    triangles
}

fn ground() -> Vec<Vec3> {
    let (y, side) = (-1.7, 250.0);
    let corners = [(-side, -side), (side, -side), (side, side), (-side, side)];
    quad(corners.map(|(x, z)| Vec3::new(x, y, z))).to_vec()
}

/// Returns the sum of the differences, and the sum of `b`.
fn difference(a: &[u32], b: &[u32]) -> (u64, u64) {
    let differences = a.iter().zip(b).map(|(a, b)| u64::from(a.abs_diff(*b)));
    (differences.sum(), b.iter().map(|count| u64::from(*count)).sum())
}

/// Asserts that at most a share of the points is counted in a different place.
fn assert_close(name: &str, counts: &Counts, expected: &Counts, share: f64) {
    for (what, a, b) in [("cells", &counts.cells, &expected.cells), ("bins", &counts.bins, &expected.bins)] {
        let (difference, points) = difference(a, b);
        // A misplaced point is missing in one place and extra in another.
        let limit = 2.0 * share * points as f64;
        assert!(difference as f64 <= limit, "{name}, {what}: the difference is {difference}, of {points} points");
    }
}

/// Compares the pass with the reference, and returns its counts.
fn compared(gpu: &Engine, name: &str, view: &DemandView, drawing: &Drawing) -> Counts {
    let texture = draw(gpu, view, &scene(), drawing);
    let counts = Counts::from(&seen(gpu, view, &texture));
    let expected = Counts::from(&count_on_cpu(view, &read(gpu, &texture)).expect("a good view"));
    assert!(expected.cells.iter().sum::<u32>() > 5000, "{name}: too few points to compare");
    assert_eq!(expected.bins.iter().sum::<u32>() > 5000, view.frustum.near > 0.0, "{name}");
    assert_close(name, &counts, &expected, ROUNDING);
    counts
}

/// Returns a slanted orthographic view from above that begins at this view depth, in metres.
fn orthographic(near: f32) -> DemandView {
    let depth = DepthConvention::Reversed;
    let range = 65.0;
    // x and y of ±16 and ±9 m.
    let projection = Mat4::from_cols_array_2d(&[
        [1.0 / 16.0, 0.0, 0.0, 0.0],
        [0.0, 1.0 / 9.0, 0.0, 0.0],
        [0.0, 0.0, 1.0 / range, 0.0],
        [0.0, 0.0, (near + range) / range, 1.0],
    ]);
    let clip_from_world = projection * Mat4::from_rotation_x(0.6);
    let frustum = ViewFrustum::from_eye_from_clip(&clip_from_world.inverse(), DVec3::ZERO, depth, f32::MAX);
    DemandView { frustum: frustum.expect("a good matrix"), clip_from_world, ..view(depth, SIZE) }
}

/// Returns a view through a tilted portal that hides the lower part of the image. Its near plane is the
/// portal (E. Lengyel, "Oblique view frustum depth projection and clipping", 2005).
fn portal(depth: DepthConvention) -> DemandView {
    behind_plane(depth, DVec3::new(0.3, 0.5, -1.0), 2.0)
}

/// Returns a view whose near plane lies at a distance from the eye, in metres, along a normal.
fn behind_plane(depth: DepthConvention, normal: DVec3, distance: f64) -> DemandView {
    let view = view(depth, SIZE);
    let matrix = view.clip_from_world.as_dmat4();
    let plane = normal.normalize().extend(-distance);
    let sides = matrix.inverse().transpose() * plane;
    let corner = DVec4::new(sides.x.signum(), sides.y.signum(), f64::from(depth.far()), 1.0);
    let plane = plane / plane.dot(matrix.inverse() * corner);
    let mut rows = matrix.transpose();
    rows.z_axis = if depth == DepthConvention::Reversed { rows.w_axis - plane } else { plane };
    let clip_from_world = rows.transpose();
    let frustum = ViewFrustum::from_eye_from_clip(&clip_from_world.inverse().as_mat4(), DVec3::ZERO, depth, 150.0);
    DemandView { frustum: frustum.expect("a good matrix"), clip_from_world: clip_from_world.as_mat4(), ..view }
}

#[test]
fn counts_are_those_of_the_reference_for_every_kind_of_projection() {
    let gpu = Engine::shared();
    let plain = view(DepthConvention::ZeroToOne, SIZE);
    let reversed = view(DepthConvention::Reversed, SIZE);
    let lower_half = behind_plane(DepthConvention::Reversed, DVec3::NEG_Y, 0.5);
    let camera = camera();
    let clip_from_view = infinite(camera.clip_from_view(DepthConvention::Reversed), camera.near);
    let endless = DemandView { clip_from_world: clip_from_view * camera.view_from_world(), ..reversed };
    // Mirrored and off-axis: the centre of projection is in the lower left quarter.
    let skewed = Mat4::from_cols_array_2d(&[
        [-1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
        [0.2, -0.3, 0.0, 1.0],
    ]) * reversed.clip_from_world;
    let frustum = ViewFrustum::from_eye_from_clip(&skewed.inverse(), camera.eye, DepthConvention::Reversed, f32::MAX);
    let skewed = DemandView { clip_from_world: skewed, frustum: frustum.expect("a good matrix"), ..reversed };
    let near = DemandView { max_distance: 20.0, ..reversed };
    let cases = [
        ("plain", plain),
        ("reversed", reversed),
        ("endless", endless),
        ("skewed", skewed),
        ("to 20 m", near),
        ("plain portal", portal(DepthConvention::ZeroToOne)),
        ("reversed portal", portal(DepthConvention::Reversed)),
        ("the lower half of a picture", lower_half),
        ("orthographic", orthographic(1.5)),
        ("orthographic from behind the eye", orthographic(-5.0)),
    ];
    let share = lower_half.frustum.height_in_picture(&lower_half.clip_from_world);
    assert!((0.3..0.8).contains(&share), "{share} of the picture is shown");
    for (name, view) in cases {
        compared(&gpu, name, &view, &Drawing::new(SIZE));
    }
}

#[test]
fn a_part_of_a_texture_is_counted_as_a_picture_of_its_own() {
    let gpu = Engine::shared();
    let whole = view(DepthConvention::Reversed, SIZE);
    let part = DemandView { rectangle: [30, 50, SIZE[0], SIZE[1]], ..whole };
    let alone = compared(&gpu, "whole", &whole, &Drawing::new(SIZE));
    let within = compared(&gpu, "part", &part, &Drawing::new([200, 150]));
    assert_close("part of whole", &within, &alone, ROUNDING);
}

#[test]
fn every_point_of_lit_ground_is_counted_and_the_sky_is_not() {
    let gpu = Engine::shared();
    let view = view(DepthConvention::Reversed, SIZE);
    let texture = draw(&gpu, &view, &ground(), &Drawing::new(SIZE));
    let drawn = read(&gpu, &texture).values.iter().filter(|depth| **depth != 0.0).count();
    let counts = Counts::from(&seen(&gpu, &view, &texture));
    assert!(drawn > 3000 && drawn < (SIZE[0] * SIZE[1]) as usize, "{drawn}");
    assert_eq!(counts.cells.iter().sum::<u32>() as usize, drawn);
    assert_eq!(counts.bins.iter().sum::<u32>() as usize, drawn);
}

#[test]
fn an_empty_picture_gives_an_empty_grid_and_histogram() {
    let gpu = Engine::shared();
    for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed] {
        let view = view(depth, SIZE);
        let counted = seen(&gpu, &view, &draw(&gpu, &view, &[], &Drawing::new(SIZE)));
        assert!(counted.demand().counts.iter().all(|count| *count == 0));
        assert!(counted.histogram().is_empty());
    }
}

#[test]
fn points_turned_from_the_light_are_left_out_and_grazing_ones_ask_for_no_texel() {
    let gpu = Engine::shared();
    let count = |direction: Vec3| {
        let view = DemandView { direction, ..view(DepthConvention::Reversed, SIZE) };
        let counts = Counts::from(&seen(&gpu, &view, &draw(&gpu, &view, &ground(), &Drawing::new(SIZE))));
        [counts.cells, counts.bins].map(|counts| counts.iter().sum::<u32>())
    };
    assert_eq!(count(Vec3::new(0.3, 0.8, 0.25)), [0, 0]);
    let [cells, bins] = count(Vec3::new(1.0, -0.03, 0.0));
    assert!(cells == 0 && bins > 3000, "{cells} {bins}");
}

#[test]
fn plain_and_reversed_depth_give_the_same() {
    let gpu = Engine::shared();
    let [plain, reversed] = [DepthConvention::ZeroToOne, DepthConvention::Reversed]
        .map(|depth| compared(&gpu, "either", &view(depth, SIZE), &Drawing::new(SIZE)));
    // Plain depth has 24 bits for a range that grows with the square of the distance.
    assert_close("plain of reversed", &plain, &reversed, 0.02);
}

#[test]
fn only_the_first_sample_of_multisampled_depth_is_read() {
    let gpu = Engine::shared();
    let view = view(DepthConvention::Reversed, SIZE);
    let counted = |samples: u32, mask: u64| {
        Counts::from(&seen(&gpu, &view, &draw(&gpu, &view, &scene(), &Drawing { size: SIZE, samples, mask })))
    };
    let [first, others, all] = [1, !1, !0].map(|mask| counted(4, mask));
    assert!(others.cells.iter().chain(&others.bins).all(|count| *count == 0), "other samples were read");
    assert_eq!(first, all);
    // The sample is off the pixel's centre, so that points near the borders of cells move.
    for (a, b) in shares(&first).iter().zip(shares(&counted(1, !0))) {
        assert!((a - b).abs() < 0.02, "{a} of the points, and {b} at the centres");
    }
}

#[test]
fn silhouettes_do_not_mix_surfaces() {
    let gpu = Engine::shared();
    let camera = PerspectiveCamera { forward: Vec3::NEG_Z, ..camera() };
    let settings = MapSettings::default();
    let view = DemandView::from_camera(&camera, DepthConvention::Reversed, Vec3::new(0.0, -0.1, -1.0), &settings, SIZE)
        .expect("a good camera");
    // A wall that fills the view, and tiles in front of it.
    let wall = |x: f32, y: f32, z: f32, side: f32| {
        quad([(-side, side), (side, side), (side, -side), (-side, -side)].map(|(i, j)| Vec3::new(x + i, y + j, z)))
    };
    let mut triangles = wall(0.0, 0.0, -40.0, 60.0).to_vec();
    triangles.extend((-3..4_i16).flat_map(|i| wall(f32::from(i) * 1.1, f32::from(i) * 0.3, -5.0, 0.3)));
    let counts = Counts::from(&seen(&gpu, &view, &draw(&gpu, &view, &triangles, &Drawing::new(SIZE))));
    assert_eq!(counts.bins.iter().sum::<u32>(), SIZE[0] * SIZE[1]);
    let depths: Vec<usize> = (0..DEPTHS * CLASSES).filter(|bin| counts.bins[*bin] > 0).collect();
    assert!(depths.len() == 2 && depths[1] < DEPTHS, "a wall and tiles, both facing the eye: {depths:?}");
}

/// Returns the shares of the points in each octave of texels, and in each class and eighth of the depths.
fn shares(counts: &Counts) -> Vec<f64> {
    let share = |counts: &[u32], run: usize| -> Vec<f64> {
        let total: u32 = counts.iter().sum();
        counts.chunks(run).map(|run| f64::from(run.iter().sum::<u32>()) / f64::from(total)).collect()
    };
    let mut shares = share(&counts.cells, counts.cells.len() / 16);
    shares.extend(share(&counts.bins, DEPTHS / 8));
    shares
}

#[test]
fn shares_of_points_do_not_depend_on_the_resolution() {
    let gpu = Engine::shared();
    // 1% allows for points of pixels that edges cross. The adapter's rounding of corners moves all edges by
    // one step. Their total length is twice the border of the coarse image.
    let border = 4.0 * f64::from(SIZE[0] + SIZE[1]);
    let step_share = f64::from(subpixel_step(&gpu.adapter.get_info())) * border / f64::from(SIZE[0] * SIZE[1]);
    let coarse = compared(&gpu, "coarse", &view(DepthConvention::Reversed, SIZE), &Drawing::new(SIZE));
    for size in [[320, 180], [1280, 720]] {
        let counts = compared(&gpu, "fine", &view(DepthConvention::Reversed, size), &Drawing::new(size));
        for (a, b) in shares(&counts).iter().zip(shares(&coarse)) {
            assert!((a - b).abs() < 0.01 + step_share, "{size:?}: {a} of the points, and {b} in a coarse picture");
        }
    }
}

#[test]
fn counts_carry_the_stamp_of_their_picture_and_only_the_newest_is_given_once() {
    let gpu = Engine::shared();
    let mut pass = demand_pass(&gpu, 1);
    assert_eq!(pass.wait(), Ok(None), "nothing was recorded");
    let first = DemandView { max_distance: 20.0, ..view(DepthConvention::Reversed, SIZE) };
    let second = DemandView { direction: Vec3::new(-0.5, -0.6, 0.2), ..view(DepthConvention::Reversed, SIZE) };
    let texture = draw(&gpu, &first, &scene(), &Drawing::new(SIZE));
    for (views, newest, far) in [(vec![first], first, 20.0), (vec![first, second], second, 300.0)] {
        for view in &views {
            record(&gpu, &mut pass, view, &texture);
        }
        let seen = pass.wait().expect("the device works").expect("frames were recorded");
        let space = DemandSpace::new(&newest.frustum, newest.direction, newest.up, newest.max_distance);
        assert_eq!(Ok(seen.demand().space), space);
        assert_eq!((seen.histogram().near, seen.histogram().far), (0.1, far));
        assert_eq!(Counts::from(&seen), demand_counts(&gpu, &newest, &texture));
        assert_eq!(pass.take(), Ok(None), "already taken");
    }
    record(&gpu, &mut pass, &first, &texture);
    pass.reset();
    assert_eq!(pass.wait(), Ok(None), "forgotten");
}

fn demand_counts(gpu: &Engine, view: &DemandView, texture: &wgpu::TextureView) -> Counts {
    Counts::from(&seen(gpu, view, texture))
}

#[test]
fn recording_ends_where_pictures_pile_up_and_goes_on_when_they_are_dropped_or_taken() {
    let gpu = Engine::shared();
    let mut pass = demand_pass(&gpu, 1);
    let view = view(DepthConvention::Reversed, SIZE);
    let texture = draw(&gpu, &view, &scene(), &Drawing::new(SIZE));
    for _ in 0..2 {
        let mut encoder = gpu.encoder();
        let recorded = (0..9).filter(|_| pass.record(&mut encoder, &texture, &view, None) == Ok(true)).count();
        assert_eq!(recorded, 4);
        assert_eq!(pass.take(), Ok(None), "not submitted");
        // Dropped without having been submitted.
        drop(encoder);
    }
    record(&gpu, &mut pass, &view, &texture);
    assert!(pass.wait().is_ok_and(|seen| seen.is_some()));
}

#[test]
fn what_cannot_be_counted_is_an_error_that_says_why() {
    let gpu = Engine::shared();
    let mut pass = demand_pass(&gpu, 1);
    let good = view(DepthConvention::Reversed, SIZE);
    let texture = draw(&gpu, &good, &scene(), &Drawing::new(SIZE));
    let multisampled = draw(&gpu, &good, &scene(), &Drawing { samples: 4, ..Drawing::new(SIZE) });
    let mut refused = |view: DemandView, texture: &wgpu::TextureView| {
        let mut encoder = gpu.encoder();
        pass.record(&mut encoder, texture, &view, None).expect_err("it is refused")
    };
    let rectangle = [1, 0, SIZE[0], SIZE[1]];
    let error = refused(DemandView { rectangle, ..good }, &texture);
    assert_eq!(error, DepthBufferError::Rectangle { rectangle, texture: SIZE }.into());
    let rectangle = [0, 0, 0, SIZE[1]];
    assert!(matches!(
        refused(DemandView { rectangle, ..good }, &texture),
        DemandPassError::DepthBuffer(DepthBufferError::Rectangle { .. })
    ));
    assert!(matches!(
        refused(good, &multisampled),
        DemandPassError::DepthBuffer(DepthBufferError::Texture { samples: 4, expected_samples, .. })
            if expected_samples == [1]
    ));
    let depth = DepthConvention::NegativeOneToOne;
    assert_eq!(
        refused(DemandView { depth, ..good }, &texture),
        DemandPassError::DepthBuffer(DepthBufferError::Depth(depth))
    );
    for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed] {
        let other = DemandView { clip_from_world: camera().clip_from_world(depth), ..good };
        let told =
            if depth == DepthConvention::Reversed { DepthConvention::ZeroToOne } else { DepthConvention::Reversed };
        assert_eq!(
            refused(DemandView { depth: told, ..other }, &texture),
            DemandPassError::DepthBuffer(DepthBufferError::OtherDepth(told))
        );
    }
    for clip_from_world in [Mat4::ZERO, Mat4::NAN] {
        assert_eq!(
            refused(DemandView { clip_from_world, ..good }, &texture),
            DemandPassError::DepthBuffer(DepthBufferError::SingularMatrix)
        );
    }
    for direction in [Vec3::ZERO, Vec3::NAN] {
        assert!(matches!(refused(DemandView { direction, ..good }, &texture), DemandPassError::Fit(_)));
    }
    assert!(matches!(refused(DemandView { max_distance: f32::NAN, ..good }, &texture), DemandPassError::Fit(_)));
}

#[test]
fn counts_of_a_lost_device_are_an_error_each_time() {
    let gpu = Engine::open(wgpu::Limits::default());
    let mut pass = demand_pass(&gpu, 1);
    let view = view(DepthConvention::Reversed, SIZE);
    let texture = draw(&gpu, &view, &scene(), &Drawing::new(SIZE));
    record(&gpu, &mut pass, &view, &texture);
    assert!(pass.wait().is_ok_and(|seen| seen.is_some()));
    gpu.device.destroy();
    for _ in 0..6 {
        record(&gpu, &mut pass, &view, &texture);
        assert_eq!(pass.take(), Err(DemandPassError::Lost));
    }
    assert!(DemandPassError::Lost.to_string().contains("device is lost"));
}
