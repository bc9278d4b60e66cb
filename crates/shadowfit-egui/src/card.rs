//! The card of a scene: its lesson, its variants, and its own options.

use egui::{Checkbox, ComboBox, Label, RichText, Slider, Ui};

use crate::accessibility::rename;
use crate::theme::Palette;
use crate::widgets::{caption, card, main_button, title};
use crate::{Card, CardControl, CardRow, Command};

/// Width of the names of options, in points.
const LABEL_WIDTH: f32 = 96.0;

/// Shows the card.
pub(crate) fn show(ui: &mut Ui, scene: &Card<'_>, command: &mut Option<Command>) {
    let palette = Palette::of(ui);
    card(ui, Some(palette.accent), |ui| {
        title(ui, scene.title);
        ui.add(Label::new(scene.text).wrap());
        caption(ui, scene.flaw);
        ui.add_space(2.0);
        variants(ui, scene, command);
    });
    ui.add_space(4.0);
    for (index, row) in scene.rows.iter().enumerate() {
        ui.push_id(("option of a card", index), |ui| option(ui, index, row, command));
    }
    figures(ui, scene, command);
}

/// Shows the menu of variants, and a text on the chosen one.
fn variants(ui: &mut Ui, scene: &Card<'_>, command: &mut Option<Command>) {
    let shown = scene.shown.and_then(|index| scene.variants.get(index));
    let now = shown.map_or(scene.first, |variant| variant.label);
    let response =
        ComboBox::from_id_salt("variants of a card").width(ui.available_width()).selected_text(now).show_ui(ui, |ui| {
            if ui.selectable_label(scene.shown.is_none(), scene.first).clicked() {
                *command = Some(Command::ShowSampleVariant(None));
            }
            for (index, variant) in scene.variants.iter().enumerate() {
                let is_shown = scene.shown == Some(index);
                if ui.selectable_label(is_shown, variant.label).on_hover_text(variant.text).clicked() {
                    *command = Some(Command::ShowSampleVariant(Some(index)));
                }
            }
        });
    rename(ui, &response.response, "Variant".to_owned());
    if let Some(variant) = shown {
        ui.add(Label::new(RichText::new(variant.text).strong()).wrap());
    }
}

/// Shows the name and the control of an option.
fn option(ui: &mut Ui, index: usize, row: &CardRow<'_>, command: &mut Option<Command>) {
    ui.horizontal(|ui| {
        let size = egui::vec2(LABEL_WIDTH, ui.spacing().interact_size.y);
        ui.allocate_ui_with_layout(size, egui::Layout::left_to_right(egui::Align::Center), |ui| {
            ui.set_min_width(LABEL_WIDTH);
            ui.label(row.label).on_hover_text(row.help);
        });
        let changed = match row.control {
            CardControl::Choice(choices) => choice(ui, row, choices),
            CardControl::Number { min, max, unit } => {
                let mut value = row.value;
                ui.spacing_mut().slider_width = (ui.available_width() - LABEL_WIDTH).max(24.0);
                let decimals = match max - min {
                    ..=0.11 => 4,
                    ..=10.0 => 2,
                    _ => 1,
                };
                let suffix = if unit.is_empty() { String::new() } else { format!(" {unit}") };
                let slider = Slider::new(&mut value, min..=max).fixed_decimals(decimals).suffix(suffix);
                let response = ui.add(slider.update_while_editing(false)).on_hover_text(row.help);
                rename(ui, &response, row.label.to_owned());
                response.changed().then_some(value)
            }
            CardControl::Toggle => {
                let mut on = row.value != 0.0;
                let response = ui.add(Checkbox::without_text(&mut on)).on_hover_text(row.help);
                rename(ui, &response, row.label.to_owned());
                response.changed().then_some(f32::from(u8::from(on)))
            }
        };
        if let Some(value) = changed {
            *command = Some(Command::SetSampleOption { index, value });
        }
    });
}

fn choice(ui: &mut Ui, row: &CardRow<'_>, choices: &[(&str, &str)]) -> Option<f32> {
    let now = row.value as usize;
    let text = choices.get(now).map_or("", |(_, label)| *label);
    let mut chosen = None;
    let list = ComboBox::from_id_salt("choices").width(ui.available_width()).selected_text(text).show_ui(ui, |ui| {
        for (index, (_, label)) in choices.iter().enumerate() {
            if ui.selectable_label(index == now, *label).clicked() {
                chosen = Some(index as f32);
            }
        }
    });
    rename(ui, &list.response, row.label.to_owned());
    list.response.on_hover_text(row.help);
    chosen
}

/// Shows the measured figures, and the button that measures.
fn figures(ui: &mut Ui, scene: &Card<'_>, command: &mut Option<Command>) {
    let Some(help) = scene.measure else { return };
    ui.add_space(4.0);
    let palette = Palette::of(ui);
    card(ui, None, |ui| {
        if main_button(ui, "Measure", "", palette.accent_fill).on_hover_text(help).clicked() {
            *command = Some(Command::MeasureSample);
        }
        for line in scene.figures {
            ui.horizontal(|ui| {
                ui.label(line.name.as_str());
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    ui.label(RichText::new(&line.value).strong());
                });
            });
        }
    });
}
