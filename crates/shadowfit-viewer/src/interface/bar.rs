//! The bar above the picture: scenes, views, comparison, undo and the other buttons that are always there.

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
                // Views and comparison are those of techniques.
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
            let help = "Keeps the shadow maps where they look now while the camera flies on";
            if ui.add(freeze).on_hover_text(with_keys(help, &Command::ToggleFreeze)).clicked() {
                output.commands.push(Command::ToggleFreeze);
            }
        });
        ui.add_space(2.0);
    });
}

/// Least width at which the whole bar fits a line, in points; fingers need more.
pub(super) const fn least_width(is_touched: bool) -> f32 {
    if is_touched { 1200.0 } else { 1000.0 }
}

/// The bar of a narrow window: the less used buttons are in a menu. Returns whether the panel is to be opened, by a
/// button that is there if it `has_drawer`.
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

/// The buttons that a narrow bar has no room for.
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

/// The menu of scenes: built in, opened before, and from a file, with the cameras and suns of the file on show.
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

/// The menus of the file's cameras and suns, where it has any.
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

/// A menu that sets a parameter to the number of a name, or to none.
struct FileMenu {
    title: &'static str,
    /// Id of the parameter.
    id: &'static str,
    /// The names, numbered from 1.
    names: Vec<String>,
    chosen: Option<u32>,
    /// Label and value of no number.
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
