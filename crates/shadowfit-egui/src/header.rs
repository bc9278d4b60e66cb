//! The top of the panel: the scene, what can be undone, and what the application does with the whole.

use egui::{Align, Button, Label, Layout, Popup, RichText, Sense, TextStyle, ThemePreference, Ui, Vec2};

use crate::theme::Palette;
use crate::units::grouped;
use crate::widgets::{Icon, icon_button};
use crate::{Action, Changes, Panel, Part, SceneLine};

/// Title, buttons, scene and message.
pub(crate) fn show(
    ui: &mut Ui,
    panel: &Panel,
    scene: &SceneLine<'_>,
    changes: Changes<'_>,
    message: Option<&str>,
    action: &mut Option<Action>,
) {
    ui.horizontal(|ui| {
        ui.heading("Shadow tuning");
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.spacing_mut().item_spacing.x = 1.0;
            buttons(ui, panel, changes, action);
        });
    });
    let line = format!("{}, {} triangles", scene.name, grouped(scene.triangles));
    ui.add(Label::new(RichText::new(line).weak()).wrap());
    for note in scene.notes {
        ui.add(Label::new(RichText::new(note).color(ui.visuals().warn_fg_color)).wrap());
    }
    match message {
        Some(message) => ui.add(Label::new(RichText::new(message).color(Palette::of(ui).accent)).wrap()),
        // The line stays free, so that a message does not push what is below it.
        None => ui.allocate_response(Vec2::new(0.0, ui.text_style_height(&TextStyle::Body)), Sense::hover()),
    };
}

/// From the right to the left.
fn buttons(ui: &mut Ui, panel: &Panel, changes: Changes<'_>, action: &mut Option<Action>) {
    if icon_button(ui, Icon::Help, "Help", "Shows the table of the keys (H or F1).").clicked() {
        *action = Some(Action::OpenHelp);
    }
    if panel.has(Part::Theme) {
        theme_menu(ui, action);
    }
    if panel.has(Part::Screenshot)
        && icon_button(ui, Icon::Screenshot, "Screenshot", "Saves the picture (P).").clicked()
    {
        *action = Some(Action::Screenshot);
    }
    if panel.has(Part::Copy) {
        let items = [
            ("Copy as Rust code", "K", "Copies the technique as Rust code.", Action::CopyRust),
            (
                "Copy the command line",
                "",
                "Copies the command that starts with this scene and these settings.",
                Action::CopyCommandLine,
            ),
        ];
        menu(ui, Icon::Copy, "Copy", "Copies the settings, to use them elsewhere.", items, action);
    }
    let items = [
        ("Reset everything", "R", "Puts settings and camera back to where they began.", Action::Reset),
        ("Reset the camera", "", "Puts the camera back to where it began.", Action::ResetCamera),
    ];
    menu(ui, Icon::Reset, "Reset", "Goes back to where settings and camera began.", items, action);
    if panel.has(Part::Undo) {
        for (icon, name, key, what, asked) in [
            (Icon::Redo, "Redo", "Ctrl+Shift+Z", changes.redo, Action::Redo),
            (Icon::Undo, "Undo", "Ctrl+Z", changes.undo, Action::Undo),
        ] {
            let help =
                what.map_or_else(|| format!("Nothing to {}", name.to_lowercase()), |what| format!("{name}: {what}"));
            let help = format!("{help} ({key})");
            let button = ui.add_enabled_ui(what.is_some(), |ui| icon_button(ui, icon, name, &help));
            if button.inner.clicked() {
                *action = Some(asked);
            }
        }
    }
}

/// A button that opens a list of requests: name, key, help.
fn menu<const N: usize>(
    ui: &mut Ui,
    icon: Icon,
    name: &str,
    help: &str,
    items: [(&str, &str, &str, Action); N],
    action: &mut Option<Action>,
) {
    let button = icon_button(ui, icon, name, help);
    Popup::menu(&button).show(|ui| {
        for (label, key, help, asked) in items {
            let response = ui.add(Button::new(label).shortcut_text(key)).on_hover_text(help);
            crate::accessibility::rename(ui, &response, label.to_owned());
            if response.clicked() {
                *action = Some(asked);
            }
        }
    });
}

fn theme_menu(ui: &mut Ui, action: &mut Option<Action>) {
    let now = ui.ctx().options(|options| options.theme_preference);
    let button = icon_button(ui, Icon::Theme, "Theme", "Dark or light.");
    Popup::menu(&button).show(|ui| {
        for (label, theme) in [
            ("Dark", ThemePreference::Dark),
            ("Light", ThemePreference::Light),
            ("As the system", ThemePreference::System),
        ] {
            if ui.add(Button::selectable(theme == now, label)).clicked() {
                *action = Some(Action::SetTheme(theme));
            }
        }
    });
}
