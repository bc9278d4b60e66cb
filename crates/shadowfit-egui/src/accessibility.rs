//! Names for screen readers beyond egui's own.

use egui::{Response, Ui};

/// Gives a widget another name for screen readers, for widgets without a text, such as sliders.
pub fn rename(ui: &Ui, response: &Response, name: String) {
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name));
}
