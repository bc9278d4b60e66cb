//! Maps that a shadow map refuses, because they would silently give a wrong image. Each error contains the
//! index and the value, and a refusal changes no state.

use shadowfit::glam::{DVec2, DVec3, UVec2, Vec3};
use shadowfit::selection::DepthRange;
use shadowfit::settings::{Edges, MapSelection, SplitScheme};
use shadowfit::{
    Bias, FitError, FitInput, FitState, FittedMap, LightProjection, PerspectiveCamera, Scratch, Technique,
};
use shadowfit_wgpu::{MapView, ShadowMap, ShadowMapDescriptor, ShadowMapError};

use super::engine::Engine;
use super::exact_counts_gpu::box_fit;

/// Layers of the shadow map.
const LAYERS: u32 = 3;

fn fit() -> LightProjection {
    box_fit(shadowfit::DepthConvention::ZeroToOne)
}

/// Returns maps that end at the given view depths.
fn maps(far: &[f32]) -> Vec<FittedMap> {
    let depths = |far: &f32| DepthRange::new(0.0, Some((*far).into()));
    far.iter().map(|far| FittedMap::new(fit(), Bias::default()).with_depths(depths(far))).collect()
}

fn descriptor(selection: MapSelection) -> ShadowMapDescriptor {
    ShadowMapDescriptor { maps: LAYERS, resolution: [256; 2], selection, ..ShadowMapDescriptor::default() }
}

/// Prepares a shadow map with maps for a view along `forward`.
fn prepared(maps: &[FittedMap], forward: Vec3) -> Result<usize, ShadowMapError> {
    let gpu = Engine::shared();
    let mut map = ShadowMap::new(&gpu.device, &descriptor(MapSelection::ViewDepth { overlap: 0.0 }))
        .expect("a possible shadow map");
    map.prepare(&gpu.queue, &MapView::from_eye(DVec3::ZERO, forward), maps)?;
    Ok(map.volumes().len())
}

#[test]
fn more_fits_than_layers_are_an_error() {
    let too_many = prepared(&maps(&[1.0, 2.0, 3.0, 4.0]), Vec3::NEG_Z);
    assert_eq!(too_many, Err(ShadowMapError::TooManyFits { fits: 4, layers: 3 }));
    for count in 0..=3 {
        assert_eq!(prepared(&maps(&[1.0, 2.0, 3.0][..count]), Vec3::NEG_Z), Ok(count), "{count} fits");
    }
}

#[test]
fn a_forward_direction_that_is_not_of_unit_length_is_an_error() {
    for (forward, length) in [(Vec3::new(0.12, -0.26, -1.0), 1.0402), (Vec3::ZERO, 0.0), (Vec3::X * 0.998, 0.998)] {
        match prepared(&maps(&[1.0]), forward) {
            Err(ShadowMapError::Forward { forward: told, length: is }) => {
                assert_eq!(told, forward);
                assert!((is - length).abs() < 1e-4, "{is}");
            }
            other => panic!("{forward}: {other:?}"),
        }
    }
    for forward in [Vec3::NAN, Vec3::INFINITY] {
        assert!(matches!(prepared(&maps(&[1.0]), forward), Err(ShadowMapError::Forward { .. })), "{forward}");
    }
    for length in [1.0, 1.0 - 0.9e-3, 1.0 + 0.9e-3] {
        assert_eq!(prepared(&maps(&[1.0]), Vec3::new(0.6, 0.0, -0.8) * length), Ok(1), "{length}");
    }
    assert_eq!(prepared(&[], Vec3::NAN), Ok(0), "without maps the direction is not used");
}

#[test]
fn a_bias_that_is_nan_or_infinite_is_an_error_with_its_map() {
    let fields: [fn(&mut Bias) -> &mut f32; 4] = [
        |bias| &mut bias.constant_depth,
        |bias| &mut bias.slope_depth,
        |bias| &mut bias.normal_offset,
        |bias| &mut bias.receiver_plane,
    ];
    for field in fields {
        for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let mut maps = maps(&[1.0, 2.0, 3.0]);
            *field(&mut maps[1].bias) = value;
            match prepared(&maps, Vec3::NEG_Z) {
                Err(ShadowMapError::Bias { index: 1, error: FitError::NotFinite { value: told, .. } }) => {
                    assert_eq!(told.to_string(), f64::from(value).to_string());
                }
                other => panic!("{value}: {other:?}"),
            }
        }
    }
}

#[test]
fn maps_out_of_order_are_an_error_and_those_without_a_range_are_not() {
    for (far, index) in [
        (&[2.0, 1.0][..], 1),
        (&[1.0, f32::MAX, 3.0], 2),
        (&[1.0, f32::NAN, 3.0], 1),
        (&[f32::NAN], 0),
        (&[3.0, f32::MIN], 1),
    ] {
        match prepared(&maps(far), Vec3::NEG_Z) {
            Err(ShadowMapError::Order { index: told, far: value, previous }) => {
                assert_eq!((told, value.to_bits()), (index, far[index].to_bits()), "{far:?}");
                assert_eq!(previous, if index == 0 { f32::MIN } else { far[index - 1] }, "{far:?}");
            }
            other => panic!("{far:?}: {other:?}"),
        }
    }
    for far in [&[1.0, 1.0, 2.0][..], &[f32::MIN, f32::MIN, 5.0], &[5.0, f32::MAX, f32::MAX], &[-2.0, 3.0]] {
        assert_eq!(prepared(&maps(far), Vec3::NEG_Z), Ok(far.len()), "{far:?}");
    }
}

