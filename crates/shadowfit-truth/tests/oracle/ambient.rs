//! Ambient occlusion against values in closed form.

use glam::{DVec3, Vec3};
use shadowfit_truth::{AmbientSettings, AmbientTruth, PixelCamera, Tracer, Truth};

use super::scenes::{Triangles, cuboid, level, looking_at, looking_down, quad};

/// Half size of the planes. Rays of a metre do not reach their ends.
const FAR: f32 = 50.0;

fn floor() -> Triangles {
    level(0.0, [-FAR, -FAR], [FAR, FAR])
}

/// Returns the plane x = 0 above the floor.
fn wall() -> Triangles {
    let at = |y: f32, z: f32| Vec3::new(0.0, y, z);
    quad([at(0.0, -FAR), at(FAR, -FAR), at(FAR, FAR), at(0.0, FAR)])
}

fn traced(triangles: Triangles, camera: &PixelCamera, settings: &AmbientSettings) -> AmbientTruth {
    let tracer = Tracer::new(triangles);
    AmbientTruth::trace(&tracer, camera, settings, &Truth::seen_by_rays(&tracer, camera))
}

/// Returns the occlusion of a pixel of one metre a side, straight over (x, 0).
fn over(triangles: Triangles, x: f64, settings: &AmbientSettings) -> f64 {
    let camera = PixelCamera { eye: DVec3::new(x, 0.9, 0.0), near: 1e-3, ..looking_down(0.9, 1e-3, [1, 1]) };
    traced(triangles, &camera, settings).occlusion[0].expect("the floor").into()
}

#[test]
fn an_open_plane_hides_nothing_and_the_sky_has_no_value() {
    let camera = looking_at(DVec3::new(-4.0, 4.0, 5.0), DVec3::Y * 3.0, [60, 40]);
    let truth = traced(level(0.0, [-6.0, -6.0], [6.0, 6.0]), &camera, &AmbientSettings::default());
    assert!(truth.occlusion.iter().any(Option::is_none));
    let seen: Vec<f32> = truth.occlusion.iter().flatten().copied().collect();
    assert!(seen.len() > 500 && seen.iter().all(|occlusion| *occlusion == 0.0));
}

/// Returns the occlusion of a point on a floor at a distance `k` from an endless wall, in units of the
/// fall-off distance.
///
/// Cosine-weighted directions, seen from above, fill the disc evenly: the share of directions with a
/// component u toward the wall is `(2/π) √(1-u²) du`. Such a ray meets the wall at k/u, so the occlusion is
/// `O = (2/π) ∫ √(1-u²) (1 - k/u) du` from k to 1. With `∫ √(1-u²) du = (u √(1-u²) + asin u)/2`,
/// `∫ √(1-u²)/u du = √(1-u²) - artanh √(1-u²)` and `s = √(1-k²)`, this is
/// `O = (acos k + k s - 2 k artanh s) / π`: 1/2 in the corner, 0 from k = 1 on, and 0.08672 at k = 0.4, where
/// acos k = 1.15928, s = 0.916515 and artanh s = 1.56680.
fn beside_a_wall(k: f64) -> f64 {
    let s = (1.0 - k * k).sqrt();
    (k.acos() + k * s - 2.0 * k * s.atanh()) / core::f64::consts::PI
}

#[test]
fn a_floor_beside_a_wall_is_occluded_as_the_integral_says() {
    assert!((beside_a_wall(0.4) - 0.08672).abs() < 1e-4, "{}", beside_a_wall(0.4));
    for distance in [1.0, 2.5] {
        for k in [0.01, 0.1, 0.4, 0.8, 0.99] {
            let of = |rays| {
                over(
                    [floor(), wall()].concat(),
                    k * distance,
                    &AmbientSettings { rays, distance, ..Default::default() },
                )
            };
            // A step at the border of a disc with 32 even points errs by about n^(-3/4), 7%. This integrand
            // has no step.
            let (few, many, wanted) = (of(32), of(8192), beside_a_wall(k));
            assert!((few - wanted).abs() < 0.03, "{few} {wanted} at {k}");
            assert!((many - wanted).abs() < 1e-3, "{many} {wanted} at {k}");
        }
        let beyond =
            over([floor(), wall()].concat(), distance * 1.01, &AmbientSettings { distance, ..Default::default() });
        assert_eq!(beyond, 0.0);
    }
}

#[test]
fn the_side_of_the_eye_is_occluded_whichever_way_triangles_wind() {
    let flipped = |triangles: Triangles| triangles.into_iter().map(|[a, b, c]| [c, b, a]).collect::<Triangles>();
    let settings = AmbientSettings::default();
    let both = [floor(), wall()].concat();
    assert_eq!(over(both.clone(), 0.2, &settings), over(flipped(both), 0.2, &settings));
}

#[test]
fn a_closed_box_is_nearly_black_where_its_walls_are_near_and_open_where_they_are_far() {
    let settings = AmbientSettings { ray_offset: 1e-4, ..AmbientSettings::default() };
    let inside = |half: f32| cuboid(Vec3::new(-half, 0.0, -half), Vec3::new(half, 2.0 * half, half));
    let at = |half: f32, x: f64| {
        let eye = DVec3::new(x, f64::from(half), 0.0);
        let camera = PixelCamera { eye, near: 1e-4, ..looking_down(f64::from(half), 1e-4, [1, 1]) };
        f64::from(traced(inside(half), &camera, &settings).occlusion[0].expect("the floor"))
    };
    // No ray is longer than the diagonal, 5 cm times √3.
    assert!(at(0.025, 0.0) > 1.0 - 0.05 * 3f64.sqrt() && at(0.025, 0.0) < 1.0);
    // In a box of 20 m only the floor beside a wall is occluded, as if the wall were endless.
    assert_eq!(at(10.0, 0.0), 0.0);
    assert!((at(10.0, 9.9) - beside_a_wall(0.1)).abs() < 0.03, "{}", at(10.0, 9.9));
}

#[test]
fn the_error_of_a_picture_is_its_mean_over_the_pixels_that_have_a_truth() {
    // A floor under the left half of 40 by 10 pixels.
    let camera = looking_down(1.0, 0.1, [40, 10]);
    let truth = traced(level(0.0, [-9.0, -9.0], [0.0, 9.7]), &camera, &AmbientSettings::default());
    let error = |value: &dyn Fn(usize) -> f32| {
        truth.mean_absolute_error(&(0..400).map(|pixel| value(pixel % 40)).collect::<Vec<_>>())
    };
    assert_eq!(error(&|_| 0.0), Some(0.0));
    // Half of the 20 columns are at 0.5. Values in the sky are ignored.
    assert_eq!(error(&|column| if column < 10 { 0.5 } else { 0.0 }), Some(0.25));
    assert_eq!(error(&|column| if column < 20 { 0.0 } else { 1.0 }), Some(0.0));
    assert_eq!(error(&|_| 7.0), Some(1.0));
    assert_eq!(error(&|column| if column == 0 { f32::NAN } else { 0.0 }), Some(0.05));
    let sky = traced(Triangles::new(), &camera, &AmbientSettings::default());
    assert_eq!(sky.mean_absolute_error(&[0.3; 400]), None);
}
