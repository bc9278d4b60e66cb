//! The bar above the picture: scenes, views, comparison, undo and the other buttons that are always there.

use egui::{Button, Ui, containers::menu::MenuButton};
use shadowfit_classics::SAMPLES;
use shadowfit_egui::{Command, Toggle, keys_of, with_keys};
use shadowfit_scene::builtin::BuiltinScene;

use super::{InterfaceInput, InterfaceOutput};
use crate::source::SceneSource;
use crate::stage::Stage;

pub(super) fn show(ui: &mut Ui, stage: &mut Stage, input: &InterfaceInput<'_>, output: &mut InterfaceOutput) {
    egui::Panel::top("bar").show(ui, |ui| {
        ui.add_space(2.0);
        ui.horizontal_wrapped(|ui| {
            scenes(ui, input, output);
            ui.separator();
            if stage.draws_sample() {
                // Views and comparison are those of techniques.
                return;
            }
            shadowfit_egui::view_bar(ui, &mut stage.settings.view);
            ui.separator();
            let compare = Button::selectable(stage.is_comparing(), "A | B");
            let command = Command::Compare(Toggle::Switch);
            if ui.add(compare).on_hover_text(with_keys("Compares two techniques side by side", &command)).clicked() {
                output.commands.push(command);
            }
            let freeze = Button::selectable(stage.settings.view.freeze_fit, "Freeze");
            let help = "Keeps the shadow maps where they look now while the camera flies on";
            if ui.add(freeze).on_hover_text(with_keys(help, &Command::ToggleFreeze)).clicked() {
                output.commands.push(Command::ToggleFreeze);
            }
        });
        ui.add_space(2.0);
    });
}

/// The menu of scenes: built in, opened before, and from a file.
fn scenes(ui: &mut Ui, input: &InterfaceInput<'_>, output: &mut InterfaceOutput) {
    let open = |output: &mut InterfaceOutput, name: &str| output.commands.push(Command::Open(name.to_owned()));
    MenuButton::new("Scene").ui(ui, |ui| {
        for scene in BuiltinScene::ALL {
            if ui.button(scene.label()).on_hover_text(scene.help()).clicked() {
                open(output, scene.id());
            }
        }
        ui.separator();
        ui.menu_button("Classic techniques", |ui| {
            for sample in &SAMPLES {
                if ui.button(sample.title).on_hover_text(sample.teaches).clicked() {
                    open(output, sample.id);
                    ui.close();
                }
            }
        });
        ui.separator();
        if ui.add(Button::new("Open a glTF file…").shortcut_text(keys_of(&Command::ChooseFile))).clicked() {
            output.commands.push(Command::ChooseFile);
        }
        if !input.saved.recent.is_empty() {
            ui.separator();
            for path in &input.saved.recent {
                let source = SceneSource::file(path);
                if ui.button(source.label()).on_hover_text(source.text()).clicked() {
                    output.commands.push(Command::OpenFile(path.clone()));
                }
            }
        }
    });
}
