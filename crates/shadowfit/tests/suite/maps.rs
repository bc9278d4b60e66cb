//! Several maps for one view: their splits, their fields, and the values that are held.

use proptest::prelude::*;
use shadowfit::BoundSource;
use shadowfit::demand::{DepthBounds, DepthHistogram};
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::selection::DepthRange;
use shadowfit::settings::{CasterPolicy, FitKind, FitSettings, MapSelection, RectangleKind, SplitScheme, Stabilise};
use shadowfit::{
    Aabb, Boxes, Cascades, FitInput, FitState, FittedMap, FittedMaps, PerspectiveCamera, Scratch, Technique,
    ViewFrustum,
};

use crate::scenes::{COVERING, any_light, any_technique, any_view};
use crate::support::{
    DIRECTION, SNAP, ShaderDepths, any_camera, any_direction, camera, cases, every_stabilise, sliced,
};

fn fit_with(fitter: &mut FitState, input: &FitInput, settings: &Technique) -> FittedMaps {
    let boxes =
        input.receivers.map_or(0, |boxes| boxes.boxes.len()).max(input.casters.map_or(0, |boxes| boxes.boxes.len()));
    let mut storage = vec![DVec2::ZERO; Scratch::required(boxes, input.views.len())];
    fitter.fit(input, settings, &mut Scratch::new(&mut storage)).unwrap()
}

fn fit_once(input: &FitInput, settings: &Technique) -> FittedMaps {
    fit_with(&mut FitState::new(), input, settings)
}

fn settings(kind: FitKind, splits: SplitScheme, count: u32) -> Technique {
    kept(kind, splits, count, Stabilise::Off)
}

fn kept(kind: FitKind, splits: SplitScheme, count: u32, stabilise: Stabilise) -> Technique {
    let fit = FitSettings::default().with_kind(kind).with_max_distance(f32::MAX).with_casters(CasterPolicy::None);
    let selection = MapSelection::ViewDepth { overlap: 0.0 };
    sliced(&fit, Cascades { count, splits, selection, stabilise, ..Cascades::default() })
}

/// Returns the ends of all maps except the last one.
fn splits_of(maps: &[FittedMap]) -> Vec<f64> {
    maps[..maps.len() - 1].iter().map(|map| f64::from(map.far())).collect()
}

fn assert_splits(maps: &[FittedMap], expected: impl Fn(f64) -> f64) {
    let count = maps.len() as f64;
    for (i, split) in splits_of(maps).into_iter().enumerate() {
        let wanted = expected((i + 1) as f64 / count);
        // One rounding to f32.
        assert!((split / wanted - 1.0).abs() < 1e-6, "split {i} at {split} instead of {wanted}");
    }
}

