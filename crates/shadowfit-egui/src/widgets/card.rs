//! A frame around a group of widgets.

use egui::{Color32, CornerRadius, Frame, InnerResponse, Margin, Stroke, Ui};

use crate::theme::CARD_RADIUS;

/// Shows a card in the available width. With `accent`, its outline has that colour.
pub(crate) fn card<R>(ui: &mut Ui, accent: Option<Color32>, contents: impl FnOnce(&mut Ui) -> R) -> InnerResponse<R> {
    let border = ui.visuals().widgets.noninteractive.bg_stroke;
    let stroke = accent.map_or(border, |accent| Stroke::new(1.0, accent));
    Frame::new()
        .fill(ui.visuals().faint_bg_color)
        .stroke(stroke)
        .corner_radius(CornerRadius::same(CARD_RADIUS))
        .inner_margin(Margin::symmetric(10, 8))
        .show(ui, |ui| {
            ui.set_width(ui.available_width());
            contents(ui)
        })
}
