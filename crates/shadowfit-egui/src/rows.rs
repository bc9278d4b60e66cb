//! One control per parameter: label, slider, list or check box, unit, and a reset button if the value differs
//! from the default.

mod label;
mod side;

use egui::{Checkbox, ComboBox, Response, Slider, SliderClamping, Ui};
use shadowfit_params::tool::Settings;
use shadowfit_params::{ChoiceOption, Kind, Number, Parameter, Unset, Value};

use crate::accessibility::rename;
use crate::maps;
use label::{RESET_WIDTH, label, reset_button};

/// Width of the number field with its unit, in points.
const VALUE_WIDTH: f32 = 92.0;

/// Decimals to which edits of a logarithmic number are rounded.
const MOST_DECIMALS: usize = 8;

/// Id of the parameter that is shown as a row of buttons, one for each map.
const INSET_MAP: &str = "view.inset_map";

/// A parameter and the texts of its row.
struct Row<'a> {
    parameter: &'a Parameter,
    /// Effect, range and default.
    help: String,
    /// Reason why it has no effect.
    reason: Option<&'static str>,
    /// Name of its group, if the row is shown outside of the group and would be ambiguous.
    context: &'static str,
}

impl Row<'_> {
    fn label(&self, ui: &mut Ui) -> Response {
        self.explain(label(ui, self.parameter.label, self.context))
    }

    fn explain(&self, response: Response) -> Response {
        match self.reason {
            Some(reason) => response.on_disabled_hover_text(format!("{reason}\n\n{}", self.help)),
            None => response.on_hover_text(&self.help),
        }
    }
}

/// Returns whether a parameter gets a row under these settings. Parameters of another choice and of missing
/// maps get none.
pub(crate) fn is_shown(parameter: &Parameter, settings: &Settings) -> bool {
    parameter.is_present(settings) && !(parameter.is_of_choice() && (parameter.inert)(settings).is_some())
}

/// Shows the rows of parameters. Each row may change which of the next ones exist.
pub(crate) fn show_all(
    ui: &mut Ui,
    parameters: impl IntoIterator<Item = &'static Parameter>,
    settings: &mut Settings,
    defaults: &Settings,
) {
    for parameter in parameters {
        if is_shown(parameter, settings) {
            show(ui, parameter, settings, defaults, "");
        }
    }
}

/// Shows the row of a parameter. A double click on its label resets it, like the button. A NaN, which no
/// slider can show, resets itself.
pub(crate) fn show(
    ui: &mut Ui,
    parameter: &Parameter,
    settings: &mut Settings,
    defaults: &Settings,
    context: &'static str,
) {
    let row = Row { parameter, help: help(parameter, defaults), reason: (parameter.inert)(settings), context };
    let mut reset = is_nan(parameter, settings);
    ui.push_id(parameter.id, |ui| {
        let line = ui.horizontal(|ui| {
            let line = ui.add_enabled_ui(row.reason.is_none(), |ui| first_line(ui, &row, settings));
            if !parameter.is_equal(settings, defaults) {
                reset |= reset_button(ui, parameter.label);
            }
            line.inner
        });
        let label = line.inner;
        if let Kind::Number(number @ Number { unset: Some(_), .. }) = &parameter.kind
            && let Some(value) = parameter.number(settings)
        {
            ui.add_enabled_ui(row.reason.is_none(), |ui| second_line(ui, &row, number, value, settings, &label));
        }
        reset |= label.double_clicked();
    });
    if reset {
        parameter.copy(settings, defaults);
    }
}

