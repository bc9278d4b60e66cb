//! No holes: every visible point of a receiver lies in the map that its view depth selects, with the filter's
//! border around it. This holds for every fit except the XNA sample's.
//!
//! Points and matrices are f32, as in a shader. There is no tolerance: the fits include a margin for that
//! rounding.

use proptest::prelude::*;
use shadowfit::demand::DepthHistogram;
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::settings::FitKind;
use shadowfit::{Aabb, Boxes, FitInput, FitState, FittedMap, LightProjection, Scratch, Technique, ViewFrustum};

use crate::scenes::{
    BoxPlan, SceneView, any_box, any_covering_fit, any_light, any_technique, any_view, any_walk, of_camera, share,
};
use crate::support::{ShaderDepths, any_camera, apply, cases};

/// A point of a view: position in the picture and share of the depth or of the log depth.
#[derive(Clone, Copy, Debug)]
struct Sample {
    place: [f64; 3],
    is_log: bool,
    /// Number of the box that the point is moved into, if any.
    which: usize,
}

fn any_samples() -> impl Strategy<Value = Vec<Sample>> {
    let one = ([share(), share(), share()], any::<bool>(), 0..16_usize);
    prop::collection::vec(one.prop_map(|(place, is_log, which)| Sample { place, is_log, which }), 24)
}

impl Sample {
    /// Returns the world position, relative to the eye, of this point of the view.
    fn in_view(&self, view: &SceneView, last: f64) -> DVec3 {
        let [x, y, z] = self.place;
        let (near, far) = (view.lens.near, view.lens.far.min(last));
        let depth = if self.is_log { near * (far / near).powf(z) } else { near + (far - near) * z };
        view.point(x, y, depth.min(far))
    }

    /// Returns a point of a box, relative to the box's origin.
    fn in_box(&self, aabb: &Aabb) -> DVec3 {
        let (min, max) = (aabb.min.as_dvec3(), aabb.max.as_dvec3());
        min + (max - min) * DVec3::from_array(self.place)
    }
}

fn holds(aabb: &Aabb, p: DVec3) -> bool {
    p.cmpge(aabb.min.as_dvec3()).all() && p.cmple(aabb.max.as_dvec3()).all()
}

/// Returns the visible points of receivers, relative to the view's eye.
fn seen(samples: &[Sample], view: &SceneView, receivers: Option<Boxes>, last: f64) -> Vec<DVec3> {
    let mut points: Vec<DVec3> = samples.iter().map(|sample| sample.in_view(view, last)).collect();
    if let Some(Boxes { origin, boxes }) = receivers {
        let offset = origin - view.eye;
        let in_box = |sample: &Sample| boxes.get(sample.which % boxes.len().max(1)).map(|b| sample.in_box(b) + offset);
        points.retain(|p| boxes.iter().any(|b| holds(b, *p - offset)));
        points.extend(samples.iter().filter_map(in_box).filter(|p| view.sees(*p, last)));
    }
    points
}

/// Asserts that the point lies in the map, computed as in a shader, with the border around it.
fn assert_stored(fit: &LightProjection, border: f32, point: DVec3) {
    let local = (point - fit.origin).as_vec3();
    let uv = apply(&fit.uv_from_world, local);
    let (texel, size) = (uv.truncate().as_dvec2() * fit.resolution.as_dvec2(), fit.resolution.as_dvec2());
    let margin = DVec2::splat(f64::from(border));
    let is_inside = texel.cmpge(margin).all() && texel.cmple(size - margin).all();
    assert!(is_inside, "{texel} of {size} less {border}, for {local}, texel {}", fit.texel_size);
    assert!((0.0..=1.0).contains(&uv.z), "depth {} for {local}, range {}", uv.z, fit.depth_range);
}

/// Returns the map that a shader selects for a view depth, and the next one where they overlap.
fn chosen(maps: &[FittedMap], depth: f32) -> impl Iterator<Item = &FittedMap> {
    let first = maps.iter().position(|map| depth < map.far()).unwrap_or(maps.len() - 1);
    let next = maps.get(first + 1).filter(move |next| depth >= next.covered_from());
    [Some(&maps[first]), next].into_iter().flatten()
}

/// No list of boxes, or a list of zero, one or many, relative to the world's origin or to a point near the
/// eye.
fn any_receivers() -> impl Strategy<Value = (Option<Vec<BoxPlan>>, bool)> {
    let boxes = prop_oneof![
        1 => Just(None),
        1 => prop::collection::vec(any_box(), 1).prop_map(Some),
        2 => prop::collection::vec(any_box(), 0..10).prop_map(Some),
    ];
    (boxes, any::<bool>())
}

struct Stage {
    boxes: Option<Vec<Aabb>>,
    origin: DVec3,
}

