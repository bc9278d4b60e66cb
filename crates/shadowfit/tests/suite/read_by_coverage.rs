//! Maps with selection by coverage: the map that a visible point reads has all of the point's casters, in its
//! depth range and after culling, and the proof confirms it.

use proptest::prelude::*;
use shadowfit::bias::FilterRadius;
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::proof::{CoverageProof, CoverageQuery, prove};
use shadowfit::settings::{CasterPolicy, FitKind, MapSelection, SplitScheme};
use shadowfit::{
    Aabb, Boxes, FitInput, FitState, FittedMaps, LightProjection, PerspectiveCamera, Scratch, Technique, ViewFrustum,
};

use crate::scenes::{BoxPlan, any_box, any_light, any_technique, any_view, any_walk, share};
use crate::support::{cases, read_by};

/// A receiver's point, and a caster's point above it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    pub(crate) receiver: usize,
    caster: usize,
    pub(crate) place: [f64; 3],
}

pub(crate) fn any_samples() -> impl Strategy<Value = Vec<Sample>> {
    let one = (0..16_usize, 0..16_usize, [share(), share(), share()]);
    prop::collection::vec(one.prop_map(|(receiver, caster, place)| Sample { receiver, caster, place }), 48)
}

fn any_shared_technique() -> impl Strategy<Value = Technique> {
    let casters = prop::sample::select(vec![CasterPolicy::PerObject, CasterPolicy::SceneBounds]);
    (any_technique(), casters).prop_map(|(technique, casters)| {
        let border = technique.fit.border.unwrap_or(0.0).max(4.0);
        let technique = technique.with_fit(technique.fit.with_casters(casters).with_border(border));
        read_by(&technique, MapSelection::default())
    })
}

pub(crate) fn input<'a>(views: &'a [ViewFrustum], direction: Vec3, origin: DVec3, boxes: &'a [Aabb]) -> FitInput<'a> {
    let boxes = Some(Boxes { origin, boxes });
    FitInput { receivers: boxes, casters: boxes, ..FitInput::new(views, direction) }
}

