//! The header of the panel: the scene, undo and redo, and commands for the whole application.

use egui::{Align, Button, Label, Layout, Popup, RichText, Sense, TextStyle, ThemePreference, Ui, Vec2};

use crate::theme::Palette;
use crate::units::grouped;
use crate::widgets::{Icon, icon_button};
use crate::{Changes, Command, Panel, Part, SceneLine, keys_of, with_keys};

/// Menu entry that opens the [check](crate::device_check_overlay).
const CHECK_THIS_GPU: &str = "Check this GPU…";

/// Shows title, buttons, scene and message.
pub(crate) fn show(
    ui: &mut Ui,
    panel: &Panel,
    scene: &SceneLine<'_>,
    changes: Changes<'_>,
    message: Option<&str>,
    command: &mut Option<Command>,
) {
    ui.horizontal(|ui| {
        ui.heading("Shadow tuning");
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.spacing_mut().item_spacing.x = 1.0;
            buttons(ui, panel, changes, command);
        });
    });
    let line = format!("{}, {} triangles", scene.name, grouped(scene.triangles));
    ui.add(Label::new(RichText::new(line).weak()).wrap());
    for note in scene.notes {
        ui.add(Label::new(RichText::new(note).color(ui.visuals().warn_fg_color)).wrap());
    }
    match message {
        Some(message) => ui.add(Label::new(RichText::new(message).color(Palette::of(ui).accent)).wrap()),
        // The line stays free, so that a message does not move the contents below it.
        None => ui.allocate_response(Vec2::new(0.0, ui.text_style_height(&TextStyle::Body)), Sense::hover()),
    };
}

/// Shows the buttons from right to left.
fn buttons(ui: &mut Ui, panel: &Panel, changes: Changes<'_>, command: &mut Option<Command>) {
    if panel.has(Part::DeviceCheck) {
        let check = "Compares this device's maps, look-ups and rays with the CPU's, in a minute or less on a GPU.";
        let items = [
            ("Table of keys", "Shows the table of keys.", Command::ToggleHelp),
            (CHECK_THIS_GPU, check, Command::CheckDevice),
        ];
        menu(ui, Icon::CircleQuestionMark, "Help", "Keys, and a check of this device.", items, command);
    } else {
        button(ui, Icon::CircleQuestionMark, "Help", "Shows the table of keys", Command::ToggleHelp, command);
    }
    if panel.has(Part::Theme) {
        theme_menu(ui, command);
    }
    if panel.has(Part::Screenshot) {
        button(ui, Icon::Camera, "Screenshot", "Saves the picture", Command::Screenshot(None), command);
    }
    if panel.has(Part::Copy) {
        let line = "Copies the command that starts with this scene and these settings.";
        let items = [
            ("Copy a link", "Copies a link to this scene, settings and camera.", Command::CopyLink),
            ("Copy as Rust code", "Copies the technique as Rust code.", Command::CopyRust),
            ("Copy the command line", line, Command::CopyCommandLine),
        ];
        menu(ui, Icon::Copy, "Copy", "Copies the settings for use elsewhere.", items, command);
    }
    let items = [
        ("Reset everything", "Restores the initial settings and camera.", Command::Reset),
        ("Reset the camera", "Restores the initial camera.", Command::ResetCamera),
    ];
    menu(ui, Icon::RotateCcw, "Reset", "Restores the initial settings or camera.", items, command);
    if panel.has(Part::Undo) {
        change_button(ui, Icon::Redo2, "Redo", changes.redo, Command::Redo, command);
        change_button(ui, Icon::Undo2, "Undo", changes.undo, Command::Undo, command);
    }
}

/// Shows a button that undoes or redoes a named change.
fn change_button(
    ui: &mut Ui,
    icon: Icon,
    name: &str,
    change: Option<&str>,
    asked: Command,
    command: &mut Option<Command>,
) {
    let help =
        change.map_or_else(|| format!("Nothing to {}", name.to_lowercase()), |change| format!("{name}: {change}"));
    ui.add_enabled_ui(change.is_some(), |ui| button(ui, icon, name, &help, asked, command));
}

/// Shows a button for a command, with the command's keys after its help.
fn button(ui: &mut Ui, icon: Icon, name: &str, help: &str, asked: Command, command: &mut Option<Command>) {
    if icon_button(ui, icon, name, &with_keys(help, &asked)).clicked() {
        *command = Some(asked);
    }
}

/// Shows a button that opens a list of commands, each with its name and help.
fn menu<const N: usize>(
    ui: &mut Ui,
    icon: Icon,
    name: &str,
    help: &str,
    items: [(&str, &str, Command); N],
    command: &mut Option<Command>,
) {
    let button = icon_button(ui, icon, name, help);
    Popup::menu(&button).show(|ui| {
        for (label, help, asked) in items {
            let response = ui.add(Button::new(label).shortcut_text(keys_of(&asked))).on_hover_text(help);
            crate::accessibility::rename(ui, &response, label.to_owned());
            if response.clicked() {
                *command = Some(asked);
            }
        }
    });
}

fn theme_menu(ui: &mut Ui, command: &mut Option<Command>) {
    let now = ui.ctx().options(|options| options.theme_preference);
    let button = icon_button(ui, Icon::Contrast, "Theme", "Dark or light.");
    Popup::menu(&button).show(|ui| {
        for (label, theme) in [
            ("Dark", ThemePreference::Dark),
            ("Light", ThemePreference::Light),
            ("As the system", ThemePreference::System),
        ] {
            if ui.add(Button::selectable(theme == now, label)).clicked() {
                *command = Some(Command::SetTheme(theme));
            }
        }
    });
}
