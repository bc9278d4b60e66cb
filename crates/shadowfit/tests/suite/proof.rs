//! The coverage proof: it succeeds for correct fits and finds the holes of broken ones.

use proptest::prelude::*;
use shadowfit::bias::FilterRadius;
use shadowfit::glam::{DVec2, DVec3, Mat4, UVec2, Vec3};
use shadowfit::proof::{CoverageProof, CoverageQuery, MapPlane, prove};
use shadowfit::settings::{
    CasterPolicy, FitKind, FitSettings, Hysteresis, MapSettings, RectangleKind, Shape, SplitScheme, Stabilise,
};
use shadowfit::{
    Aabb, Bias, Boxes, Cascades, DepthConvention, FitError, FitInput, FitState, FittedMap, LightProjection,
    PerspectiveCamera, Scratch, Technique, ViewFrustum,
};

use crate::scenes::{COVERING, any_choice, any_walk};
use crate::support::{DIRECTION, SNAP, any_camera, any_direction, apply, camera, cases, double, float, sliced};

fn storage(boxes: usize) -> Vec<DVec2> {
    vec![DVec2::ZERO; Scratch::required(boxes, 10)]
}

/// A box by its position and size, in shares of the view's extent.
#[derive(Clone, Copy, Debug)]
struct Plan {
    centre: DVec3,
    half: DVec3,
}

fn any_plan() -> impl Strategy<Value = Plan> {
    let place = || double(-1.2, 1.2);
    let size = || prop_oneof![double(0.0, 0.02), double(0.0, 0.3), double(0.5, 2.0), Just(0.0)];
    ((place(), place(), place()), (size(), size(), size()))
        .prop_map(|((x, y, z), (a, b, c))| Plan { centre: DVec3::new(x, y, z), half: DVec3::new(a, b, c) })
}

/// Boxes around a camera, relative to the world's origin or to a point near the eye.
#[derive(Clone, Debug)]
struct Scene {
    receivers: Option<Vec<Aabb>>,
    casters: Vec<Aabb>,
    origin: DVec3,
}

impl Scene {
    fn receivers(&self) -> Option<Boxes<'_>> {
        self.receivers.as_ref().map(|boxes| Boxes { origin: self.origin, boxes })
    }

    fn casters(&self) -> Boxes<'_> {
        Boxes { origin: self.origin, boxes: &self.casters }
    }

    fn input<'a>(&'a self, views: &'a [ViewFrustum], direction: Vec3) -> FitInput<'a> {
        FitInput { receivers: self.receivers(), casters: Some(self.casters()), ..FitInput::new(views, direction) }
    }

    fn len(&self) -> usize {
        self.casters.len().max(self.receivers.as_ref().map_or(0, Vec::len))
    }
}

type Plans = (Option<Vec<Plan>>, Vec<Plan>, bool);

fn any_plans() -> impl Strategy<Value = Plans> {
    let boxes = || prop::collection::vec(any_plan(), 0..12);
    (prop_oneof![1 => Just(None), 4 => boxes().prop_map(Some)], boxes(), any::<bool>())
}

fn scene(plans: &Plans, camera: &PerspectiveCamera) -> Scene {
    let origin = if plans.2 { DVec3::ZERO } else { camera.eye.round() };
    // A centre inside the view and a scale between near and far, so that scenes with large depth ratios are
    // hit too.
    let scale = f64::from(camera.near) * (f64::from(camera.far) / f64::from(camera.near)).sqrt() * 4.0;
    let centre = camera.eye - origin + camera.forward.as_dvec3() * scale * 0.5;
    let aabb = |plan: &Plan| {
        let (middle, half) = (centre + plan.centre * scale, plan.half * scale);
        Aabb::new((middle - half).as_vec3(), (middle + half).as_vec3())
    };
    let receivers: Option<Vec<Aabb>> = plans.0.as_ref().map(|plans| plans.iter().map(aabb).collect());
    // All receivers are also casters.
    let casters = plans.1.iter().map(aabb).chain(receivers.iter().flatten().copied()).collect();
    Scene { receivers, casters, origin }
}

fn any_depth() -> impl Strategy<Value = DepthConvention> {
    prop::sample::select(vec![DepthConvention::ZeroToOne, DepthConvention::Reversed, DepthConvention::NegativeOneToOne])
}

