//! Rejected values, and settings that are out of range.

use shadowfit::Maps;
use shadowfit::glam::{UVec2, Vec3};
use shadowfit::settings::SplitScheme;
use shadowfit_params::tool::Settings;
use shadowfit_params::{self as params, Kind, Number, PARAMETERS, Value, set_from_str};

use crate::{SLICES, change, row, settings_with, starts, with, written};

#[test]
fn numbers_clamp_and_ignore_what_is_not_finite() {
    for parameter in PARAMETERS {
        let start = settings_with(parameter);
        let Kind::Number(Number { min, max, .. }) = parameter.kind else { continue };
        let set = |value: f64| {
            let mut settings = start;
            parameter.set(&mut settings, Value::Number(value));
            settings
        };
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(set(value), start, "{} took {value}", parameter.id);
        }
        for (value, bound) in [(-1e30, min), (1e30, max)] {
            let read = parameter.number(&set(value)).expect("a number");
            // f32 and the conversion to radians round the bound.
            assert!((read - bound).abs() <= 1e-6 * bound.abs(), "{} = {read}", parameter.id);
        }
    }
}

#[test]
fn a_row_that_does_not_exist_is_written_as_nothing_and_ignores_what_it_is_given() {
    for parameter in PARAMETERS {
        for start in starts().into_iter().filter(|start| !parameter.is_present(start)) {
            let mut settings = start;
            change(&mut settings, parameter);
            parameter.copy(&mut settings, &settings_with(parameter));
            assert_eq!((settings, written(&start, parameter)), (start, String::new()), "{}", parameter.id);
            assert!((parameter.inert)(&start).is_some(), "{} says why", parameter.id);
        }
    }
}

#[test]
fn broken_settings_are_still_written_and_read() {
    for mut settings in starts() {
        settings.camera.near = f32::NAN;
        settings.camera.far = f32::INFINITY;
        settings.light.azimuth = f32::NEG_INFINITY;
        settings.light.elevation = f32::MAX;
        let technique = &mut settings.technique;
        technique.maps = technique.maps.with_count(u32::MAX);
        technique.fit.resolution = UVec2::new(0, 3);
        technique.fit.max_distance = -0.0;
        technique.fit.border = Some(f32::NAN);
        technique.fit.up = Vec3::INFINITY;
        if let Maps::Cascades(cascades) = &mut technique.maps {
            match &mut cascades.splits {
                SplitScheme::Practical(lambda) => *lambda = f32::NAN,
                SplitScheme::Manual(ends) => ends[0] = f32::INFINITY,
                _ => {}
            }
        }
        for parameter in PARAMETERS {
            let is_written = !written(&settings, parameter).is_empty();
            assert_eq!(is_written, parameter.is_present(&settings), "{}", parameter.id);
            change(&mut settings, parameter);
        }
        for parameter in PARAMETERS {
            parameter.copy(&mut settings, &Settings::default());
        }
        assert_eq!(settings, Settings::default());
    }
}

#[test]
fn errors_name_the_id_the_value_and_what_is_allowed() {
    for (id, value, words) in [
        ("bias.nrmal", "1", &["bias.nrmal", "bias.normal_offset", "view.play"][..]),
        ("bias.slope", "steep", &["bias.slope", "steep", "0 to 16 texels"]),
        ("bias.slope", "17", &["bias.slope", "17", "0 to 16 texels"]),
        ("bias.slope", "NaN", &["bias.slope", "NaN", "0 to 16 texels"]),
        ("bias.slope", "inf", &["bias.slope", "inf", "0 to 16 texels"]),
        ("bias.slope", "", &["bias.slope", "\"\"", "0 to 16 texels"]),
        ("map.resolution", "20", &["map.resolution", "20", "256 to 8192 texels"]),
        ("map.resolution", "2000.5", &["map.resolution", "2000.5", "a whole number", "256 to 8192 texels"]),
        ("splits.count", "9", &["splits.count", "9", "a whole number from 1 to 8"]),
        ("fit.border", "wide", &["fit.border", "wide", "0 to 32 texels, or auto"]),
        ("fit.max_distance", "0", &["fit.max_distance", "0", "1 to 100000 m, or far_plane"]),
        ("fit.casters", "some", &["fit.casters", "some", "list, extend, scene_bounds, depth_clamp, none"]),
        ("splits.lambda", "2", &["splits.lambda", "2", "0 to 1"]),
        ("view.play", "maybe", &["view.play", "maybe", "true or false"]),
    ] {
        let mut settings = Settings::default();
        let message = set_from_str(&mut settings, id, value).expect_err(value).to_string();
        for word in words {
            assert!(message.contains(word), "{message:?} lacks {word:?}");
        }
        assert_eq!(settings, Settings::default());
    }
}

#[test]
fn setting_a_row_that_does_not_exist_is_an_error_that_names_what_to_set_first() {
    for (id, value, first, option) in [
        ("splits.lambda", "0.3", "splits.scheme", "practical"),
        ("softness.metres", "0.3", "softness.measure", "metres"),
        ("view.inset_white", "0.5", "view.inset_black", "0.25"),
        ("splits.manual_1", "3", "splits.scheme", "manual"),
        ("splits.manual_7", "300", "splits.scheme", "manual"),
    ] {
        let cascades = with(&[SLICES]);
        let mut settings = cascades;
        let error = set_from_str(&mut settings, id, value).expect_err(id);
        assert!(
            matches!(error, params::ParameterError::Rejected { reason: params::RejectionReason::NotPresent(_), .. }),
            "{error:?}"
        );
        assert!(error.to_string().contains(id) && error.to_string().contains(first), "{error}");
        assert_eq!(settings, cascades);
        set_from_str(&mut settings, first, option).expect(first);
        set_from_str(&mut settings, id, value).expect(id);
        assert_eq!(written(&settings, row(id)), value, "{id}");
    }
}
