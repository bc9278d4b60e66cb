//! Two techniques, A | B: the side that the controls edit, and commands for both.

use egui::{Align, Button, Layout, RichText, Ui};

use crate::theme::Palette;
use crate::widgets::{Icon, icon_button, title};
use crate::{Command, Compare, Toggle, with_keys};

/// Shows the heading of the techniques, with a button that starts the comparison.
pub(crate) fn start(ui: &mut Ui, command: &mut Option<Command>) {
    ui.horizontal(|ui| {
        title(ui, "Technique");
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let help = "Shows two techniques beside each other; B starts with a preset";
            let help = with_keys(help, &Command::Compare(Toggle::Switch));
            if ui.button("Compare A | B").on_hover_text(help).clicked() {
                *command = Some(Command::Compare(Toggle::On));
            }
        });
    });
}

/// Shows the tabs of A and B.
pub(crate) fn tabs(ui: &mut Ui, compare: &mut Compare<'_>, command: &mut Option<Command>) {
    let palette = Palette::of(ui);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 3.0;
        for (name, is_other, color) in [("A", false, palette.accent), ("B", true, palette.second)] {
            let is_edited = *compare.edits_other == is_other;
            let text = format!("Technique {name}");
            let color = if is_edited { palette.on_accent } else { color };
            let button = Button::selectable(is_edited, RichText::new(&text).color(color)).frame_when_inactive(true);
            let response = ui.add_sized([100.0, ui.spacing().interact_size.y], button);
            if response.on_hover_text(format!("The controls edit technique {name}.")).clicked() {
                *compare.edits_other = is_other;
            }
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.spacing_mut().item_spacing.x = 1.0;
            let [from, to] = if *compare.edits_other { ["B", "A"] } else { ["A", "B"] };
            let copy = format!("Copy {from} to {to}");
            let stop = with_keys("Shows only A", &Command::Compare(Toggle::Switch));
            for (icon, name, help, asked) in [
                (Icon::X, "Stop comparing", stop.as_str(), Command::Compare(Toggle::Off)),
                (Icon::Copy, &copy, "Makes both techniques equal.", Command::CopyToOther),
                (Icon::ArrowLeftRight, "Swap A and B", "Swaps the two techniques.", Command::SwapSides),
            ] {
                if icon_button(ui, icon, name, &format!("{name}. {help}")).clicked() {
                    *command = Some(asked);
                }
            }
        });
    });
}
