//! The table of the keys.

use egui::{Align2, Context, Grid, RichText, ScrollArea, Ui, Vec2, Window};

use crate::widgets::caption;

/// Keys that belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeyGroup {
    /// What they are about.
    pub heading: &'static str,
    /// The keys, in the order that they are shown.
    pub keys: &'static [KeyHelp],
}

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
pub const KEYS: &[KeyGroup] = &[
    KeyGroup {
        heading: "Fly",
        keys: &[
            key("W A S D", "move"),
            key("Q, E", "down, up"),
            key("Arrow keys", "look around"),
            key("Left mouse drag", "look around"),
            key("Double click", "focus on what is there"),
            key("Shift", "move fast"),
            key("Wheel", "flying speed"),
        ],
    },
    KeyGroup {
        heading: "Views",
        keys: &[
            key("1", "final picture"),
            key("2", "truth, by rays"),
            key("3", "errors"),
            key("4", "pixels per texel"),
            key("5", "maps"),
            key("6", "texel grid"),
            key("7", "need"),
            key("8", "map updates"),
            key("9", "outside"),
        ],
    },
    KeyGroup {
        heading: "Artefacts",
        keys: &[
            key("Z", "show acne"),
            key("X", "show aliasing"),
            key("C", "show a clipping hole"),
            key("F", "fix what is shown"),
            key("T", "auto-tune"),
        ],
    },
    KeyGroup {
        heading: "Picture",
        keys: &[
            key("B", "compare A | B"),
            key("M", "mark wrong pixels"),
            key("I", "shadow map inset"),
            key("O", "outside view"),
            key("G", "freeze the fit"),
            key("L", "animate the sun"),
            key("Space", "play or pause"),
        ],
    },
    KeyGroup {
        heading: "Bookmarks",
        keys: &[key("Ctrl+1 … 9", "go to a bookmark"), key("Ctrl+Shift+1 … 9", "set a bookmark")],
    },
    KeyGroup {
        heading: "Settings and files",
        keys: &[
            key("Ctrl+Z", "undo"),
            key("Ctrl+Shift+Z or Ctrl+Y", "redo"),
            key("R", "reset"),
            key("K", "copy as Rust code"),
            key("P", "screenshot"),
            key("Ctrl+O", "open a scene"),
        ],
    },
    KeyGroup {
        heading: "Window",
        keys: &[
            key("Tab", "hide or show the panel"),
            key("H or F1", "this help"),
            key("Esc", "close a menu or this help; else quit"),
            key("Ctrl+Q", "quit"),
        ],
    },
    KeyGroup {
        heading: "Gamepad",
        keys: &[
            key("Left stick", "move"),
            key("Right stick", "look around, click: first view"),
            key("Triggers", "down, up"),
            key("Back", "quit"),
        ],
    },
];

/// Which groups of [`KEYS`] stand below each other, by their number in each column.
const COLUMNS: [usize; 3] = [2, 3, 3];

/// Width of a column, in points.
const COLUMN: f32 = 300.0;

/// Space between columns, in points.
const GAP: f32 = 24.0;

/// More than the title bar of the table and its margins take, in points.
const TITLE_HEIGHT: f32 = 80.0;

/// Shows the table of the keys over everything else while `open`, and clears `open` when it is closed. It has three
/// columns where the window is wide enough, else one.
pub fn help_overlay(ctx: &Context, open: &mut bool) {
    let room = ctx.content_rect().size();
    let width = COLUMN * COLUMNS.len() as f32 + GAP * (COLUMNS.len() as f32 - 1.0);
    let is_wide = room.x >= width + 2.0 * GAP;
    Window::new("Keys")
        .open(open)
        .anchor(Align2::CENTER_CENTER, Vec2::ZERO)
        .resizable(false)
        .collapsible(false)
        .default_width(if is_wide { width } else { COLUMN })
        .show(ctx, |ui| {
            // Lines of text alone.
            ui.spacing_mut().interact_size.y = 0.0;
            ScrollArea::vertical()
                .max_height(room.y - TITLE_HEIGHT)
                .min_scrolled_height(room.y - TITLE_HEIGHT)
                .show(ui, |ui| if is_wide { columns(ui) } else { column(ui, KEYS) });
        });
}

fn columns(ui: &mut Ui) {
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        let mut rest = KEYS;
        for count in COLUMNS {
            let (groups, after) = rest.split_at(count);
            rest = after;
            ui.vertical(|ui| {
                ui.set_width(COLUMN);
                column(ui, groups);
            });
        }
    });
}

fn column(ui: &mut Ui, groups: &[KeyGroup]) {
    /// Width of the keys, in points.
    const KEY_WIDTH: f32 = 112.0;
    for group in groups {
        caption(ui, group.heading);
        Grid::new(group.heading).num_columns(2).min_col_width(KEY_WIDTH).spacing([12.0, 5.0]).show(ui, |ui| {
            for line in group.keys {
                ui.label(RichText::new(line.keys).strong());
                ui.label(line.does);
                ui.end_row();
            }
        });
        ui.add_space(12.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_columns_hold_every_group_and_no_key_has_two_meanings() {
        assert_eq!(COLUMNS.iter().sum::<usize>(), KEYS.len());
        let mut keys: Vec<&str> = KEYS.iter().flat_map(|group| group.keys).map(|line| line.keys).collect();
        keys.sort_unstable();
        let count = keys.len();
        keys.dedup();
        assert_eq!(keys.len(), count);
    }
}