fn any_fit() -> impl Strategy<Value = FitSettings> {
    let kind = prop::sample::select(COVERING.to_vec());
    let rectangle = prop::sample::select(vec![
        RectangleKind::AxisAligned,
        RectangleKind::MinimumArea,
        RectangleKind::MinimumSquare,
    ]);
    let casters =
        prop::sample::select(vec![CasterPolicy::PerObject, CasterPolicy::SceneBounds, CasterPolicy::DepthClamp]);
    let resolution = prop::sample::select(vec![UVec2::new(2048, 2048), UVec2::new(512, 1024), UVec2::new(64, 40)]);
    let distance = prop_oneof![Just(f32::MAX), float(5.0, 500.0)];
    (kind, rectangle, casters, resolution, any_depth(), distance, prop_oneof![Just(0.0), float(0.0, 6.0)]).prop_map(
        |(kind, rectangle, casters, resolution, depth, max_distance, border)| FitSettings {
            shape: Shape { kind, rectangle, ..Shape::default() },
            map: MapSettings {
                casters,
                resolution,
                depth,
                max_distance,
                border: Some(border),
                ..MapSettings::default()
            },
        },
    )
}

fn any_technique() -> impl Strategy<Value = Technique> {
    let splits = prop_oneof![
        Just(SplitScheme::Uniform),
        Just(SplitScheme::Logarithmic),
        float(0.0, 1.0).prop_map(SplitScheme::Practical),
        Just(SplitScheme::FromBoxes),
    ];
    let held = prop_oneof![Just(0.0), Just(0.02), float(0.0, 0.5)]
        .prop_map(|margin| Stabilise::Hysteresis(Hysteresis::default().with_margin(margin)));
    let stabilise = prop_oneof![Just(Stabilise::Off), Just(SNAP), held];
    (any_fit(), 1..=8_u32, splits, any_choice(), stabilise).prop_map(|(fit, count, splits, selection, stabilise)| {
        sliced(&fit, Cascades { count, splits, selection, stabilise, ..Cascades::default() })
    })
}

/// Returns the widest reach that the border allows.
fn reach_of(settings: &MapSettings) -> FilterRadius {
    FilterRadius::taps(settings.border.unwrap_or(3.0) + 0.5)
}

