//! Properties that a picture's figures must not depend on: the world's origin, its axes and its unit.

use glam::{DAffine3, DMat4, DQuat, DVec2, DVec3, Vec3};
use shadowfit_truth::{
    MapReading, MeasuredMap, PictureMaps, PictureTally, PixelCamera, Tracer, Truth, TruthLight, TruthSettings, judge,
};

use super::scenes::{PlainMap, cuboid, lamp_image, level, looking_at, map_around, sphere};

const LIGHTS: [Light; 2] = [Light::Sun, Light::Lamp];

/// Kind of light on the scene.
#[derive(Clone, Copy, Debug)]
enum Light {
    Sun,
    Lamp,
}

/// Returns a light and its map after the world was transformed by a motion and then to `world`.
fn light_and_map(light: Light, motion: DAffine3, world: DAffine3) -> (TruthLight, MeasuredMap) {
    let from_world = DMat4::from(world.inverse());
    let toward = DVec3::new(0.5, 0.7, 0.3).normalize();
    match light {
        Light::Sun => {
            let to_light = motion.transform_vector3(toward);
            let map = map_around(DVec3::ZERO, toward, 16.0, 3.0, 1024);
            let clip_from_world = map.clip_from_world * from_world;
            let map = PlainMap { clip_from_world, ..map }.measured(to_light);
            (TruthLight::sun(to_light), map)
        }
        Light::Lamp => {
            let position = world.transform_point3(toward * 9.0);
            let clip_from_world = lamp_image(toward * 9.0, [4.0, 40.0]) * from_world;
            let map = MeasuredMap::of_spot(&clip_from_world, DVec2::splat(1024.0), f64::INFINITY, position);
            (TruthLight::Spot { position, image: Some(clip_from_world) }, map)
        }
    }
}

/// Judges a scene after its whole world was transformed by a motion and a scale.
fn tally(light: Light, motion: DAffine3, scale: f64) -> PictureTally {
    let world = DAffine3::from_scale(DVec3::splat(scale)) * motion;
    let turned = |direction: DVec3| motion.transform_vector3(direction);
    let ground = level(0.0, [-15.0, -15.0], [15.0, 16.1]);
    let tower = cuboid(Vec3::new(-0.5, 0.02, -0.4), Vec3::new(0.3, 2.0, 0.5));
    // The roof is before the map, so its shadow is a hole.
    let roof = level(5.0, [2.0, -6.0], [7.0, 3.0]);
    let triangles = [ground, tower, roof, sphere(Vec3::new(1.5, 1.0, 1.5), 0.6, 24)].concat();
    let moved = triangles.iter().map(|t| t.map(|corner| world.transform_point3(corner.as_dvec3()).as_vec3()));
    let tracer = Tracer::new(moved);
    let camera = looking_at(DVec3::new(-4.0, 3.0, 5.0), DVec3::Y * 0.5, [240, 160]);
    let camera = PixelCamera {
        eye: world.transform_point3(camera.eye),
        right: turned(camera.right),
        up: turned(camera.up),
        forward: turned(camera.forward),
        near: camera.near * scale,
        far: camera.far * scale,
        ..camera
    };
    let (light, map) = light_and_map(light, motion, world);
    let settings = TruthSettings { ray_offset: 1e-3 * scale, ..TruthSettings::of_light(light) };
    let truth = Truth::trace(&tracer, &camera, &settings, &Truth::seen_by_rays(&tracer, &camera));
    // Shadows shifted in the picture, with stripes, give every kind of error.
    let factors: Vec<f32> = (0..camera.pixels())
        .map(|pixel| {
            let shifted = truth.verdict(pixel.saturating_sub(12)).unwrap_or(true);
            f32::from(u8::from(shifted != (pixel % 31 == 0)))
        })
        .collect();
    let maps = PictureMaps { maps: &[map], reading: MapReading::ViewDepth, filter_radius: 0.5, depth_clamp: false };
    judge(&tracer, &truth, &maps, &factors, |_| true).tally
}

/// Asserts that every column is the same to `tolerance` per cent of the picture, or per cent of its own value
/// if it is not a share.
fn assert_same(name: &str, wanted: &PictureTally, found: &PictureTally, tolerance: f64) {
    for ((column, wanted), (_, found)) in wanted.columns().into_iter().zip(found.columns()) {
        if wanted.is_nan() && found.is_nan() {
            continue; // Not measured, such as crawl in a single picture.
        }
        let unit = if column.ends_with('%') { 1.0 } else { wanted.abs() / 100.0 };
        assert!((found - wanted).abs() <= tolerance * unit, "{name}: {column} is {found}, not {wanted}");
    }
}

fn plain(light: Light) -> PictureTally {
    let plain = tally(light, DAffine3::IDENTITY, 1.0);
    for count in [plain.all.false_shadow, plain.all.false_light, plain.all.hole, plain.all.edge] {
        assert!(count > 50, "{:?}", plain.columns());
    }
    plain
}

#[test]
fn a_unit_that_is_a_power_of_two_changes_no_pixel() {
    for (light, scale) in LIGHTS.into_iter().flat_map(|light| [0.125, 64.0].map(|scale| (light, scale))) {
        assert_same("scaled", &plain(light), &tally(light, DAffine3::IDENTITY, scale), 0.0);
    }
}

#[test]
fn a_unit_of_centimetres_or_kilometres_changes_figures_by_rounding_alone() {
    // Pixels on edges of shadows and triangles change: fewer than one in a thousand. Quantiles are in bins of
    // half a per cent.
    for (light, scale) in LIGHTS.into_iter().flat_map(|light| [0.01, 100.0, 1000.0].map(|scale| (light, scale))) {
        assert_same("scaled", &plain(light), &tally(light, DAffine3::IDENTITY, scale), 0.6);
    }
}

#[test]
fn a_world_that_is_turned_and_moved_has_the_same_figures() {
    let turn = DQuat::from_axis_angle(DVec3::new(0.3, 0.8, -0.4).normalize(), 2.0);
    let motion = DAffine3::from_rotation_translation(turn, DVec3::new(30.0, -12.0, 50.0));
    // A left-handed world: everything is mirrored, including the winding.
    let mirror = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    for light in LIGHTS {
        assert_same("moved", &plain(light), &tally(light, motion, 1.0), 0.6);
        assert_same("mirrored", &plain(light), &tally(light, mirror, 1.0), 0.6);
    }
}
