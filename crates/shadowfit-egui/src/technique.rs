//! The menu of techniques by name: the presets, and the one that the host opened.

use egui::text::LayoutJob;
use egui::{Button, ComboBox, RectAlign, Response, TextFormat, TextStyle, Tooltip, Ui};
use shadowfit::{PRESETS, Technique};

use crate::rows;

/// What the menu does.
const HELP: &str = "Sets everything from Fit to Single maps as a technique by name has it, and keeps shadow distance, \
                    caster extension and resolution as they are.";

/// Width of the open menu, in points: a summary takes one line or two.
const WIDTH: f32 = 320.0;

/// Most of the screen's height that the open menu takes.
const HEIGHT: f32 = 0.6;

/// What a technique is called that was not chosen from the menu.
const CUSTOM: &str = "custom";

/// The name that was chosen last, and the technique that the host opened.
#[derive(Clone, Debug, Default)]
pub(crate) struct Menu {
    chosen: String,
    opened: Option<(String, Technique)>,
}

/// A technique of the menu.
struct Entry<'a> {
    name: &'a str,
    summary: &'a str,
    advice: &'a str,
    technique: Technique,
}

impl Menu {
    pub(crate) fn open(&mut self, name: String, technique: &Technique) {
        self.chosen.clone_from(&name);
        self.opened = Some((name, *technique));
    }

    fn entries(&self) -> impl Iterator<Item = Entry<'_>> {
        let opened = self.opened.iter().map(|(name, technique)| Entry {
            name,
            summary: "as it was opened",
            advice: "Goes back to the technique that was opened.",
            technique: *technique,
        });
        let presets = PRESETS.iter().map(|preset| Entry {
            name: preset.name,
            summary: preset.summary,
            advice: preset.advice,
            technique: preset.technique(),
        });
        opened.chain(presets)
    }

    /// The menu, as a row of its own.
    pub(crate) fn show(&mut self, ui: &mut Ui, technique: &mut Technique) {
        let now = *technique;
        let current = self.entries().find(|entry| of_scene(entry.technique, &now) == now);
        let name = current.as_ref().map(|entry| entry.name.to_owned());
        let help = match &current {
            Some(entry) => format!("{}: {}. {}\n\n{HELP}", entry.name, entry.summary, entry.advice),
            None => HELP.to_owned(),
        };
        if let Some(name) = &name {
            self.chosen.clone_from(name);
        }
        let title = name.clone().unwrap_or_else(|| self.changed());
        let mut chosen = None;
        ui.horizontal(|ui| {
            let label = rows::label(ui, "Technique").on_hover_text(&help);
            let width = ui.available_width();
            let height = HEIGHT * ui.ctx().content_rect().height();
            let list = ComboBox::from_id_salt("technique").width(width).height(height).selected_text(title);
            let list = list.show_ui(ui, |ui| {
                ui.set_width(WIDTH);
                ui.spacing_mut().item_spacing.y = 0.0;
                ui.spacing_mut().button_padding.y = 1.0;
                for entry in self.entries() {
                    if option(ui, &entry, name.as_deref() == Some(entry.name)).clicked() {
                        chosen = Some((entry.name.to_owned(), entry.technique));
                    }
                }
            });
            list.response.labelled_by(label.id).on_hover_text(help);
        });
        if let Some((name, preset)) = chosen {
            self.chosen = name;
            *technique = of_scene(preset, &now);
        }
    }

    /// What a technique is called that is not in the menu.
    fn changed(&self) -> String {
        format!("{}, changed", if self.chosen.is_empty() { CUSTOM } else { &self.chosen })
    }
}

/// A technique with the shadow distance, the caster extension and the resolution of another one:
/// those depend on the scene and the machine.
fn of_scene(mut technique: Technique, other: &Technique) -> Technique {
    technique.fit.max_distance = other.fit.max_distance;
    technique.fit.caster_extension = other.fit.caster_extension;
    technique.fit.resolution = other.fit.resolution;
    technique
}

/// A line of the menu: the name, and below it in a few words what it is.
fn option(ui: &mut Ui, entry: &Entry<'_>, is_selected: bool) -> Response {
    let mut text = LayoutJob::default();
    let format =
        |style: TextStyle, color| TextFormat { font_id: style.resolve(ui.style()), color, ..Default::default() };
    text.append(entry.name, 0.0, format(TextStyle::Button, ui.visuals().strong_text_color()));
    text.append("\n", 0.0, TextFormat::default());
    text.append(entry.summary, 0.0, format(TextStyle::Small, ui.visuals().text_color()));
    let response = ui.add(Button::selectable(is_selected, text).wrap());
    // Beside the line: below it, it would lie on the next ones.
    let mut tooltip = Tooltip::for_enabled(&response);
    tooltip.popup = tooltip.popup.align(RectAlign::LEFT_START);
    tooltip.show(|ui| ui.label(entry.advice));
    response
}