proptest! {
    #![proptest_config(cases(1000))]

    #[test]
    fn a_single_map_has_no_holes(
        camera in any_camera(), plans in any_plans(), direction in any_direction(), fit in any_fit(),
    ) {
        prop_assume!(camera.near < fit.map.max_distance);
        let scene = scene(&plans, &camera);
        let views = [camera.frustum().unwrap()];
        let input = scene.input(&views, direction);
        let mut storage = storage(scene.len());
        let mut scratch = Scratch::new(&mut storage);
        let map = shadowfit::fit_scene(&input, &fit, &mut scratch).unwrap();
        let query = CoverageQuery::of_fit(&fit, reach_of(&fit.map));
        let proof = prove(&input, &map, &query, &mut scratch).unwrap();
        prop_assert!(proof.is_proven(), "{proof:?}");
    }

    /// Checks that the proof also holds for sampled points, which no clipping produced: f32 matrix times f32
    /// position.
    #[test]
    fn everything_seen_of_a_proven_box_is_inside(
        camera in any_camera(), plans in any_plans(), direction in any_direction(), fit in any_fit(),
        margin in double(-0.1, 0.1), places in prop::collection::vec((double(0.0, 1.0), double(0.0, 1.0), double(0.0, 1.0)), 16),
    ) {
        prop_assume!(camera.near < fit.map.max_distance);
        let scene = scene(&plans, &camera);
        let views = [camera.frustum().unwrap()];
        let input = scene.input(&views, direction);
        let mut storage = storage(scene.len());
        let mut scratch = Scratch::new(&mut storage);
        let mut map = shadowfit::fit_scene(&input, &fit, &mut scratch).unwrap();
        // Shift the map by up to a tenth. Most of these maps have holes, and the proof must reject them.
        let shift = map.light_from_world.x_axis.truncate() * (map.box_max.x - map.box_min.x) * margin as f32;
        map.origin += shift.as_dvec3();
        let query = CoverageQuery { near: f32::MIN, far: f32::MAX, ..CoverageQuery::of_fit(&fit, reach_of(&fit.map)) };
        let CoverageProof::Proven(_) = prove(&input, &map, &query, &mut scratch).unwrap() else { return Ok(()) };
        let corner = |i: usize| views[0].corners[i].as_dvec3();
        for (x, y, z) in places {
            let at = |t: f64, a: DVec3, b: DVec3| a * (1.0 - t) + b * t;
            let rectangle = |i: usize| at(y, at(x, corner(i), corner(i + 1)), at(x, corner(i + 3), corner(i + 2)));
            let point = views[0].origin + at(z, rectangle(0), rectangle(4));
            let is_received = scene.receivers.as_ref().is_none_or(|boxes| boxes.iter().any(|b| {
                let p = point - scene.origin;
                p.cmpge(b.min.as_dvec3()).all() && p.cmple(b.max.as_dvec3()).all()
            }));
            let uv = looked_up(&map, point);
            prop_assert!(!is_received || (uv.cmpge(Vec3::ZERO).all() && uv.cmple(Vec3::ONE).all()), "{point}: {uv}");
        }
    }

    #[test]
    fn several_maps_have_no_holes_while_the_camera_walks_and_turns(
        camera in any_camera(), plans in any_plans(), direction in any_direction(), settings in any_technique(),
        (walk, frames) in (any_walk(), 1..6_usize),
    ) {
        prop_assume!(camera.near < settings.fit.max_distance);
        let scene = scene(&plans, &camera);
        let mut storage = storage(scene.len());
        let mut scratch = Scratch::new(&mut storage);
        let (mut fitter, mut camera) = (FitState::new(), camera);
        for frame in 0..frames {
            let views = [camera.frustum().unwrap()];
            let input = scene.input(&views, direction);
            let maps = fitter.fit(&input, &settings, &mut scratch).unwrap();
            for (i, map) in maps.iter().enumerate() {
                let query = CoverageQuery::of_map(map, &settings, reach_of(&settings.fit));
                let proof = prove(&input, &map.projection, &query, &mut scratch).unwrap();
                prop_assert!(proof.is_proven(), "frame {frame}, map {i}: {proof:?} of {map:?}");
            }
            camera = walk.moved_camera(&camera);
        }
    }
}

/// A filter that is wide compared with a coarse map reads casters up to its reach beside a receiver, also at
/// the map's edge.
#[test]
fn stable_maps_keep_the_casters_that_wide_filters_read() {
    let camera = PerspectiveCamera {
        eye: DVec3::splat(-1000.0),
        forward: Vec3::new(0.445_013_64, 0.837_557_3, 0.316_955_18),
        up: Vec3::new(-0.762_319_2, -0.479_056_95, -0.435_171_04),
        fov_y: 0.854_415_8,
        aspect: 1.228_704_7,
        near: 0.181_872_81,
        far: 19.197_952,
    };
    let plan = Plan {
        centre: DVec3::new(-0.432_606_8, 0.478_195_5, -0.117_337_4),
        half: DVec3::new(0.203_612_2, 1.470_268_1, 0.168_060_2),
    };
    let scene = scene(&(Some(vec![plan]), Vec::new(), true), &camera);
    let fit = FitSettings::default()
        .with_kind(FitKind::Sphere)
        .with_casters(CasterPolicy::PerObject)
        .with_border(3.195_267_7)
        .with_resolution(UVec2::new(64, 40));
    let settings = sliced(&fit, Cascades { count: 7, splits: SplitScheme::Logarithmic, ..Cascades::default() });
    let views = [camera.frustum().unwrap()];
    let input = scene.input(&views, Vec3::new(-0.172_338_68, -0.965_532_3, -0.195_055_77));
    let mut storage = storage(scene.len());
    let mut scratch = Scratch::new(&mut storage);
    let maps = FitState::new().fit(&input, &settings, &mut scratch).unwrap();
    for (i, map) in maps.iter().enumerate() {
        let query = CoverageQuery::of_map(map, &settings, reach_of(&fit.map));
        let proof = prove(&input, &map.projection, &query, &mut scratch).unwrap();
        assert!(proof.is_proven(), "map {i}: {proof:?}");
    }
}

