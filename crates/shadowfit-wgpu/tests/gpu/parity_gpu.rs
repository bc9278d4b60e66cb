//! The formulas of the look-up in WGSL equal those in Rust: projection, biases, selection of the map,
//! comparison.

use shadowfit::glam::{DVec2, DVec3, UVec2, Vec3};
use shadowfit::settings::{BiasSettings, FilterKind, FitSettings, MapFormat, MapSelection, Softness};
use shadowfit::{Bias, DepthConvention, FittedMap, LightProjection, PerspectiveCamera, fit};
use shadowfit_wgpu::ShadowMapDescriptor;

use super::engine::Engine;
use super::engine::points::Point;
use super::harness::Harness;

/// Number of compared points.
const POINTS: usize = 600;

/// Width of the maps in texels.
const RESOLUTION: u32 = 256;

/// Cosine below which the WGSL clamps the slope's tangent.
const MIN_COSINE: f64 = 0.005;

/// Allowed difference in texture coordinates and depth. A term of the projection is at most |p| / extent,
/// about 3 here. The longest chain is 12 operations in f32 (2⁻²⁴ each), a square root and a division of 2.5
/// ULP by WGSL's rules.
const TOLERANCE: f64 = 16.0 * 3.0 / 16_777_216.0;

/// Biases that are large and all different, so that they cannot be confused.
const BIAS: BiasSettings =
    BiasSettings { constant: 3.0, slope: 1.5, normal_offset: 2.0, receiver_plane: 1.25, depth_steps: 1.0 };

/// Returns numbers in 0..1 that fill the cube evenly: fractional parts of multiples of powers of a
/// generalised golden ratio (Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018).
fn evenly(index: usize, axis: i32) -> f64 {
    (0.5 + (index as f64 + 1.0) * 1.167_303_978_261_418_7_f64.powi(-axis)).fract()
}

fn two_fits(origin: DVec3, depth: DepthConvention) -> [LightProjection; 2] {
    let camera = PerspectiveCamera {
        eye: origin,
        forward: Vec3::new(0.3, -0.2, -1.0),
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: 1.6,
        near: 0.1,
        far: 100.0,
    };
    let frustum = camera.frustum().expect("a good camera");
    [12.0, 60.0].map(|max_distance| {
        let settings = FitSettings::default()
            .with_max_distance(max_distance)
            .with_caster_extension(20.0)
            .with_resolution(UVec2::splat(RESOLUTION))
            .with_depth(depth);
        fit(&frustum, Vec3::new(0.4, -0.8, 0.3), &settings).expect("a good fit")
    })
}

/// Returns points in and around the far map's box, with normals in all directions, relative to the fits'
/// origin.
fn points(fits: &[LightProjection; 2]) -> Vec<Point> {
    let corners = fits[1].corners();
    let (right, down, away) = (corners[1] - corners[0], corners[3] - corners[0], corners[4] - corners[0]);
    (0..POINTS)
        .map(|index| {
            // Every other point is near the eye, in the near map.
            let reach = if index % 2 == 0 { 1.2 } else { 0.3 };
            let at = [1, 2, 3].map(|axis| ((evenly(index, axis) - 0.5) * reach) as f32 + 0.5);
            let center = if index % 2 == 0 { corners[0] } else { -(right + down + away) * 0.5 };
            let (height, turn) = (evenly(index, 4) * 2.0 - 1.0, evenly(index, 5) * core::f64::consts::TAU);
            let level = (1.0 - height * height).sqrt();
            let normal = DVec3::new(level * turn.cos(), height, level * turn.sin()).as_vec3();
            Point {
                position: (center + right * at[0] + down * at[1] + away * at[2]).to_array(),
                normal: normal.to_array(),
            }
        })
        .collect()
}

/// Returns texture coordinates and depth of a position, in f64 with the fit's own numbers.
fn uv(fit: &LightProjection, position: DVec3) -> DVec3 {
    let m = fit.uv_from_world.as_dmat4();
    (m.x_axis * position.x + m.y_axis * position.y + m.z_axis * position.z + m.w_axis).truncate()
}

fn bias_of(fit: &LightProjection) -> Bias {
    Bias::from_texels(&BIAS, MapFormat::Depth32Float, fit)
}

/// Returns the expected result of `shadowfit_project`, from the core's `Bias`.
fn projected(fit: &LightProjection, bias: &Bias, point: &Point) -> DVec3 {
    let (position, normal) = (Vec3::from(point.position).as_dvec3(), Vec3::from(point.normal).as_dvec3());
    let cosine = normal.dot(-fit.direction.as_dvec3()).clamp(MIN_COSINE, 1.0);
    let sine = (1.0 - cosine * cosine).sqrt();
    let at = uv(fit, position + normal * f64::from(bias.normal_offset) * sine);
    let gradient = gradient(fit, normal, cosine);
    let rise = f64::from(bias.receiver_plane) * (gradient.x.abs() + gradient.y.abs());
    let toward_light = f64::from(bias.constant_depth) + f64::from(bias.slope_depth) * sine / cosine + rise;
    let sign = if fit.depth == DepthConvention::Reversed { 1.0 } else { -1.0 };
    at + DVec3::Z * sign * toward_light
}

/// Returns the change of a plane's depth over a texel along u and v. Its height falls by n·x / n·z along x,
/// and v runs against y.
fn gradient(fit: &LightProjection, normal: DVec3, cosine: f64) -> DVec2 {
    let along = |row: usize| fit.light_from_world.row(row).truncate().as_dvec3().dot(normal);
    let away_from_light = if fit.depth == DepthConvention::Reversed { -1.0 } else { 1.0 };
    let texel = fit.texel_size.as_dvec2();
    DVec2::new(along(0) * texel.x, -along(1) * texel.y) * (away_from_light / (cosine * f64::from(fit.depth_range)))
}

