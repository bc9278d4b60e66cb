//! Truth and classes for lights with a position.

use glam::{DMat4, DVec2, DVec3};
use shadowfit_truth::{
    Class, Judged, MapReading, MeasuredMap, PictureMaps, PictureTally, PixelCamera, PixelTruth, Tracer, Truth,
    TruthLight, TruthPoint, TruthSettings, judge,
};

use super::scenes::{Triangles, lamp_image, lamp_map, level, looking_at, looking_down, quad};
use super::shadows::{compare, floor};

const LAMP: DVec3 = DVec3::new(0.7, 3.0, -0.4);

/// Returns the corners of a tilted square of about a metre.
fn plate(centre: DVec3) -> [DVec3; 4] {
    let (across, along) = (DVec3::new(0.4, 0.1, 0.3), DVec3::new(-0.3, 0.1, 0.4));
    [across + along, across - along, -across - along, along - across].map(|corner| centre + corner)
}

fn scene(plate: [DVec3; 4]) -> Tracer {
    Tracer::new([floor(), quad(plate.map(DVec3::as_vec3))].concat())
}

fn truth_of(tracer: &Tracer, camera: &PixelCamera, light: TruthLight) -> Truth {
    Truth::trace(tracer, camera, &TruthSettings::of_light(light), &Truth::seen_by_rays(tracer, camera))
}

fn lamp(position: DVec3) -> TruthLight {
    TruthLight::Spot { position, image: None }
}

fn camera() -> PixelCamera {
    looking_at(DVec3::new(-4.0, 4.0, 5.0), DVec3::Y * 0.5, [240, 160])
}

/// Returns the point where the ray from a light through a point meets the floor.
fn on_floor(light: DVec3, point: DVec3) -> DVec2 {
    let met = light + (point - light) * (light.y / (light.y - point.y));
    DVec2::new(met.x, met.z)
}

/// Returns whether a point is in a convex polygon that is enlarged by `slack` on all sides.
fn is_in_polygon(corners: &[DVec2], point: DVec2, slack: f64) -> bool {
    let sides = corners.iter().zip(corners.iter().cycle().skip(1));
    let middle = corners.iter().sum::<DVec2>() / corners.len() as f64;
    sides.into_iter().all(|(a, b)| {
        let outward = (b - a).perp().normalize();
        let outward = if outward.dot(middle - a) > 0.0 { -outward } else { outward };
        outward.dot(point - a) <= slack
    })
}

#[test]
fn a_plates_shadow_has_its_corners_where_rays_from_the_lamp_through_its_own_meet_the_floor() {
    let plate = plate(DVec3::new(0.2, 1.2, 0.1));
    let corners = plate.map(|corner| on_floor(LAMP, corner));
    let truth = truth_of(&scene(plate), &camera(), lamp(LAMP));
    let decided = compare(&truth, |point, slack| {
        // The upper side of the plate itself is lit. Its lower side faces away.
        point.position.y > 0.1 || !is_in_polygon(&corners, DVec2::new(point.position.x, point.position.z), slack)
    });
    assert!(decided.iter().all(|count| *count > 600), "{decided:?}");
    // A sun in the direction of the lamp, seen from the plate, casts a shadow half as large.
    let sun = truth_of(&scene(plate), &camera(), TruthLight::sun((LAMP - DVec3::new(0.2, 1.2, 0.1)).normalize()));
    let dark = |truth: &Truth| truth.points.iter().flatten().filter(|point| point.verdict() == Some(false)).count();
    assert!(dark(&sun) * 3 < dark(&truth) * 2, "{} and {}", dark(&sun), dark(&truth));
}

#[test]
fn a_plate_behind_the_lamp_casts_nothing_though_it_stands_in_line() {
    let tracer = scene(plate(LAMP + DVec3::Y));
    let camera = looking_down(2.0, 0.02, [60, 40]);
    let truth = truth_of(&tracer, &camera, lamp(LAMP));
    let points: Vec<&TruthPoint> = truth.points.iter().flatten().collect();
    assert!(points.len() == 2400 && points.iter().all(|point| point.is_judged && point.lit == 1.0));
    let beyond = truth_of(&tracer, &camera, lamp(LAMP + DVec3::Y * 2.0));
    assert!(beyond.points.iter().flatten().any(|point| point.lit == 0.0));
}

