//! NaN, infinity, zero, subnormal and huge values in every float input of the biases, the diagnostics and the
//! light steps: an error or a finite result, never a panic.

use proptest::prelude::*;
use shadowfit::bias::{FilterRadius, acos_bias, depth_gradient, normal_offset, receiver_plane_depth};
use shadowfit::diagnostics::{DepthStorage, acne_margin, coverage, depth_step_at, share_of_map};
use shadowfit::glam::{DVec3, Vec2, Vec3};
use shadowfit::light_steps::{LightStepState, LightSteps};
use shadowfit::settings::{BiasSettings, FitKind, MapFormat};
use shadowfit::{Bias, FitError, LightProjection};

use crate::support::{DIRECTION, camera, cases, exact, fitted};

const NOT_FINITE: [f32; 3] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];

const ODD: [f32; 12] =
    [0.0, -0.0, 1e-45, -1e-45, f32::MIN_POSITIVE, 1e-20, -1e-20, 1e20, -1e20, 1.0e18, f32::MAX, f32::MIN];

/// All inputs of these functions, with valid values.
#[derive(Clone, Copy)]
struct Inputs {
    normal: Vec3,
    point: DVec3,
    reach: FilterRadius,
    bias: Bias,
    fixed: f32,
    epsilon: f32,
    cosine: f32,
    depth: f32,
    range: f32,
    direction: Vec3,
    steps: LightSteps,
    seconds: f32,
}

