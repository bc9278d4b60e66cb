//! One control per parameter: label, slider or list or check box, unit, and a reset button when the
//! value is not the default.

mod label;
mod side;

use egui::{Checkbox, ComboBox, Response, Slider, SliderClamping, Ui};
use shadowfit::params::{Choice, Kind, Number, Optional, Parameter, Toggle};
use shadowfit::tool::Settings;

use crate::accessibility::rename;
use crate::maps;
use label::{RESET_WIDTH, label, reset_button};

/// Width of the number field with its unit, in points.
const VALUE_WIDTH: f32 = 92.0;

/// Id of the parameter that is shown as a row of buttons, one for each map.
const INSET_MAP: &str = "view.inset_map";

/// A parameter, and what its row says.
struct Row<'a> {
    parameter: &'a Parameter,
    /// What it does, its range and its default.
    help: String,
    /// Why it has no effect.
    reason: Option<&'static str>,
    /// Its group, where the row stands outside of it and would not be understood.
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

/// Whether a parameter gets a row under these settings: not one of another choice of splits, and none of a map
/// that is not there.
pub(crate) fn is_shown(parameter: &Parameter, settings: &Settings) -> bool {
    let belongs_to_a_choice = matches!(&parameter.kind, Kind::Optional(optional) if optional.unset.is_none());
    parameter.is_present(settings) && !(belongs_to_a_choice && (parameter.inert)(settings).is_some())
}

/// The rows of parameters that are shown, each of which may change what the next ones are.
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

/// The row of a parameter. A double click on its label resets it, as the button does; a number that
/// is NaN, which no slider can show, resets itself.
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
        if let Kind::Optional(optional) = &parameter.kind
            && optional.unset.is_some()
            && optional.get(settings).is_some()
        {
            ui.add_enabled_ui(row.reason.is_none(), |ui| second_line(ui, &row, optional, settings, &label));
        }
        reset |= label.double_clicked();
    });
    if reset {
        parameter.copy(settings, defaults);
    }
}

/// Label and control, for a number that need not be there its check box; returns the label.
fn first_line(ui: &mut Ui, row: &Row<'_>, settings: &mut Settings) -> Response {
    let label = row.label(ui);
    match &row.parameter.kind {
        Kind::Number(number) if row.parameter.id == INSET_MAP => {
            let index = settings.view.inset_index(settings.technique.count);
            if let Some(map) = maps::selector(ui, settings.technique.count, index, |button| row.explain(button)) {
                number.set(settings, map as f64 + 1.0);
            }
        }
        Kind::Number(number) => {
            if let Some(value) = number_control(ui, row, &Scale::from(number), number.get(settings), &label) {
                number.set(settings, value);
            }
        }
        Kind::Optional(optional) => match (&optional.unset, optional.get(settings)) {
            (Some(unset), value) => {
                let mut is_unset = value.is_none();
                let response = ui.add(Checkbox::new(&mut is_unset, unset.label)).on_hover_text(unset.help);
                if response.changed() {
                    if is_unset { optional.set(settings, None) } else { begin(optional, settings) }
                }
                rename(ui, &response, format!("{}: {}", row.parameter.label, unset.label));
                row.explain(response);
            }
            (None, Some(value)) => {
                if let Some(value) = number_control(ui, row, &Scale::from(optional), value, &label) {
                    optional.set(settings, Some(value));
                }
            }
            (None, None) => {}
        },
        Kind::Choice(choice) => choice_control(ui, row, choice, settings, &label),
        Kind::Toggle(toggle) => toggle_control(ui, row, *toggle, settings),
    }
    label
}

/// Slider and field of a number that need not be there, while it is.
fn second_line(ui: &mut Ui, row: &Row<'_>, optional: &Optional, settings: &mut Settings, label: &Response) {
    let Some(value) = optional.get(settings) else { return };
    ui.horizontal(|ui| {
        ui.add_space(ui.spacing().icon_width);
        if let Some(value) = number_control(ui, row, &Scale::from(optional), value, label) {
            let mut next = *settings;
            optional.set(&mut next, Some(value));
            // A value that means none, such as a height equal to the width, removes the slider, but not while it is
            // being dragged.
            if optional.get(&next).is_some() || !ui.input(|input| input.pointer.any_down()) {
                *settings = next;
            }
        }
    });
}

/// Turns a number on; where its initial value means none, at half of that.
fn begin(optional: &Optional, settings: &mut Settings) {
    optional.set(settings, Some(optional.initial));
    if optional.get(settings).is_none() {
        optional.set(settings, Some(0.5 * optional.initial));
    }
}

/// Range and look of a number.
struct Scale {
    min: f64,
    max: f64,
    logarithmic: bool,
    decimals: usize,
}

