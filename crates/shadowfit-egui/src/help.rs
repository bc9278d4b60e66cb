//! The table of the keys.

use egui::{Align2, Context, Grid, RichText};

/// A line of the table of the keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeyHelp {
    /// The keys, as printed on them.
    pub keys: &'static str,
    /// What they do.
    pub does: &'static str,
}

const fn key(keys: &'static str, does: &'static str) -> KeyHelp {
    KeyHelp { keys, does }
}

/// The keys that a host of the panel answers, in the order that they are shown.
pub const KEYS: &[KeyHelp] = &[
    key("W A S D", "move"),
    key("Arrow keys", "look around"),
    key("Left mouse drag", "look around"),
    key("Q, E", "down, up"),
    key("Shift", "move fast"),
    key("Wheel", "flying speed"),
    key("Space", "play or pause"),
    key("1", "show acne"),
    key("2", "show aliasing"),
    key("3", "show a clipping hole"),
    key("F", "fix what is shown"),
    key("O", "outside view"),
    key("I", "shadow map inset"),
    key("L", "animate the sun"),
    key("R", "reset"),
    key("P", "screenshot"),
    key("Tab", "hide or show the panel"),
    key("H or F1", "this help"),
    key("Esc", "quit"),
    key("Left stick", "move (gamepad)"),
    key("Right stick", "look around (gamepad)"),
    key("Back", "quit (gamepad)"),
];

/// Width of the table, in points.
const WIDTH: f32 = 300.0;

/// More than the title bar of the table and its margins take, in points.
const TITLE_HEIGHT: f32 = 64.0;

/// Shows the table of the keys over everything else while `open`, and clears `open` when it is
/// closed.
pub fn help_overlay(ctx: &Context, open: &mut bool) {
    egui::Window::new("Keys")
        .open(open)
        .anchor(Align2::CENTER_CENTER, [0.0, 0.0])
        .resizable(false)
        .collapsible(false)
        .vscroll(true)
        .default_width(WIDTH)
        .default_height(ctx.content_rect().height())
        .max_height(ctx.content_rect().height() - TITLE_HEIGHT)
        .show(ctx, |ui| {
            let gap = 24.0;
            let half = 0.5 * (ui.available_width() - gap);
            Grid::new("keys").num_columns(2).min_col_width(half).spacing([gap, 2.0]).striped(true).show(ui, |ui| {
                for line in KEYS {
                    ui.label(RichText::new(line.keys).strong());
                    ui.label(line.does);
                    ui.end_row();
                }
            });
        });
}
