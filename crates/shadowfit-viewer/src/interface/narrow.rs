//! The interface in narrow windows, such as on phones: the panel is a drawer over the picture, closed at
//! first. While it is closed, its important messages are shown over the picture.

use egui::{
    Color32, CornerRadius, Frame, Id, Label, Rect, Role, ScrollArea, Sense, Ui, UiBuilder, Vec2, WidgetInfo, vec2,
};
use shadowfit_egui::{Command, Icon, PANEL_WIDTH, ShownArtefact, artefact_card, icon_button};

use super::{Interface, InterfaceInput, InterfaceOutput};
use crate::stage::Stage;

/// Least width at which picture and panel are beside each other, in points.
const LEAST_WIDTH: f32 = 700.0;
/// Greatest share of the width for the drawer. A tap on the rest of the picture closes it.
const DRAWER: f32 = 0.9;
/// Distance of notes from the edges of the picture, in points.
const MARGIN: f32 = 10.0;
/// Greatest share of the picture's height for notes.
const NOTES: f32 = 0.5;

/// Returns whether a window of a size, in points, is too narrow for a panel beside the picture.
pub(super) fn is_narrow(size: Vec2) -> bool {
    size.x < LEAST_WIDTH
}

impl Interface {
    /// Shows the panel over everything else until it is closed, by its button, by a tap beside it, or by a
    /// command that shows an artefact.
    pub(super) fn show_drawer(
        &mut self,
        ui: &mut Ui,
        stage: &mut Stage,
        input: &InterfaceInput<'_>,
        output: &mut InterfaceOutput,
    ) {
        let window = ui.ctx().content_rect();
        let ui = &mut ui.new_child(UiBuilder::new().max_rect(window));
        ui.set_clip_rect(window);
        let beside = ui.interact(window, Id::unique("beside the drawer"), Sense::click_and_drag());
        beside.widget_info(|| WidgetInfo::labeled(Role::Button, true, "Beside the panel"));
        ui.painter().rect_filled(window, CornerRadius::ZERO, Color32::from_black_alpha(190));
        let width = PANEL_WIDTH.min(DRAWER * window.width());
        let place = Rect::from_min_max(window.right_top() - vec2(width, 0.0), window.max);
        // The space between the controls belongs to the drawer.
        ui.interact(place, Id::unique("drawer"), Sense::click_and_drag())
            .widget_info(|| WidgetInfo::labeled(Role::Pane, true, "Panel"));
        ui.scope_builder(UiBuilder::new().max_rect(place), |ui| {
            ui.set_clip_rect(place);
            Frame::side_top_panel(ui.style()).show(ui, |ui| {
                ui.set_min_size(ui.available_size());
                self.show_panel(ui, stage, input, output);
            });
        });
        let strip = Rect::from_min_max(window.min, place.left_bottom()).shrink(4.0);
        let close = ui.scope_builder(UiBuilder::new().max_rect(strip), |ui| {
            ui.visuals_mut().widgets.inactive.fg_stroke.color = Color32::WHITE;
            ui.vertical_centered(|ui| icon_button(ui, Icon::X, "Close the panel", "Back to the picture").clicked())
                .inner
        });
        let is_shown = output.commands.iter().any(|command| matches!(command, Command::ShowArtefact(_)));
        self.drawer_open = !(close.inner || beside.clicked() || is_shown);
    }
}

/// Shows the message and the card of the shown artefact at the top of the picture.
pub(super) fn show_notes(
    ui: &mut Ui,
    picture: Rect,
    stage: &Stage,
    input: &InterfaceInput<'_>,
    output: &mut InterfaceOutput,
) {
    let room = picture.shrink(MARGIN);
    ui.scope_builder(UiBuilder::new().max_rect(room), |ui| {
        if let Some(message) = stage.problem().or(input.message) {
            Frame::popup(ui.style()).show(ui, |ui| {
                ui.set_width(ui.available_width());
                ui.add(Label::new(message).wrap());
            });
        }
        if let Some(shown) = stage.shown() {
            let (narration, changes) = (stage.narration(), stage.cure_changes());
            let card = ShownArtefact { artefact: shown.artefact, fixed: shown.fixed, narration, changes };
            let area = ScrollArea::vertical().max_height((NOTES * room.height()).max(0.0));
            output.commands.extend(area.show(ui, |ui| artefact_card(ui, &card)).inner);
        }
    });
}
