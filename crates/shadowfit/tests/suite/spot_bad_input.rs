//! NaN, infinity, zero, subnormal and huge values in every float input of spot lights: an error with the
//! value or a finite result, never a panic.

use proptest::prelude::*;
use shadowfit::bias::FilterRadius;
use shadowfit::diagnostics::DepthStorage;
use shadowfit::glam::{DVec3, UVec2, Vec2, Vec3};
use shadowfit::settings::{BiasSettings, MapFormat};
use shadowfit::spot::{SpotBias, SpotFit, SpotLight};
use shadowfit::spot::{depth_gradient, normal_offset, on_hardware, receiver_plane_depth};
use shadowfit::{DepthConvention, FitError};

use crate::spot::{in_window, lamp};
use crate::support::cases;

const NOT_FINITE: [f32; 3] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];

const ODD: [f32; 12] =
    [0.0, -0.0, 1e-45, -1e-45, f32::MIN_POSITIVE, 1e-20, -1e-20, 1e20, -1e20, 1.0e18, f32::MAX, f32::MIN];

/// All inputs, with valid values.
#[derive(Clone, Copy)]
struct Inputs {
    lamp: SpotLight,
    normal: Vec3,
    point: DVec3,
    reach: FilterRadius,
    bias: SpotBias,
    fixed: f32,
}