#[test]
fn a_map_for_all_view_depths_is_made_for_what_lies_behind_the_eye_of_orthographic_views_too() {
    let fit = FitSettings::default();
    let (technique, reach) = (sliced(&fit, Cascades::default()), reach_of(&fit.map));
    let map = FittedMap::new(LightProjection::default(), Bias::default());
    let [by_map, by_fit] =
        [CoverageQuery::of_map(&map, &technique, reach), CoverageQuery::of_fit(&fit, reach)].map(|query| query.near);
    assert_eq!(by_map, by_fit);
}

/// Returns the texture coordinates of a world position as a shader computes them, in f32.
fn looked_up(fit: &LightProjection, point: DVec3) -> Vec3 {
    apply(&fit.uv_from_world, (point - fit.origin).as_vec3())
}

/// Returns an orthographic view from above: 8 m wide, 4 m high, from 1 m to 3 m below the eye.
fn from_above() -> ViewFrustum {
    let corner = |x: f32, z: f32, depth: f32| Vec3::new(x * 4.0, -depth, z * 2.0);
    let rectangle = |depth| {
        [corner(-1.0, -1.0, depth), corner(1.0, -1.0, depth), corner(1.0, 1.0, depth), corner(-1.0, 1.0, depth)]
    };
    let (near, far) = (rectangle(1.0), rectangle(3.0));
    ViewFrustum {
        origin: DVec3::new(100.0, 50.0, -30.0),
        corners: [near[0], near[1], near[2], near[3], far[0], far[1], far[2], far[3]],
        near: 1.0,
        far: 3.0,
        forward: Vec3::NEG_Y,
    }
}

fn plain() -> FitSettings {
    FitSettings::default()
        .with_kind(FitKind::FrustumAabb)
        .with_casters(CasterPolicy::None)
        .with_border(0.0)
        .with_resolution(UVec2::new(800, 400))
}

fn proof(input: &FitInput, fit: &LightProjection, query: &CoverageQuery) -> CoverageProof {
    let mut storage = storage(1);
    prove(input, fit, query, &mut Scratch::new(&mut storage)).unwrap()
}

/// Returns a box around a point over the view's centre, relative to the eye.
fn over(x: f32, y: f32, half: f32) -> Aabb {
    Aabb::new(Vec3::new(x - half, y - half, -half), Vec3::new(x + half, y + half, half))
}

#[test]
fn the_margins_left_are_those_of_the_settings() {
    let views = [from_above()];
    // 9 m by 5 m in 800 by 400 texels, and half a metre of depth on either side.
    let settings = plain().with_margin(0.5);
    let fit = shadowfit::fit(&views[0], Vec3::NEG_Y, &settings).unwrap();
    let casters = [over(0.0, -0.75, 0.125)];
    let input = FitInput {
        casters: Some(Boxes { origin: views[0].origin, boxes: &casters }),
        ..FitInput::new(&views, Vec3::NEG_Y)
    };
    let query = CoverageQuery::of_fit(&settings, FilterRadius::POINT);
    let CoverageProof::Proven(margins) = proof(&input, &fit, &query) else { panic!("{fit:?}") };
    let expected = [800.0 / 9.0 * 0.5, 800.0 / 9.0 * 0.5, 400.0 / 5.0 * 0.5, 400.0 / 5.0 * 0.5, 0.5, 0.5];
    for (margin, expected) in margins.planes.into_iter().zip(expected) {
        assert!((margin / expected - 1.0).abs() < 1e-4, "{margin} {expected}");
    }
    // The caster's top is 0.625 m below the eye, the near plane 0.5 m.
    assert!((margins.casters - 0.125).abs() < 1e-4, "{}", margins.casters);
    // The filter reduces the margin by its reach beyond half a texel, and the normal offset by its length.
    let query = CoverageQuery::of_fit(&settings, FilterRadius::POINT.over_disc(3.0)).with_normal_offset(0.1);
    let CoverageProof::Proven(wide) = proof(&input, &fit, &query) else { panic!("{fit:?}") };
    for (i, per_metre) in [800.0 / 9.0, 800.0 / 9.0, 80.0, 80.0].into_iter().enumerate() {
        assert!((margins.planes[i] - wide.planes[i] - 3.0 - 0.1 * per_metre).abs() < 1e-3);
    }
    assert_eq!(margins.planes[4..], wide.planes[4..]);
}

