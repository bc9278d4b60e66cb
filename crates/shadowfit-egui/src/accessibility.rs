//! What screen readers are told beyond what egui says by itself.

use egui::{Response, Ui};

/// Gives a widget another name for screen readers: for those that show no text of their own, such as sliders.
pub fn rename(ui: &Ui, response: &Response, name: String) {
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name));
}
