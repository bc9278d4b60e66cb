//! The demand grid: the cell of a visible point, computed by hand and at any scale.

use proptest::prelude::*;
use shadowfit::demand::{CELLS, DemandSpace, LEVELS, MIN_FACING, SIDE};
use shadowfit::glam::{DVec3, Vec3};
use shadowfit::{FitError, PerspectiveCamera};

use crate::scenes::any_light;
use crate::support::{any_camera, any_direction, cases, float};

/// Returns a space under a vertical light, with cells of 1/4 m for texels of 1/1024 to 2/1024 m.
fn space() -> DemandSpace {
    DemandSpace {
        origin: DVec3::ZERO,
        direction: Vec3::NEG_Y,
        x: Vec3::X,
        y: Vec3::NEG_Z,
        texel: 1.0 / 1024.0,
        cell: 0.25,
    }
}

/// Returns the cell of a point on level ground that moves by `pixel` metres per pixel.
fn on_ground(space: &DemandSpace, x: f32, z: f32, pixel: f32) -> Option<usize> {
    space.index(Vec3::new(x, -2.0, z), Vec3::Y, Vec3::X * pixel, Vec3::Z * pixel)
}

const fn index(level: usize, row: usize, column: usize) -> usize {
    (level * SIDE + row) * SIDE + column
}

#[test]
fn points_count_in_the_cells_that_hand_finds() {
    assert_eq!((LEVELS, SIDE, CELLS), (16, 32, 16_384));
    let cases = [
        // The eye is in the middle: at the corner of cells 15 and 16.
        ((0.0, 0.0, 0.0015), Some(index(0, 16, 16))),
        ((-0.01, 0.01, 0.0015), Some(index(0, 15, 15))),
        // 0.3 m are 1.2 cells of 0.25 m to the right, -0.6 m along z are 2.4 cells up.
        ((0.3, -0.6, 0.0015), Some(index(0, 18, 17))),
        // The outermost cells of level 0 end at 16 · 0.25 m = 4 m.
        ((3.99, 3.99, 0.0015), Some(index(0, 0, 31))),
        ((-3.99, -3.99, 0.0015), Some(index(0, 31, 0))),
        // Beyond that, a point counts as coarser: 5 m are 10 cells of 0.5 m.
        ((5.0, 0.0, 0.0015), Some(index(1, 16, 26))),
        // 100 m are 12.5 cells of 8 m, the first cells that reach it: cells of 4 m end at 64 m.
        ((-100.0, 0.0, 0.0015), Some(index(5, 16, 3))),
        // Level 0 is the finest, at any distance.
        ((0.3, -0.6, 1e-6), Some(index(0, 18, 17))),
        ((0.3, -0.6, 0.0), Some(index(0, 18, 17))),
        // Octaves: level 0 begins at 1/1024 m, level 1 with its cells of 0.5 m at 2/1024 m.
        ((0.3, -0.6, 1.0 / 1024.0), Some(index(0, 18, 17))),
        ((0.3, -0.6, 1.999 / 1024.0), Some(index(0, 18, 17))),
        ((0.3, -0.6, 2.0 / 1024.0), Some(index(1, 17, 16))),
        ((0.3, -0.6, 3.9 / 1024.0), Some(index(1, 17, 16))),
        ((0.3, -0.6, 4.0 / 1024.0), Some(index(2, 16, 16))),
        // Level 15 is the coarsest, from 32 m, and its cells of 8192 m reach 131,072 m.
        ((1e5, 0.0, 33.0), Some(index(15, 16, 28))),
        ((1e5, 0.0, 1e6), Some(index(15, 16, 28))),
        ((131_073.0, 0.0, 33.0), None),
        ((2e5, 0.0, 0.0015), None),
    ];
    for ((x, z, pixel), expected) in cases {
        assert_eq!(on_ground(&space(), x, z, pixel), expected, "({x}, {z}), {pixel} m for a pixel");
    }
}