#[test]
fn facing_is_the_cosine_toward_the_lamp_and_a_floor_below_it_is_judged_from_one_side() {
    let tracer = Tracer::new(floor());
    let camera = looking_down(1.0, 0.1, [40, 10]);
    for (height, is_judged) in [(2.0, true), (-2.0, false)] {
        let position = DVec3::new(0.5, height, 0.0);
        for point in truth_of(&tracer, &camera, lamp(position)).points.into_iter().flatten() {
            let cosine = height / (position - point.position).length();
            assert!((point.facing - cosine).abs() < 1e-12 && point.is_judged == is_judged);
        }
    }
}

#[test]
fn occluders_lie_on_the_way_from_the_point_to_the_lamp() {
    let tracer = scene(plate(DVec3::new(0.2, 1.2, 0.1)));
    let settings = TruthSettings { ray_offset: 0.05, ..TruthSettings::of_light(lamp(LAMP)) };
    let camera = camera();
    let rays = PixelTruth { tracer: &tracer, camera: &camera, settings: &settings };
    let mut met = 0;
    for pixel in 0..camera.pixels() {
        let Some(point) = rays.point(pixel).filter(|point| point.is_judged) else { continue };
        for occluder in rays.occluders(pixel, &point) {
            let (way, part) = (LAMP - point.position, occluder.position - point.position);
            assert!(part.reject_from(way).length() < 1e-9, "{} is off the line to the lamp", occluder.position);
            assert!((0.0..way.length_squared()).contains(&part.dot(way)) && occluder.distance < way.length());
            met += 1;
        }
    }
    assert!(met > 300, "{met}");
}

#[test]
fn points_outside_of_the_lamps_image_are_not_judged() {
    let tracer = Tracer::new(floor());
    let camera = looking_down(2.0, 0.1, [60, 60]);
    let position = DVec3::Y * 2.0;
    // The image is 90 degrees wide from 2 m, so 2 m to each side. The floor's pixel centres are at odd
    // multiples of 5 cm.
    for (planes, is_far_enough) in [([0.1, 2.1], true), ([0.1, 1.9], false), ([2.05, 9.0], false)] {
        let image = Some(lamp_image(position, planes));
        let truth = truth_of(&tracer, &camera, TruthLight::Spot { position, image });
        for point in truth.points.iter().flatten() {
            let is_inside = point.position.x.abs().max(point.position.z.abs()) < 2.0;
            assert_eq!(point.is_judged, is_inside && is_far_enough, "{} in {planes:?}", point.position);
            assert_eq!(point.lit, if point.is_judged { 1.0 } else { 0.0 });
        }
    }
}

#[test]
fn a_far_lamp_is_a_sun() {
    let tracer = scene(plate(DVec3::new(0.2, 1.2, 0.1)));
    let to_light = DVec3::new(0.5, 0.7, 0.3).normalize();
    let sun = truth_of(&tracer, &camera(), TruthLight::sun(to_light));
    // Within 30 m of the origin the directions differ by 3e-5.
    let far = truth_of(&tracer, &camera(), lamp(to_light * 1e6));
    let (mut dark, mut different) = (0, 0);
    for (pixel, (a, b)) in sun.points.iter().zip(&far.points).enumerate() {
        let (Some(a), Some(b)) = (a, b) else { continue };
        assert!((a.facing - b.facing).abs() < 4e-5 && a.is_judged == b.is_judged);
        dark += usize::from(a.verdict() == Some(false));
        different += usize::from(a.lit != b.lit);
        assert!(a.lit == b.lit || sun.transition_distance(pixel) < 1.0, "pixel {pixel}");
    }
    assert!(dark > 100 && different <= 2, "{different} of {dark}");
}

/// A floor of 40 by 10 pixels of 10 cm, under a lamp 4 m over its middle and a roof at 2 m over x < 0. The
/// roof's shadow also begins at x = 0.
struct Room {
    tracer: Tracer,
    truth: Truth,
}

const OVER: DVec3 = DVec3::new(0.0, 4.0, 0.0);
const IN_IMAGE: [f64; 2] = [0.5, 9.0];

impl Room {
    fn new() -> Self {
        let roof: Triangles = level(2.0, [-9.0, -9.0], [0.0, 9.7]);
        let tracer = Tracer::new([level(0.0, [-9.0, -9.0], [9.0, 9.7]), roof].concat());
        let image = Some(lamp_image(OVER, IN_IMAGE));
        let truth = truth_of(&tracer, &looking_down(1.0, 0.1, [40, 10]), TruthLight::Spot { position: OVER, image });
        Self { tracer, truth }
    }

