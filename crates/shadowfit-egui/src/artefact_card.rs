//! The part of the panel that shows and fixes artefacts.

use egui::{Align, Button, Color32, Label, Layout, RichText, Ui};

use crate::theme::{Palette, has_arrows};
use crate::widgets::{Icon, KeyButton, at_least, caption, card, icon_button, main_button};
use crate::{Artefact, Command, ShownArtefact, keys_of};

/// Shows the buttons, and the card of the shown artefact.
pub(crate) fn show(ui: &mut Ui, shown: Option<&ShownArtefact<'_>>, command: &mut Option<Command>) {
    ui.columns_const(|columns: &mut [Ui; 3]| {
        for (ui, artefact) in columns.iter_mut().zip(Artefact::ALL) {
            let accessible_name = format!("Show {}", artefact.label().to_lowercase());
            let button = KeyButton {
                name: &format!("Show {}", artefact.short_label()),
                accessible_name: &accessible_name,
                key: keys_of(&Command::ShowArtefact(artefact)),
                is_selected: shown.is_some_and(|shown| shown.artefact == artefact),
            };
            if button.show(ui).on_hover_text(artefact.explanation()).clicked() {
                *command = Some(Command::ShowArtefact(artefact));
            }
        }
    });
    if let Some(shown) = shown {
        *command = card_of(ui, shown, false).or(command.take());
    }
}

/// Shows a brief card of the artefact in the whole width of `ui`: the narration, the changes of the cure, and
/// the button that fixes it. For use over the picture while the panel is closed.
pub fn artefact_card(ui: &mut Ui, shown: &ShownArtefact<'_>) -> Option<Command> {
    card_of(ui, shown, true)
}

/// Shows the card. A brief card leaves out the explanation if there is a narration.
fn card_of(ui: &mut Ui, shown: &ShownArtefact<'_>, is_brief: bool) -> Option<Command> {
    let ShownArtefact { artefact, fixed, narration, changes: changed } = *shown;
    let palette = Palette::of(ui);
    let accent = if fixed { palette.success } else { palette.warning };
    let mut command = None;
    card(ui, Some(accent), |ui| {
        if head(ui, shown, accent) {
            command = Some(Command::CloseArtefact);
        }
        let is_to_be_seen = !(is_brief && fixed);
        if is_to_be_seen && !narration.is_empty() {
            ui.add(Label::new(RichText::new(narration).strong()).wrap());
        }
        if !is_brief || narration.is_empty() {
            let text = if fixed { artefact.cure() } else { artefact.explanation() };
            ui.add(Label::new(text).wrap());
        }
        if !fixed && !is_brief {
            caption(ui, &format!("{} marks the wrong pixels.", keys_of(&Command::NextMarks)));
        }
        ui.add_space(2.0);
        if fixed {
            changes(ui, changed);
            if ui.add_sized([ui.available_width(), at_least(ui, 28.0)], Button::new("Show again")).clicked() {
                command = Some(Command::ShowArtefact(artefact));
            }
        } else if main_button(ui, "Fix", keys_of(&Command::FixArtefact), palette.success_fill)
            .on_hover_text(artefact.cure())
            .clicked()
        {
            command = Some(Command::FixArtefact);
        }
    });
    command
}

/// Shows the title of the card and its close button. Returns whether the button was clicked.
fn head(ui: &mut Ui, shown: &ShownArtefact<'_>, accent: Color32) -> bool {
    let label = shown.artefact.label();
    let title = if shown.fixed { format!("{label}: fixed") } else { label.to_owned() };
    ui.horizontal(|ui| {
        ui.label(RichText::new(title).color(accent));
        let close = |ui: &mut Ui| icon_button(ui, Icon::X, "Close the artefact", "Ends the demonstration.").clicked();
        ui.with_layout(Layout::right_to_left(Align::Center), close).inner
    })
    .inner
}

/// Shows the changes, a line each.
pub(crate) fn changes(ui: &mut Ui, changes: &[String]) {
    let has_arrows = has_arrows(ui);
    for change in changes {
        let change = if has_arrows { change.clone() } else { change.replace('→', "to") };
        caption(ui, &format!("• {change}"));
    }
}