#[test]
fn maps_that_are_read_by_coverage_have_no_order() {
    let gpu = Engine::shared();
    let mut map = ShadowMap::new(&gpu.device, &descriptor(MapSelection::default())).expect("a possible shadow map");
    let view = MapView::from_eye(DVec3::ZERO, Vec3::NEG_Z);
    assert_eq!(map.prepare(&gpu.queue, &view, &maps(&[2.0, 1.0, f32::NAN])), Ok(()));
}

#[test]
fn a_blend_that_is_out_of_range_or_no_number_is_an_error() {
    let gpu = Engine::shared();
    for blend in [-0.1, 64.1, f32::NAN, f32::INFINITY] {
        let error = ShadowMap::new(&gpu.device, &descriptor(MapSelection::Coverage { blend })).expect_err("no map");
        assert!(matches!(error, ShadowMapError::Blend(_)) && error.to_string().contains(&blend.to_string()), "{error}");
    }
}

#[test]
fn a_number_of_rays_that_is_out_of_range_is_an_error() {
    let gpu = Engine::shared();
    let traced = |samples| ShadowMapDescriptor { edges: Edges::Traced { samples }, ..ShadowMapDescriptor::default() };
    for samples in [0, Edges::MAX_SAMPLES + 1] {
        let error = ShadowMap::new(&gpu.device, &traced(samples)).expect_err("no map");
        assert_eq!(error, ShadowMapError::Samples(samples));
        assert!(error.to_string().contains(&samples.to_string()), "{error}");
    }
    assert!(ShadowMap::new(&gpu.device, &traced(Edges::MAX_SAMPLES)).is_ok());
}

#[test]
fn maps_of_the_core_are_in_order_where_some_of_them_have_no_range() {
    let view = [PerspectiveCamera {
        eye: DVec3::ZERO,
        forward: Vec3::NEG_Z,
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: 1.6,
        near: 0.1,
        far: 30.0,
    }
    .frustum()
    .expect("a camera")];
    for ends in [[10.0, 50.0], [-5.0, 10.0], [40.0, 50.0], [-5.0, -1.0]] {
        let mut manual = [100.0; 7];
        manual[..2].copy_from_slice(&ends);
        let cascades = Technique::preset("calm-4").expect("a preset");
        let mut settings =
            cascades.with_maps(cascades.maps.as_cascades().with_count(LAYERS).with_splits(SplitScheme::Manual(manual)));
        settings.fit.resolution = UVec2::splat(256);
        let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
        let input = FitInput::new(&view, Vec3::new(0.3, -0.8, 0.2));
        let fitted = FitState::new().fit(&input, &settings, &mut Scratch::new(&mut storage)).expect("maps");
        let maps: Vec<FittedMap> = fitted.to_vec();
        assert_eq!(prepared(&maps, Vec3::NEG_Z), Ok(3), "{ends:?}");
    }
}

#[test]
fn a_refused_frame_leaves_the_volumes_of_the_last_one() {
    let gpu = Engine::shared();
    let mut map = ShadowMap::new(&gpu.device, &descriptor(MapSelection::ViewDepth { overlap: 0.0 }))
        .expect("a possible shadow map");
    let view = MapView::from_eye(DVec3::ZERO, Vec3::NEG_Z);
    map.prepare(&gpu.queue, &view, &maps(&[1.0, 2.0])).expect("good maps");
    let before = map.volumes().to_vec();
    assert!(map.prepare(&gpu.queue, &view, &maps(&[3.0, 2.0, 1.0])).is_err());
    assert_eq!(map.volumes(), before);
}

#[test]
fn every_refusal_says_what_and_which() {
    let fit = ShadowMapError::TooManyFits { fits: 4, layers: 1 }.to_string();
    assert!(fit.contains("given: 4") && fit.contains("shadow map: 1"), "{fit}");
    let order = ShadowMapError::Order { index: 2, far: 3.0, previous: 7.5 }.to_string();
    assert!(order.contains("map 2") && order.contains("3 m") && order.contains("7.5 m"), "{order}");
    let bias = Bias { normal_offset: f32::NAN, ..Bias::default() }.checked().expect_err("NaN");
    let bias = ShadowMapError::Bias { index: 1, error: bias }.to_string();
    assert!(bias.contains("map 1") && bias.contains("normal offset") && bias.contains("NaN"), "{bias}");
    let forward = ShadowMapError::Forward { forward: Vec3::X * 2.0, length: 2.0 }.to_string();
    assert!(forward.contains("[2, 0, 0]") && forward.contains("length 2"), "{forward}");
}