impl Stage {
    fn new(plans: &(Option<Vec<BoxPlan>>, bool), view: &SceneView) -> Self {
        let origin = if plans.1 { DVec3::ZERO } else { view.eye.round() };
        let boxes = plans.0.as_ref().map(|plans| plans.iter().map(|plan| plan.aabb(view, origin)).collect());
        Self { boxes, origin }
    }

    fn receivers(&self) -> Option<Boxes<'_>> {
        self.boxes.as_ref().map(|boxes| Boxes { origin: self.origin, boxes })
    }
}

fn scratch(boxes: usize, views: usize) -> Vec<DVec2> {
    vec![DVec2::ZERO; Scratch::required(boxes, views)]
}

/// Fits one frame and looks up the visible points of its views.
fn check_frame(
    fitter: &mut FitState,
    settings: &Technique,
    views: &[SceneView],
    stage: &Stage,
    direction: Vec3,
    samples: &[Sample],
) {
    let frusta: Vec<ViewFrustum> = views.iter().map(SceneView::frustum).collect();
    let counts: Vec<u32> = samples.iter().map(|sample| (sample.place[0] * 9.0) as u32).collect();
    let histogram = DepthHistogram { near: 0.1, far: 100.0, bins: &counts, classes: 1 };
    let receivers = stage.receivers();
    let input = FitInput { receivers, histogram: Some(histogram), ..FitInput::new(&frusta, direction) };
    let mut storage = scratch(stage.boxes.as_ref().map_or(0, Vec::len), views.len());
    let maps = fitter.fit(&input, settings, &mut Scratch::new(&mut storage)).unwrap();
    assert_eq!(maps.len(), settings.maps.count() as usize);
    let last = f64::from(settings.fit.max_distance);
    for (view, frustum) in views.iter().zip(&frusta) {
        for point in seen(samples, view, receivers, last) {
            let depth = frustum.forward.dot(point.as_vec3());
            for map in chosen(&maps, depth) {
                assert!(!map.projection.is_empty, "what is seen at {depth} m lies in a map that nobody draws");
                assert_stored(&map.projection, settings.border(), view.eye + point);
            }
        }
    }
}

proptest! {
    #![proptest_config(cases(2000))]

    #[test]
    fn a_single_map_stores_what_any_view_sees_of_receivers(
        view in any_view(), plans in any_receivers(), direction in any_light(),
        fit in any_covering_fit(), samples in any_samples(),
    ) {
        prop_assume!(view.lens.near < f64::from(fit.map.max_distance));
        let stage = Stage::new(&plans, &view);
        let frusta = [view.frustum()];
        let input = FitInput { receivers: stage.receivers(), ..FitInput::new(&frusta, direction) };
        let mut storage = scratch(10, 1);
        let map = shadowfit::fit_scene(&input, &fit, &mut Scratch::new(&mut storage)).unwrap();
        // Only one fit uses receivers. The others store the whole view.
        let receivers = if fit.shape.kind == FitKind::Focused { stage.receivers() } else { None };
        let points = seen(&samples, &view, receivers, f64::from(fit.map.max_distance));
        prop_assert!(points.is_empty() || !map.is_empty);
        for point in points {
            assert_stored(&map, fit.map.border.unwrap_or(3.0), view.eye + point);
        }
    }

    #[test]
    fn several_maps_store_what_several_views_see_while_they_walk_and_turn(
        view in any_view(), plans in any_receivers(), direction in any_light(), settings in any_technique(),
        (walk, frames) in (any_walk(), 1..6_usize), apart in (any_walk(), 1..=2_usize), samples in any_samples(),
    ) {
        prop_assume!(view.lens.near < f64::from(settings.fit.max_distance));
        let stage = Stage::new(&plans, &view);
        let mut views = vec![view; apart.1];
        if let Some(other) = views.get_mut(1) {
            *other = apart.0.moved(other);
        }
        let mut fitter = FitState::new();
        for _ in 0..frames {
            check_frame(&mut fitter, &settings, &views, &stage, direction, &samples);
            for view in &mut views {
                *view = walk.moved(view);
            }
        }
    }

    /// Uses the crate's own camera, whose corners are rounded once, with depth ratios up to 10,000.
    #[test]
    fn several_maps_of_a_camera_store_what_it_sees(
        camera in any_camera(), plans in any_receivers(), direction in any_light(), settings in any_technique(),
        samples in any_samples(),
    ) {
        prop_assume!(camera.near < settings.fit.max_distance);
        let view = of_camera(&camera);
        let stage = Stage::new(&plans, &view);
        check_frame(&mut FitState::new(), &settings, &[view], &stage, direction, &samples);
    }
}