impl From<&Number> for Scale {
    fn from(number: &Number) -> Self {
        Self { min: number.min, max: number.max, logarithmic: number.logarithmic, decimals: number.decimals }
    }
}

impl From<&Optional> for Scale {
    fn from(optional: &Optional) -> Self {
        let Optional { min, max, logarithmic, decimals, .. } = *optional;
        Self { min, max, logarithmic, decimals }
    }
}

/// Slider and field, and for the sides of maps a list of the powers of two; returns a new value.
fn number_control(ui: &mut Ui, row: &Row<'_>, scale: &Scale, mut value: f64, label: &Response) -> Option<f64> {
    let gap = ui.spacing().item_spacing.x;
    let is_side = side::is_side(row.parameter, scale.decimals);
    let list_width = if is_side { side::LIST_WIDTH + gap } else { 0.0 };
    let taken = VALUE_WIDTH + list_width + RESET_WIDTH + 2.0 * gap;
    ui.spacing_mut().slider_width = (ui.available_width() - taken).max(24.0);
    ui.spacing_mut().interact_size.x = VALUE_WIDTH;
    let mut slider = Slider::new(&mut value, scale.min..=scale.max)
        // The setting stays as it is until a person turns it.
        .clamping(SliderClamping::Edits)
        .logarithmic(scale.logarithmic)
        // A typed number counts when it is complete: 1024 passes through 1, 10 and 102.
        .update_while_editing(false);
    slider = if scale.decimals == 0 { slider.integer() } else { slider.fixed_decimals(scale.decimals) };
    if !row.parameter.unit.is_empty() {
        slider = slider.suffix(format!(" {}", row.parameter.unit));
    }
    let response = row.explain(ui.add(slider).labelled_by(label.id));
    let chosen = if is_side { side::list(ui, row.parameter.label, value, scale.min..=scale.max) } else { None };
    chosen.or_else(|| response.changed().then_some(value))
}

fn choice_control(ui: &mut Ui, row: &Row<'_>, choice: &Choice, settings: &mut Settings, label: &Response) {
    let name = |index: usize| {
        let option = choice.options.get(index).map_or("", |option| option.label);
        if row.parameter.unit.is_empty() { option.to_owned() } else { format!("{option} {}", row.parameter.unit) }
    };
    let current = choice.get(settings);
    let width = ui.available_width() - RESET_WIDTH - ui.spacing().item_spacing.x;
    let list = ComboBox::from_id_salt("options").width(width).selected_text(name(current)).show_ui(ui, |ui| {
        for (index, option) in choice.options.iter().enumerate() {
            if ui.selectable_label(index == current, name(index)).on_hover_text(option.help).clicked() {
                choice.set(settings, index);
            }
        }
    });
    row.explain(list.response.labelled_by(label.id));
}

fn toggle_control(ui: &mut Ui, row: &Row<'_>, toggle: Toggle, settings: &mut Settings) {
    let mut on = toggle.get(settings);
    let response = ui.add(Checkbox::without_text(&mut on));
    if response.changed() {
        toggle.set(settings, on);
    }
    rename(ui, &response, row.parameter.label.to_owned());
    row.explain(response);
}

fn is_nan(parameter: &Parameter, settings: &Settings) -> bool {
    match &parameter.kind {
        Kind::Number(number) => number.get(settings).is_nan(),
        Kind::Optional(optional) => optional.get(settings).is_some_and(f64::is_nan),
        Kind::Choice(_) | Kind::Toggle(_) => false,
    }
}

/// What the parameter does, its range and its default.
fn help(parameter: &Parameter, defaults: &Settings) -> String {
    let unit = if parameter.unit.is_empty() { String::new() } else { format!(" {}", parameter.unit) };
    let facts = match &parameter.kind {
        Kind::Number(number) => {
            let decimals = number.decimals;
            format!("{} to {}{unit}, default {:.decimals$}{unit}", number.min, number.max, number.get(defaults))
        }
        Kind::Optional(optional) => {
            let decimals = optional.decimals;
            let default = match (optional.get(defaults), optional.unset) {
                (Some(value), _) => format!(", default {value:.decimals$}{unit}"),
                (None, Some(unset)) => format!(", default {}", unset.label),
                (None, None) => String::new(),
            };
            format!("{} to {}{unit}{default}", optional.min, optional.max)
        }
        Kind::Choice(choice) => {
            let default = choice.options.get(choice.get(defaults)).map_or("", |option| option.label);
            format!("Default {default}{unit}")
        }
        Kind::Toggle(toggle) => format!("Default {}", if toggle.get(defaults) { "on" } else { "off" }),
    };
    format!("{}\n\n{facts}.", parameter.help)
}
