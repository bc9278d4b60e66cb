//! The two ends of a row: its label, and its reset button.

use egui::{Align, Label, Layout, Response, RichText, Sense, Ui, Vec2};

use crate::widgets::{Icon, icon_button};

/// Width of the labels, in points. The longest one fits.
const LABEL_WIDTH: f32 = 122.0;
/// Width reserved for the reset button, in points, so that controls do not jump.
pub(super) const RESET_WIDTH: f32 = 24.0;

/// Shows a clickable label of fixed width, followed by a small word of context.
pub(super) fn label(ui: &mut Ui, text: &str, context: &str) -> Response {
    let size = Vec2::new(LABEL_WIDTH, ui.spacing().interact_size.y);
    let layout = Layout::left_to_right(Align::Center);
    ui.allocate_ui_with_layout(size, layout, |ui| {
        ui.set_min_width(LABEL_WIDTH);
        let label = ui.add(Label::new(text).sense(Sense::click()).selectable(false));
        if !context.is_empty() {
            ui.label(RichText::new(context).small().weak());
        }
        label
    })
    .inner
}

pub(super) fn reset_button(ui: &mut Ui, label: &str) -> bool {
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        icon_button(ui, Icon::RotateCcw, &format!("Reset {label}"), "Back to the default").clicked()
    })
    .inner
}