/// Shows the label and the control; for an optional number its check box. Returns the label.
fn first_line(ui: &mut Ui, row: &Row<'_>, settings: &mut Settings) -> Response {
    let label = row.label(ui);
    let parameter = row.parameter;
    match (&parameter.kind, parameter.get(settings)) {
        (Kind::Number(_), _) if parameter.id == INSET_MAP => {
            let index = settings.view.inset_index(settings.technique.maps.count());
            if let Some(map) = maps::selector(ui, settings.technique.maps.count(), index, |button| row.explain(button))
            {
                parameter.set(settings, Value::Number(map as f64 + 1.0));
            }
        }
        (Kind::Number(Number { unset: Some(unset), .. }), Some(value)) => {
            unset_control(ui, row, unset, value == Value::Unset, settings);
        }
        (Kind::Number(number), Some(Value::Number(value))) => {
            if let Some(value) = number_control(ui, row, number, value, &label) {
                parameter.set(settings, Value::Number(value));
            }
        }
        (Kind::Choice(options), Some(Value::Option(index))) => {
            if let Some(index) = choice_control(ui, row, options, index, &label) {
                parameter.set(settings, Value::Option(index));
            }
        }
        (Kind::Toggle, Some(Value::Toggle(on))) => {
            if let Some(on) = toggle_control(ui, row, on) {
                parameter.set(settings, Value::Toggle(on));
            }
        }
        _ => {}
    }
    label
}

/// Shows the check box of an optional number.
fn unset_control(ui: &mut Ui, row: &Row<'_>, unset: &Unset, mut is_unset: bool, settings: &mut Settings) {
    let (parameter, option) = (row.parameter, unset.option);
    let response = ui.add(Checkbox::new(&mut is_unset, option.label)).on_hover_text(option.help);
    if response.changed() {
        if is_unset {
            parameter.set(settings, Value::Unset);
        } else {
            begin(parameter, unset, settings);
        }
    }
    rename(ui, &response, format!("{}: {}", parameter.label, option.label));
    row.explain(response);
}

/// Shows slider and field of an optional number that is set.
fn second_line(ui: &mut Ui, row: &Row<'_>, number: &Number, value: f64, settings: &mut Settings, label: &Response) {
    ui.horizontal(|ui| {
        ui.add_space(ui.spacing().icon_width);
        if let Some(value) = number_control(ui, row, number, value, label) {
            let mut next = *settings;
            row.parameter.set(&mut next, Value::Number(value));
            // A value that means unset, such as a height equal to the width, removes the slider, but not
            // during a drag.
            if row.parameter.number(&next).is_some() || !ui.input(|input| input.pointer.any_down()) {
                *settings = next;
            }
        }
    });
}

/// Sets an optional number to its initial value, or to half of that if the initial value means unset.
fn begin(parameter: &Parameter, unset: &Unset, settings: &mut Settings) {
    parameter.set(settings, Value::Number(unset.initial));
    if parameter.number(settings).is_none() {
        parameter.set(settings, Value::Number(0.5 * unset.initial));
    }
}

/// Shows slider and field, and for the sides of maps a list of the powers of two. Returns a new value.
fn number_control(ui: &mut Ui, row: &Row<'_>, scale: &Number, mut value: f64, label: &Response) -> Option<f64> {
    let gap = ui.spacing().item_spacing.x;
    let is_side = side::is_side(row.parameter, scale.decimals);
    let list_width = if is_side { side::LIST_WIDTH + gap } else { 0.0 };
    let taken = VALUE_WIDTH + list_width + RESET_WIDTH + 2.0 * gap;
    ui.spacing_mut().slider_width = (ui.available_width() - taken).max(24.0);
    ui.spacing_mut().interact_size.x = VALUE_WIDTH;
    let mut slider = Slider::new(&mut value, scale.min..=scale.max)
        // The setting stays out of range until the user edits it.
        .clamping(SliderClamping::Edits)
        .logarithmic(scale.logarithmic)
        // A typed number is applied when complete, since typing 1024 passes through 1, 10 and 102.
        .update_while_editing(false);
    slider = match scale.decimals {
        0 => slider.integer(),
        // An edit may change the magnitude, so only the text is rounded to it.
        _ if scale.logarithmic => slider.max_decimals(MOST_DECIMALS).custom_formatter(|value, _| text(scale, value)),
        decimals => slider.fixed_decimals(decimals),
    };
    if !row.parameter.unit.is_empty() {
        slider = slider.suffix(format!(" {}", row.parameter.unit));
    }
    let response = row.explain(ui.add(slider).labelled_by(label.id));
    let chosen = if is_side { side::list(ui, row.parameter.label, value, scale.min..=scale.max) } else { None };
    chosen.or_else(|| response.changed().then_some(value))
}