/// A float input with its name.
type Setter = (&'static str, fn(&mut Inputs, f32));

const SETTERS: [Setter; 29] = [
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
    ("bias.slope_depth", |i, v| i.bias.slope_depth = v),
    ("bias.normal_offset", |i, v| i.bias.normal_offset = v),
    ("bias.receiver_plane", |i, v| i.bias.receiver_plane = v),
    ("fixed bias", |i, v| i.fixed = v),
    ("epsilon", |i, v| i.epsilon = v),
    ("cosine", |i, v| i.cosine = v),
    ("depth", |i, v| i.depth = v),
    ("depth range", |i, v| i.range = v),
    ("direction.x", |i, v| i.direction.x = v),
    ("direction.y", |i, v| i.direction.y = v),
    ("direction.z", |i, v| i.direction.z = v),
    ("steps.texels", |i, v| i.steps.texels = v),
    ("steps.extent", |i, v| i.steps.extent = v),
    ("steps.fade", |i, v| i.steps.fade = v),
    ("seconds", |i, v| i.seconds = v),
    // The same inputs where another call reads them.
    ("normal", |i, v| i.normal = Vec3::splat(v)),
    ("point", |i, v| i.point = DVec3::splat(f64::from(v))),
    ("direction", |i, v| i.direction = Vec3::splat(v)),
    ("reach", |i, v| i.reach = FilterRadius { taps: v, disc: Vec2::splat(v) }),
];

fn good() -> Inputs {
    Inputs {
        normal: Vec3::new(0.2, 0.9, -0.1),
        point: camera().eye + camera().forward.as_dvec3() * 10.0,
        reach: FilterRadius::HARDWARE_2X2.over_disc(2.0),
        bias: Bias { constant_depth: 0.001, slope_depth: 0.001, normal_offset: 0.01, receiver_plane: 1.0 },
        fixed: 0.001,
        epsilon: 0.001,
        cosine: 0.5,
        depth: 0.5,
        range: 100.0,
        direction: DIRECTION,
        steps: LightSteps::default(),
        seconds: 0.016,
    }
}

/// Calls all functions. Returns all resulting numbers, or the first error.
fn figures(fit: &LightProjection, i: &Inputs) -> Result<Vec<f32>, FitError> {
    let point = (i.point - fit.origin).as_vec3();
    let on_plane = i.bias.on_plane(fit, i.normal)?;
    let automatic = Bias::automatic(i.reach, DepthStorage::Unorm16, fit)?;
    let receiver_plane = Bias::automatic_receiver_plane(i.reach, DepthStorage::Float16, fit)?;
    let margin = acne_margin(fit, &i.bias, i.reach, DepthStorage::Float32, i.point, i.normal)?;
    coverage(fit, i.reach, i.point)?;
    let mut light = LightStepState::default();
    light.update(DIRECTION, &i.steps, i.seconds)?;
    let step = light.update(i.direction, &i.steps, i.seconds)?;
    let step = light.update(-i.direction, &i.steps, i.seconds).map(|next| [step.blend, next.blend])?;
    let mut all = vec![
        normal_offset(fit, i.reach, i.normal)?,
        receiver_plane_depth(fit, i.reach, i.normal)?,
        depth_gradient(fit, i.normal)?.abs().max_element(),
        acos_bias(i.epsilon, i.cosine)?,
        Bias::fixed(i.fixed)?.constant_depth,
        depth_step_at(DepthStorage::Float16, i.range, i.depth)?,
        share_of_map(fit, &[point, Vec3::ZERO, Vec3::X])?,
        light.held.map_or(0.0, Vec3::length),
    ];
    all.extend([on_plane.offset, on_plane.depth, automatic.normal_offset, automatic.constant_depth]);
    all.extend([receiver_plane.receiver_plane, step[0], step[1]]);
    all.extend(margin.map_or([0.0; 2], |margin| [margin.metres, margin.texels]));
    Ok(all)
}

fn fit() -> LightProjection {
    fitted(&camera(), DIRECTION, &exact(FitKind::FrustumAabb))
}

#[test]
fn nan_and_infinity_in_each_float_input_are_refused_as_not_finite() {
    assert!(figures(&fit(), &good()).unwrap().iter().all(|figure| figure.is_finite()));
    for (name, set) in SETTERS {
        for value in NOT_FINITE {
            let mut inputs = good();
            set(&mut inputs, value);
            let result = figures(&fit(), &inputs);
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
            if let Ok(figures) = figures(&fit(), &inputs) {
                assert!(figures.iter().all(|figure| figure.is_finite()), "{name} = {value:e}: {figures:?}");
            }
        }
    }
}

#[test]
fn values_without_meaning_are_refused() {
    let table: [(&str, &[f32]); 13] = [
        ("normal", &[0.0, 1e-45, 1e-20, 1e20]),
        ("direction", &[0.0, 1e-45, 1e-20, 1e20]),
        ("point", &[1e20, f32::MAX]),
        ("reach.taps", &[-1e-20, -1.0, 1e20]),
        ("reach.disc.x", &[-1e-20, -1.0, 1e20]),
        ("fixed bias", &[1.1, -1.1, f32::MAX]),
        ("epsilon", &[-1e-20, f32::MAX]),
        ("depth", &[-1e-45, 1.1, f32::MAX]),
        ("depth range", &[0.0, -1.0, 1e-45, f32::MAX]),
        ("steps.texels", &[-1e-45, f32::MAX]),
        ("steps.extent", &[0.0, 0.5, -1.0, f32::MAX]),
        ("steps.fade", &[-1e-45, f32::MAX]),
        ("seconds", &[-1e-45, f32::MAX]),
    ];
    for (name, values) in table {
        let (_, set) = SETTERS.into_iter().find(|(n, _)| *n == name).unwrap();
        for value in values {
            let mut inputs = good();
            set(&mut inputs, *value);
            assert!(figures(&fit(), &inputs).is_err(), "{name} = {value:e}");
        }
    }
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
    for set in sets {
        let bias = |value| Bias::from_texels(&set(BiasSettings::default(), value), MapFormat::Depth16Unorm, &fit());
        for value in NOT_FINITE {
            assert!(matches!(bias(value).checked(), Err(FitError::NotFinite { .. })), "{value}");
        }
        for value in ODD {
            let made = bias(value);
            assert!(made.checked().is_err() || made.on_plane(&fit(), Vec3::Y).is_ok_and(|b| b.depth.is_finite()));
        }
        assert_eq!(bias(1.0).checked(), Ok(bias(1.0)));
    }
}

#[test]
fn a_fit_filled_with_bad_numbers_by_hand_gives_an_error_or_finite_figures() {
    let sets: [fn(&mut LightProjection, f32); 5] = [
        |fit, v| fit.texel_size = Vec2::splat(v),
        |fit, v| fit.depth_range = v,
        |fit, v| fit.light_from_world.x_axis.y = v,
        |fit, v| fit.uv_from_world.y_axis.x = v,
        |fit, v| fit.box_max.x = v,
    ];
    for set in sets {
        for value in NOT_FINITE.into_iter().chain(ODD) {
            let mut bad = fit();
            set(&mut bad, value);
            if let Ok(figures) = figures(&bad, &good()) {
                assert!(figures.iter().all(|figure| figure.is_finite()), "{value:e}: {figures:?}");
            }
            let _ = LightSteps { extent: LightSteps::extent_of(&bad), ..Default::default() }.angle();
        }
    }
}

proptest! {
    #![proptest_config(cases(2000))]

    #[test]
    fn no_bit_pattern_panics_and_every_figure_is_finite(bits in prop::array::uniform29(any::<u32>()), replaced in any::<u32>()) {
        let mut inputs = good();
        for (i, (_, set)) in SETTERS.into_iter().enumerate() {
            if replaced & (1 << i) != 0 {
                set(&mut inputs, f32::from_bits(bits[i]));
            }
        }
        if let Ok(figures) = figures(&fit(), &inputs) {
            prop_assert!(figures.iter().all(|figure| figure.is_finite()), "{figures:?}");
        }
    }
}
