//! Values as text are read back to the bit.

use proptest::prelude::*;
use shadowfit::{PRESETS, Technique};
use shadowfit_params::tool::Settings;
use shadowfit_params::{
    Kind, Number, PARAMETERS, Parameter, Value, set_from_str, set_technique_from_str, technique_parameters,
};

use crate::{SLICES, change, row, settings_with, starts, with, written};

#[test]
fn values_survive_text_to_the_bit() {
    for parameter in PARAMETERS {
        for share in [0.0, 0.001, 1.0 / 3.0, 0.5, 0.77, 1.0] {
            let mut settings = settings_with(parameter);
            match &parameter.kind {
                Kind::Number(number) => {
                    parameter.set(&mut settings, Value::Number(number.min + share * (number.max - number.min)));
                }
                Kind::Choice(_) | Kind::Toggle => change(&mut settings, parameter),
            }
            survives_text(&settings, parameter);
            if let Kind::Number(Number { unset: Some(_), .. }) = &parameter.kind {
                survives_text(&settings_with(parameter), parameter);
            }
        }
    }
}

/// Checks that a row's text is read back as the same value.
fn survives_text(settings: &Settings, parameter: &Parameter) {
    let text = written(settings, parameter);
    let mut restored = *settings;
    change(&mut restored, parameter);
    set_from_str(&mut restored, parameter.id, &text).expect("what was written is read");
    assert!(parameter.is_equal(&restored, settings), "{} = {text}", parameter.id);
}

#[test]
fn all_defaults_survive_text_in_any_order() {
    let defaults = Settings::default();
    for start in starts() {
        let mut forward = start;
        for parameter in PARAMETERS {
            change(&mut forward, parameter);
        }
        let mut backward = forward;
        let there = || PARAMETERS.iter().filter(|parameter| parameter.is_present(&defaults));
        for parameter in there() {
            set_from_str(&mut forward, parameter.id, &written(&defaults, parameter)).expect(parameter.id);
        }
        let set = |settings: &mut Settings, parameter: &'static Parameter| {
            set_from_str(settings, parameter.id, &written(&defaults, parameter)).map_err(|error| error.to_string())
        };
        // A row that only exists after another one is set waits for it.
        let waiting: Vec<_> = there().rev().filter(|parameter| set(&mut backward, parameter).is_err()).collect();
        for parameter in waiting {
            set(&mut backward, parameter).expect(parameter.id);
        }
        assert_eq!((forward, backward), (defaults, defaults));
    }
}

/// Returns the default technique after reading the rows of another one, written in table order.
fn restored(technique: &Technique) -> Technique {
    let settings = Settings::default().with_technique(*technique);
    let mut restored = Technique::default();
    for parameter in technique_parameters().filter(|parameter| parameter.is_present(&settings)) {
        set_technique_from_str(&mut restored, parameter.id, &written(&settings, parameter)).expect(parameter.id);
    }
    restored
}

/// Returns a technique with values given as numbers, 0..=1, one for each row.
fn technique_by(shares: &[f64]) -> Technique {
    let mut settings = Settings::default();
    for (parameter, share) in technique_parameters().zip(shares) {
        let value = match &parameter.kind {
            Kind::Number(Number { unset: Some(_), .. }) if *share < 0.3 => Value::Unset,
            // Many relevant values are small.
            Kind::Number(Number { min, max, .. }) => Value::Number(min + share.powi(4) * (max - min)),
            Kind::Choice(options) => Value::Option(((share * options.len() as f64) as usize).min(options.len() - 1)),
            Kind::Toggle => Value::Toggle(*share < 0.5),
        };
        parameter.set(&mut settings, value);
    }
    settings.technique
}

proptest! {
    /// Saved files rely on this.
    #[test]
    fn rows_written_in_order_restore_any_technique(
        shares in prop::collection::vec(0.0..=1.0_f64, technique_parameters().count())
    ) {
        let technique = technique_by(&shares);
        prop_assert_eq!(restored(&technique), technique);
    }
}

#[test]
fn rows_written_in_order_restore_every_preset() {
    for preset in &PRESETS {
        assert_eq!(restored(&preset.technique()), preset.technique(), "{}", preset.name);
    }
}

#[test]
fn numbers_are_written_short() {
    let mut settings = with(&[SLICES, ("splits.scheme", "practical")]);
    settings.light.elevation = 30_f32.to_radians();
    settings.light.azimuth = core::f32::consts::TAU;
    for (id, text) in [
        ("light.elevation", "30"),
        ("light.azimuth", "360"),
        ("camera.fov_y", "45"),
        ("camera.near", "0.1"),
        ("fit.max_distance", "far_plane"),
        ("fit.border", "auto"),
        ("fit.max_texel_ratio", "none"),
        ("fit.up_y", "1"),
        ("splits.count", "4"),
        ("splits.lambda", "0.5"),
        ("splits.manual_1", ""),
        ("stabilise.max_oversize", "1.8"),
        ("map.resolution", "2048"),
        ("map.height", "square"),
        ("view.inset", "one"),
        ("view.play", "true"),
        ("view.mode", "final"),
        ("light.hour", "by_angles"),
    ] {
        assert_eq!(written(&settings, row(id)), text, "{id}");
    }
}

#[test]
fn values_may_be_surrounded_by_spaces() {
    let settings = with(&[("view.play", " off "), ("camera.speed", "\t12.5\n"), ("fit.border", " auto")]);
    assert!(!settings.view.play && settings.camera.speed == 12.5);
}