proptest! {
    #![proptest_config(cases(1000))]

    /// Maps follow each other without a gap, from the near plane to infinity. Each map covers view depths
    /// before its range by the overlap's share of the previous range.
    #[test]
    fn ranges_of_maps_ascend_without_gaps(view in any_view(), direction in any_light(), settings in any_technique()) {
        prop_assume!(view.lens.near < f64::from(settings.fit.max_distance));
        let views = [view.frustum()];
        let maps = fit_once(&FitInput::new(&views, direction), &settings);
        prop_assert_eq!(maps.len(), settings.maps.count() as usize);
        let ranged: Vec<&FittedMap> = maps.iter().filter(|map| map.near() < map.far()).collect();
        prop_assert_eq!(ranged[0].near(), views[0].near);
        prop_assert_eq!(ranged[ranged.len() - 1].far(), f32::MAX);
        let overlap = if let MapSelection::ViewDepth { overlap } = settings.maps.selection() { overlap } else { 0.0 };
        for pair in ranged.windows(2) {
            prop_assert_eq!(pair[0].far(), pair[1].near());
            let before = pair[1].near() - overlap * (pair[0].far() - pair[0].near());
            prop_assert!(pair[1].projection.is_empty || (pair[1].covered_from() - before).abs() <= 1e-6 * before.abs());
        }
        // No depth selects a map without a range.
        for depth in [views[0].near, views[0].far, 0.5 * (views[0].near + views[0].far)] {
            let chosen = maps.iter().find(|map| depth < map.far()).unwrap();
            prop_assert!(chosen.near() < chosen.far());
        }
    }

    #[test]
    fn fixed_schemes_split_by_their_definitions(camera in any_camera(), direction in any_direction(), count in 1..=8_u32, lambda in crate::support::float(0.0, 1.0)) {
        let views = [camera.frustum().unwrap()];
        let input = FitInput::new(&views, direction);
        let (near, far) = (f64::from(camera.near), f64::from(camera.far));
        let uniform = |s: f64| near + (far - near) * s;
        let logarithmic = |s: f64| near * (far / near).powf(s);
        let at = |splits| fit_once(&input, &settings(FitKind::FrustumAabb, splits, count));
        assert_splits(&at(SplitScheme::Uniform), uniform);
        assert_splits(&at(SplitScheme::Logarithmic), logarithmic);
        let l = f64::from(lambda);
        assert_splits(&at(SplitScheme::Practical(lambda)), |s| l * logarithmic(s) + (1.0 - l) * uniform(s));
    }

    /// With a scheme that uses boxes, the first map still begins at the near plane, and the splits are spread
    /// over the visible parts of the boxes.
    #[test]
    fn splits_are_spread_over_the_depths_of_receivers(count in 2..=8_u32, near in crate::support::float(5.0, 20.0)) {
        let views = [ahead()];
        let boxes = [Aabb::new(Vec3::new(-1.0, -1.0, -60.0), Vec3::new(1.0, 1.0, -near))];
        let input = FitInput { receivers: Some(Boxes { origin: DVec3::ZERO, boxes: &boxes }), ..FitInput::new(&views, DIRECTION) };
        let maps = fit_once(&input, &settings(FitKind::FrustumAabb, SplitScheme::Uniform, count));
        let near = f64::from(near);
        assert_splits(&maps, |s| near + (60.0 - near) * s);
        prop_assert_eq!(maps[0].near(), views[0].near);
    }

    #[test]
    fn reset_equals_a_new_fitter(
        view in any_view(), other in any_view(), direction in any_light(), settings in any_technique(),
    ) {
        prop_assume!(view.lens.near.max(other.lens.near) < f64::from(settings.fit.max_distance));
        let (views, others) = ([view.frustum()], [other.frustum()]);
        let mut fitter = FitState::new();
        fit_with(&mut fitter, &FitInput::new(&others, direction), &settings);
        fitter.reset();
        let input = FitInput::new(&views, direction);
        let mut new = FitState::new();
        for _ in 0..2 {
            prop_assert_eq!(fit_with(&mut fitter, &input, &settings), fit_with(&mut new, &input, &settings));
        }
    }

    /// While nothing moves, nothing changes, except the flag of a held map.
    #[test]
    fn maps_stay_bit_for_bit_while_nothing_moves(
        view in any_view(), direction in any_light(), settings in any_technique(),
    ) {
        prop_assume!(view.lens.near < f64::from(settings.fit.max_distance));
        let views = [view.frustum()];
        let input = FitInput::new(&views, direction);
        let mut fitter = FitState::new();
        let first = fit_with(&mut fitter, &input, &settings);
        let second = fit_with(&mut fitter, &input, &settings);
        for (a, b) in first.iter().zip(second.iter()) {
            prop_assert_eq!(a.projection.uv_from_world, b.projection.uv_from_world);
            prop_assert_eq!(a.depths, b.depths);
        }
        for _ in 0..3 {
            prop_assert_eq!(fit_with(&mut fitter, &input, &settings), second);
        }
    }

    /// By their own model, splits from boxes are no worse than logarithmic ones. Without known receivers,
    /// every octave of depth counts alike. Splits lie on 64 bins, each of which may cost its own width, and
    /// extents are estimated from 32 directions, which may cost 5%.
    #[test]
    fn splits_by_content_are_no_worse_than_logarithmic_ones(
        camera in any_camera(), direction in any_direction(), count in 1..=6_u32,
        kind in prop::sample::select(COVERING.to_vec()),
    ) {
        let views = [camera.frustum().unwrap()];
        let input = FitInput::new(&views, direction);
        // For rectangles of least area, the longer side, which counts here, is arbitrary. So use squares.
        let square = |splits| squared(&settings(kind, splits, count));
        let measure = |splits| quantile(&fit_once(&input, &square(splits)), &views[0]);
        let (chosen, logarithmic) = (measure(SplitScheme::FromBoxes), measure(SplitScheme::Logarithmic));
        let bin = f64::from(camera.far / camera.near).powf(1.0 / 64.0);
        prop_assert!(chosen <= logarithmic * bin * 1.05, "{chosen} and {logarithmic}");
    }
}

