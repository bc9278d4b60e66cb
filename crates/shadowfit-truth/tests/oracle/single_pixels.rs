//! Pixels that are judged alone, and pictures that are cancelled: the same rules as for whole pictures.

use core::sync::atomic::{AtomicUsize, Ordering};

use glam::{DVec3, Vec3};
use shadowfit_truth::{
    Class, MapReading, MeasuredMap, PictureMaps, PixelTruth, Tracer, Truth, TruthLight, TruthSettings, judge,
    judge_while,
};

use super::scenes::{cuboid, lamp_image, lamp_map, level, looking_at, shadow_map, sphere};

/// A tower, a ball and a roof that the map does not hold, with shifted and striped shadows: every kind of
/// error.
struct Picture {
    tracer: Tracer,
    truth: Truth,
    factors: Vec<f32>,
    map: MeasuredMap,
}

impl Picture {
    fn new(settings: TruthSettings) -> Self {
        let ground = level(0.0, [-15.0, -15.0], [15.0, 16.1]);
        let tower = cuboid(Vec3::new(-0.5, 0.02, -0.4), Vec3::new(0.3, 2.0, 0.5));
        let roof = level(5.0, [2.0, -6.0], [7.0, 3.0]);
        let ball = sphere(Vec3::new(1.5, 1.0, 1.5), 0.6, 12);
        let tracer = Tracer::new([ground, tower, roof, ball].concat());
        let camera = looking_at(DVec3::new(-4.0, 3.0, 5.0), DVec3::Y * 0.5, [90, 60]);
        let truth = Truth::trace(&tracer, &camera, &settings, &Truth::seen_by_rays(&tracer, &camera));
        let factor = |pixel: usize| truth.verdict(pixel.saturating_sub(12)).unwrap_or(true) != pixel.is_multiple_of(31);
        let factors = (0..camera.pixels()).map(|pixel| f32::from(u8::from(factor(pixel)))).collect();
        let map = match settings.light {
            TruthLight::Sun { to_light, .. } => shadow_map(DVec3::ZERO, to_light, 16.0, 3.0, 256),
            TruthLight::Spot { position, .. } => lamp_map(position, [4.0, 40.0], 256),
        };
        Self { tracer, truth, factors, map }
    }

    fn maps(&self) -> PictureMaps<'_> {
        let maps = core::slice::from_ref(&self.map);
        PictureMaps { maps, reading: MapReading::ViewDepth, filter_radius: 0.5, depth_clamp: false }
    }
}

/// Returns a lamp over the scene.
fn lamp() -> TruthLight {
    let position = DVec3::new(4.0, 8.0, 2.4);
    TruthLight::Spot { position, image: Some(lamp_image(position, [4.0, 40.0])) }
}

#[test]
fn a_pixel_alone_has_the_class_and_the_point_that_it_has_in_the_picture() {
    let to_light = DVec3::new(0.5, 0.7, 0.3).normalize();
    let soft = TruthLight::Sun { to_light, radius: 0.05, rays: 16 };
    for light in [TruthLight::sun(to_light), soft, lamp()] {
        let settings = TruthSettings::of_light(light);
        let picture = Picture::new(settings);
        let Picture { tracer, truth, factors, .. } = &picture;
        let judged = judge(tracer, truth, &picture.maps(), factors, |_| true);
        let alone = PixelTruth { tracer, camera: &truth.camera, settings: &truth.settings };
        for class in [Class::Right, Class::FalseShadow, Class::FalseLight, Class::Hole, Class::Edge] {
            assert!(judged.classes.contains(&class), "{class:?}");
        }
        for (pixel, factor) in factors.iter().enumerate() {
            let point = alone.point(pixel);
            assert_eq!(point, truth.points[pixel], "pixel {pixel}");
            let Some(point) = point else { continue };
            let found = alone.judge(&picture.maps(), *factor, pixel, &point);
            let wanted = (judged.classes[pixel], judged.map_index[pixel]);
            assert_eq!((found.class, found.map_index), wanted, "pixel {pixel}");
            assert_eq!(found.pixels_per_texel.to_bits(), judged.pixels_per_texel[pixel].to_bits(), "pixel {pixel}");
            let is_wrong = !matches!(found.class, Class::Right | Class::NotJudged);
            assert_eq!(found.is_in_edge_zone, is_wrong && judged.edge_zone[pixel], "pixel {pixel}");
            if light != soft && point.is_judged {
                assert_eq!(alone.occluders(pixel, &point).is_empty(), point.lit == 1.0, "pixel {pixel}");
            }
        }
        assert_eq!(alone.point(factors.len()), None, "beyond the picture");
    }
}

#[test]
fn edges_around_a_pixel_are_found_as_far_as_they_are_looked_for() {
    let picture = Picture::new(TruthSettings::new(DVec3::new(0.5, 0.7, 0.3).normalize()));
    let truth = &picture.truth;
    let alone = PixelTruth { tracer: &picture.tracer, camera: &truth.camera, settings: &truth.settings };
    for pixel in (0..truth.points.len()).step_by(17) {
        let wanted = truth.transition_distance(pixel);
        for at_most in [1.5, 6.0, 40.0] {
            let limited = if wanted <= at_most { wanted } else { f32::INFINITY };
            assert_eq!(alone.transition_distance(pixel, at_most), limited, "pixel {pixel} within {at_most}");
        }
    }
}

#[test]
fn a_picture_that_is_given_up_is_left_at_once_and_one_that_is_not_is_the_same() {
    let picture = Picture::new(TruthSettings::new(DVec3::new(0.5, 0.7, 0.3).normalize()));
    let Picture { tracer, truth, factors, .. } = &picture;
    let maps = picture.maps();
    let seen: Vec<Option<u32>> = truth.points.iter().map(|point| point.map(|point| point.triangle)).collect();
    let trace = |goes_on: &(dyn Fn() -> bool + Sync)| {
        Truth::trace_while(tracer, &truth.camera, &truth.settings, &seen, goes_on)
    };
    assert_eq!(trace(&|| true).as_ref(), Some(truth));
    let whole = judge(tracer, truth, &maps, factors, |_| true);
    assert_eq!(
        judge_while(tracer, truth, &maps, factors, |_| true, || true).expect("not cancelled").classes,
        whole.classes
    );
    let asked = AtomicUsize::new(0);
    let few = || asked.fetch_add(1, Ordering::Relaxed) < 50;
    assert_eq!(trace(&few), None);
    assert!(judge_while(tracer, truth, &maps, factors, |_| true, || false).is_none());
}
