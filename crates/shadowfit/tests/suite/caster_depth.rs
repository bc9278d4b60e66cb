//! Every caster with a visible shadow is kept: each point of a caster's box between the light and a visible
//! receiver point is inside the map's depth range, and the box survives culling.

use proptest::prelude::*;
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::settings::{CasterPolicy, Stabilise};
use shadowfit::{Aabb, Boxes, FitInput, FitState, LightProjection, Scratch, Technique};

use crate::scenes::{
    BoxPlan, SceneView, Walk, any_box, any_covering_fit, any_light, any_technique, any_view, any_walk, share,
};
use crate::support::{ShaderDepths, apply, cases, double};

/// A box around a point on the way from the light to a visible point.
#[derive(Clone, Copy, Debug)]
struct CasterPlan {
    /// Number of the visible point that it shades.
    which: usize,
    /// Its distance before that point, and its half extents, in view depths (log10).
    before: f64,
    half: [f64; 3],
    /// Where the light's ray passes through the box, -1..1 of the half extents.
    at: [f64; 3],
}

fn any_caster() -> impl Strategy<Value = CasterPlan> {
    let half = || prop_oneof![1 => Just(f64::NEG_INFINITY), 4 => double(-3.0, 0.0)];
    let at = || prop_oneof![1 => Just(-1.0), 1 => Just(1.0), 4 => double(-1.0, 1.0)];
    (0..16_usize, double(-3.0, 1.0), [half(), half(), half()], [at(), at(), at()])
        .prop_map(|(which, before, half, at)| CasterPlan { which, before, half, at })
}

/// Visible points relative to the eye.
fn any_places() -> impl Strategy<Value = Vec<[f64; 3]>> {
    prop::collection::vec([share(), share(), share()], 16)
}

fn visible(view: &SceneView, places: &[[f64; 3]], receivers: &[Aabb], last: f64) -> Vec<DVec3> {
    let far = view.lens.far.min(last);
    let free = places.iter().map(|[x, y, z]| view.point(*x, *y, view.lens.near + (far - view.lens.near) * z));
    let in_box = |(i, place): (usize, &[f64; 3])| {
        let aabb = receivers.get(i % receivers.len().max(1))?;
        let (min, max) = (aabb.min.as_dvec3(), aabb.max.as_dvec3());
        Some(min + (max - min) * DVec3::from_array(*place))
    };
    let held = |p: &DVec3| receivers.iter().any(|b| p.cmpge(b.min.as_dvec3()).all() && p.cmple(b.max.as_dvec3()).all());
    let mut points: Vec<DVec3> = free.filter(held).collect();
    points.extend(places.iter().enumerate().filter_map(in_box).filter(|p| view.sees(*p, last)));
    points
}

impl CasterPlan {
    fn aabb(&self, points: &[DVec3], to_light: DVec3, scale: f64) -> Aabb {
        let on_ray = points[self.which % points.len()] + to_light * (10.0_f64.powf(self.before) * scale);
        let half = DVec3::from_array(self.half.map(|e| 10.0_f64.powf(e))) * scale;
        let centre = on_ray - half * DVec3::from_array(self.at);
        Aabb::new((centre - half).as_vec3(), (centre + half).as_vec3())
    }
}

/// Returns the distances toward the light at which the ray from a point enters and leaves a box.
fn crossing(point: DVec3, to_light: DVec3, aabb: &Aabb) -> Option<(f64, f64)> {
    let (mut enter, mut leave) = (0.0_f64, f64::MAX);
    for axis in 0..3 {
        let (min, max) = (f64::from(aabb.min[axis]) - point[axis], f64::from(aabb.max[axis]) - point[axis]);
        if to_light[axis] == 0.0 {
            if min > 0.0 || max < 0.0 {
                return None;
            }
            continue;
        }
        let (a, b) = (min / to_light[axis], max / to_light[axis]);
        enter = enter.max(a.min(b));
        leave = leave.min(a.max(b));
    }
    (enter <= leave).then_some((enter, leave))
}

/// Asserts that a caster that shades a point is completely in the map. `points` and boxes are relative to the
/// eye, which is the fit's origin.
fn assert_kept(fit: &LightProjection, point: DVec3, casters: &[Aabb], to_light: DVec3) {
    for aabb in casters {
        let Some((enter, leave)) = crossing(point, to_light, aabb) else { continue };
        for t in [enter, (enter + leave) * 0.5, leave] {
            let p = point + to_light * t;
            let depth = apply(&fit.uv_from_world, p.as_vec3()).z;
            // Near and far plane have a margin for the rounding of covered points. A caster's own distance is
            // rounded by 2⁻²⁴ in each of up to eight steps of a shader.
            let slack = 8.0 / 16_777_216.0 * (1.0 + p.length() / f64::from(fit.depth_range)) as f32;
            assert!((-slack..=1.0 + slack).contains(&depth), "depth {depth} of {p} for {point}");
        }
        assert!(fit.caster_volume().intersects_aabb(aabb.min, aabb.max), "{aabb:?} is culled, but shades {point}");
    }
}