    /// Judges factors that are given by column.
    fn judge(&self, factor: impl Fn(usize) -> f32, map: MeasuredMap, depth_clamp: bool) -> Judged {
        let factors: Vec<f32> = (0..400).map(|pixel| factor(pixel % 40)).collect();
        let maps = PictureMaps { maps: &[map], reading: MapReading::ViewDepth, filter_radius: 0.5, depth_clamp };
        judge(&self.tracer, &self.truth, &maps, &factors, |_| true)
    }
}

/// Returns a map whose image is 8 m wide on the floor, with texels `pixels_per_texel` pixels wide.
fn map(pixels_per_texel: u32, planes: [f64; 2]) -> MeasuredMap {
    lamp_map(OVER, planes, 80 / pixels_per_texel)
}

/// Returns false shadow, false light, hole, edge and wrong, in columns of 40.
fn columns(tally: &PictureTally) -> [u64; 5] {
    [tally.all.false_shadow, tally.all.false_light, tally.all.hole, tally.all.edge, tally.all.wrong].map(|count| {
        assert!(count.is_multiple_of(10), "whole columns");
        count / 10
    })
}

#[test]
fn a_perfect_picture_of_a_lamp_has_no_wrong_pixel() {
    let judged = Room::new().judge(|column| if column < 20 { 0.0 } else { 1.0 }, map(1, IN_IMAGE), false);
    let tally = &judged.tally;
    assert_eq!((tally.all.facing, tally.all.wrong, tally.error, tally.displacement), (400, 0, 0.0, 0.0));
    assert_eq!((tally.transitions, tally.edge_zone, tally.uncovered), (10, 40, 0));
    // On a floor parallel to the map, all texels have the same size in any perspective.
    assert!(judged.pixels_per_texel.iter().all(|pixels| (pixels - 1.0).abs() < 1e-4));
}

#[test]
fn a_lamp_whose_caster_is_in_the_map_and_casts_nothing_is_false_light_beside_the_edge_zone() {
    assert_eq!(columns(&Room::new().judge(|_| 1.0, map(1, IN_IMAGE), false).tally), [0, 18, 0, 2, 20]);
    assert_eq!(columns(&Room::new().judge(|_| 1.0, map(4, IN_IMAGE), false).tally), [0, 14, 0, 6, 20]);
}

#[test]
fn a_lamp_that_is_dark_everywhere_is_false_shadow_beside_the_edge_zone() {
    let tally = Room::new().judge(|_| 0.0, map(1, IN_IMAGE), false).tally;
    assert_eq!((columns(&tally), tally.displacement), ([18, 0, 0, 2, 20], 320.0));
}

#[test]
fn a_caster_before_the_lamps_near_plane_leaves_a_hole_unless_depth_is_clamped() {
    // The roof is 2 m below the lamp.
    let cut = map(1, [2.5, 9.0]);
    assert_eq!(columns(&Room::new().judge(|_| 1.0, cut, false).tally), [0, 0, 20, 0, 20]);
    assert_eq!(columns(&Room::new().judge(|_| 1.0, cut, true).tally), [0, 18, 0, 2, 20]);
}

#[test]
fn a_map_that_is_narrower_than_what_the_lamp_shines_on_leaves_points_uncovered() {
    // The map is half as wide, 2 m to each side, and moved by a metre. The camera sees 2 m to each side.
    let shifted = DMat4::from_translation(DVec3::X * 1.5) * DMat4::from_scale(DVec3::new(2.0, 2.0, 1.0));
    let shifted = shifted * lamp_image(OVER, IN_IMAGE);
    let map = MeasuredMap::of_spot(&shifted, DVec2::splat(40.0), f64::INFINITY, OVER);
    let judged = Room::new().judge(|_| 1.0, map, true);
    // Clip x of 2 x / 4 m + 1.5 w leaves -1..=1 at x = -1 m on the floor, so columns from 10 on are
    // uncovered.
    assert_eq!(judged.tally.uncovered, 300);
    for (pixel, class) in judged.classes.iter().enumerate().filter(|(pixel, _)| pixel % 40 < 20) {
        let is_covered = judged.map_index[pixel].is_some();
        assert_eq!(is_covered, pixel % 40 < 10, "column {}", pixel % 40);
        assert_eq!(*class == Class::Hole, !is_covered, "column {}", pixel % 40);
    }
}