/// Returns the technique with square maps.
fn squared(technique: &Technique) -> Technique {
    let shape = technique.maps.shape().unwrap().with_rectangle(RectangleKind::MinimumSquare);
    technique.with_maps(technique.maps.with_shape(shape))
}

/// Returns the quantile with another number of maps.
fn error_of(input: &FitInput, settings: &Technique, count: u32) -> f64 {
    quantile(&fit_once(input, &settings.with_count(count)), &input.views[0])
}

/// Returns the 95% quantile of the wider texel side per view depth, over depths at even steps of their log.
fn quantile(maps: &[FittedMap], view: &ViewFrustum) -> f64 {
    let (near, far) = (f64::from(view.near).max(f64::from(view.far) / 65_536.0), f64::from(view.far));
    let mut errors: Vec<f64> = (0..1000)
        .map(|i| {
            let depth = near * (far / near).powf((f64::from(i) + 0.5) / 1000.0);
            let map = maps.iter().find(|map| depth < f64::from(map.far())).unwrap();
            f64::from(map.projection.texel_size.max_element()) / depth
        })
        .collect();
    errors.sort_by(f64::total_cmp);
    errors[950]
}

/// Returns a view from the origin along -z, 0.1 to 100 m.
fn ahead() -> ViewFrustum {
    PerspectiveCamera {
        eye: DVec3::ZERO,
        forward: Vec3::NEG_Z,
        up: Vec3::Y,
        fov_y: 1.0,
        aspect: 1.5,
        near: 0.1,
        far: 100.0,
    }
    .frustum()
    .unwrap()
}

#[test]
fn manual_splits_are_taken_as_they_are() {
    let views = [ahead()];
    let given = [1.0, 5.0, 20.0, 50.0, 60.0, 70.0, 80.0];
    for kind in COVERING {
        let maps = fit_once(&FitInput::new(&views, DIRECTION), &settings(kind, SplitScheme::Manual(given), 4));
        assert_eq!(splits_of(&maps), [1.0, 5.0, 20.0]);
    }
}

#[test]
fn manual_splits_outside_of_what_is_shadowed_leave_maps_empty() {
    let views = [ahead()];
    let given = [0.01, 0.05, 20.0, 50.0, 150.0, 200.0, 300.0];
    for kind in COVERING {
        for stabilise in every_stabilise() {
            let settings = kept(kind, SplitScheme::Manual(given), 8, stabilise);
            let maps = fit_once(&FitInput::new(&views, DIRECTION), &settings);
            let empty: Vec<bool> = maps.iter().map(|map| map.projection.is_empty).collect();
            assert_eq!(empty, [true, true, false, false, false, true, true, true], "{kind:?}");
            assert_eq!((maps[2].near(), maps[4].far()), (0.1, f32::MAX));
        }
    }
}

/// A histogram of a narrow band: nearly all pixels see it, so the map that they select is made for them, and
/// finer than with logarithmic splits.
#[test]
fn a_histogram_with_one_narrow_band_splits_around_it() {
    let views = [ahead()];
    let mut bins = vec![0_u32; 64];
    for depth in 0..100 {
        let depth = 18.0 + 2.0 * depth as f32 / 100.0;
        bins[DepthHistogram::bin(0.1, 100.0, 64, 1, depth, 0.0).unwrap()] += 1;
    }
    let histogram = Some(DepthHistogram { near: 0.1, far: 100.0, bins: &bins, classes: 1 });
    let input = FitInput { histogram, ..FitInput::new(&views, DIRECTION) };
    for kind in [FitKind::FrustumAabb, FitKind::Oriented, FitKind::Sphere] {
        let at = |splits| {
            let maps = fit_once(&input, &settings(kind, splits, 3));
            let map = *maps.iter().find(|map| 19.0 < map.far()).unwrap();
            (map.projection.texel_size.max_element(), map)
        };
        let (chosen, map) = at(SplitScheme::FromHistogram);
        let (logarithmic, _) = at(SplitScheme::Logarithmic);
        assert!(chosen < logarithmic, "{kind:?}: {chosen} and {logarithmic}");
        // It ends with the band, except for the few points that may be left out.
        assert!(map.far() > 18.0 && map.far() < 25.0, "{kind:?}: {}..{}", map.near(), map.far());
    }
}