#[test]
fn a_shrunken_box_is_refused_with_its_plane_and_a_point_outside() {
    let views = [from_above()];
    let input = FitInput::new(&views, Vec3::NEG_Y);
    let fit = shadowfit::fit(&views[0], Vec3::NEG_Y, &plain()).unwrap();
    let query = CoverageQuery::of_fit(&plain(), FilterRadius::POINT);
    assert!(proof(&input, &fit, &query).is_proven());
    for (i, plane) in MapPlane::ALL.into_iter().enumerate() {
        let mut small = fit;
        // Move one side of the box inward by 1% of its extent, in all fields of the fit.
        let (axis, is_high) = (i / 2, i % 2 == 1);
        let extent = (fit.box_max - fit.box_min)[axis];
        let (low, high) = if is_high { (0.0, 0.01) } else { (0.01, 0.0) };
        small.box_min[axis] += extent * low;
        small.box_max[axis] -= extent * high;
        if axis == 2 {
            small.depth_range *= 0.99;
        }
        squeeze(&mut small.clip_from_world, axis, if axis == 2 { (0.0, 1.0) } else { (-1.0, 1.0) }, is_high);
        // v and depth run against the light's y and z.
        squeeze(&mut small.uv_from_world, axis, (0.0, 1.0), is_high);
        if axis == 1 {
            small.uv_from_world = fit.uv_from_world;
            squeeze(&mut small.uv_from_world, axis, (0.0, 1.0), !is_high);
        }
        if axis == 2 {
            (small.clip_from_world, small.uv_from_world) = (fit.clip_from_world, fit.uv_from_world);
            squeeze(&mut small.clip_from_world, axis, (0.0, 1.0), !is_high);
            squeeze(&mut small.uv_from_world, axis, (0.0, 1.0), !is_high);
        }
        let CoverageProof::Uncovered { plane: found, point, by } = proof(&input, &small, &query) else {
            panic!("{plane:?} of {small:?}");
        };
        assert_eq!(found, plane);
        let missing = if axis == 2 { 0.01 * extent } else { 0.01 / 0.99 * fit.resolution.as_vec2()[axis] };
        assert!((by / missing - 1.0).abs() < 0.02, "{plane:?}: {by} instead of {missing}");
        let uv = looked_up(&small, point);
        assert!(uv.cmplt(Vec3::ZERO).any() || uv.cmpgt(Vec3::ONE).any(), "{plane:?}: {point} is at {uv}");
        assert!(!small.covers(point) && fit.covers(point));
    }
}

/// Moves the lower or upper end of the range that a row of a matrix maps to, inward by 1% of it.
fn squeeze(matrix: &mut Mat4, row: usize, (low, high): (f32, f32), is_high: bool) {
    let fixed = if is_high { low } else { high };
    for column in [&mut matrix.x_axis, &mut matrix.y_axis, &mut matrix.z_axis, &mut matrix.w_axis] {
        column[row] /= 0.99;
    }
    matrix.w_axis[row] += fixed - fixed / 0.99;
}

#[test]
fn each_of_the_matrices_counts_by_itself() {
    let views = [from_above()];
    let input = FitInput::new(&views, Vec3::NEG_Y);
    let fit = shadowfit::fit(&views[0], Vec3::NEG_Y, &plain()).unwrap();
    let query = CoverageQuery::of_fit(&plain(), FilterRadius::POINT);
    let refused = |fit: &LightProjection| {
        matches!(proof(&input, fit, &query), CoverageProof::Uncovered { plane: MapPlane::Right, .. })
    };
    let mut small = fit;
    squeeze(&mut small.clip_from_world, 0, (-1.0, 1.0), true);
    assert!(refused(&small));
    let mut small = fit;
    squeeze(&mut small.uv_from_world, 0, (0.0, 1.0), true);
    assert!(refused(&small));
    let mut small = fit;
    small.box_max.x *= 0.99;
    assert!(refused(&small));
}

