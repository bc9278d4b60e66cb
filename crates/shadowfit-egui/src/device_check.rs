//! The dialog of the device check: the summary sentence, a line for each check, and the report to copy.

use egui::{Align, Align2, Context, Id, Label, Layout, ProgressBar, RichText, ScrollArea, Ui, Vec2, Window};
use shadowfit_params::device_check::{CheckReport, CheckRow, CheckState};

use crate::Command;
use crate::theme::Palette;
use crate::widgets::{at_least, caption, main_button};

/// Width of the dialog if the window has room, in points.
const WIDTH: f32 = 760.0;

/// Least width at which the dialog shows results beside tolerances, in points.
const SIDE_BY_SIDE: f32 = 560.0;

/// Widths of the names at the left and the times at the right, in points.
const NAMES: f32 = 132.0;
const TIMES: f32 = 52.0;

/// Space between columns, in points.
const GAP: f32 = 16.0;

/// Distance of the dialog from the window's sides, in points.
const MARGIN: f32 = 12.0;

/// Upper limit of the height of title bar, sentence, buttons and margins, in points.
const AROUND: f32 = 210.0;

/// Duration of the confirmation that the report was copied, in seconds.
const COPIED: f64 = 2.0;

/// Title of the dialog.
const TITLE: &str = "Check this GPU";

/// Shows the report of a check over everything else. Returns the command of a clicked button: copy the
/// report, cancel the check, close the dialog, or check again.
pub fn device_check_overlay(ctx: &Context, report: &CheckReport) -> Option<Command> {
    let room = ctx.content_rect().size() - Vec2::splat(2.0 * MARGIN);
    let (mut command, mut is_open) = (None, true);
    Window::new(TITLE)
        .open(&mut is_open)
        .anchor(Align2::CENTER_CENTER, Vec2::ZERO)
        .resizable(false)
        .collapsible(false)
        .show(ctx, |ui| {
            ui.set_width(WIDTH.min(room.x - 2.0 * MARGIN));
            head(ui, report);
            heads(ui);
            let height = (room.y - AROUND).max(60.0);
            ScrollArea::vertical().max_height(height).show(ui, |ui| {
                for row in &report.rows {
                    line(ui, row);
                }
            });
            ui.separator();
            buttons(ui, report, &mut command);
        });
    if !is_open {
        command = Some(Command::CloseCheck);
    }
    command
}

/// Shows the device and the summary sentence.
fn head(ui: &mut Ui, report: &CheckReport) {
    let palette = Palette::of(ui);
    let fact = |name: &str| report.facts.iter().find(|fact| fact.0 == name).map_or("", |fact| fact.1.as_str());
    let device = if report.facts.is_empty() {
        "Opening a separate device".to_owned()
    } else {
        format!("{}, {}", fact("adapter"), fact("backend"))
    };
    ui.add(Label::new(RichText::new(device).weak()).wrap());
    let color = match (report.has_ended(), report.has_passed()) {
        (false, _) => palette.accent,
        (true, true) => palette.success,
        (true, false) => palette.error,
    };
    ui.add(Label::new(RichText::new(report.sentence()).color(color).heading()).wrap());
    if !report.has_ended() {
        let share = report.ended() as f32 / report.rows.len().max(1) as f32;
        let bar = ui.add(ProgressBar::new(share).desired_height(6.0).fill(palette.accent_fill));
        crate::accessibility::rename(ui, &bar, "Progress of the check".to_owned());
    }
    ui.add_space(4.0);
}

/// Returns whether the dialog shows results beside tolerances.
fn is_wide(ui: &Ui) -> bool {
    ui.available_width() >= SIDE_BY_SIDE
}

/// Shows the names of the columns.
fn heads(ui: &mut Ui) {
    if is_wide(ui) {
        let head = |text: &'static str| {
            move |ui: &mut Ui| {
                caption(ui, text);
            }
        };
        columns(ui, [&head("Check"), &head("Result"), &head("Tolerance"), &head("Time")]);
    }
}

