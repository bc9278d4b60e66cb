//! The card of the search for settings with a lower error.

use egui::{Label, ProgressBar, RichText, Ui};
use shadowfit_params::figures::JudgedFigures;

use crate::theme::{Palette, has_arrows};
use crate::units::percent;
use crate::widgets::{at_least, caption, card, main_button, title};
use crate::{Command, Tune};

const HELP: &str = "Tries biases, filters and fits on this view, judges each against rays, and keeps the settings with \
                    the least error. Nothing changes until you apply them.";

/// Shows the card.
pub(crate) fn show(ui: &mut Ui, tune: &Tune<'_>, command: &mut Option<Command>) {
    let palette = Palette::of(ui);
    let accent = match tune {
        Tune::Idle => None,
        Tune::Running { .. } => Some(palette.accent),
        Tune::Done { .. } => Some(palette.success),
        Tune::Failed(_) => Some(palette.error),
    };
    card(ui, accent, |ui| match *tune {
        Tune::Idle => idle(ui, command),
        Tune::Running { tried, at_most, start_error, best_error, what } => {
            title(ui, "Auto-tune: searching").on_hover_text(HELP);
            progress(ui, tried as f32 / at_most.max(1) as f32);
            if start_error.is_finite() {
                ui.label(RichText::new(from_to(ui, start_error, best_error)).strong());
                caption(ui, &format!("{tried} of at most {at_most} tried; now {what}"));
            } else {
                caption(ui, what);
            }
            if ui.button("Cancel").on_hover_text("Ends the search and keeps its best result.").clicked() {
                *command = Some(Command::CancelTune);
            }
        }
        Tune::Done { before, after, changes, is_applied } => done(ui, &before, &after, changes, is_applied, command),
        Tune::Failed(reason) => {
            ui.label(RichText::new("Auto-tune failed").color(palette.error));
            ui.add(Label::new(reason).wrap());
            start(ui, "Try again", command);
        }
    });
}

fn idle(ui: &mut Ui, command: &mut Option<Command>) {
    ui.horizontal(|ui| {
        ui.vertical(|ui| {
            ui.set_width(ui.available_width() - 110.0);
            title(ui, "Auto-tune").on_hover_text(HELP);
            caption(ui, "Finds the settings with the least error in this view.");
        });
        start(ui, "Auto-tune", command);
    });
}

/// Shows the progress bar of a search. `share` is the finished share, 0..=1.
fn progress(ui: &mut Ui, share: f32) {
    let bar = ProgressBar::new(share).desired_height(8.0).fill(Palette::of(ui).accent_fill);
    let response = ui.add(bar);
    crate::accessibility::rename(ui, &response, "Progress of the search".to_owned());
}

fn done(
    ui: &mut Ui,
    before: &JudgedFigures,
    after: &JudgedFigures,
    changes: &[String],
    is_applied: bool,
    command: &mut Option<Command>,
) {
    let palette = Palette::of(ui);
    let is_better = !changes.is_empty();
    let text = match (is_better, is_applied) {
        (false, _) => "Auto-tune: nothing better found",
        (true, false) => "Auto-tune: better settings found",
        (true, true) => "Auto-tune: applied",
    };
    ui.label(RichText::new(text).color(palette.success));
    ui.label(RichText::new(format!("Wrong pixels {}", from_to(ui, before.wrong, after.wrong))).strong());
    caption(ui, &format!("Light error {}", from_to(ui, before.light_error, after.light_error)));
    crate::artefact_card::changes(ui, changes);
    ui.add_space(2.0);
    if is_better && !is_applied {
        ui.columns_const(|[apply, discard]: &mut [Ui; 2]| {
            if main_button(apply, "Apply", "", palette.accent_fill).clicked() {
                *command = Some(Command::ApplyTune);
            }
            close(discard, "Discard", command);
        });
    } else {
        ui.columns_const(|[again, discard]: &mut [Ui; 2]| {
            let button = wide(again, "Tune again");
            if button.on_hover_text(format!("{HELP} (T)")).clicked() {
                *command = Some(Command::StartTune);
            }
            close(discard, "Close", command);
        });
    }
}

fn from_to(ui: &Ui, from: f32, to: f32) -> String {
    let arrow = if has_arrows(ui) { "→" } else { "to" };
    format!("{} {arrow} {}", percent(from), percent(to))
}

fn start(ui: &mut Ui, text: &str, command: &mut Option<Command>) {
    let fill = Palette::of(ui).accent_fill;
    if main_button(ui, text, "T", fill).on_hover_text(HELP).clicked() {
        *command = Some(Command::StartTune);
    }
}

fn close(ui: &mut Ui, text: &str, command: &mut Option<Command>) {
    if wide(ui, text).on_hover_text("Discards the result of the search; the settings stay.").clicked() {
        *command = Some(Command::DiscardTune);
    }
}

fn wide(ui: &mut Ui, text: &str) -> egui::Response {
    let size = [ui.available_width(), at_least(ui, 28.0)];
    ui.add_sized(size, egui::Button::new(text))
}
