//! Soft filters: their radius in texels, their reach, and the finest map that they allow.

use proptest::prelude::*;
use shadowfit::bias::FilterRadius;
use shadowfit::glam::{DVec2, UVec2, Vec2, Vec3};
use shadowfit::proof::{CoverageQuery, prove};
use shadowfit::settings::{
    Edges, FilterKind, FitKind, FitSettings, MapSettings, RectangleKind, Shape, SoftRadius, Softness, SplitScheme,
};
use shadowfit::{Cascades, FitInput, FitState, FittedMaps, LightProjection, Maps, Scratch, Technique, ViewFrustum};

use crate::support::{DIRECTION, any_camera, any_direction, camera, cases, every_stabilise, exact, fitted, float};

const SOFT: [FilterKind; 4] = [FilterKind::Vogel8, FilterKind::Vogel16, FilterKind::Vogel32, FilterKind::Pcss];

fn metres(metres: f32) -> Softness {
    Softness::default().with_radius(SoftRadius::Metres(metres))
}

/// Returns a fit with texels of a size, in metres.
fn with_texels(texel_size: Vec2) -> LightProjection {
    LightProjection { texel_size, ..fitted(&camera(), DIRECTION, &exact(FitKind::FrustumAabb)) }
}

#[test]
fn a_sun_s_penumbra_is_its_tangent_times_the_distance() {
    let sun = Softness::default().with_radius(SoftRadius::SunAngle(0.1));
    for filter in SOFT {
        let distance = if filter == FilterKind::Pcss { 20.0 } else { Softness::USUAL_DISTANCE };
        assert!((sun.metres(filter) / (0.1_f32.tan() * distance) - 1.0).abs() < 1e-6, "{filter:?}");
    }
    assert_eq!((metres(0.3).metres(FilterKind::Vogel8), metres(0.3).metres(FilterKind::Pcss)), (0.3, 1.2));
    let hard = FilterKind::ALL.into_iter().filter(|filter| !filter.is_soft());
    for filter in hard {
        let fit = with_texels(Vec2::splat(0.01));
        assert_eq!((sun.metres(filter), sun.texels(filter, &fit)), (0.0, Vec2::ZERO), "{filter:?}");
        assert_eq!(sun.filter_radius_in(filter, &fit), FilterRadius::from(filter), "{filter:?}");
        assert_eq!((sun.filter_radius(filter), sun.least_texel(filter)), (filter.filter_radius(), 0.0), "{filter:?}");
    }
}

/// Returns the variance along an axis, in square metres, of an edge that is rasterised, compared bilinearly
/// and blurred by a disc with a radius in texels. It is simulated for all positions of the edge in a texel.
fn variance(radius: f64, texel: f64) -> f64 {
    let steps = 400;
    let (mut sum, mut weight) = (0.0, 0.0);
    for i in 0..steps {
        // Position of the edge in its texel. The first texel on its far side is lit.
        let edge = (f64::from(i) + 0.5) / f64::from(steps);
        for j in 0..200 {
            // The strip of a disc at x has a share of √(1 - x²).
            let x = (f64::from(j) + 0.5) / 100.0 - 1.0;
            let share = (1.0 - x * x).sqrt();
            for k in 0..20 {
                // A look-up changes linearly from dark to lit over the texel between two centres.
                let ramp = (f64::from(k) + 0.5) / 20.0 - 0.5;
                let at = edge.round() - edge + ramp + x * radius;
                sum += share * at * at;
                weight += share;
            }
        }
    }
    sum / weight * texel * texel
}

#[test]
fn penumbrae_are_as_wide_in_maps_of_other_texels() {
    let softness = metres(0.1).with_floor(0.0).with_ceiling(64.0);
    for texel in [0.002_f32, 0.01, 0.03, 0.05, 0.1, 0.12] {
        let radius = softness.texels(FilterKind::Vogel16, &with_texels(Vec2::splat(texel))).x;
        // Radius of the disc with the same blur, in metres.
        let whole = 2.0 * variance(radius.into(), texel.into()).sqrt();
        assert!((whole / 0.1 - 1.0).abs() < 0.01, "{texel}: {whole}");
    }
    // A single look-up blurs like a disc of this radius.
    assert!((4.0 * variance(0.0, 1.0) / f64::from(Softness::LOOK_UP_SQUARE) - 1.0).abs() < 0.01);
}