fn is_inside(uv: DVec3) -> bool {
    uv.cmpge(DVec3::ZERO).all() && uv.cmple(DVec3::ONE).all()
}

/// Returns whether rounding may put a point on the other side of a border of the map.
fn is_at_border(uv: DVec3) -> bool {
    uv.to_array().iter().any(|x| x.abs().min((x - 1.0).abs()) < TOLERANCE)
}

/// Returns a triangle that covers the whole map at half its depth, relative to the fit's origin.
fn half_way(fit: &LightProjection) -> Vec<Vec3> {
    let c = fit.corners();
    let [corner, right, below] = [0, 1, 3].map(|i: usize| (c[i] + c[i + 4]) * 0.5);
    let margin = (right - corner) + (below - corner);
    let start = corner - margin * 0.5;
    vec![start, start + (right - corner) * 4.0, start + (below - corner) * 4.0]
}

/// Returns descriptors with all conventions and storages. The uniforms' origin differs from the fits' origin.
fn cases() -> impl Iterator<Item = ShadowMapDescriptor> {
    let all = [MapFormat::Depth32Float, MapFormat::R32Float]
        .map(|format| [DepthConvention::ZeroToOne, DepthConvention::Reversed].map(|depth| (format, depth)));
    all.into_iter().flatten().map(|(format, depth)| ShadowMapDescriptor {
        resolution: [RESOLUTION; 2],
        maps: 2,
        format,
        filter: FilterKind::Point,
        softness: Softness::default(),
        selection: MapSelection::ViewDepth { overlap: 0.0 },
        depth,
        ..ShadowMapDescriptor::default()
    })
}

/// Returns a new origin, the fits relative to it, and the points.
fn moved(depth: DepthConvention) -> (DVec3, [LightProjection; 2], Vec<Point>) {
    let (eye, origin) = (DVec3::new(1000.0, 20.0, -3000.0), DVec3::new(1004.0, 18.0, -3002.0));
    let fits = two_fits(eye, depth).map(|fit| fit.relative_to(origin));
    (origin, fits, points(&fits))
}

#[test]
fn projection_and_biases_are_the_same_in_wgsl_and_rust() {
    let gpu = Engine::shared();
    for descriptor in cases() {
        let (origin, fits, points) = moved(descriptor.depth);
        // The harness gets the fits with their own origin, so that `prepare` must move them.
        let given = two_fits(DVec3::new(1000.0, 20.0, -3000.0), descriptor.depth);
        let harness = Harness::new(&gpu, &descriptor, origin, &given, &BIAS, &[Vec::new(), Vec::new()]);
        for (index, fit) in fits.iter().enumerate() {
            let map = FittedMap::new(given[index], bias_of(&given[index])).relative_to(origin);
            for (point, answer) in points.iter().zip(harness.ask(index as u32, &points)) {
                let expected = projected(fit, &map.bias, point);
                // Far outside the near map, coordinates and slopes are large, and so is their rounding.
                let scale = expected.abs().max_element().max(1.0);
                let error = (answer.projected.as_dvec3() - expected).abs().max_element();
                let normal = Vec3::from(point.normal).as_dvec3();
                let cosine = normal.dot(-fit.direction.as_dvec3()).clamp(MIN_COSINE, 1.0);
                let slope = (answer.gradient.as_dvec2() - gradient(fit, normal, cosine)).abs().max_element();
                assert!(slope <= TOLERANCE, "{descriptor:?}, map {index}, {point:?}: {answer:?}, off by {slope}");
                assert!(
                    error <= TOLERANCE * scale,
                    "{descriptor:?}, map {index}, {point:?}: {answer:?}, not {expected}"
                );
            }
        }
    }
}

#[test]
fn the_factor_is_that_of_the_first_map_which_covers_the_point_and_one_outside_all() {
    let gpu = Engine::shared();
    for descriptor in cases() {
        let (origin, fits, points) = moved(descriptor.depth);
        let casters = fits.each_ref().map(half_way);
        let harness = Harness::new(&gpu, &descriptor, origin, &fits, &BIAS, &casters);
        let answers = harness.ask(0, &points);
        // Counts of each case: near map, far map, outside; in shadow, lit.
        let mut met = [[0; 2]; 3];
        for (point, answer) in points.iter().zip(answers) {
            let position = Vec3::from(point.position).as_dvec3();
            let at = fits.each_ref().map(|fit| uv(fit, position));
            let map = at.iter().position(|uv| is_inside(*uv));
            let depth = map.map_or(0.0, |map| projected(&fits[map], &bias_of(&fits[map]), point).z);
            let on_the_caster = (depth - 0.5).abs() < 0.001;
            if at.iter().any(|uv| is_at_border(*uv)) || on_the_caster {
                continue;
            }
            let is_nearer = if descriptor.depth == DepthConvention::Reversed { depth > 0.5 } else { depth < 0.5 };
            let lit = map.is_none() || is_nearer;
            assert_eq!(answer.factor, if lit { 1.0 } else { 0.0 }, "{descriptor:?}, map {map:?}, {point:?}");
            met[map.unwrap_or(2)][usize::from(lit)] += 1;
        }
        println!("{descriptor:?}: near map {:?}, far map {:?}, outside {:?} (in shadow, lit)", met[0], met[1], met[2]);
        assert!(met[0].iter().chain(&met[1]).all(|count| *count >= 20) && met[2][1] >= 20, "{met:?}");
    }
}