/// Shows a check: its name and state, its result, its tolerance and its time.
fn line(ui: &mut Ui, row: &CheckRow) {
    ui.separator();
    if is_wide(ui) {
        let tolerance = |ui: &mut Ui| tolerance(ui, row.tolerance);
        return columns(ui, [&|ui| name(ui, row), &|ui| result(ui, row), &tolerance, &|ui| time(ui, row)]);
    }
    ui.horizontal(|ui| {
        name(ui, row);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| time(ui, row));
    });
    result(ui, row);
    tolerance(ui, &format!("Tolerance: {}", row.tolerance));
}

/// Shows four things beside each other, the last one aligned to the right.
fn columns(ui: &mut Ui, [first, second, third, last]: [&dyn Fn(&mut Ui); 4]) {
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        let half = (ui.available_width() - NAMES - TIMES - 3.0 * GAP) / 2.0;
        for (width, show) in [(NAMES, first), (half, second), (half, third)] {
            ui.vertical(|ui| {
                ui.set_width(width);
                ui.spacing_mut().item_spacing.y = 2.0;
                show(ui);
            });
        }
        ui.with_layout(Layout::right_to_left(Align::Min), last);
    });
}

fn name(ui: &mut Ui, row: &CheckRow) {
    let palette = Palette::of(ui);
    let color = match row.state {
        CheckState::Passed => palette.success,
        CheckState::Failed => palette.error,
        CheckState::Running => palette.accent,
        CheckState::Unavailable(_) => palette.warning,
        CheckState::Waiting | CheckState::NotRun(_) => palette.weak,
    };
    ui.add(Label::new(RichText::new(row.name).strong()).wrap()).on_hover_text(row.about);
    ui.label(RichText::new(row.state.word()).color(color));
}

fn result(ui: &mut Ui, row: &CheckRow) {
    let text = match &row.state {
        CheckState::Unavailable(reason) | CheckState::NotRun(reason) => RichText::new(reason),
        CheckState::Waiting | CheckState::Running => RichText::new(row.about).weak(),
        CheckState::Passed | CheckState::Failed => RichText::new(&row.found),
    };
    ui.add(Label::new(text).wrap());
}

fn tolerance(ui: &mut Ui, text: &str) {
    ui.add(Label::new(RichText::new(text).small().weak()).wrap());
}

fn time(ui: &mut Ui, row: &CheckRow) {
    if row.seconds > 0.0 {
        ui.label(RichText::new(format!("{:.1} s", row.seconds)).weak());
    }
}

fn buttons(ui: &mut Ui, report: &CheckReport, command: &mut Option<Command>) {
    let fill = Palette::of(ui).accent_fill;
    if report.has_ended() {
        caption(ui, "Please attach the report to issues about shadows on this device.");
    }
    let (copied_at, now) = (Id::unique("shadowfit report copied"), ui.input(|input| input.time));
    let is_copied = ui.data(|data| data.get_temp(copied_at)).is_some_and(|at: f64| now - at < COPIED);
    ui.columns_const(|[copy, again, close]: &mut [Ui; 3]| {
        copy.add_enabled_ui(report.has_ended(), |ui| {
            if main_button(ui, if is_copied { "Copied" } else { "Copy report" }, "", fill).clicked() {
                *command = Some(Command::CopyCheck);
                ui.data_mut(|data| data.insert_temp(copied_at, now));
                ui.ctx().request_repaint_after_secs(COPIED as f32);
            }
        });
        let (label, asked) =
            if report.has_ended() { ("Check again", Command::CheckDevice) } else { ("Cancel", Command::CancelCheck) };
        if wide(again, label).clicked() {
            *command = Some(asked);
        }
        if wide(close, "Close").clicked() {
            *command = Some(Command::CloseCheck);
        }
    });
}

fn wide(ui: &mut Ui, text: &str) -> egui::Response {
    let size = [ui.available_width(), at_least(ui, 28.0)];
    ui.add_sized(size, egui::Button::new(text))
}