#[test]
fn discs_keep_within_the_floor_and_the_ceiling_on_either_axis() {
    let softness = metres(1.0).with_floor(2.0).with_ceiling(10.0);
    for filter in SOFT {
        let radius = softness.metres(filter);
        let at = |x: f32, y: f32| softness.texels(filter, &with_texels(Vec2::new(radius / x, radius / y)));
        assert_eq!(at(1.0, 100.0), Vec2::new(2.0, 10.0), "{filter:?}");
        let expected = Vec2::new(4.0, 6.0).map(|r| (r * r - Softness::LOOK_UP_SQUARE).sqrt());
        assert!(at(4.0, 6.0).abs_diff_eq(expected, 1e-4), "{filter:?}");
        assert_eq!(softness.filter_radius(filter), 11.0);
    }
    // Fits refuse a floor above its ceiling. This function must not panic on it.
    let broken = softness.with_floor(20.0);
    assert_eq!(broken.texels(FilterKind::Pcss, &with_texels(Vec2::ONE)), Vec2::splat(10.0));
    for value in [f32::NAN, f32::INFINITY, -1.0] {
        let _ = metres(value).with_floor(value).with_ceiling(value).texels(FilterKind::Pcss, &with_texels(Vec2::ONE));
    }
}

#[test]
fn a_least_texel_is_the_greater_of_what_is_set_and_what_the_ceiling_asks_for() {
    let soft = Technique::default().with_filter(FilterKind::Vogel16).with_softness(metres(0.8));
    assert!((soft.least_texel() / 0.05 - 1.0).abs() < 1e-6);
    let set = |metres| MapSettings::default().with_least_texel(metres);
    assert_eq!(soft.with_fit(set(0.01)).least_texel(), soft.least_texel());
    assert_eq!(soft.with_fit(set(0.2)).least_texel(), 0.2);
    assert_eq!(soft.with_filter(FilterKind::Pcf7x7).least_texel(), 0.0);
    let traced = soft.with_edges(Edges::Traced { samples: 1 });
    assert_eq!(traced.least_texel(), 0.0, "rays make the penumbra");
    assert_eq!(traced.with_fit(set(0.01)).least_texel(), 0.01);
    assert_eq!((soft.with_filter(FilterKind::Pcf7x7).filter_radius(), soft.filter_radius()), (4.0, 17.0));
}

#[test]
fn no_limit_and_one_that_is_met_anyway_give_the_same_map() {
    let frustum = camera().frustum().unwrap();
    for kind in [FitKind::XnaSample, FitKind::FrustumAabb, FitKind::Oriented, FitKind::Sphere, FitKind::Focused] {
        let plain = exact(kind);
        let free = shadowfit::fit(&frustum, DIRECTION, &plain).unwrap();
        // The sphere's texels are up to an eighth of an octave wider than necessary.
        let met = plain.with_least_texel(free.texel_size.min_element() * 0.9);
        assert_eq!(shadowfit::fit(&frustum, DIRECTION, &met).unwrap(), free, "{kind:?}");
        let limited = plain.with_least_texel(free.texel_size.max_element() * 3.0);
        let wide = shadowfit::fit(&frustum, DIRECTION, &limited).unwrap();
        assert_eq!(wide == free, kind == FitKind::XnaSample, "{kind:?}");
        let share = wide.texel_size.min_element() / limited.map.least_texel;
        assert!(kind == FitKind::XnaSample || (1.0 - 1e-5..1.1).contains(&share), "{kind:?}: {share}");
    }
}

fn any_softness() -> impl Strategy<Value = Softness> {
    let radius = prop_oneof![
        (-9.0_f32..3.0).prop_map(|exponent| SoftRadius::Metres(exponent.exp2())),
        (-9.0_f32..-1.0).prop_map(|exponent| SoftRadius::SunAngle(exponent.exp2())),
    ];
    (radius, float(1.0, 14.0)).prop_map(|(radius, ceiling)| Softness { radius, floor: 1.0, ceiling })
}