/// Returns the distance along the ray from a point toward the light at which it leaves a box, or `None` if it misses.
pub(crate) fn above(point: DVec3, to_light: DVec3, aabb: &Aabb) -> Option<f64> {
    let (mut enter, mut leave) = (f64::MIN, f64::MAX);
    for axis in 0..3 {
        let (min, max) = (f64::from(aabb.min[axis]), f64::from(aabb.max[axis]));
        if to_light[axis] == 0.0 {
            if point[axis] < min || point[axis] > max {
                return None;
            }
            continue;
        }
        let (a, b) = ((min - point[axis]) / to_light[axis], (max - point[axis]) / to_light[axis]);
        (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
    }
    (enter <= leave && leave > 0.0).then_some(leave)
}

/// Distance before the near plane, as a share of the map's depth range, that counts as rounding of f32.
const TOLERANCE: f64 = 1e-5;

/// Returns the distance of a point before the map's near plane, as a share of the depth range.
fn before_near(fit: &LightProjection, point: DVec3) -> f64 {
    let local = (point - fit.origin).as_vec3();
    let p = fit.light_from_world.as_dmat4().transform_point3(local.as_dvec3());
    (p.z - f64::from(fit.box_max.z)) / f64::from(fit.depth_range)
}

/// Checks one frame. Returns the number of casters above points that read a map.
pub(crate) fn check(
    maps: &FittedMaps,
    input: &FitInput,
    technique: &Technique,
    seen: &[DVec3],
    samples: &[Sample],
) -> usize {
    let Boxes { origin, boxes } = input.casters.unwrap();
    let to_light = -input.direction.as_dvec3().normalize();
    let view = &input.views[0];
    let volumes = maps.caster_volumes(input.views, technique).unwrap();
    let mut found = 0;
    for (point, sample) in seen.iter().zip(samples) {
        let depth = (*point - view.origin).dot(view.forward.as_dvec3());
        let read = maps.read(technique, *point, depth).unwrap_or_else(|| panic!("{point} is in no map"));
        for index in [Some(read.map), read.blend.map(|blend| blend.map)].into_iter().flatten() {
            let (map, volume) = (&maps[index], &volumes[index]);
            let caster = &boxes[sample.caster % boxes.len()];
            let Some(distance) = above(*point - origin, to_light, caster) else { continue };
            let occluder = *point + to_light * distance;
            assert!(
                before_near(&map.projection, occluder) < TOLERANCE,
                "{occluder} is before the near plane of {:?}",
                map.projection
            );
            let moved = |v: Vec3| (v.as_dvec3() + origin - volume.origin).as_vec3();
            assert!(volume.intersects_aabb(moved(caster.min), moved(caster.max)), "{caster:?} is culled");
            found += 1;
        }
    }
    found
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn every_caster_above_a_visible_point_is_in_the_map_that_the_point_reads(
        view in any_view(), direction in any_light(), technique in any_shared_technique(), walk in any_walk(),
        plans in prop::collection::vec(any_box(), 1..12), samples in any_samples(),
    ) {
        prop_assume!(view.lens.near < f64::from(technique.fit.max_distance));
        let origin = view.eye.round();
        let boxes: Vec<Aabb> = plans.iter().map(|plan: &BoxPlan| plan.aabb(&view, origin)).collect();
        let mut storage = vec![DVec2::ZERO; Scratch::required(boxes.len(), 3)];
        let (mut fitter, mut view) = (FitState::new(), view);
        for _ in 0..3 {
            let views = [view.frustum()];
            let input = input(&views, direction, origin, &boxes);
            let maps = fitter.fit(&input, &technique, &mut Scratch::new(&mut storage)).unwrap();
            let last = f64::from(technique.fit.max_distance);
            let points = samples.iter().map(|sample| {
                let aabb = &boxes[sample.receiver % boxes.len()];
                let (min, max) = (aabb.min.as_dvec3(), aabb.max.as_dvec3());
                origin + min + (max - min) * DVec3::from_array(sample.place)
            });
            let (seen, samples): (Vec<DVec3>, Vec<Sample>) =
                points.zip(&samples).filter(|(point, _)| view.sees(*point - view.eye, last)).unzip();
            check(&maps, &input, &technique, &seen, &samples);
            view = walk.moved(&view);
        }
    }

    #[test]
    fn maps_that_are_read_by_coverage_are_proven(
        view in any_view(), direction in any_light(), technique in any_shared_technique(), walk in any_walk(),
        plans in prop::collection::vec(any_box(), 0..12),
    ) {
        prop_assume!(view.lens.near < f64::from(technique.fit.max_distance));
        let origin = view.eye.round();
        let boxes: Vec<Aabb> = plans.iter().map(|plan: &BoxPlan| plan.aabb(&view, origin)).collect();
        let mut storage = vec![DVec2::ZERO; Scratch::required(boxes.len(), 3)];
        let (mut fitter, mut view) = (FitState::new(), view);
        for frame in 0..3 {
            let views = [view.frustum()];
            let input = input(&views, direction, origin, &boxes);
            let mut scratch = Scratch::new(&mut storage);
            let maps = fitter.fit(&input, &technique, &mut scratch).unwrap();
            for (i, map) in maps.iter().enumerate() {
                let query = CoverageQuery::of_map(map, &technique, FilterRadius::HARDWARE_2X2);
                let proof = prove(&input, &map.projection, &query, &mut scratch).unwrap();
                prop_assert!(proof.is_proven(), "frame {frame}, map {i}: {proof:?} of {map:?}");
            }
            view = walk.moved(&view);
        }
    }
}

/// A tower beside the view, over a part of the first map. If the near plane is fitted only to the map's
/// slice, the tower is lost, and the proof finds it.
#[test]
fn a_near_plane_for_the_slice_alone_loses_casters_by_coverage() {
    let camera = PerspectiveCamera {
        eye: DVec3::new(0.0, 1.7, 0.0),
        forward: Vec3::NEG_Z,
        up: Vec3::Y,
        fov_y: 1.0,
        aspect: 1.5,
        near: 0.1,
        far: 200.0,
    };
    let (views, direction) = ([camera.frustum().unwrap()], Vec3::new(0.2, -1.0, 0.1));
    let boxes = [
        Aabb::new(Vec3::new(-100.0, -0.1, -200.0), Vec3::new(100.0, 0.0, 10.0)),
        Aabb::new(Vec3::new(5.0, 0.0, -4.0), Vec3::new(6.0, 40.0, -3.0)),
    ];
    let input = input(&views, direction, DVec3::ZERO, &boxes);
    let mut storage = vec![DVec2::ZERO; Scratch::required(boxes.len(), 1)];
    let mut scratch = Scratch::new(&mut storage);
    let manual = SplitScheme::Manual([12.0, 60.0, 61.0, 62.0, 63.0, 64.0, 65.0]);
    let mut proof = |selection| {
        // Spheres already cover all casters of their map, rectangles do not.
        let stable = Technique::preset("stable-4").unwrap().maps.with_kind(FitKind::FrustumAabb).as_cascades();
        let cascades = stable.with_count(3).with_splits(manual).with_selection(selection);
        let technique = Technique::default().with_maps(cascades);
        let map = FitState::new().fit(&input, &technique, &mut scratch).unwrap()[0];
        let query = CoverageQuery::of_map(&map, &technique, FilterRadius::HARDWARE_2X2);
        let query = CoverageQuery { is_shared: true, ..query };
        prove(&input, &map.projection, &query, &mut scratch).unwrap()
    };
    assert!(proof(MapSelection::default()).is_proven());
    let lost = proof(MapSelection::ViewDepth { overlap: 0.0 });
    assert!(matches!(lost, CoverageProof::CasterLost { by, .. } if by > 10.0), "{lost:?}");
}
