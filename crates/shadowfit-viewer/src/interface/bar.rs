//! The bar above the picture: scenes, views, comparison, undo and the rest of what is always at hand.

use egui::{Button, Ui, containers::menu::MenuButton};
use shadowfit_classics::SAMPLES;
use shadowfit_scene::builtin::BuiltinScene;

use super::{Asked, Shows};
use crate::command::{Command, Toggle};
use crate::source::SceneSource;
use crate::stage::Stage;

pub(super) fn show(ui: &mut Ui, stage: &mut Stage, shows: &Shows<'_>, asked: &mut Asked) {
    egui::Panel::top("bar").show(ui, |ui| {
        ui.add_space(2.0);
        ui.horizontal_wrapped(|ui| {
            scenes(ui, shows, asked);
            ui.separator();
            if stage.draws_sample() {
                // Views and comparison are those of techniques.
                return;
            }
            shadowfit_egui::view_bar(ui, &mut stage.settings.view);
            ui.separator();
            let compare = Button::selectable(stage.is_comparing(), "A | B");
            let help = "Compares two techniques side by side (B)";
            if ui.add(compare).on_hover_text(help).clicked() {
                asked.commands.push(Command::Compare(Toggle::Other));
            }
            let freeze = Button::selectable(stage.settings.view.freeze_fit, "Freeze");
            let help = "Keeps the shadow maps where they look now while the camera flies on (G)";
            if ui.add(freeze).on_hover_text(help).clicked() {
                asked.commands.push(Command::ToggleFreeze);
            }
        });
        ui.add_space(2.0);
    });
}

/// The menu of scenes: built in, opened before, and from a file.
fn scenes(ui: &mut Ui, shows: &Shows<'_>, asked: &mut Asked) {
    let open = |asked: &mut Asked, source| asked.commands.push(Command::Open(source));
    MenuButton::new("Scene").ui(ui, |ui| {
        for scene in BuiltinScene::ALL {
            if ui.button(scene.label()).on_hover_text(scene.help()).clicked() {
                open(asked, SceneSource::BuiltIn(scene));
            }
        }
        ui.separator();
        ui.menu_button("Classic techniques", |ui| {
            for sample in &SAMPLES {
                if ui.button(sample.title).on_hover_text(sample.teaches).clicked() {
                    open(asked, SceneSource::Sample { sample, variant: None });
                    ui.close();
                }
            }
        });
        ui.separator();
        if ui.add(Button::new("Open a glTF file…").shortcut_text("Ctrl+O")).clicked() {
            asked.commands.push(Command::ChooseFile);
        }
        if !shows.saved.recent.is_empty() {
            ui.separator();
            for path in &shows.saved.recent {
                let source = SceneSource::file(path);
                if ui.button(source.label()).on_hover_text(source.text()).clicked() {
                    open(asked, source);
                }
            }
        }
    });
}
