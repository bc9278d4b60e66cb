//! Small patches of colour, with and without text on them.

use egui::{
    Align2, Color32, CornerRadius, Rect, Response, Role, Sense, Stroke, StrokeKind, TextStyle, Ui, Vec2, WidgetInfo,
};

/// Width and height of a colour square, in points.
const SWATCH: f32 = 10.0;

/// Converts a colour from sRGB bytes.
pub(crate) fn color([r, g, b]: [u8; 3]) -> Color32 {
    Color32::from_rgb(r, g, b)
}

/// Shows a colour square with a thin outline, which makes it visible on any background.
pub(crate) fn swatch(ui: &mut Ui, color: Color32) -> Response {
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(SWATCH), Sense::hover());
    if ui.is_rect_visible(rect) {
        paint_swatch(ui, rect, color);
    }
    response
}

fn paint_swatch(ui: &Ui, rect: Rect, color: Color32) {
    let line = Stroke::new(1.0, ui.visuals().weak_text_color().gamma_multiply(0.6));
    ui.painter().rect(rect, CornerRadius::same(2), color, line, StrokeKind::Inside);
}

/// Shows a line of [`color_entry`]s, which wraps.
pub(crate) fn color_line(ui: &mut Ui, entries: impl FnOnce(&mut Ui)) {
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing = Vec2::new(12.0, 3.0);
        ui.spacing_mut().interact_size.y = 0.0;
        ui.horizontal_wrapped(entries);
    });
}

/// Shows a colour, its meaning, and a value, as one widget, so that a line of them wraps.
pub(crate) fn color_entry(ui: &mut Ui, fill: Color32, name: &str, value: Option<&str>) -> Response {
    /// Distances between the square, the name and the value, in points.
    const GAP: f32 = 5.0;
    let font = TextStyle::Small.resolve(ui.style());
    let (weak, strong) = (ui.visuals().text_color(), ui.visuals().strong_text_color());
    let name_galley = ui.painter().layout_no_wrap(name.to_owned(), font.clone(), weak);
    let value_galley = value.map(|value| ui.painter().layout_no_wrap(value.to_owned(), font, strong));
    let value_width = value_galley.as_ref().map_or(0.0, |galley| GAP + galley.size().x);
    let size = Vec2::new(SWATCH + GAP + name_galley.size().x + value_width, name_galley.size().y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let text = value.map_or_else(|| name.to_owned(), |value| format!("{name} {value}"));
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &text));
    if ui.is_rect_visible(rect) {
        let square = Rect::from_center_size(rect.left_center() + Vec2::new(0.5 * SWATCH, 0.0), Vec2::splat(SWATCH));
        paint_swatch(ui, square, fill);
        let left = rect.left_top() + Vec2::new(SWATCH + GAP, 0.0);
        let after = left + Vec2::new(name_galley.size().x + GAP, 0.0);
        ui.painter().galley(left, name_galley, weak);
        if let Some(galley) = value_galley {
            ui.painter().galley(after, galley, strong);
        }
    }
    response
}

/// A widget with an optional colour square, a name, and values in columns of `width` at the right.
pub(crate) struct ValueRow<'a> {
    pub(crate) fill: Option<Color32>,
    pub(crate) name: &'a str,
    pub(crate) values: &'a [Option<String>],
    pub(crate) width: f32,
}

impl ValueRow<'_> {
    /// Shows the row in the available width. Unknown values are dashes.
    pub(crate) fn show(&self, ui: &mut Ui) -> Response {
        let small = TextStyle::Small.resolve(ui.style());
        let height = ui.text_style_height(&TextStyle::Small) + 3.0;
        let (rect, response) = ui.allocate_exact_size(Vec2::new(ui.available_width(), height), Sense::hover());
        let text = |value: &Option<String>| value.clone().unwrap_or_else(|| "—".to_owned());
        let all = self.values.iter().map(text).collect::<Vec<_>>().join(", ");
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, format!("{} {all}", self.name)));
        if ui.is_rect_visible(rect) {
            let mut left = rect.left_center();
            if let Some(fill) = self.fill {
                let square = Rect::from_center_size(left + Vec2::new(0.5 * SWATCH, 0.0), Vec2::splat(SWATCH));
                paint_swatch(ui, square, fill);
                left.x += SWATCH + 6.0;
            }
            ui.painter().text(left, Align2::LEFT_CENTER, self.name, small.clone(), ui.visuals().text_color());
            for (index, value) in self.values.iter().rev().enumerate() {
                let color =
                    if value.is_some() { ui.visuals().strong_text_color() } else { ui.visuals().weak_text_color() };
                let right = rect.right_center() - Vec2::new(index as f32 * self.width, 0.0);
                ui.painter().text(right, Align2::RIGHT_CENTER, text(value), small.clone(), color);
            }
        }
        response
    }
}

/// Shows a short text on a patch of colour.
pub(crate) fn badge(ui: &mut Ui, text: &str, fill: Color32, on_fill: Color32, name: &str) -> Response {
    let (rect, response) = ui.allocate_exact_size(Vec2::new(22.0, 16.0), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, name));
    if ui.is_rect_visible(rect) {
        ui.painter().rect_filled(rect, CornerRadius::same(3), fill);
        let font = TextStyle::Small.resolve(ui.style());
        ui.painter().text(rect.center(), Align2::CENTER_CENTER, text, font, on_fill);
    }
    response
}
