//! The limit of the ratio of a texel's length to its width.

use proptest::prelude::*;
use shadowfit::glam::{DVec2, UVec2, Vec3};
use shadowfit::proof::{CoverageQuery, prove};
use shadowfit::settings::{FitKind, FitSettings, RectangleKind, SplitScheme};
use shadowfit::{Cascades, FitError, FitInput, FitState, LightProjection, Scratch};

use crate::support::{DIRECTION, any_camera, any_direction, camera, cases, every_stabilise, float, sliced};

/// Grazing light, under which a map is far longer than wide.
const GRAZING: Vec3 = Vec3::new(0.3, -0.05, 0.9);

const RECTANGLES: [RectangleKind; 3] =
    [RectangleKind::AxisAligned, RectangleKind::MinimumArea, RectangleKind::MinimumSquare];

fn ratio(fit: &LightProjection) -> f32 {
    fit.texel_size.max_element() / fit.texel_size.min_element()
}

fn area(fit: &LightProjection) -> f32 {
    fit.texel_size.element_product()
}

fn fitted(settings: &FitSettings, direction: Vec3) -> LightProjection {
    shadowfit::fit(&camera().frustum().unwrap(), direction, settings).unwrap()
}

#[test]
fn a_limit_that_is_met_anyway_changes_nothing() {
    for rectangle in RECTANGLES {
        let plain = FitSettings::default().with_rectangle(rectangle);
        let free = fitted(&plain, DIRECTION);
        assert_eq!(fitted(&plain.with_max_texel_ratio(ratio(&free) * 1.01), DIRECTION), free, "{rectangle:?}");
    }
}

#[test]
fn long_texels_are_made_as_wide_as_the_limit_says_by_the_least_area() {
    let plain = FitSettings::default().with_kind(FitKind::Oriented);
    let free = fitted(&plain, GRAZING);
    assert!(ratio(&free) > 1.5, "{}", ratio(&free));
    let limited = fitted(&plain.with_max_texel_ratio(1.2), GRAZING);
    assert!(ratio(&limited) <= 1.2 * (1.0 + 1e-5), "{}", ratio(&limited));
    // No more area than the free rectangle has when it is widened.
    assert!(area(&limited) <= area(&free) * ratio(&free) / 1.2 * (1.0 + 1e-4));
    let square = fitted(&plain.with_rectangle(RectangleKind::MinimumSquare), GRAZING);
    let one = fitted(&plain.with_max_texel_ratio(1.0), GRAZING);
    assert!((area(&one) / area(&square) - 1.0).abs() < 1e-4, "a limit of one is the least square");
}

#[test]
fn what_is_no_limit_is_refused() {
    for bad in [f32::NAN, f32::INFINITY, 0.99, 0.0, -1.0] {
        let settings = FitSettings::default().with_max_texel_ratio(bad);
        let error = shadowfit::fit(&camera().frustum().unwrap(), DIRECTION, &settings).unwrap_err();
        assert!(matches!(error, FitError::NotFinite { .. } | FitError::OutOfRange { .. }), "{bad}: {error}");
        assert!(error.to_string().contains("greatest texel ratio"), "{error}");
    }
}

proptest! {
    #![proptest_config(cases(200))]

    /// This includes snapped and held maps, whose texels are quantised separately.
    #[test]
    fn no_map_has_longer_texels_than_the_limit(
        camera in any_camera(), direction in any_direction(), limit in float(1.0, 4.0), turn in float(-0.05, 0.05),
        (kind, stabilise, rectangle, tall) in (0..4_usize, 0..3_usize, 0..3_usize, any::<bool>()),
    ) {
        let kind = [FitKind::FrustumAabb, FitKind::Oriented, FitKind::Sphere, FitKind::Focused][kind];
        let stabilise = every_stabilise()[stabilise];
        let resolution = if tall { UVec2::new(512, 1024) } else { UVec2::splat(1024) };
        let fit = FitSettings::default().with_kind(kind).with_rectangle(RECTANGLES[rectangle]);
        let fit = fit.with_resolution(resolution).with_max_texel_ratio(limit);
        let technique = sliced(&fit, Cascades { splits: SplitScheme::Logarithmic, stabilise, ..Cascades::default() });
        let mut storage = [DVec2::ZERO; Scratch::required(0, 3)];
        let mut fitter = FitState::new();
        let mut camera = camera;
        for _ in 0..3 {
            let Ok(view) = camera.frustum() else { return Ok(()) };
            let views = [view];
            let input = FitInput::new(&views, direction);
            let Ok(maps) = fitter.fit(&input, &technique, &mut Scratch::new(&mut storage)) else { return Ok(()) };
            for map in maps.iter() {
                prop_assert!(ratio(&map.projection) <= limit * (1.0 + 1e-5), "{} of {limit}", ratio(&map.projection));
                let query = CoverageQuery::of_map(map, &technique, technique.filter_radius_in(&map.projection));
                let proof = prove(&input, &map.projection, &query, &mut Scratch::new(&mut storage)).unwrap();
                prop_assert!(proof.is_proven(), "{proof:?}");
            }
            camera.forward += Vec3::new(turn, -turn, turn) * camera.forward.length();
        }
    }
}