#[test]
fn a_near_plane_behind_a_caster_loses_it() {
    let views = [from_above()];
    let origin = views[0].origin;
    let settings = plain();
    let fit = shadowfit::fit(&views[0], Vec3::NEG_Y, &settings).unwrap();
    let query = CoverageQuery::of_fit(&settings, FilterRadius::HARDWARE_2X2);
    let check = |caster: Aabb, query: &CoverageQuery| {
        let casters = [over(0.0, -2.0, 0.5), caster];
        let casters = Boxes { origin, boxes: &casters };
        let query = CoverageQuery { filter_radius: FilterRadius::POINT, ..*query };
        proof(&FitInput { casters: Some(casters), ..FitInput::new(&views, Vec3::NEG_Y) }, &fit, &query)
    };
    // The caster is 5 m above the eye. The near plane is 1 m below it.
    let CoverageProof::CasterLost { point, by } = check(over(3.0, 4.0, 1.0), &query) else { panic!("not lost") };
    assert!((by - 6.0).abs() < 1e-3 && (point.y - origin.y - 5.0).abs() < 1e-9, "{point} by {by}");
    assert!(looked_up(&fit, point).z < 0.0);
    // Casters beside the view or below it cast no shadow into it.
    assert!(check(over(5.1, 4.0, 1.0), &query).is_proven());
    assert!(check(over(0.0, -9.0, 1.0), &query).is_proven());
    // A caster partly over the view counts. With depth clamp none does.
    assert!(!check(over(4.9, 4.0, 1.0), &query).is_proven());
    assert!(check(over(0.0, 4.0, 1.0), &CoverageQuery { casters: CasterPolicy::DepthClamp, ..query }).is_proven());
    // A texel is 1 cm wide: only a filter of reach 2 reads a caster 1.5 cm beside the view.
    let beside = over(5.015, 4.0, 1.0);
    assert!(check(beside, &query).is_proven());
    let casters = [beside];
    let input = FitInput { casters: Some(Boxes { origin, boxes: &casters }), ..FitInput::new(&views, Vec3::NEG_Y) };
    let settings = settings.with_border(1.5);
    let wide = shadowfit::fit(&views[0], Vec3::NEG_Y, &settings).unwrap();
    let proof = proof(&input, &wide, &CoverageQuery::of_fit(&settings, FilterRadius::taps(2.0)));
    assert!(matches!(proof, CoverageProof::CasterLost { .. }), "{proof:?}");
}

#[test]
fn the_xna_fit_covers_the_view_but_loses_casters_before_it() {
    let views = [PerspectiveCamera { far: 20.0, ..camera() }.frustum().unwrap()];
    let settings = plain().with_kind(FitKind::XnaSample).with_margin(0.01);
    let fit = shadowfit::fit(&views[0], DIRECTION, &settings).unwrap();
    let query = CoverageQuery::of_fit(&settings, FilterRadius::POINT);
    let input = FitInput::new(&views, DIRECTION);
    assert!(proof(&input, &fit, &query).is_proven());
    let middle = (fit.corners()[0] + fit.corners()[2]) * 0.5 - fit.direction * 10.0;
    let casters = [Aabb::new(middle - 1.0, middle + 1.0)];
    let input = FitInput { casters: Some(Boxes { origin: fit.origin, boxes: &casters }), ..input };
    let CoverageProof::CasterLost { point, by } = proof(&input, &fit, &query) else { panic!("not lost") };
    assert!(by > 10.0 && by < 12.0 && !fit.covers(point), "{point} by {by}");
    // Its corners lie exactly in its planes: without a margin, rounding may put them beyond.
    let exact = shadowfit::fit(&views[0], DIRECTION, &settings.with_margin(0.0)).unwrap();
    let CoverageProof::Uncovered { by, .. } = proof(&FitInput::new(&views, DIRECTION), &exact, &query) else {
        panic!("proven")
    };
    assert!(by < 0.01, "{by}");
}

#[test]
fn receivers_of_a_map_that_nobody_draws_are_found() {
    let views = [from_above()];
    let receivers = [over(1.0, -2.0, 0.25)];
    let boxes = Boxes { origin: views[0].origin, boxes: &receivers };
    let input = FitInput { receivers: Some(boxes), ..FitInput::new(&views, Vec3::NEG_Y) };
    let fit = LightProjection { is_empty: true, ..shadowfit::fit(&views[0], Vec3::NEG_Y, &plain()).unwrap() };
    let query = CoverageQuery::of_fit(&plain(), FilterRadius::POINT);
    assert!(matches!(proof(&input, &fit, &query), CoverageProof::MarkedEmpty { .. }));
    // Without receivers, in the range or at all, an empty map is correct.
    for (boxes, far) in [(&receivers[..], 1.5), (&receivers[..0], 3.0)] {
        let boxes = Boxes { origin: views[0].origin, boxes };
        let input = FitInput { receivers: Some(boxes), ..input };
        let CoverageProof::Proven(margins) = proof(&input, &fit, &CoverageQuery { far, ..query }) else {
            panic!("{far}")
        };
        assert_eq!(margins.planes, [f32::INFINITY; 6]);
    }
}

