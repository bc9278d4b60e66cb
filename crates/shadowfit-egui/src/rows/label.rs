//! What stands at both ends of a row: its label, and the button that resets it.

use std::f32::consts::TAU;

use egui::{Align, Color32, Label, Layout, Pos2, Response, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo};

/// Width of the labels, in points: the longest of them fits.
const LABEL_WIDTH: f32 = 122.0;
/// Width kept free for the reset button, in points, so that controls do not jump.
pub(super) const RESET_WIDTH: f32 = 20.0;

/// A label that can be clicked, as wide as all others.
pub(crate) fn label(ui: &mut Ui, text: &str) -> Response {
    let size = Vec2::new(LABEL_WIDTH, ui.spacing().interact_size.y);
    let layout = Layout::left_to_right(Align::Center);
    ui.allocate_ui_with_layout(size, layout, |ui| {
        ui.set_min_width(LABEL_WIDTH);
        ui.add(Label::new(text).sense(Sense::click()).selectable(false))
    })
    .inner
}

pub(super) fn reset_button(ui: &mut Ui, label: &str) -> bool {
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        let (rect, response) = ui.allocate_exact_size(Vec2::splat(RESET_WIDTH), Sense::click());
        let name = format!("Reset {label}");
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
