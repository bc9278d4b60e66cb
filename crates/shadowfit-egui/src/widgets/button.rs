//! Buttons that egui lacks: with only an icon, and with a key below the name.

use egui::{
    Align2, Button, Color32, Response, RichText, Role, Sense, Stroke, StrokeKind, TextStyle, Ui, Vec2, WidgetInfo,
};

use crate::accessibility::rename;
use crate::icon::{Icon, paint_icon};
use crate::theme::Palette;

/// Width and height of an icon button, in points.
const ICON_BUTTON: f32 = 24.0;

/// Shows a button with an icon, a name for screen readers, and help. Hosts can use it for bars that should
/// look like the panel.
pub fn icon_button(ui: &mut Ui, icon: Icon, name: &str, help: &str) -> Response {
    let size = Vec2::new(ICON_BUTTON, at_least(ui, ICON_BUTTON));
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, ui.is_enabled(), name));
    if ui.is_rect_visible(rect) {
        let visuals = ui.style().interact(&response);
        if response.hovered() || response.has_focus() {
            let rect = rect.shrink(1.0);
            ui.painter().rect(rect, visuals.corner_radius, visuals.weak_bg_fill, visuals.bg_stroke, StrokeKind::Inside);
        }
        paint_icon(ui, icon, rect.center(), visuals.text_color());
    }
    response.on_hover_text(help).on_disabled_hover_text(help)
}

/// Returns a height in points, raised to the least height of controls.
pub(crate) fn at_least(ui: &Ui, height: f32) -> f32 {
    height.max(ui.spacing().interact_size.y)
}

/// Shows a button with an icon before its name.
pub fn named_icon_button(ui: &mut Ui, icon: Icon, name: &str, help: &str) -> Response {
    let text =
        ui.painter().layout_no_wrap(name.to_owned(), TextStyle::Button.resolve(ui.style()), Color32::PLACEHOLDER);
    let padding = ui.spacing().button_padding.x;
    let size = Vec2::new(ICON_BUTTON + text.size().x + 2.0 * padding, at_least(ui, ICON_BUTTON));
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, ui.is_enabled(), name));
    if ui.is_rect_visible(rect) {
        let visuals = ui.style().interact(&response);
        ui.painter().rect(rect, visuals.corner_radius, visuals.weak_bg_fill, visuals.bg_stroke, StrokeKind::Inside);
        let left = rect.left_center() + Vec2::new(padding, 0.0);
        paint_icon(ui, icon, left + Vec2::new(0.4 * ICON_BUTTON, 0.0), visuals.text_color());
        let at = left + Vec2::new(ICON_BUTTON, -0.5 * text.size().y);
        ui.painter().galley(at, text, visuals.text_color());
    }
    response.on_hover_text(help)
}

/// Shows the main button of a card, over its whole width.
pub(crate) fn main_button(ui: &mut Ui, text: &str, key: &str, fill: Color32) -> Response {
    let on_fill = Palette::of(ui).on_accent;
    let name = RichText::new(text).color(on_fill);
    let button =
        if key.is_empty() { Button::new(name) } else { Button::new((name, RichText::new(key).small().color(on_fill))) };
    let size = Vec2::new(ui.available_width(), at_least(ui, 28.0));
    let response = ui.add_sized(size, button.fill(fill).stroke(Stroke::NONE));
    rename(ui, &response, text.to_owned());
    response
}

/// A button with its key below its name.
pub(crate) struct KeyButton<'a> {
    pub(crate) name: &'a str,
    pub(crate) accessible_name: &'a str,
    pub(crate) key: &'a str,
    pub(crate) is_selected: bool,
}

impl KeyButton<'_> {
    /// Shows the button in the available width.
    pub(crate) fn show(&self, ui: &mut Ui) -> Response {
        let (rect, response) = ui.allocate_exact_size(Vec2::new(ui.available_width(), 42.0), Sense::click());
        response.widget_info(|| {
            WidgetInfo::selected(Role::Button, ui.is_enabled(), self.is_selected, self.accessible_name)
        });
        if ui.is_rect_visible(rect) {
            let visuals = ui.style().interact_selectable(&response, self.is_selected);
            let weak = if self.is_selected { visuals.text_color() } else { ui.visuals().weak_text_color() };
            ui.painter().rect(rect, visuals.corner_radius, visuals.weak_bg_fill, visuals.bg_stroke, StrokeKind::Inside);
            let line = |offset: f32, text: &str, style: TextStyle, color| {
                let at = rect.center() + Vec2::new(0.0, offset);
                ui.painter().text(at, Align2::CENTER_CENTER, text, style.resolve(ui.style()), color);
            };
            line(-8.0, self.name, TextStyle::Button, visuals.text_color());
            line(10.0, self.key, TextStyle::Small, weak);
        }
        response
    }
}
