//! One control per parameter: label, slider or list or check box, unit, and a reset button when the
//! value is not the default.

use std::f32::consts::TAU;

use egui::{
    Align, Checkbox, Color32, ComboBox, Label, Layout, Pos2, Response, Role, Sense, Shape, Slider, SliderClamping,
    Stroke, Ui, Vec2, WidgetInfo,
};
use shadowfit::Settings;
use shadowfit::params::{Choice, Kind, Number, Parameter, Toggle};

/// Width of the labels, in points: the longest of them fits.
const LABEL_WIDTH: f32 = 108.0;
/// Width of the number field with its unit, in points.
const VALUE_WIDTH: f32 = 82.0;
/// Width kept free for the reset button, in points, so that controls do not jump.
const RESET_WIDTH: f32 = 20.0;

/// The row of a parameter. A double click on its label resets it, as the button does; a number that
/// is NaN, which no slider can show, resets itself.
pub(crate) fn show(ui: &mut Ui, parameter: &Parameter, settings: &mut Settings, defaults: &Settings) {
    let help = help(parameter, defaults);
    let reason = (parameter.inert)(settings);
    let mut reset = matches!(parameter.kind, Kind::Number(number) if number.get(settings).is_nan());
    ui.push_id(parameter.id, |ui| {
        ui.horizontal(|ui| {
            ui.add_enabled_ui(reason.is_none(), |ui| match &parameter.kind {
                Kind::Number(number) => reset |= number_row(ui, parameter, number, settings, &help, reason),
                Kind::Choice(choice) => reset |= choice_row(ui, parameter, choice, settings, &help, reason),
                Kind::Toggle(toggle) => toggle_row(ui, parameter, *toggle, settings, &help, reason),
            });
            if !parameter.is_equal(settings, defaults) {
                reset |= reset_button(ui, parameter);
            }
        });
    });
    if reset {
        parameter.copy(settings, defaults);
    }
}

fn number_row(
    ui: &mut Ui,
    parameter: &Parameter,
    number: &Number,
    settings: &mut Settings,
    help: &str,
    reason: Option<&str>,
) -> bool {
    let label = label(ui, parameter, help, reason);
    let taken = VALUE_WIDTH + RESET_WIDTH + 2.0 * ui.spacing().item_spacing.x;
    let slider_width = (ui.available_width() - taken).max(24.0);
    ui.spacing_mut().slider_width = slider_width;
    ui.spacing_mut().interact_size.x = VALUE_WIDTH;
    let mut value = number.get(settings);
    let mut slider = Slider::new(&mut value, number.min..=number.max)
        // The setting stays as it is until a person turns it.
        .clamping(SliderClamping::Edits)
        .logarithmic(number.logarithmic)
        .fixed_decimals(number.decimals);
    if !parameter.unit.is_empty() {
        slider = slider.suffix(format!(" {}", parameter.unit));
    }
    let response = ui.add(slider).labelled_by(label.id);
    if response.changed() {
        number.set(settings, value);
    }
    explain(response, help, reason);
    label.double_clicked()
}

fn choice_row(
    ui: &mut Ui,
    parameter: &Parameter,
    choice: &Choice,
    settings: &mut Settings,
    help: &str,
    reason: Option<&str>,
) -> bool {
    let label = label(ui, parameter, help, reason);
    let name = |index: usize| {
        let option = choice.options.get(index).map_or("", |option| option.label);
        if parameter.unit.is_empty() { option.to_owned() } else { format!("{option} {}", parameter.unit) }
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
    explain(list.response.labelled_by(label.id), help, reason);
    label.double_clicked()
}

fn toggle_row(
    ui: &mut Ui,
    parameter: &Parameter,
    toggle: Toggle,
    settings: &mut Settings,
    help: &str,
    reason: Option<&str>,
) {
    let mut on = toggle.get(settings);
    let response = ui.add(Checkbox::new(&mut on, parameter.label));
    if response.changed() {
        toggle.set(settings, on);
    }
    explain(response, help, reason);
}

fn label(ui: &mut Ui, parameter: &Parameter, help: &str, reason: Option<&str>) -> Response {
    let size = Vec2::new(LABEL_WIDTH, ui.spacing().interact_size.y);
    let layout = Layout::left_to_right(Align::Center);
    let response = ui
        .allocate_ui_with_layout(size, layout, |ui| {
            ui.set_min_width(LABEL_WIDTH);
            ui.add(Label::new(parameter.label).sense(Sense::click()).selectable(false))
        })
        .inner;
    explain(response, help, reason)
}

fn reset_button(ui: &mut Ui, parameter: &Parameter) -> bool {
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        let (rect, response) = ui.allocate_exact_size(Vec2::splat(RESET_WIDTH), Sense::click());
        let name = format!("Reset {}", parameter.label);
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
        if ui.is_rect_visible(rect) {
            paint_reset_icon(ui, rect.center(), ui.style().interact(&response).fg_stroke.color);
        }
        response.on_hover_text("Back to the default").clicked()
    })
    .inner
}

/// An arrow that turns back anticlockwise. It is painted because egui's default fonts have no such
/// glyph.
fn paint_reset_icon(ui: &Ui, center: Pos2, colour: Color32) {
    const RADIUS: f32 = 5.0;
    const SEGMENTS: u8 = 16;
    // From the arrow's head at the upper left, clockwise over the top, most of the way round;
    // y points down.
    let at = |turn: f32, radius: f32| center + radius * Vec2::angled(TAU * turn);
    let arc = (0..=SEGMENTS).map(|step| at(-0.4 + 0.75 * f32::from(step) / f32::from(SEGMENTS), RADIUS)).collect();
    ui.painter().line(arc, Stroke::new(1.5, colour));
    let head = [at(-0.4, RADIUS + 3.0), at(-0.4, RADIUS - 3.0), at(-0.5, RADIUS + 0.5)];
    ui.painter().add(Shape::convex_polygon(head.into(), colour, Stroke::NONE));
}

fn explain(response: Response, help: &str, reason: Option<&str>) -> Response {
    match reason {
        Some(reason) => response.on_disabled_hover_text(format!("{reason}\n\n{help}")),
        None => response.on_hover_text(help),
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
        Kind::Choice(choice) => {
            let default = choice.options.get(choice.get(defaults)).map_or("", |option| option.label);
            format!("Default {default}{unit}")
        }
        Kind::Toggle(toggle) => format!("Default {}", if toggle.get(defaults) { "on" } else { "off" }),
    };
    format!("{}\n\n{facts}.", parameter.help)
}
