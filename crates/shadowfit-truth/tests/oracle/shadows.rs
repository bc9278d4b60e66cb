//! The truth compared with shadows in closed form.

use glam::{DVec3, Vec2, Vec3};
use shadowfit_truth::{
    AlphaImage, CutMaterial, CutOut, CutOuts, Tracer, Truth, TruthLight, TruthPoint, TruthSettings, Wrap,
};

use super::scenes::{Triangles, cuboid, level, looking_at, looking_down, quad, sphere};

/// Length by which the closed form may be off before a pixel counts as decided: twice the millimetre by which
/// shadow rays start above the surface, and the same again for slanting light.
pub(crate) const SLACK: f64 = 4e-3;

pub(crate) fn floor() -> Triangles {
    level(0.0, [-20.0, -20.0], [20.0, 21.3])
}

fn sun() -> DVec3 {
    DVec3::new(0.5, 0.7, 0.3).normalize()
}

/// Compares the truth of every pixel that faces the light with `lit`, a function of a point and a slack (a
/// length that enlarges the casters). Returns the number of pixels decided as shadowed and as lit. Pixels
/// whose result depends on the slack are skipped.
pub(crate) fn compare(truth: &Truth, lit: impl Fn(&TruthPoint, f64) -> bool) -> [usize; 2] {
    let mut decided = [0, 0];
    for (pixel, point) in truth.points.iter().enumerate() {
        let Some((point, found)) = point.as_ref().and_then(|point| Some((point, point.verdict()?))) else { continue };
        let [smaller, larger] = [-SLACK, SLACK].map(|slack| lit(point, slack));
        if smaller == larger {
            assert_eq!(found, smaller, "pixel {pixel} at {}", point.position);
            decided[usize::from(found)] += 1;
        }
    }
    let facing = truth.points.iter().flatten().filter(|point| point.is_judged).count();
    assert!(decided.iter().sum::<usize>() * 100 >= facing * 97, "{decided:?} of {facing} are decided");
    decided
}

fn traced(tracer: &Tracer, eye: DVec3, to_light: DVec3) -> Truth {
    let camera = looking_at(eye, DVec3::Y * 0.5, [240, 160]);
    let seen = Truth::seen_by_rays(tracer, &camera);
    Truth::trace(tracer, &camera, &TruthSettings::new(to_light), &seen)
}

/// Returns whether a ray from beyond the surface meets a box that is enlarged by `slack` on all sides.
fn meets_box(origin: DVec3, direction: DVec3, min: DVec3, max: DVec3, slack: f64) -> bool {
    let [a, b] = [min - slack, max + slack].map(|corner| (corner - origin) / direction);
    a.max(b).min_element() >= a.min(b).max_element().max(0.0)
}

#[test]
fn the_shadow_of_a_box_on_a_plane_is_where_its_slabs_say() {
    let (min, max) = (DVec3::new(-1.0, 0.5, -0.7), DVec3::new(1.0, 1.8, 0.9));
    let tracer = Tracer::new([floor(), cuboid(min.as_vec3(), max.as_vec3())].concat());
    let truth = traced(&tracer, DVec3::new(-4.0, 4.0, 5.0), sun());
    let decided = compare(&truth, |point, slack| {
        // The box is convex, so its own facing sides are lit.
        point.position.y > 0.1 || !meets_box(point.position, sun(), min, max, slack)
    });
    assert!(decided.iter().all(|count| *count > 600), "{decided:?}");
}

#[test]
fn the_shadow_of_a_sphere_is_that_of_its_radius_within_the_tessellation() {
    let (centre, radius, rings) = (DVec3::new(0.2, 1.5, -0.3), 1.0, 64);
    let tracer = Tracer::new([floor(), sphere(centre.as_vec3(), radius as f32, rings)].concat());
    let truth = traced(&tracer, DVec3::new(-4.0, 4.0, 5.0), sun());
    // The corners are on the sphere. The middle of a quad's diagonal is this far below it.
    let sagitta = radius * (1.0 - (core::f64::consts::PI / f64::from(rings) / 2f64.sqrt()).cos());
    assert!(sagitta < SLACK, "{sagitta}");
    let decided = compare(&truth, |point, slack| {
        let to_centre = centre - point.position;
        let is_floor = point.position.y.abs() < 1e-6;
        !is_floor || to_centre.reject_from_normalized(sun()).length() > radius + slack
    });
    assert!(decided.iter().all(|count| *count > 600), "{decided:?}");
}

