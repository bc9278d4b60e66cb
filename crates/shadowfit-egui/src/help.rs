//! The table of keys, shown over the window.

use egui::{Align2, Context, Grid, InputState, RichText, ScrollArea, Ui, Vec2, Window};

use crate::keys::TOUCH;
use crate::widgets::caption;
use crate::{KEYS, KeyGroup};

/// Number of groups of [`KEYS`] in each column.
const COLUMNS: [usize; 3] = [2, 3, 4];

/// Width of a column, in points.
const COLUMN: f32 = 300.0;

/// Space between columns, in points.
const GAP: f32 = 24.0;

/// Upper limit of the height of the table's title bar and margins, in points.
const TITLE_HEIGHT: f32 = 80.0;

/// Shows the table of keys over everything else while `open`, and clears `open` when it is closed. The table
/// has three columns if the window is wide enough, else one. In one column, touch gestures come first on
/// touch screens.
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
            // These lines hold only text.
            ui.spacing_mut().interact_size.y = 0.0;
            ScrollArea::vertical()
                .max_height(room.y - TITLE_HEIGHT)
                .min_scrolled_height(room.y - TITLE_HEIGHT)
                .show(ui, |ui| if is_wide { columns(ui) } else { one_column(ui) });
        });
}

fn columns(ui: &mut Ui) {
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        let mut rest = KEYS.as_slice();
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

fn one_column(ui: &mut Ui) {
    let mut groups = KEYS.clone();
    if ui.input(InputState::has_touch_screen) {
        groups.sort_by_key(|group| group.heading != TOUCH);
    }
    column(ui, &groups);
}

fn column(ui: &mut Ui, groups: &[KeyGroup]) {
    /// Width of the keys, in points.
    const KEY_WIDTH: f32 = 112.0;
    for group in groups {
        caption(ui, group.heading);
        Grid::new(group.heading).num_columns(2).min_col_width(KEY_WIDTH).spacing([12.0, 5.0]).show(ui, |ui| {
            for line in &group.keys {
                ui.label(RichText::new(line.keys).strong());
                ui.label(&*line.does);
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
    fn the_columns_hold_every_group() {
        assert_eq!(COLUMNS.iter().sum::<usize>(), KEYS.len());
    }
}
