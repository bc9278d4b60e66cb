//! The menu of techniques by name: the presets, and the one that the host opened.

use egui::text::LayoutJob;
use egui::{Button, ComboBox, Key, RectAlign, Response, TextEdit, TextFormat, TextStyle, Tooltip, Ui, Vec2};
use shadowfit::{PRESETS, Technique};

use crate::accessibility::rename;
use crate::widgets::{Icon, icon_button};
use crate::{Command, Toggle, UserPreset};

/// What the menu does.
const HELP: &str = "Sets everything from Fit to Bias as a technique by name has it, and keeps shadow distance, \
                    caster extension and resolution as they are.";

/// Width of the open menu, in points: a summary takes one line or two.
const WIDTH: f32 = 320.0;

/// Most of the screen's height that the open menu takes.
const HEIGHT: f32 = 0.6;

/// Most characters of the name of a saved technique.
const MAX_NAME: usize = 40;

/// What a technique is called that was not chosen from the menu.
const CUSTOM: &str = "custom";

/// The names that were chosen last, of A and of B, and the technique that the host opened.
#[derive(Clone, Debug, Default)]
pub(crate) struct Menu {
    chosen: [String; 2],
    /// Which of both was shown last.
    side: usize,
    opened: Option<(String, Technique)>,
    /// The name that a technique is about to be saved under, while the field for it is shown.
    name: Option<String>,
}

/// A technique of the menu.
struct Entry<'a> {
    name: &'a str,
    summary: &'a str,
    advice: &'a str,
    technique: Technique,
    /// Whether a person saved it, and can delete it.
    is_saved: bool,
}

impl Menu {
    pub(crate) fn open(&mut self, name: String, technique: &Technique) {
        self.chosen[self.side].clone_from(&name);
        let is_it = |preset: &&shadowfit::Preset| of_scene(&preset.technique(), technique) == *technique;
        // A preset is in the menu already.
        if !PRESETS.iter().filter(is_it).any(|preset| preset.name == name) {
            self.opened = Some((name, *technique));
        }
    }

    /// Swaps or copies the names as a command is about to do with the techniques.
    pub(crate) fn follow(&mut self, command: &Command, edits_other: bool) {
        match command {
            Command::SwapSides => self.chosen.swap(0, 1),
            Command::Compare(Toggle::On) => self.copy_name(0),
            Command::CopyToOther => {
                self.copy_name(usize::from(edits_other));
            }
            _ => {}
        }
    }

    fn copy_name(&mut self, from: usize) {
        let [a, b] = &mut self.chosen;
        if from == 0 { b.clone_from(a) } else { a.clone_from(b) }
    }

    fn entries<'a>(&'a self, saved: &'a [UserPreset]) -> impl Iterator<Item = Entry<'a>> {
        let opened = self.opened.iter().map(|(name, technique)| Entry {
            name,
            summary: "as it was opened",
            advice: "Goes back to the technique that was opened.",
            technique: *technique,
            is_saved: false,
        });
        let saved = saved.iter().map(|preset| Entry {
            name: &preset.name,
            summary: "saved by you",
            advice: "A technique that you saved.",
            technique: preset.technique,
            is_saved: true,
        });
        let presets = PRESETS.iter().map(|preset| Entry {
            name: preset.name,
            summary: preset.summary,
            advice: preset.advice,
            technique: preset.technique(),
            is_saved: false,
        });
        opened.chain(saved).chain(presets)
    }

    /// The menu, as a line of its own; with `saved`, the techniques saved by name, a button saves this one too.
    pub(crate) fn show(
        &mut self,
        ui: &mut Ui,
        technique: &mut Technique,
        side: usize,
        saved: Option<&[UserPreset]>,
        command: &mut Option<Command>,
    ) {
        self.side = side;
        let now = *technique;
        let presets = saved.unwrap_or_default();
        let current = self.entries(presets).find(|entry| of_scene(&entry.technique, &now) == now);
        let name = current.as_ref().map(|entry| entry.name.to_owned());
        let help = match &current {
            Some(entry) => format!("{}: {}. {}\n\n{HELP}", entry.name, entry.summary, entry.advice),
            None => HELP.to_owned(),
        };
        if let Some(name) = &name {
            self.chosen[side].clone_from(name);
        }
        let title = name.clone().unwrap_or_else(|| self.changed(side));
        let mut chosen = None;
        ui.horizontal(|ui| {
            let width = ui.available_width() - if saved.is_some() { 30.0 } else { 0.0 };
            let height = HEIGHT * ui.ctx().content_rect().height();
            let list = ComboBox::from_id_salt("technique").width(width).height(height).selected_text(title).truncate();
            let list = list.show_ui(ui, |ui| chosen = self.list(ui, presets, name.as_deref(), command));
            rename(ui, &list.response, "Technique".to_owned());
            list.response.on_hover_text(help);
            let help = "Saves the technique under a name of its own.";
            if saved.is_some() && icon_button(ui, Icon::Save, "Save the technique", help).clicked() {
                self.name = if self.name.is_some() { None } else { Some(String::new()) };
            }
        });
        self.name_field(ui, command);
        if let Some((name, preset)) = chosen {
            self.chosen[side] = name;
            *technique = of_scene(&preset, &now);
        }
    }