#[test]
fn the_finer_axis_of_the_texel_counts() {
    let count = |right, down| space().index(Vec3::ZERO, Vec3::Y, right, down);
    // 1.5 mm along x and 100 mm along z: the least singular value is the former.
    assert_eq!(count(Vec3::X * 0.0015, Vec3::Z * 0.1), Some(index(0, 16, 16)));
    assert_eq!(count(Vec3::X * 0.1, Vec3::Z * 0.0015), Some(index(0, 16, 16)));
    // A square turned by 45° keeps its size: 0.003 √2 · √½ · … = 3 mm in both directions.
    let half = 0.003 * core::f32::consts::FRAC_1_SQRT_2;
    assert_eq!(count(Vec3::new(half, 0.0, half), Vec3::new(-half, 0.0, half)), Some(index(1, 16, 16)));
    // The pixel moves the point along one line only, so the other axis needs no particular texel size.
    assert_eq!(count(Vec3::X, Vec3::X), Some(index(0, 16, 16)));
    // Movement along the light does not count in the plane.
    assert_eq!(count(Vec3::new(0.0015, 9.0, 0.0), Vec3::new(0.0, -9.0, 0.0015)), Some(index(0, 16, 16)));
    // A plane whose second axis is twice as long halves the texel there: 2 · 0.8 mm.
    let space = DemandSpace { y: Vec3::NEG_Z * 2.0, ..space() };
    assert_eq!(space.index(Vec3::ZERO, Vec3::Y, Vec3::X * 0.01, Vec3::Z * 0.0008), Some(index(0, 16, 16)));
    assert_eq!(space.index(Vec3::ZERO, Vec3::Y, Vec3::X * 0.01, Vec3::Z * 0.0012), Some(index(1, 16, 16)));
}

#[test]
fn points_turned_from_the_light_or_nearly_so_do_not_count() {
    let facing = |cosine: f32| {
        let normal = Vec3::new((1.0 - cosine * cosine).sqrt(), cosine, 0.0);
        space().index(Vec3::ZERO, normal, Vec3::X, Vec3::Z).is_some()
    };
    for (cosine, counts) in [
        (1.0, true),
        (0.1, true),
        (MIN_FACING, true),
        (MIN_FACING * 0.999, false),
        (0.0, false),
        (-0.5, false),
        (-1.0, false),
    ] {
        assert_eq!(facing(cosine), counts, "{cosine}");
    }
}

#[test]
fn numbers_that_are_none_count_nowhere() {
    let good = [Vec3::ZERO, Vec3::Y, Vec3::X * 0.01, Vec3::Z * 0.01];
    let [position, normal, right, down] = good;
    assert!(space().index(position, normal, right, down).is_some());
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for (vector, axis) in (0..4).flat_map(|vector| (0..3).map(move |axis| (vector, axis))) {
            let mut all = good;
            all[vector][axis] = bad;
            let [position, normal, right, down] = all;
            assert_eq!(space().index(position, normal, right, down), None, "{bad} in {vector}, {axis}");
        }
    }
}

#[test]
fn a_space_of_bad_input_is_an_error() {
    let camera = crate::support::camera();
    let view = camera.frustum().unwrap();
    let new = |direction, up, distance| DemandSpace::new(&view, direction, up, distance);
    assert!(new(Vec3::NEG_Y, Vec3::Y, f32::MAX).is_ok());
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert!(new(Vec3::NEG_Y, Vec3::Y, bad).is_err(), "{bad}");
        for axis in 0..3 {
            let mut vector = Vec3::new(0.3, -0.8, 0.4);
            vector[axis] = bad;
            assert!(new(vector, Vec3::Y, f32::MAX).is_err() && new(Vec3::NEG_Y, vector, f32::MAX).is_err());
            let mut view = view;
            view.corners[5][axis] = bad;
            assert!(DemandSpace::new(&view, Vec3::NEG_Y, Vec3::Y, f32::MAX).is_err());
        }
    }
    assert!(new(Vec3::ZERO, Vec3::Y, f32::MAX).is_err());
    assert!(new(Vec3::NEG_Y, Vec3::ZERO, f32::MAX).is_err());
    assert!(matches!(new(Vec3::NEG_Y, Vec3::Y, camera.near), Err(FitError::NearNotBelowFar { .. })));
}