/// Boxes at two depths: the empty depths between and beyond them get no separate maps.
#[test]
fn splits_from_boxes_are_finer_where_boxes_are() {
    let views = [ahead()];
    let boxes = [
        Aabb::new(Vec3::new(-40.0, -40.0, -22.0), Vec3::new(40.0, 40.0, -20.0)),
        Aabb::new(Vec3::new(-1.0, -1.0, -3.0), Vec3::new(1.0, 1.0, -2.0)),
    ];
    let receivers = Some(Boxes { origin: DVec3::ZERO, boxes: &boxes });
    let input = FitInput { receivers, ..FitInput::new(&views, DIRECTION) };
    for kind in [FitKind::FrustumAabb, FitKind::Focused, FitKind::Sphere] {
        let texel = |splits, depth: f32| {
            let maps = fit_once(&input, &settings(kind, splits, 2));
            maps.iter().find(|map| depth < map.far()).unwrap().projection.texel_size.max_element() / depth
        };
        let worst = |splits| texel(splits, 2.5).max(texel(splits, 21.0));
        let (chosen, logarithmic) = (worst(SplitScheme::FromBoxes), worst(SplitScheme::Logarithmic));
        assert!(chosen <= logarithmic * 1.01, "{kind:?}: {chosen} and {logarithmic}");
    }
}

/// Receivers end at 45 m, in front of the manual ends of the second and later maps. Splits of spheres end
/// with the receivers.
#[test]
fn cascades_behind_all_receivers_begin_where_shadows_end() {
    let views = [ahead()];
    let boxes = [Aabb::new(Vec3::new(-5.0, -2.0, -45.0), Vec3::new(5.0, -1.0, -5.0))];
    let receivers = Some(Boxes { origin: DVec3::ZERO, boxes: &boxes });
    let input = FitInput { receivers, ..FitInput::new(&views, DIRECTION) };
    let splits = SplitScheme::Manual([10.0, 60.0, 70.0, 80.0, 90.0, 95.0, 99.0]);
    let maps = fit_once(&input, &settings(FitKind::Sphere, splits, 4).with_max_distance(80.0));
    let depths: Vec<_> = maps.iter().map(|map| map.depths).collect();
    let last = DepthRange { covered_from: Some(10.0), ..DepthRange::new(10.0, None) };
    assert_eq!(depths[1..], [Some(last), Some(DepthRange::new(80.0, None)), Some(DepthRange::new(80.0, None))]);
}