/// One map, cascades of every kind, and windows.
fn any_limited() -> impl Strategy<Value = Technique> {
    let cascades = [FitKind::FrustumAabb, FitKind::Oriented, FitKind::Sphere, FitKind::Focused].map(Some);
    let kinds: Vec<Option<FitKind>> = cascades.into_iter().chain([None]).collect();
    let rectangles = [RectangleKind::AxisAligned, RectangleKind::MinimumArea, RectangleKind::MinimumSquare];
    let kind = (prop::sample::select(kinds), prop::sample::select(rectangles.to_vec()));
    let stabilise = prop::sample::select(every_stabilise().to_vec());
    let sides = || prop::sample::select(vec![64_u32, 300, 1024]);
    let least = prop_oneof![1 => Just(0.0), 3 => (-10.0_f32..5.0).prop_map(f32::exp2)];
    let ratio = prop_oneof![3 => Just(f32::MAX), 1 => float(1.0, 4.0)];
    let filter = (prop::sample::select(FilterKind::ALL.to_vec()), any_softness());
    (kind, stabilise, (sides(), sides()), (least, ratio), filter, 1..=8_u32).prop_map(
        |((kind, rectangle), stabilise, (width, height), (least_texel, max_texel_ratio), (filter, softness), count)| {
            let cascades = |kind| {
                let splits = SplitScheme::Logarithmic;
                let shape = Shape { kind, rectangle, max_texel_ratio };
                Maps::from(Cascades { shape, splits, stabilise, ..Cascades::default() })
            };
            let maps = kind.map_or(Maps::default(), cascades).with_count(count);
            let fit = MapSettings::default().with_least_texel(least_texel);
            Technique { maps, fit, softness, ..Technique::default() }.with_filter(filter).with_resolution(width, height)
        },
    )
}

/// Returns whether the windows' texel sizes are whole eighths of an octave on the world grid.
fn are_windows(maps: &FittedMaps) -> bool {
    let step = |map: &shadowfit::FittedMap| map.grid_position.map(|grid_position| grid_position.texel.x.log2() * 8.0);
    let on_ladder = |step: Option<f64>| step.is_some_and(|step| (step - step.round()).abs() < 1e-6);
    maps.iter().map(step).all(on_ladder)
        && maps.windows(2).all(|pair| pair[0].projection.texel_size.cmplt(pair[1].projection.texel_size).all())
}

proptest! {
    #![proptest_config(cases(300))]

    /// New, snapped and held maps and windows, while the camera moves and turns.
    #[test]
    fn no_map_has_finer_texels_than_the_limit_and_all_still_hold_what_they_must(
        camera in any_camera(), direction in any_direction(), technique in any_limited(),
        (turn, step) in (float(-0.05, 0.05), float(-0.01, 0.01)),
    ) {
        let mut storage = [DVec2::ZERO; Scratch::required(0, 3)];
        let mut fitter = FitState::new();
        let mut camera = camera;
        for _ in 0..4 {
            let views: [ViewFrustum; 1] = [camera.frustum().unwrap()];
            let input = FitInput::new(&views, direction);
            let maps = fitter.fit(&input, &technique, &mut Scratch::new(&mut storage)).unwrap();
            for map in maps.iter() {
                let (texel, least) = (map.projection.texel_size.min_element(), technique.least_texel());
                prop_assert!(texel >= least * (1.0 - 1e-5), "{texel} of {least}");
                let reach = technique.filter_radius_in(&map.projection);
                prop_assert!(reach.per_axis() <= technique.filter_radius(), "{reach:?}");
                let query = CoverageQuery::of_map(map, &technique, reach);
                let proof = prove(&input, &map.projection, &query, &mut Scratch::new(&mut storage)).unwrap();
                // Only the last window must cover all visible points.
                prop_assert!(proof.is_proven(), "{proof:?}");
            }
            prop_assert!(!matches!(technique.maps, Maps::Windows(_)) || are_windows(&maps), "{maps:?}");
            camera.forward += Vec3::new(turn, -turn, turn) * camera.forward.length();
            camera.eye += (camera.forward * step * camera.far).as_dvec3();
        }
    }

    #[test]
    fn a_single_map_keeps_to_the_limit_of_its_settings(
        camera in any_camera(), direction in any_direction(), technique in any_limited(),
    ) {
        let frustum = camera.frustum().unwrap();
        let map = technique.fit.with_resolution(UVec2::new(512, 300));
        let settings = FitSettings { shape: technique.maps.shape().unwrap_or_default(), map };
        let map = shadowfit::fit(&frustum, direction, &settings).unwrap();
        prop_assert!(map.texel_size.min_element() >= settings.map.least_texel * (1.0 - 1e-5), "{map:?}");
        let query = CoverageQuery::of_fit(&settings, FilterRadius::kernel(5));
        let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
        let views = [frustum];
        let input = FitInput::new(&views, direction);
        let proof = prove(&input, &map, &query, &mut Scratch::new(&mut storage)).unwrap();
        prop_assert!(proof.is_proven(), "{proof:?}");
    }
}