proptest! {
    #![proptest_config(cases(1000))]

    /// Powers of two scale without rounding, so that centimetres and kilometres count in the same cells.
    #[test]
    fn scenes_of_another_unit_count_in_the_same_cells(
        camera in any_camera(), direction in any_light(), octaves in -12..12_i32,
        places in prop::collection::vec((float(-1.0, 1.0), float(-1.0, 1.0), float(-1.0, 1.0), float(-14.0, 0.0)), 16),
        normal in any_direction(), right in any_direction(), down in any_direction(),
    ) {
        let scale = f64::from(octaves).exp2();
        let scaled = PerspectiveCamera {
            eye: camera.eye * scale,
            near: camera.near * scale as f32,
            far: camera.far * scale as f32,
            ..camera
        };
        let [one, other] =
            [camera, scaled].map(|c| DemandSpace::new(&c.frustum().unwrap(), direction, Vec3::Y, f32::MAX).unwrap());
        prop_assert_eq!(other.texel, one.texel * scale as f32);
        prop_assert_eq!(other.cell, one.cell * scale as f32);
        prop_assert_eq!((one.x, one.y, one.direction), (other.x, other.y, other.direction));
        for (x, y, z, size) in places {
            let (p, pixel) = (Vec3::new(x, y, z) * camera.far, size.exp2() * camera.far);
            let index = |space: &DemandSpace, k: f32| space.index(p * k, normal, right * (pixel * k), down * (pixel * k));
            prop_assert_eq!(index(&one, 1.0), index(&other, scale as f32));
        }
    }

    /// The sixteen octaves end at the pixel size of the far end. A cell is a quarter of the distance for its
    /// level, so visible points have a cell of their octave or a slightly coarser one.
    #[test]
    fn what_is_in_view_counts_by_its_octave(
        camera in any_camera(), direction in any_light(), (x, y) in (float(-1.0, 1.0), float(-1.0, 1.0)),
        octaves in float(0.0, 8.0),
    ) {
        let view = camera.frustum().unwrap();
        let space = DemandSpace::new(&view, direction, Vec3::Y, f32::MAX).unwrap();
        let depth = (camera.far / octaves.exp2()).max(camera.near);
        let [forward, up] = [camera.forward, camera.up].map(Vec3::normalize);
        let side = forward.cross(up).normalize();
        let above = side.cross(forward);
        let height = (camera.fov_y * 0.5).tan() * depth;
        // A surface that faces the light and has the pixel's height along both axes of the plane.
        let pixel = 2.0 * height / shadowfit::demand::PIXELS;
        let p = forward * depth + side * (x * height) + above * (y * height);
        let (a, b) = (space.x * pixel, space.y.normalize() * (pixel / space.y.length()));
        // Points farther away in the plane than twice the far end's distance may have no cell.
        let farthest = space.x.dot(p).abs().max(space.y.dot(p).abs());
        prop_assume!(farthest < 2.0 * camera.far);
        let index = space.index(p, -space.direction, a, b).expect("it has a cell");
        let level = (pixel / space.texel).log2();
        // Rounding may select the other side of an octave's end. Points in the corners of a picture, or where
        // the plane's second axis is up to four times longer, may be too far away for their level's cells.
        let (found, least) = ((index / (SIDE * SIDE)) as f32, level.floor().min((level - 1e-4).floor()));
        prop_assert!(found >= least.max(0.0) && found <= level.max(0.0) + 2.0, "level {found} for {level}");
    }
}

/// Returns a lens's space for a camera that looks level along -z, under a sun at an elevation in degrees to
/// the left.
fn space_of(fov_y: f32, elevation: f32) -> DemandSpace {
    let (eye, forward, up) = (DVec3::ZERO, Vec3::NEG_Z, Vec3::Y);
    let camera = PerspectiveCamera { eye, forward, up, fov_y, aspect: 16.0 / 9.0, near: 0.1, far: 500.0 };
    let (sin, cos) = elevation.to_radians().sin_cos();
    DemandSpace::new(&camera.frustum().unwrap(), Vec3::new(cos, -sin, 0.0), up, f32::MAX).unwrap()
}