/// Visible from 2 to 20 m only, in a view from 0.1 to 100 m.
#[test]
fn fixed_splits_are_spread_between_the_depth_bounds_and_lose_nothing_outside() {
    let views = [ahead()];
    let bounds =
        |near, far| FitInput { depth_bounds: Some(DepthBounds { near, far }), ..FitInput::new(&views, DIRECTION) };
    for kind in COVERING {
        let inner = |splits, near, far| {
            let maps = fit_once(&bounds(near, far), &settings(kind, splits, 3));
            assert!(maps[0].near() <= 0.1 && maps[0].covered_from() <= 0.1, "{kind:?}");
            let last = maps.iter().rfind(|map| map.near() < map.far()).unwrap();
            assert!(last.far() >= 100.0 && !last.projection.is_empty, "{kind:?}");
            [maps[1].near(), maps[2].near()]
        };
        let is_near = |[a, b]: [f32; 2], [c, d]: [f32; 2]| (a / c - 1.0).abs() < 1e-5 && (b / d - 1.0).abs() < 1e-5;
        let third = 10.0_f32.cbrt();
        assert!(is_near(inner(SplitScheme::Logarithmic, 2.0, 20.0), [2.0 * third, 2.0 * third * third]), "{kind:?}");
        assert!(is_near(inner(SplitScheme::Uniform, 2.0, 20.0), [8.0, 14.0]), "{kind:?}");
        // Bounds beyond the view are clamped to the view.
        let whole = fit_once(&FitInput::new(&views, DIRECTION), &settings(kind, SplitScheme::Logarithmic, 3));
        assert!(is_near(inner(SplitScheme::Logarithmic, 0.0, 1e9), [whole[1].near(), whole[2].near()]), "{kind:?}");
        // A wall at a single depth.
        let flat = fit_once(&bounds(5.0, 5.0), &settings(kind, SplitScheme::Logarithmic, 3));
        assert!(
            flat.iter().any(|map| map.near() <= 4.9 && map.far() > 4.9) && flat.iter().any(|map| map.far() >= 100.0)
        );
    }
    for (near, far) in [(f32::NAN, 5.0), (1.0, f32::INFINITY), (6.0, 5.0)] {
        let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
        let result = FitState::new().fit(&bounds(near, far), &Technique::default(), &mut Scratch::new(&mut storage));
        assert!(result.is_err(), "{near} {far}");
    }
}

/// Held splits are recomputed only after the bounds have left them.
#[test]
fn held_splits_follow_depth_bounds_that_leave_them() {
    let views = [ahead()];
    let settings = kept(FitKind::Sphere, SplitScheme::Logarithmic, 3, SNAP);
    let mut fitter = FitState::new();
    let mut split = |near, far| {
        let input = FitInput { depth_bounds: Some(DepthBounds { near, far }), ..FitInput::new(&views, DIRECTION) };
        // Held splits are compared every few frames.
        (0..16).map(|_| fit_with(&mut fitter, &input, &settings)[1].near()).last().unwrap()
    };
    let first = split(2.0, 20.0);
    assert_eq!(split(2.2, 22.0), first);
    assert!(split(2.2, 90.0) > first * 1.2, "the far end has left them");
    assert!(split(0.3, 90.0) < first, "the near end has left them");
}

proptest! {
    #![proptest_config(cases(200))]

    /// Without known receivers every octave of depth counts alike, as in [`quantile`].
    #[test]
    fn the_fewest_maps_waste_no_more_than_they_may(
        camera in any_camera(), direction in any_direction(), count in 1..=6_u32, waste in 1.0_f32..8.0,
        kind in prop::sample::select(COVERING.to_vec()),
    ) {
        let views = [camera.frustum().unwrap()];
        let input = FitInput::new(&views, direction);
        let settings = squared(&settings(kind, SplitScheme::FromBoxes, count));
        let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
        let mut fewest = |waste| shadowfit::fewest_maps(&input, &settings, waste, &mut Scratch::new(&mut storage)).unwrap();
        let found = fewest(waste);
        prop_assert!((1..=count).contains(&found) && fewest(1.0) >= found && fewest(100.0) <= found);
        // Bins and directions cost the same as for the splits, in both.
        let bin = f64::from(camera.far / camera.near).powf(1.0 / 64.0);
        prop_assert!(error_of(&input, &settings, found) <= error_of(&input, &settings, count) * f64::from(waste) * bin * bin * 1.1, "{found} of {count}");
        if found > 1 {
            prop_assert!(error_of(&input, &settings, found - 1) * bin * bin * 1.1 >= error_of(&input, &settings, count) * f64::from(waste), "{} would do", found - 1);
        }
    }
}

#[test]
fn no_receivers_give_empty_maps_and_no_error() {
    let views = [ahead()];
    let receivers = Some(Boxes::default());
    let input = FitInput { receivers, ..FitInput::new(&views, DIRECTION) };
    for stabilise in every_stabilise() {
        for splits in
            [SplitScheme::Uniform, SplitScheme::Logarithmic, SplitScheme::FromBoxes, SplitScheme::FromHistogram]
        {
            let settings = kept(FitKind::Focused, splits, 3, stabilise);
            let mut fitter = FitState::new();
            for _ in 0..2 {
                let maps = fit_with(&mut fitter, &input, &settings);
                assert!(maps.len() == 3 && maps.iter().all(|map| map.projection.is_empty), "{settings:?}");
            }
        }
    }
}