#[test]
fn stairs_shadow_the_treads_below_as_far_as_their_corners_reach() {
    let (depth, rise, steps) = (0.5, 0.4, 6u32);
    let stairs = (0..steps).flat_map(|step| {
        let [x, y] = [depth, rise].map(|length: f64| (length * f64::from(step)) as f32);
        let next = x + depth as f32;
        let tread = level(y, [x, -20.0], [next, 21.3]);
        let wall = |x: f32| {
            let at = |y: f32, z: f32| Vec3::new(x, y, z);
            quad([at(y, -20.0), at(y + rise as f32, -20.0), at(y + rise as f32, 21.3), at(y, 21.3)])
        };
        [tread, if step + 1 < steps { wall(next) } else { Triangles::new() }].concat()
    });
    let tracer = Tracer::new(stairs);
    // The light comes from up the stairs, so each step can shadow lower ones.
    let to_light = DVec3::new(1.0, 0.6, 0.0).normalize();
    let camera = looking_at(DVec3::new(-1.0, 4.0, 0.1), DVec3::new(1.6, 1.0, 0.0), [240, 160]);
    let seen = Truth::seen_by_rays(&tracer, &camera);
    let truth = Truth::trace(&tracer, &camera, &TruthSettings::new(to_light), &seen);
    let slope = to_light.y / to_light.x;
    let decided = compare(&truth, |point, slack| {
        (1..steps).map(f64::from).all(|step| {
            let (x, y) = (depth * step, rise * step);
            x < point.position.x + 1e-6 || y + slack < point.position.y + (x - point.position.x) * slope
        })
    });
    assert!(decided.iter().all(|count| *count > 500), "{decided:?}");
}

#[test]
fn a_fence_of_cut_outs_casts_its_pickets_and_not_its_gaps() {
    // A plane at x = 0, 2 m high and 8 m long, of pickets and gaps a quarter of a metre wide.
    let at = |y: f32, z: f32| Vec3::new(0.0, y, z);
    let fence = quad([at(0.0, -4.0), at(0.0, 4.0), at(2.0, 4.0), at(2.0, -4.0)]);
    let first = floor().len() as u32;
    let uv = |corner: Vec3| Vec2::new((corner.z + 4.0) * 2.0, 1.0 - corner.y * 0.5);
    let cut_outs = (first..).zip(&fence).map(|(triangle, corners)| {
        let wrap = [Wrap::Repeat, Wrap::Clamp];
        let material = CutMaterial { image: Some(0), wrap, nearest: true, ..CutMaterial::default() };
        (triangle, CutOut { uvs: corners.map(uv), alphas: [1.0; 3], material })
    });
    let image = AlphaImage::new(2, 1, vec![255, 0]).expect("two texels");
    let cut_outs = CutOuts::new(vec![image], cut_outs);
    let tracer = Tracer::new([floor(), fence].concat()).with_cut_outs(cut_outs);
    let truth = traced(&tracer, DVec3::new(-3.0, 3.0, 2.0), sun());
    let decided = compare(&truth, |point, slack| {
        if point.position.x > slack {
            return true;
        }
        let met = point.position - sun() * (point.position.x / sun().x);
        let is_between = |least: f64, most: f64, value: f64| value >= least - slack && value <= most + slack;
        let along = (met.z + 4.0).rem_euclid(0.5);
        let is_picket = is_between(0.0, 0.25, along) || is_between(0.5, 0.75, along);
        !(is_between(-4.0, 4.0, met.z) && is_between(0.0, 2.0, met.y) && is_picket)
    });
    assert!(decided.iter().all(|count| *count > 500), "{decided:?}");
}

#[test]
fn the_penumbra_of_a_straight_edge_is_the_share_of_the_sun_beside_it() {
    let (height, radius, rays) = (2.0, 0.05, 256);
    let roof = level(height as f32, [-20.0, -20.0], [0.0, 21.3]);
    let tracer = Tracer::new([floor(), roof].concat());
    let camera = looking_down(1.0, 0.005, [120, 16]);
    let settings = TruthSettings::of_light(TruthLight::Sun { to_light: DVec3::Y, radius, rays });
    let truth = Truth::trace(&tracer, &camera, &settings, &Truth::seen_by_rays(&tracer, &camera));
    let (mut sum, mut greatest, mut penumbra) = (0.0f64, 0.0f64, 0);
    for point in truth.points.iter().flatten() {
        // Distance of the edge across the sun's disc from its middle, in radii.
        let cut = ((point.position.x / (height - settings.ray_offset)).atan() / radius).clamp(-1.0, 1.0);
        let share = 0.5 + (cut * (1.0 - cut * cut).sqrt() + cut.asin()) / core::f64::consts::PI;
        let error = f64::from(point.lit) - share;
        (sum, greatest) = (sum + error, greatest.max(error.abs()));
        penumbra += usize::from(cut.abs() < 1.0);
    }
    // A line that cuts n well-spread points errs by about n^(-3/4), 1.6% here. The bound is three times that,
    // for the worst of a thousand pixels. The disc is flat to radius², 0.3%.
    assert!(penumbra > 500 && greatest < 0.045, "{greatest} over {penumbra}");
    assert!((sum / penumbra as f64).abs() < 0.003, "{sum} over {penumbra}");
}