/// Returns a number as text with its decimals. A small value on a logarithmic scale gets more of them.
fn text(number: &Number, value: f64) -> String {
    /// Greatest error of the text, as a share of the value.
    const ROUNDING: f64 = 0.05;
    let is_close = |decimals: &usize| {
        let text = format!("{value:.decimals$}");
        text.parse().is_ok_and(|rounded: f64| (rounded - value).abs() <= value.abs() * ROUNDING)
    };
    let most = if number.logarithmic && number.decimals > 0 { MOST_DECIMALS } else { number.decimals };
    let decimals = (number.decimals..most).find(is_close).unwrap_or(most);
    format!("{value:.decimals$}")
}

/// Shows a list of options. Returns the index of a newly chosen one.
fn choice_control(
    ui: &mut Ui,
    row: &Row<'_>,
    options: &[ChoiceOption],
    current: usize,
    label: &Response,
) -> Option<usize> {
    let name = |index: usize| {
        let option = options.get(index).map_or("", |option| option.label);
        if row.parameter.unit.is_empty() { option.to_owned() } else { format!("{option} {}", row.parameter.unit) }
    };
    let mut chosen = None;
    let width = ui.available_width() - RESET_WIDTH - ui.spacing().item_spacing.x;
    let list = ComboBox::from_id_salt("options").width(width).selected_text(name(current)).show_ui(ui, |ui| {
        for (index, option) in options.iter().enumerate() {
            if ui.selectable_label(index == current, name(index)).on_hover_text(option.help).clicked() {
                chosen = Some(index);
            }
        }
    });
    row.explain(list.response.labelled_by(label.id));
    chosen
}

/// Shows a check box. Returns the new state if it was changed.
fn toggle_control(ui: &mut Ui, row: &Row<'_>, mut on: bool) -> Option<bool> {
    let response = ui.add(Checkbox::without_text(&mut on));
    let changed = response.changed();
    rename(ui, &response, row.parameter.label.to_owned());
    row.explain(response);
    changed.then_some(on)
}

fn is_nan(parameter: &Parameter, settings: &Settings) -> bool {
    parameter.number(settings).is_some_and(f64::is_nan)
}

/// Returns the effect of a parameter, its range and its default.
fn help(parameter: &Parameter, defaults: &Settings) -> String {
    let unit = if parameter.unit.is_empty() { String::new() } else { format!(" {}", parameter.unit) };
    let default = parameter.get(defaults);
    let facts = match &parameter.kind {
        Kind::Number(number @ Number { min, max, unset, .. }) => {
            let default = match (default, unset) {
                (Some(Value::Number(value)), _) => format!(", default {}{unit}", text(number, value)),
                (Some(_), Some(unset)) => format!(", default {}", unset.option.label),
                _ => String::new(),
            };
            format!("{min} to {max}{unit}{default}")
        }
        Kind::Choice(options) => {
            let index = if let Some(Value::Option(index)) = default { index } else { 0 };
            format!("Default {}{unit}", options.get(index).map_or("", |option| option.label))
        }
        Kind::Toggle => format!("Default {}", if default == Some(Value::Toggle(true)) { "on" } else { "off" }),
    };
    format!("{}\n\n{facts}.", parameter.help)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_numbers_on_a_logarithmic_scale_have_the_decimals_that_they_need() {
        let near = shadowfit_params::parameter("camera.near").expect("a parameter");
        let Kind::Number(number) = &near.kind else { panic!("{:?}", near.kind) };
        let texts = [0.0, 1.23e-6, 0.000_1, 0.05, 12.345_6].map(|value| text(number, value));
        assert_eq!(texts, ["0.000", "0.0000012", "0.0001", "0.050", "12.346"]);
    }
}