/// A float input with its name.
type Setter = (&'static str, fn(&mut Inputs, f32));

const SETTERS: [Setter; 29] = [
    ("position.x", |i, v| i.lamp.position.x = f64::from(v)),
    ("position.y", |i, v| i.lamp.position.y = f64::from(v)),
    ("position.z", |i, v| i.lamp.position.z = f64::from(v)),
    ("direction.x", |i, v| i.lamp.direction.x = v),
    ("direction.y", |i, v| i.lamp.direction.y = v),
    ("direction.z", |i, v| i.lamp.direction.z = v),
    ("up.x", |i, v| i.lamp.up.x = v),
    ("up.y", |i, v| i.lamp.up.y = v),
    ("up.z", |i, v| i.lamp.up.z = v),
    ("fov_y", |i, v| i.lamp.fov_y = v),
    ("aspect", |i, v| i.lamp.aspect = v),
    ("near", |i, v| i.lamp.near = v),
    ("far", |i, v| i.lamp.far = v),
    ("normal.x", |i, v| i.normal.x = v),
    ("normal.y", |i, v| i.normal.y = v),
    ("normal.z", |i, v| i.normal.z = v),
    ("point.x", |i, v| i.point.x = f64::from(v)),
    ("point.y", |i, v| i.point.y = f64::from(v)),
    ("point.z", |i, v| i.point.z = f64::from(v)),
    ("reach.taps", |i, v| i.reach.taps = v),
    ("reach.disc.x", |i, v| i.reach.disc.x = v),
    ("reach.disc.y", |i, v| i.reach.disc.y = v),
    ("bias.constant_depth", |i, v| i.bias.constant_depth = v),
    ("bias.distance_depth", |i, v| i.bias.distance_depth = v),
    ("bias.slope_depth", |i, v| i.bias.slope_depth = v),
    ("bias.normal_offset", |i, v| i.bias.normal_offset = v),
    ("bias.constant_offset", |i, v| i.bias.constant_offset = v),
    ("bias.receiver_plane", |i, v| i.bias.receiver_plane = v),
    ("fixed bias", |i, v| i.fixed = v),
];

fn good() -> Inputs {
    Inputs {
        lamp: lamp(),
        normal: Vec3::new(0.2, 0.9, -0.1),
        point: in_window(&lamp(), 0.2, 0.3, 8.0),
        reach: FilterRadius::HARDWARE_2X2.over_disc(2.0),
        bias: SpotBias {
            constant_depth: 0.001,
            distance_depth: 0.001,
            slope_depth: 0.001,
            normal_offset: 0.001,
            constant_offset: 0.001,
            receiver_plane: 1.0,
        },
        fixed: 0.001,
    }
}

/// Calls all functions. Returns all resulting numbers, or the first error.
fn figures(inputs: &Inputs) -> Result<Vec<f32>, FitError> {
    let fit = inputs.lamp.fit(UVec2::new(512, 300), DepthConvention::ZeroToOne)?;
    let frustum = inputs.lamp.frustum()?;
    let mut all = figures_of(&fit, inputs)?;
    all.extend(frustum.corners.iter().flat_map(Vec3::to_array));
    for matrix in [fit.light_from_world, fit.clip_from_light, fit.clip_from_world, fit.uv_from_world] {
        all.extend(matrix.to_cols_array());
    }
    Ok(all)
}

fn figures_of(fit: &SpotFit, i: &Inputs) -> Result<Vec<f32>, FitError> {
    let on_plane = i.bias.on_plane(fit, i.point, i.normal)?;
    let automatic = SpotBias::automatic(i.reach, DepthStorage::Unorm16, fit)?;
    let receiver_plane = SpotBias::automatic_receiver_plane(i.reach, DepthStorage::Float16, fit)?;
    Ok(vec![
        on_plane.offset,
        on_plane.depth,
        automatic.normal_offset,
        automatic.constant_depth,
        automatic.distance_depth,
        automatic.constant_offset,
        receiver_plane.receiver_plane,
        on_hardware(fit, i.reach)?.taps,
        normal_offset(fit, i.reach, i.point, i.normal)?,
        receiver_plane_depth(fit, i.reach, i.point, i.normal)?,
        depth_gradient(fit, i.point, i.normal)?.abs().max_element(),
        SpotBias::fixed(i.fixed)?.constant_depth,
    ])
}

#[test]
fn nan_and_infinity_in_each_float_input_are_refused_as_not_finite() {
    assert!(figures(&good()).unwrap().iter().all(|figure| figure.is_finite()));
    for (name, set) in SETTERS {
        for value in NOT_FINITE {
            let mut inputs = good();
            set(&mut inputs, value);
            let result = figures(&inputs);
            assert!(matches!(result, Err(FitError::NotFinite { .. })), "{name} = {value}: {result:?}");
        }
    }
}

#[test]
fn zero_subnormal_and_huge_values_give_an_error_or_a_finite_result() {
    for (name, set) in SETTERS {
        for value in ODD {
            let mut inputs = good();
            set(&mut inputs, value);
            if let Ok(figures) = figures(&inputs) {
                assert!(figures.iter().all(|figure| figure.is_finite()), "{name} = {value:e}: {figures:?}");
            }
        }
    }
}

#[test]
fn lights_without_meaning_are_refused_with_the_value_that_is_wrong() {
    let fit = |change: fn(&mut SpotLight)| {
        let mut lamp = lamp();
        change(&mut lamp);
        let error = lamp.fit(UVec2::splat(64), DepthConvention::ZeroToOne).unwrap_err();
        assert_eq!(lamp.frustum(), Err(error));
        error.to_string()
    };
    for (message, part) in [
        (fit(|l| l.direction = Vec3::ZERO), "the spot light's direction has length 0"),
        (fit(|l| l.up = Vec3::ZERO), "the spot light's up direction has length 0"),
        (fit(|l| l.fov_y = 3.2), "the spot light's fov_y is 3.2; give a value from 1e-18 to 3.14159"),
        (fit(|l| l.fov_y = -0.1), "the spot light's fov_y is -0.1"),
        (fit(|l| l.aspect = 0.0), "the spot light's aspect is 0"),
        (fit(|l| l.near = 0.0), "the spot light's near distance is 0"),
        (fit(|l| l.far = -1.0), "the spot light's far distance is -1"),
        (fit(|l| l.near = 80.0), "near 80 m is not below far 60 m"),
        (fit(|l| l.position.x = 1e20), "the spot light's position is 1e20"),
        (fit(|l| (l.fov_y, l.aspect) = (1e-10, 1e-10)), "half an extent of the spot light's frustum at 1 m is 5e-21"),
    ] {
        assert!(message.starts_with(part), "{message}");
    }
    for resolution in [UVec2::new(0, 64), UVec2::new(64, 0)] {
        assert_eq!(lamp().fit(resolution, DepthConvention::ZeroToOne), Err(FitError::ZeroResolution { resolution }));
    }
    let here = SpotLight::toward(DVec3::ONE, DVec3::ONE, 0.9, 1.0, 0.1, 10.0);
    assert!(matches!(here.fit(UVec2::ONE, DepthConvention::ZeroToOne), Err(FitError::BadDirection { .. })));
}

#[test]
fn points_behind_the_light_and_reaches_wider_than_the_map_are_refused() {
    let fit = lamp().fit(UVec2::splat(64), DepthConvention::ZeroToOne).unwrap();
    let behind = lamp().position - lamp().direction.as_dvec3();
    for error in [
        normal_offset(&fit, 1.0, behind, Vec3::Y).unwrap_err(),
        SpotBias::default().on_plane(&fit, behind, Vec3::Y).unwrap_err(),
        depth_gradient(&fit, behind, Vec3::Y).map(|_| ()).unwrap_err(),
    ] {
        assert!(error.to_string().starts_with("the point's distance along the light's axis is -0.98"), "{error}");
    }
    let wide = SpotBias::automatic(60.0, DepthStorage::Float32, &fit).unwrap_err();
    assert!(wide.to_string().starts_with("the filter's reach at 1 m from the light is"), "{wide}");
    let inside = in_window(&lamp(), 0.0, 0.0, 5.0);
    let past = SpotBias { constant_offset: -60.0, ..SpotBias::default() };
    assert!(past.on_plane(&fit, inside, fit.direction).is_ok(), "away from the light is no error");
    let past = SpotBias { constant_offset: 60.0, ..SpotBias::default() };
    assert!(past.on_plane(&fit, inside, fit.direction).is_err(), "behind the light is one");
}

#[test]
fn bias_settings_that_are_not_finite_are_refused_once_converted() {
    let sets: [fn(BiasSettings, f32) -> BiasSettings; 5] = [
        BiasSettings::with_constant,
        BiasSettings::with_slope,
        BiasSettings::with_normal_offset,
        BiasSettings::with_receiver_plane,
        BiasSettings::with_depth_steps,
    ];
    let fit = lamp().fit(UVec2::splat(64), DepthConvention::ZeroToOne).unwrap();
    for set in sets {
        let bias = |value| SpotBias::from_texels(&set(BiasSettings::default(), value), MapFormat::Depth16Unorm, &fit);
        for value in NOT_FINITE {
            assert!(matches!(bias(value).checked(), Err(FitError::NotFinite { .. })), "{value}");
        }
        assert_eq!(bias(1.0).checked(), Ok(bias(1.0)));
    }
}

#[test]
fn a_map_filled_with_bad_numbers_by_hand_gives_an_error_or_finite_figures() {
    let sets: [fn(&mut SpotFit, f32); 7] = [
        |fit, v| fit.texel_size = Vec2::splat(v),
        |fit, v| fit.near = v,
        |fit, v| fit.far = v,
        |fit, v| fit.light_from_world.x_axis.y = v,
        |fit, v| fit.clip_from_world.x_axis.y = v,
        |fit, v| fit.position.x = f64::from(v),
        |fit, v| fit.origin.x = f64::from(v),
    ];
    for set in sets {
        for value in NOT_FINITE.into_iter().chain(ODD) {
            let mut bad = lamp().fit(UVec2::splat(64), DepthConvention::ZeroToOne).unwrap();
            set(&mut bad, value);
            bad.caster_volume();
            if let Ok(figures) = figures_of(&bad, &good()) {
                assert!(figures.iter().all(|figure| figure.is_finite()), "{value:e}: {figures:?}");
            }
        }
    }
}

proptest! {
    #![proptest_config(cases(2000))]

    #[test]
    fn no_bit_pattern_panics_and_every_figure_is_finite(
        bits in prop::array::uniform32(any::<u32>()), replaced in any::<u32>(),
    ) {
        let mut inputs = good();
        for (i, (_, set)) in SETTERS.into_iter().enumerate() {
            if replaced & (1 << i) != 0 {
                set(&mut inputs, f32::from_bits(bits[i]));
            }
        }
        if let Ok(figures) = figures(&inputs) {
            prop_assert!(figures.iter().all(|figure| figure.is_finite()), "{figures:?}");
        }
    }
}
