//! The bar above the picture: scenes, views, comparison, and other buttons that are always shown.

use egui::{Align, Button, Layout, Ui, containers::menu::MenuButton};
use shadowfit_classics::SAMPLES;
use shadowfit_egui::{Command, Icon, Toggle, keys_of, named_icon_button, with_keys};
use shadowfit_params::tool::{ErrorMarks, InsetMaps};
use shadowfit_scene::SceneSun;
use shadowfit_scene::builtin::BuiltinScene;

use super::{InterfaceInput, InterfaceOutput};
use crate::scene_source::SceneSource;
use crate::stage::Stage;

pub(super) fn show(ui: &mut Ui, stage: &mut Stage, input: &InterfaceInput<'_>, output: &mut InterfaceOutput) {
    egui::Panel::top("bar").show(ui, |ui| {
        ui.add_space(2.0);
        ui.horizontal_wrapped(|ui| {
            scenes(ui, stage, input, output);
            ui.separator();
            if stage.draws_sample() {
                // Views and comparison only apply to techniques.
                return;
            }
            let no_compute = stage.no_compute();
            shadowfit_egui::view_bar(ui, &mut stage.settings.view, no_compute);
            ui.separator();
            let compare = Button::selectable(stage.is_comparing(), "A | B");
            let command = Command::Compare(Toggle::Switch);
            if ui.add(compare).on_hover_text(with_keys("Compares two techniques side by side", &command)).clicked() {
                output.commands.push(command);
            }
            let freeze = Button::selectable(stage.settings.view.freeze_fit, "Freeze");
            let help = "Keeps the current shadow maps while the camera flies on";
            if ui.add(freeze).on_hover_text(with_keys(help, &Command::ToggleFreeze)).clicked() {
                output.commands.push(Command::ToggleFreeze);
            }
        });
        ui.add_space(2.0);
    });
}

/// Returns the least width at which the whole bar fits into a line, in points. Fingers need more.
pub(super) const fn least_width(is_touched: bool) -> f32 {
    if is_touched { 1200.0 } else { 1000.0 }
}

/// Shows the bar of a narrow window, with the less used buttons in a menu. Returns whether to open the panel.
/// The button for that is shown if `has_drawer`.
pub(super) fn show_narrow(
    ui: &mut Ui,
    stage: &mut Stage,
    input: &InterfaceInput<'_>,
    output: &mut InterfaceOutput,
    has_drawer: bool,
) -> bool {
    let mut opens = false;
    egui::Panel::top("bar").show(ui, |ui| {
        ui.add_space(2.0);
        ui.horizontal(|ui| {
            scenes(ui, stage, input, output);
            if !stage.draws_sample() {
                let no_compute = stage.no_compute();
                shadowfit_egui::view_menu(ui, &mut stage.settings.view, no_compute);
            }
            more(ui, stage, output);
            if has_drawer {
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    let help = "Opens the panel: quality, technique and all settings";
                    opens = named_icon_button(ui, Icon::SlidersHorizontal, "Tune", help).clicked();
                });
            }
        });
        ui.add_space(2.0);
    });
    opens
}

/// Shows the buttons that do not fit into a narrow bar.
fn more(ui: &mut Ui, stage: &Stage, output: &mut InterfaceOutput) {
    let view = &stage.settings.view;
    let of_techniques = [
        ("Compare A | B", stage.is_comparing(), Command::Compare(Toggle::Switch)),
        ("Freeze", view.freeze_fit, Command::ToggleFreeze),
        ("Mark wrong pixels", view.marks != ErrorMarks::Off, Command::NextMarks),
        ("Shadow map inset", view.inset != InsetMaps::Off, Command::NextInset),
    ];
    let always = [
        ("Screenshot", false, Command::Screenshot(None)),
        ("Copy a link", false, Command::CopyLink),
        ("Help", false, Command::ToggleHelp),
        ("Check this GPU…", false, Command::CheckDevice),
    ];
    MenuButton::new("More").ui(ui, |ui| {
        let count = if stage.draws_sample() { 0 } else { of_techniques.len() };
        for (name, is_on, command) in of_techniques.into_iter().take(count).chain(always) {
            if ui.add(Button::selectable(is_on, name)).clicked() {
                output.commands.push(command);
            }
        }
    });
}

/// Shows the menu of scenes: built-in, recent, and from a file, with the cameras and suns of the current
/// file.
fn scenes(ui: &mut Ui, stage: &Stage, input: &InterfaceInput<'_>, output: &mut InterfaceOutput) {
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
        if !stage.draws_sample() {
            of_the_file(ui, stage, output);
        }
    });
}

/// Shows the menus of the file's cameras and suns, if it has any.
fn of_the_file(ui: &mut Ui, stage: &Stage, output: &mut InterfaceOutput) {
    let (scene, settings) = (stage.scene(), &stage.settings);
    if scene.subject.is_some() || (scene.cameras.is_empty() && scene.suns.is_empty()) {
        return;
    }
    ui.separator();
    let cameras = scene.cameras.iter().map(|camera| camera.name.clone()).collect();
    let lux = |sun: &SceneSun| format!("{} ({:.3} lx)", sun.name, sun.strength()).trim_start().to_owned();
    let camera = FileMenu {
        title: "Camera of the file",
        id: "camera.file",
        names: cameras,
        chosen: settings.camera.file,
        none: "Free flight",
        none_id: "free",
    };
    let sun = FileMenu {
        title: "Sun of the file",
        id: "light.file",
        names: scene.suns.iter().map(lux).collect(),
        chosen: settings.light.file,
        none: "By hand",
        none_id: "by_hand",
    };
    camera.show(ui, output);
    sun.show(ui, output);
}

/// A menu that sets a parameter to the number of a name, or unsets it.
struct FileMenu {
    title: &'static str,
    /// Id of the parameter.
    id: &'static str,
    /// The names, numbered from 1.
    names: Vec<String>,
    chosen: Option<u32>,
    /// Label and value of the unset state.
    none: &'static str,
    none_id: &'static str,
}

impl FileMenu {
    /// Shows the menu, unless its list of names is empty.
    fn show(&self, ui: &mut Ui, output: &mut InterfaceOutput) {
        if self.names.is_empty() {
            return;
        }
        ui.menu_button(self.title, |ui| {
            let numbered = self.names.iter().zip(1..).map(|(name, number)| (Some(number), format!("{number}  {name}")));
            for (number, label) in numbered.chain([(None, self.none.to_owned())]) {
                if ui.add(Button::selectable(number == self.chosen, label)).clicked() {
                    let value = number.map_or(self.none_id.to_owned(), |number: u32| number.to_string());
                    output.commands.push(Command::Set(self.id.to_owned(), value));
                    ui.close();
                }
            }
        });
    }
}
