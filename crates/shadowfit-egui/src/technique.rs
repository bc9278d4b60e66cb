//! The menu of techniques by name: the presets, and the technique that the host opened.

use egui::text::LayoutJob;
use egui::{Button, ComboBox, Key, RectAlign, Response, TextEdit, TextFormat, TextStyle, Tooltip, Ui, Vec2};
use shadowfit::{PRESETS, Technique};

use crate::accessibility::rename;
use crate::widgets::{Icon, icon_button};
use crate::{Command, Toggle, UserPreset};

/// Help of the menu.
const HELP: &str = "Applies a named technique: sets all groups from Fit to Bias. Shadow distance, caster extension and \
                    resolution stay unchanged.";

/// Width of the open menu, in points: a summary takes one or two lines.
const WIDTH: f32 = 320.0;

/// Greatest share of the screen's height for the open menu.
const HEIGHT: f32 = 0.6;

/// Greatest number of characters in the name of a saved technique.
const MAX_NAME: usize = 40;

/// Name of a technique that was not chosen from the menu.
const CUSTOM: &str = "custom";

/// The names last chosen for A and B, and the technique that the host opened.
#[derive(Clone, Debug, Default)]
pub(crate) struct Menu {
    chosen: [String; 2],
    /// Side shown last.
    side: usize,
    opened: Option<(String, Technique)>,
    /// Name under which the technique is to be saved, while its field is shown.
    name: Option<String>,
}

/// A technique of the menu.
struct Entry<'a> {
    name: &'a str,
    summary: &'a str,
    advice: &'a str,
    technique: Technique,
    /// Whether the user saved it, and can delete it.
    is_saved: bool,
}

impl Menu {
    pub(crate) fn open(&mut self, name: String, technique: &Technique) {
        self.chosen[self.side].clone_from(&name);
        let is_it = |preset: &&shadowfit::Preset| of_scene(&preset.technique(), technique) == *technique;
        // The menu already has this preset.
        if !PRESETS.iter().filter(is_it).any(|preset| preset.name == name) {
            self.opened = Some((name, *technique));
        }
    }

    /// Swaps or copies the names, as the command will do with the techniques.
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
            advice: "Restores the technique as it was opened.",
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

    /// Shows the menu in a line. With `saved`, the techniques saved by name, a button saves the current one.
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
            let help = "Saves the technique under a name.";
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

    /// Shows the lines of the menu. Returns the chosen technique with its name.
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

    /// Shows the field for the name of the technique to save, if the user has asked for it.
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

    /// Returns the name of a technique that is not in the menu.
    fn changed(&self, side: usize) -> String {
        let chosen = &self.chosen[side];
        format!("{}, changed", if chosen.is_empty() { CUSTOM } else { chosen })
    }
}

/// Returns a technique with the shadow distance, the caster extension and the resolution of another one,
/// since they depend on the scene and the machine.
fn of_scene(technique: &Technique, other: &Technique) -> Technique {
    let [width, height] = other.fit.resolution.to_array();
    technique.with_lengths_of(other).with_resolution(width, height)
}

/// Shows a line of the menu, with a delete button if the user saved the technique. Returns whether it was
/// chosen.
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

/// Shows the name, and a short summary below it.
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
    // Beside the line, since below it the tooltip would cover the next lines.
    let mut tooltip = Tooltip::for_enabled(&response);
    tooltip.popup = tooltip.popup.align(RectAlign::LEFT_START);
    tooltip.show(|ui| ui.label(entry.advice));
    response
}