    /// The lines of the menu. Returns the technique that was chosen, with its name.
    fn list(
        &self,
        ui: &mut Ui,
        presets: &[UserPreset],
        current: Option<&str>,
        command: &mut Option<Command>,
    ) -> Option<(String, Technique)> {
        ui.set_width(WIDTH);
        ui.spacing_mut().item_spacing.y = 0.0;
        ui.spacing_mut().button_padding.y = 1.0;
        let mut chosen = None;
        for entry in self.entries(presets) {
            if line(ui, &entry, current == Some(entry.name), command) {
                chosen = Some((entry.name.to_owned(), entry.technique));
            }
        }
        chosen
    }

    /// The field for the name that the technique is saved under, while it is asked for.
    fn name_field(&mut self, ui: &mut Ui, command: &mut Option<Command>) {
        let Some(name) = &mut self.name else { return };
        let mut is_done = false;
        ui.horizontal(|ui| {
            let width = ui.available_width() - 124.0;
            let field = TextEdit::singleline(name).hint_text("Name").char_limit(MAX_NAME).desired_width(width);
            let field = ui.add(field);
            rename(ui, &field, "Name of the technique".to_owned());
            let is_entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            let name = name.trim();
            let save = ui.add_enabled(!name.is_empty(), Button::new("Save"));
            if (save.clicked() || is_entered) && !name.is_empty() {
                *command = Some(Command::SavePreset(name.to_owned()));
                is_done = true;
            }
            is_done |= ui.button("Cancel").clicked();
        });
        if is_done {
            self.name = None;
        }
    }

    /// What a technique is called that is not in the menu.
    fn changed(&self, side: usize) -> String {
        let chosen = &self.chosen[side];
        format!("{}, changed", if chosen.is_empty() { CUSTOM } else { chosen })
    }
}

/// A technique with the shadow distance, the caster extension and the resolution of another one:
/// those depend on the scene and the machine.
fn of_scene(technique: &Technique, other: &Technique) -> Technique {
    let [width, height] = other.fit.resolution.to_array();
    technique.with_lengths_of(other).with_resolution(width, height)
}

/// A line of the menu, with a button that deletes it where a person saved it; returns whether it was chosen.
fn line(ui: &mut Ui, entry: &Entry<'_>, is_selected: bool, command: &mut Option<Command>) -> bool {
    if !entry.is_saved {
        return option(ui, entry, is_selected, ui.available_width()).clicked();
    }
    ui.horizontal(|ui| {
        let width = ui.available_width() - 30.0;
        let chosen = ui.vertical(|ui| option(ui, entry, is_selected, width).clicked());
        let name = format!("Delete {}", entry.name);
        if icon_button(ui, Icon::Trash2, &name, "Deletes this saved technique.").clicked() {
            *command = Some(Command::DeletePreset(entry.name.to_owned()));
        }
        chosen.inner
    })
    .inner
}

/// The name, and below it in a few words what it is.
fn option(ui: &mut Ui, entry: &Entry<'_>, is_selected: bool, width: f32) -> Response {
    let mut text = LayoutJob::default();
    let format =
        |style: TextStyle, color| TextFormat { font_id: style.resolve(ui.style()), color, ..Default::default() };
    let (strong, weak) = if is_selected {
        let on_fill = ui.visuals().selection.stroke.color;
        (on_fill, on_fill)
    } else {
        (ui.visuals().strong_text_color(), ui.visuals().weak_text_color())
    };
    text.append(entry.name, 0.0, format(TextStyle::Button, strong));
    text.append("\n", 0.0, TextFormat::default());
    text.append(entry.summary, 0.0, format(TextStyle::Small, weak));
    ui.set_max_width(width);
    let response = ui.add(Button::selectable(is_selected, text).wrap().min_size(Vec2::new(width, 0.0)));
    // Beside the line: below it, it would lie on the next ones.
    let mut tooltip = Tooltip::for_enabled(&response);
    tooltip.popup = tooltip.popup.align(RectAlign::LEFT_START);
    tooltip.show(|ui| ui.label(entry.advice));
    response
}