/// A scene of receivers, and casters that shade some of their visible points, relative to the eye.
struct Stage {
    receivers: Vec<Aabb>,
    casters: Vec<Aabb>,
    points: Vec<DVec3>,
    to_light: DVec3,
}

impl Stage {
    fn new(
        view: &SceneView,
        boxes: &[BoxPlan],
        casters: &[CasterPlan],
        direction: Vec3,
        places: &[[f64; 3]],
        last: f64,
    ) -> Option<Self> {
        let to_light = -direction.as_dvec3().normalize();
        let receivers: Vec<Aabb> = boxes.iter().map(|plan| plan.aabb(view, view.eye)).collect();
        let points = visible(view, places, &receivers, last);
        if points.is_empty() {
            return None;
        }
        let casters = casters.iter().map(|plan| plan.aabb(&points, to_light, view.lens.far)).collect();
        Some(Self { receivers, casters, points, to_light })
    }

    fn input<'a>(&'a self, views: &'a [shadowfit::ViewFrustum], direction: Vec3) -> FitInput<'a> {
        let origin = views[0].origin;
        let receivers = Some(Boxes { origin, boxes: &self.receivers });
        let casters = Boxes { origin, boxes: &self.casters };
        FitInput { receivers, casters: Some(casters), ..FitInput::new(views, direction) }
    }
}

fn any_policy() -> impl Strategy<Value = CasterPolicy> {
    prop_oneof![Just(CasterPolicy::SceneBounds), Just(CasterPolicy::PerObject)]
}

fn solid_boxes() -> impl Strategy<Value = Vec<BoxPlan>> {
    prop::collection::vec(any_box(), 1..5)
}

proptest! {
    #![proptest_config(cases(2000))]

    #[test]
    fn a_single_map_keeps_all_casters_that_shade_what_is_seen(
        view in any_view(), boxes in solid_boxes(), casters in prop::collection::vec(any_caster(), 1..6),
        direction in any_light(), fit in any_covering_fit(), policy in any_policy(), places in any_places(),
    ) {
        let fit = fit.with_casters(policy);
        prop_assume!(view.lens.near < f64::from(fit.map.max_distance));
        let stage = Stage::new(&view, &boxes, &casters, direction, &places, f64::from(fit.map.max_distance));
        prop_assume!(stage.is_some());
        let stage = stage.unwrap();
        let views = [view.frustum()];
        let mut storage = vec![DVec2::ZERO; Scratch::required(6, 1)];
        let map = shadowfit::fit_scene(&stage.input(&views, direction), &fit, &mut Scratch::new(&mut storage)).unwrap();
        for point in &stage.points {
            assert_kept(&map, *point, &stage.casters, stage.to_light);
        }
    }

    /// Boxes do not move in the world while the camera does. All inputs are passed again relative to the eye.
    #[test]
    fn several_maps_keep_all_casters_that_shade_what_is_seen(
        view in any_view(), boxes in solid_boxes(), casters in prop::collection::vec(any_caster(), 1..6),
        direction in any_light(), settings in any_technique(), policy in any_policy(), places in any_places(),
        walk in any_walk(),
    ) {
        let settings = settings.with_fit(settings.fit.with_casters(policy));
        let last = f64::from(settings.fit.max_distance);
        prop_assume!(view.lens.near < last);
        let mut fitter = FitState::new();
        let frames = if matches!(settings.maps.as_single().stabilise, Stabilise::Hysteresis(_)) { 3 } else { 1 };
        let mut view = view;
        for _ in 0..frames {
            if let Some(stage) = Stage::new(&view, &boxes, &casters, direction, &places, last) {
                check_frame(&mut fitter, &view, &settings, &stage, direction);
            }
            view = Walk { turn: walk.turn * 0.1, step: walk.step * 0.1, ..walk }.moved(&view);
        }
    }
}

fn check_frame(fitter: &mut FitState, view: &SceneView, settings: &Technique, stage: &Stage, direction: Vec3) {
    let views = [view.frustum()];
    let mut storage = vec![DVec2::ZERO; Scratch::required(6, 1)];
    let maps = fitter.fit(&stage.input(&views, direction), settings, &mut Scratch::new(&mut storage)).unwrap();
    for point in &stage.points {
        let depth = views[0].forward.dot(point.as_vec3());
        let map = maps.iter().find(|map| depth < map.far()).unwrap();
        assert_kept(&map.projection, *point, &stage.casters, stage.to_light);
    }
}