/// The lens zooms beyond the held splits, and back.
#[test]
fn a_far_plane_that_comes_nearer_leaves_held_splits_without_error() {
    for kind in COVERING {
        for stabilise in [SNAP, Stabilise::default()] {
            for splits in [SplitScheme::Uniform, SplitScheme::FromBoxes] {
                let settings = kept(kind, splits, 4, stabilise);
                let mut fitter = FitState::new();
                for far in [80.0, 60.0, 50.0, 46.0, 79.0] {
                    let views = [PerspectiveCamera { far, ..camera() }.frustum().unwrap()];
                    let maps = fit_with(&mut fitter, &FitInput::new(&views, DIRECTION), &settings);
                    let last = maps.iter().find(|map| far * 0.999 < map.far()).unwrap();
                    assert!(!last.projection.is_empty, "{kind:?} {far}");
                }
            }
        }
    }
}

#[test]
fn what_set_each_plane_is_named() {
    use BoundSource::{CasterExtension, Casters, Held, Receivers, Sphere, View};
    let views = [ahead()];
    let input = FitInput::new(&views, Vec3::NEG_Y);
    let bounds_from = |input: &FitInput, kind, casters| {
        let fit = FitSettings::default().with_kind(kind).with_casters(casters).with_caster_extension(5.0);
        let mut storage = [DVec2::ZERO; Scratch::required(2, 1)];
        shadowfit::fit_scene(input, &fit, &mut Scratch::new(&mut storage)).unwrap().bounds_from
    };
    for kind in [FitKind::FrustumAabb, FitKind::Oriented, FitKind::Focused] {
        assert_eq!(bounds_from(&input, kind, CasterPolicy::None), [View; 6]);
        assert_eq!(bounds_from(&input, kind, CasterPolicy::Extend), [View, View, View, View, View, CasterExtension]);
    }
    assert_eq!(bounds_from(&input, FitKind::Sphere, CasterPolicy::None), [Sphere; 6]);
    let ball = [Aabb::new(Vec3::new(-1.0, -1.0, -21.0), Vec3::new(1.0, 1.0, -19.0))];
    let above = [Aabb::new(Vec3::new(-1.0, 5.0, -21.0), Vec3::new(1.0, 6.0, -19.0))];
    let receivers = Some(Boxes { origin: DVec3::ZERO, boxes: &ball });
    let casters = Boxes { origin: DVec3::ZERO, boxes: &above };
    let boxed = FitInput { receivers, casters: Some(casters), ..input };
    assert_eq!(bounds_from(&boxed, FitKind::Focused, CasterPolicy::None), [Receivers; 6]);
    for casters in [CasterPolicy::PerObject, CasterPolicy::SceneBounds] {
        let expected = [Receivers, Receivers, Receivers, Receivers, Receivers, Casters];
        assert_eq!(bounds_from(&boxed, FitKind::Focused, casters), expected);
    }
    // A floor under the whole view: the view bounds it at the sides, the floor itself below.
    let floor = [Aabb::new(Vec3::new(-500.0, -2.0, -500.0), Vec3::new(500.0, -1.0, 500.0))];
    let floored = FitInput { receivers: Some(Boxes { origin: DVec3::ZERO, boxes: &floor }), ..input };
    let by = bounds_from(&floored, FitKind::Focused, CasterPolicy::None);
    assert_eq!((by[3], by[4], by[5]), (View, Receivers, Receivers));
    let mut fitter = FitState::new();
    let held = kept(FitKind::Focused, SplitScheme::Uniform, 1, Stabilise::default());
    assert_eq!(fit_with(&mut fitter, &boxed, &held)[0].projection.bounds_from, [Receivers; 6]);
    assert_eq!(fit_with(&mut fitter, &boxed, &held)[0].projection.bounds_from, [Held; 6]);
}