/// Returns the mean number of octaves by which a point counts as too coarse, over an octave of view depths.
/// The point is at shares of the view depth to the right and above, on a surface that faces the camera or the
/// sun's side.
fn octaves_too_coarse(fov_y: f32, elevation: f32, (right, above): (f32, f32), normal: Vec3) -> f32 {
    let space = space_of(fov_y, elevation);
    let octave = |i: u8| {
        let depth = 10.0 * (f32::from(i) / 8.0).exp2();
        let pixel = 2.0 * (fov_y * 0.5).tan() / shadowfit::demand::PIXELS * depth;
        let across = if normal.x == 0.0 { Vec3::X } else { Vec3::Z };
        let (a, b) = (across * pixel, Vec3::NEG_Y * pixel);
        let seen = [a, b].map(|v| (space.x.dot(v), space.y.dot(v)));
        let wanted = least_singular_value(seen);
        let index = space.index(Vec3::new(right, above, -1.0) * depth, normal, a, b).expect("it is lit");
        (index / (SIDE * SIDE)) as f32 - (wanted / space.texel).log2().floor()
    };
    (0..8).map(octave).sum::<f32>() / 8.0
}

/// Returns the least singular value of a matrix with these columns.
fn least_singular_value([(ax, ay), (bx, by)]: [(f32, f32); 2]) -> f32 {
    let sum = ax * ax + ay * ay + bx * bx + by * by;
    let det = ax * by - ay * bx;
    ((sum - (sum * sum - 4.0 * det * det).max(0.0).sqrt()) * 0.5).sqrt()
}

/// A street's wall needs texels a sixth as wide as its pixels under a sun 80 degrees high.
#[test]
fn walls_under_a_high_sun_count_by_their_own_octave_or_the_next() {
    let coarser = octaves_too_coarse(0.9, 80.0, (0.4, 0.2), Vec3::NEG_X);
    assert!(coarser < 1.0, "{coarser} octaves too coarse");
}

/// The sides of a picture of 170 degrees are twenty times farther from the eye than their view depth.
#[test]
fn the_sides_of_a_wide_picture_count_by_their_own_octave_or_the_next() {
    let coarser = octaves_too_coarse(2.967, 45.0, (15.0, 5.0), Vec3::NEG_X);
    assert!(coarser < 1.0, "{coarser} octaves too coarse");
}

#[test]
fn cells_of_a_long_lens_are_finer() {
    let [usual, long] = [0.9_f32, 0.0175].map(|fov| {
        let space = space_of(fov, 45.0);
        // The view depth at which a pixel is as wide as the finest texel.
        let depth = space.texel * shadowfit::demand::PIXELS / (2.0 * (fov * 0.5).tan());
        space.cell / depth
    });
    assert!((usual - 0.25).abs() < 1e-3 && (0.0625..0.126).contains(&long), "{usual} {long}");
}

#[test]
fn every_lit_point_in_view_has_a_cell() {
    for (fov_y, far) in [0.0035_f32, 0.0175, 0.1, 0.9, 2.0, 2.97]
        .into_iter()
        .flat_map(|fov| [300.0, 480.0, 512.0, 520.0].map(|far| (fov, far)))
    {
        for (elevation, forward) in
            [(3.0_f32, Vec3::Z), (20.0, Vec3::X), (45.0, Vec3::NEG_Z), (85.0, Vec3::new(0.3, -0.9, 0.2))]
        {
            let (sin, cos) = elevation.to_radians().sin_cos();
            let direction = Vec3::new(0.6 * cos, -sin, 0.8 * cos);
            let camera =
                PerspectiveCamera { eye: DVec3::ZERO, forward, up: Vec3::Y, fov_y, aspect: 2.4, near: 0.1, far };
            let view = camera.frustum().unwrap();
            let space = DemandSpace::new(&view, direction, Vec3::Y, far * 0.8).unwrap();
            for corner in view.corners[4..].iter().map(|corner| *corner * 0.7999) {
                for share in [1.0, 0.1, 0.001] {
                    let point = corner * share;
                    let pixel = (fov_y * 0.5).tan() * 2.0 * point.dot(view.forward) / shadowfit::demand::PIXELS;
                    let side = direction.any_orthonormal_vector();
                    let (right, down) = (side * pixel, direction.cross(side) * pixel);
                    let found = space.index(point, -direction, right, down);
                    assert!(found.is_some(), "{fov_y} {far} {elevation}: {point}");
                }
            }
        }
    }
}
