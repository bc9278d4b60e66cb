//! The bar of views above the picture.

use egui::containers::menu::MenuButton;
use egui::{Button, Response, RichText, Ui};
use shadowfit_params::tool::{ViewMode, ViewSettings};
use shadowfit_params::{ChoiceOption, view_option};

use crate::accessibility::rename;
use crate::command::VIEW_KEYS;
use crate::theme::Palette;

/// Shows a button for each view, with its name and its key, 1..=9 and 0 in the order of [`ViewMode::ALL`].
/// The chosen view is filled, and the bar wraps if it is too wide. If the device has no compute shaders, pass
/// the reason as `no_compute`, which disables the views that need them. Returns the response of the whole
/// bar, which is [changed](Response::changed) when another view was chosen.
pub fn view_bar(ui: &mut Ui, view: &mut ViewSettings, no_compute: Option<&str>) -> Response {
    let before = view.mode;
    let mut bar = ui
        .horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = egui::Vec2::splat(3.0);
            ui.spacing_mut().button_padding.x = 6.0;
            for (key, mode) in VIEW_KEYS.into_iter().zip(ViewMode::ALL) {
                let refused = no_compute.filter(|_| mode.needs_compute());
                if button(ui, view_option(mode), key, refused, mode == view.mode).clicked() {
                    view.mode = mode;
                }
            }
        })
        .response;
    if view.mode != before {
        bar.mark_changed();
    }
    bar
}

/// Shows the views as a menu, for places that are too small for [`view_bar`]; `no_compute` is the same as
/// there. Returns the response of its button, which is [changed](Response::changed) when another view was
/// chosen.
pub fn view_menu(ui: &mut Ui, view: &mut ViewSettings, no_compute: Option<&str>) -> Response {
    let before = view.mode;
    let (mut response, _) = MenuButton::new(view_option(view.mode).label).ui(ui, |ui| {
        for mode in ViewMode::ALL {
            let chosen = Button::selectable(mode == view.mode, view_option(mode).label);
            let refused = no_compute.filter(|_| mode.needs_compute());
            let response = ui.add_enabled(refused.is_none(), chosen).on_hover_text(view_option(mode).help);
            let response = response.on_disabled_hover_text(refused.unwrap_or_default());
            rename(ui, &response, format!("View: {}", view_option(mode).label));
            if response.clicked() {
                view.mode = mode;
            }
        }
    });
    rename(ui, &response, "Views".to_owned());
    if view.mode != before {
        response.mark_changed();
    }
    response
}

/// Shows the button of a view. `refused` is the reason why the view cannot be chosen, if there is one.
fn button(ui: &mut Ui, option: &ChoiceOption, key: &str, refused: Option<&str>, is_selected: bool) -> Response {
    let palette = Palette::of(ui);
    let weak = if is_selected { palette.on_accent } else { palette.weak };
    let name = RichText::new(option.label);
    let key_text = RichText::new(key).small().color(weak);
    let button = Button::selectable(is_selected, (name, key_text)).frame_when_inactive(true);
    let response = ui.add_enabled(refused.is_none(), button).on_hover_text(format!("{} ({key})", option.help));
    let response = response.on_disabled_hover_text(refused.unwrap_or_default());
    rename(ui, &response, format!("View: {}", option.label));
    response
}
