//! The list of powers of two beside the width and the height of a map.

use std::ops::RangeInclusive;

use egui::{ComboBox, Ui};
use shadowfit_params::Parameter;

use crate::accessibility::rename;

/// Width of the closed list, in points, which shows only its triangle.
pub(super) const LIST_WIDTH: f32 = 38.0;

/// Returns whether a parameter is a width or a height of a map. Only these are in whole texels.
pub(super) fn is_side(parameter: &Parameter, decimals: usize) -> bool {
    parameter.unit == "texels" && decimals == 0
}

/// Shows a list of the powers of two within a range. Returns the chosen one.
pub(super) fn list(ui: &mut Ui, label: &str, value: f64, range: RangeInclusive<f64>) -> Option<f64> {
    let mut chosen = None;
    let list = ComboBox::from_id_salt("powers of two").width(LIST_WIDTH).selected_text("").show_ui(ui, |ui| {
        for side in (0..u32::BITS).map(|bit| f64::from(1_u32 << bit)).filter(|side| range.contains(side)) {
            if ui.selectable_label(side == value, format!("{side}")).clicked() {
                chosen = Some(side);
            }
        }
    });
    rename(ui, &list.response, format!("{label}: powers of two"));
    list.response.on_hover_text("The powers of two");
    chosen
}
