//! The parameter table is complete, and safe to use from files and command lines.

use shadowfit_params::tool::Settings;
use shadowfit_params::{self as params, Kind, Number, Parameter, Value, format_value, set_from_str};

mod effects;
mod errors;
mod table;
mod text;

fn written(settings: &Settings, parameter: &Parameter) -> String {
    format_value(settings, parameter)
}

fn row(id: &str) -> &'static Parameter {
    params::parameter(id).expect(id)
}

/// The default settings with values given as text.
fn with(values: &[(&str, &str)]) -> Settings {
    let mut settings = Settings::default();
    for (id, value) in values {
        set_from_str(&mut settings, id, value).expect("a value that the parameter takes");
    }
    settings
}

/// Returns settings that together contain every row.
fn starts() -> [Settings; 5] {
    [
        Settings::default(),
        with(&[("fit.kind", "focused"), ("splits.scheme", "practical")]),
        with(&[("fit.kind", "oriented"), ("splits.scheme", "manual"), ("splits.selection", "view_depth")]),
        with(&[("fit.kind", "sphere"), ("splits.count", "1"), ("stabilise.mode", "snap")]),
        with(&[("softness.measure", "metres"), ("view.inset_black", "0"), ("map.edges", "traced")]),
    ]
}

/// Returns settings in which the row exists.
fn settings_with(parameter: &Parameter) -> Settings {
    starts().into_iter().find(|start| parameter.is_present(start)).expect(parameter.id)
}

/// Gives the parameter another value, if the settings have the row.
fn change(settings: &mut Settings, parameter: &Parameter) {
    let before = parameter.get(settings);
    let values = match &parameter.kind {
        // Near a panel's initial value, since the middle of a range may have no effect.
        Kind::Number(Number { unset: Some(unset), step, max, .. }) => [unset.initial + step, *max].map(Value::Number),
        Kind::Number(Number { min, max, .. }) => [0.5 * (min + max), *max].map(Value::Number),
        Kind::Choice(_) => [0, 1].map(Value::Option),
        Kind::Toggle => [false, true].map(Value::Toggle),
    };
    for value in values {
        if parameter.get(settings) == before {
            parameter.set(settings, value);
        }
    }
}

/// A parameter and its value that turn the maps into cascades.
const SLICES: (&str, &str) = ("fit.kind", "focused");
