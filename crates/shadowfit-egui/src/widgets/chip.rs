//! Small patches of colour, with and without text on them.

use egui::{Align2, Color32, CornerRadius, Response, Role, Sense, Stroke, StrokeKind, TextStyle, Ui, Vec2, WidgetInfo};

/// A colour of sRGB bytes.
pub(crate) fn color([r, g, b]: [u8; 3]) -> Color32 {
    Color32::from_rgb(r, g, b)
}

/// A square of a colour, with a thin line around it, so that it is seen on any ground.
pub(crate) fn swatch(ui: &mut Ui, color: Color32) -> Response {
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(10.0), Sense::hover());
    if ui.is_rect_visible(rect) {
        let line = Stroke::new(1.0, ui.visuals().weak_text_color().gamma_multiply(0.6));
        ui.painter().rect(rect, CornerRadius::same(2), color, line, StrokeKind::Inside);
    }
    response
}

/// A short text on a patch of colour.
pub(crate) fn badge(ui: &mut Ui, text: &str, [fill, on_fill]: [Color32; 2], name: &str) -> Response {
    let (rect, response) = ui.allocate_exact_size(Vec2::new(22.0, 16.0), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, name));
    if ui.is_rect_visible(rect) {
        ui.painter().rect_filled(rect, CornerRadius::same(3), fill);
        let font = TextStyle::Small.resolve(ui.style());
        ui.painter().text(rect.center(), Align2::CENTER_CENTER, text, font, on_fill);
    }
    response
}