#[test]
fn another_origin_far_away_is_refused_for_its_rounding() {
    let views = [from_above()];
    let input = FitInput::new(&views, Vec3::NEG_Y);
    let fit = shadowfit::fit(&views[0], Vec3::NEG_Y, &plain().with_margin(0.001)).unwrap();
    let query = CoverageQuery::of_fit(&plain(), FilterRadius::POINT);
    assert!(proof(&input, &fit, &query).is_proven());
    let near = fit.relative_to(fit.origin + DVec3::new(10.0, 0.0, 10.0));
    assert!(proof(&input, &near, &query).is_proven());
    // At 10 km, f32 has steps of 1 mm.
    let far = fit.relative_to(fit.origin + DVec3::new(1e4, 0.0, 1e4));
    assert!(!proof(&input, &far, &query).is_proven());
}

#[test]
fn bad_numbers_are_errors() {
    let views = [from_above()];
    let input = FitInput::new(&views, Vec3::NEG_Y);
    let fit = shadowfit::fit(&views[0], Vec3::NEG_Y, &plain()).unwrap();
    let query = CoverageQuery::of_fit(&plain(), FilterRadius::POINT);
    let mut storage = storage(1);
    let mut error = |input: &FitInput, fit: &LightProjection, query: &CoverageQuery| {
        prove(input, fit, query, &mut Scratch::new(&mut storage)).unwrap_err()
    };
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let is_bad = |e: FitError| matches!(e, FitError::NotFinite { .. });
        for query in [
            CoverageQuery { near: bad, ..query },
            CoverageQuery { far: bad, ..query },
            CoverageQuery { normal_offset: bad, ..query },
            CoverageQuery { filter_radius: FilterRadius::taps(bad), ..query },
            CoverageQuery { filter_radius: FilterRadius::POINT.over_disc(bad), ..query },
        ] {
            assert!(is_bad(error(&input, &fit, &query)), "{query:?}");
        }
        for i in 0..16 {
            let with = |matrix: Mat4| {
                let mut elements = matrix.to_cols_array();
                elements[i] = bad;
                Mat4::from_cols_array(&elements)
            };
            for fit in [
                LightProjection { light_from_world: with(fit.light_from_world), ..fit },
                LightProjection { clip_from_world: with(fit.clip_from_world), ..fit },
                LightProjection { uv_from_world: with(fit.uv_from_world), ..fit },
            ] {
                assert!(is_bad(error(&input, &fit, &query)), "element {i}");
            }
        }
        for fit in [
            LightProjection { box_min: Vec3::splat(bad), ..fit },
            LightProjection { box_max: Vec3::splat(bad), ..fit },
            LightProjection { depth_range: bad, ..fit },
            LightProjection { origin: DVec3::splat(f64::from(bad)), ..fit },
        ] {
            assert!(is_bad(error(&input, &fit, &query)));
        }
        assert!(is_bad(error(&FitInput { direction: Vec3::splat(bad), ..input }, &fit, &query)));
    }
    let range = CoverageQuery { near: 2.0, far: 1.0, ..query };
    assert_eq!(error(&input, &fit, &range), FitError::NearNotBelowFar { near: 2.0, far: 1.0 });
    assert_eq!(error(&FitInput { views: &[], ..input }, &fit, &query), FitError::NoView);
    let resolution = UVec2::new(0, 4);
    assert_eq!(error(&input, &LightProjection { resolution, ..fit }, &query), FitError::ZeroResolution { resolution });
    assert!(matches!(error(&input, &LightProjection::default(), &query), FitError::ZeroResolution { .. }));
    let flat = LightProjection { clip_from_world: Mat4::ZERO, ..fit };
    assert!(matches!(error(&input, &flat, &query), FitError::OutOfRange { .. }));
    let small = prove(&input, &fit, &query, &mut Scratch::new(&mut []));
    assert!(matches!(small, Err(FitError::ScratchTooSmall { .. })));
}
