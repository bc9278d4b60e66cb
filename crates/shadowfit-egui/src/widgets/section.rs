//! Headings of folding sections, and small headings within cards.

use egui::collapsing_header::{CollapsingState, paint_default_icon};
use egui::{Align2, Rect, Response, RichText, Role, Sense, Stroke, StrokeKind, TextStyle, Ui, Vec2, WidgetInfo};

use super::button::at_least;

/// Height of the heading of a section, in points.
const HEIGHT: f32 = 27.0;

/// Width of the triangle before the heading, in points.
const INDENT: f32 = 18.0;

/// A folding section, with a summary at the right of its heading.
pub(crate) struct Section<'a> {
    pub(crate) title: &'a str,
    pub(crate) help: &'a str,
    /// Summary in a few words.
    pub(crate) summary: &'a str,
    /// Whether it is open initially.
    pub(crate) is_open: bool,
}

impl Section<'_> {
    /// Shows the heading and, if open, the contents. egui's memory stores the open state by the title.
    pub(crate) fn show(&self, ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
        let id = ui.make_persistent_id(("section", self.title));
        let mut state = CollapsingState::load_with_default_open(ui.ctx(), id, self.is_open);
        let (rect, _) = ui.allocate_exact_size(Vec2::new(ui.available_width(), at_least(ui, HEIGHT)), Sense::hover());
        let response = ui.interact(rect, id, Sense::click());
        if response.clicked() {
            state.toggle(ui);
        }
        response.widget_info(|| WidgetInfo::labeled(Role::DisclosureTriangle, ui.is_enabled(), self.title));
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_expanded(state.is_open()));
        if ui.is_rect_visible(rect) {
            self.paint(ui, &response, state.openness(ui.ctx()));
        }
        if !self.help.is_empty() {
            response.on_hover_text(self.help);
        }
        state.show_body_unindented(ui, |ui| {
            contents(ui);
            ui.add_space(6.0);
        });
    }

    fn paint(&self, ui: &mut Ui, response: &Response, openness: f32) {
        let rect = response.rect;
        let line = ui.visuals().widgets.noninteractive.bg_stroke;
        ui.painter().hline(rect.x_range(), rect.top(), line);
        let visuals = ui.style().interact(response);
        if response.hovered() || response.has_focus() {
            let ring = if response.has_focus() { visuals.bg_stroke } else { Stroke::NONE };
            let rect = rect.shrink2(Vec2::new(0.0, 2.0));
            ui.painter().rect(rect, visuals.corner_radius, visuals.weak_bg_fill, ring, StrokeKind::Inside);
        }
        let icon = Rect::from_center_size(rect.left_center() + Vec2::new(0.5 * INDENT, 0.0), Vec2::splat(11.0));
        paint_default_icon(ui, openness, &response.clone().with_new_rect(icon));
        let text = |at, align, text: &str, style: TextStyle, color| {
            ui.painter().text(at, align, text, style.resolve(ui.style()), color)
        };
        let left = rect.left_center() + Vec2::new(INDENT, 0.0);
        text(left, Align2::LEFT_CENTER, self.title, TextStyle::Body, ui.visuals().strong_text_color());
        let right = rect.right_center() - Vec2::new(4.0, 0.0);
        text(right, Align2::RIGHT_CENTER, self.summary, TextStyle::Small, ui.visuals().weak_text_color());
    }
}

/// Shows the heading of a card.
pub(crate) fn title(ui: &mut Ui, text: &str) -> Response {
    ui.label(RichText::new(text).strong())
}

/// Shows a small line in weak colour: a heading within a section, or a hint.
pub(crate) fn caption(ui: &mut Ui, text: &str) -> Response {
    ui.add(egui::Label::new(RichText::new(text).small().weak()).wrap())
}
