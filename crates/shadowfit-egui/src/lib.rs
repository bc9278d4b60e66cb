//! The shadow tuning panel, embeddable in any [egui] application.
//!
//! It edits a [`Settings`] and shows live [`Figures`](shadowfit_params::figures::Figures). For actions that
//! only the host can do (moving the camera, judging the picture, saving a screenshot) it returns a
//! [`Command`]. Its controls come from [`shadowfit_params`], so that a new parameter gets a control without
//! further code.
//!
//! ```
//! use shadowfit_params::figures::Figures;
//! use shadowfit_params::tool::Settings;
//! use shadowfit_egui::{Command, PANEL_WIDTH, Panel, PanelInput, SceneLine};
//!
//! # fn show(_: shadowfit_egui::Artefact) {}
//! // Once: both themes, and the one that the system prefers.
//! fn start(ctx: &egui::Context) -> Panel {
//!     shadowfit_egui::apply_theme(ctx, egui::ThemePreference::System);
//!     Panel::new()
//! }
//!
//! // Each frame: the panel at the right, the bar of views above the picture.
//! fn frame(ui: &mut egui::Ui, panel: &mut Panel, settings: &mut Settings, figures: &Figures) {
//!     egui::Panel::right("shadows").exact_size(PANEL_WIDTH).resizable(false).show(ui, |ui| {
//!         let scene = SceneLine { name: "Courtyard", triangles: 262_144, notes: &[] };
//!         match panel.show(ui, PanelInput::new(settings, figures, scene)).command {
//!             Some(Command::ShowArtefact(artefact)) => show(artefact),
//!             Some(Command::SetTheme(theme)) => ui.ctx().set_theme(theme),
//!             Some(command) => println!("{command:?}"),
//!             None => {}
//!         }
//!     });
//!     egui::Panel::top("views").show(ui, |ui| shadowfit_egui::view_bar(ui, &mut settings.view, None));
//!     egui::CentralPanel::default().show(ui, |ui| {
//!         let picture = ui.max_rect();
//!         shadowfit_egui::legend_overlay(ui.ctx(), picture, &settings.view, figures);
//!     });
//! }
//! ```

#![forbid(unsafe_code)]

mod accessibility;
mod artefact;
mod artefact_card;
mod card;
mod classes;
mod command;
mod compare;
mod device_check;
mod figures;
mod header;
mod help;
mod history;
mod icon;
mod input;
mod keys;
mod legend;
mod maps;
mod parameters;
mod plots;
mod quality;
mod rows;
mod technique;
mod theme;
mod tune;
mod units;
mod views;
mod why;
mod widgets;

use std::collections::BTreeSet;

use egui::{ScrollArea, Ui};
use shadowfit::Technique;
use shadowfit_params::tool::Settings;
use shadowfit_params::{Parameter, parameter};

use parameters::{Rows, TOOL_GROUPS, technique_groups};
use widgets::{Section, caption};

pub use accessibility::rename;
pub use artefact::Artefact;
pub use artefact_card::artefact_card;
pub use classes::PixelClass;
pub use command::{Command, Toggle};
pub use device_check::device_check_overlay;
pub use help::help_overlay;
pub use input::{
    Card, CardChoice, CardControl, CardFigure, CardRow, Changes, Compare, PanelInput, PanelOutput, Part, SceneLine,
    ShownArtefact, Tune, UserPreset,
};
pub use keys::{Chord, KEYS, KeyGroup, KeyHelp, KeyLayout, NoSuchKey, key_table, keys_of, with_keys};
pub use legend::{MAP_UPDATE_COLORS, has_legend, legend, legend_overlay};
pub use theme::{apply_theme, size_for_fingers};
pub use views::{view_bar, view_menu};
pub use why::{WhyCard, why_card, why_overlay};
pub use widgets::{Icon, icon_button, named_icon_button};

/// Layout width of the panel, in points, margins included.
pub const PANEL_WIDTH: f32 = 360.0;

/// The tuning panel. Keep one for the host's lifetime: it stores the plotted figures and the names of the
/// techniques.
#[derive(Clone, Debug, Default)]
pub struct Panel {
    /// Settings that the reset buttons restore. A host with its own initial settings puts them here.
    pub defaults: Settings,
    /// Ids of parameters that the host does not use, and that get no control.
    pub hidden: BTreeSet<&'static str>,
    /// Parts that the host does not use, and that are not shown.
    pub hidden_parts: BTreeSet<Part>,
    technique: technique::Menu,
    plots: plots::Plots,
    search: String,
}

impl Panel {
    /// Makes a panel with empty plots.
    pub fn new() -> Self {
        Self::default()
    }

    /// Hides the controls of parameters with these ids.
    #[must_use]
    pub fn with_hidden(mut self, ids: impl IntoIterator<Item = &'static str>) -> Self {
        self.hidden.extend(ids);
        self
    }

    /// Hides these parts, so that the panel never returns their commands.
    #[must_use]
    pub fn without(mut self, parts: impl IntoIterator<Item = Part>) -> Self {
        self.hidden_parts.extend(parts);
        self
    }

    /// Names the technique that the controls edit, after the file or other source that the host opened. The
    /// menu of techniques shows the name and, once the technique is changed, offers the original again.
    pub fn name_technique(&mut self, name: impl Into<String>, technique: &Technique) {
        self.technique.open(name.into(), technique);
    }

    /// Returns the plotted figures as comma-separated values, for [`Command::SaveFigures`].
    pub fn figures_csv(&self) -> String {
        self.plots.history.to_csv()
    }

    /// Returns whether the host uses a part.
    pub(crate) fn has(&self, part: Part) -> bool {
        !self.hidden_parts.contains(&part)
    }

    /// Shows the panel in the whole of `ui`: a fixed header, and the rest with a scroll bar if it is too
    /// high. Call it once a frame.
    pub fn show(&mut self, ui: &mut Ui, mut input: PanelInput<'_>) -> PanelOutput {
        let mut command = None;
        if self.has(Part::Plots) {
            self.plots.history.push(ui.input(|input| input.time), input.figures);
        }
        header::show(ui, self, &input.scene, input.changes, input.message, &mut command);
        ui.separator();
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| self.contents(ui, &mut input, &mut command));
        if let Some(command) = &command {
            let edits_other = input.compare.as_ref().is_some_and(|compare| *compare.edits_other);
            self.technique.follow(command, edits_other);
        }
        PanelOutput { command }
    }

    fn contents(&mut self, ui: &mut Ui, input: &mut PanelInput<'_>, command: &mut Option<Command>) {
        if let Some(card) = &input.card {
            card::show(ui, card, command);
            if !card.is_technique {
                let hidden = &self.hidden;
                let has = |parameter: &Parameter| !hidden.contains(parameter.id);
                let rows = Rows { defaults: &self.defaults, has: &has };
                rows.groups(ui, [shadowfit_params::Group::Camera], input.settings);
                return;
            }
            ui.add_space(8.0);
        }
        if self.has(Part::Artefacts) {
            artefact_card::show(ui, input.artefact.as_ref(), command);
        }
        if self.has(Part::Quality) {
            quality::show(ui, input.figures, input.compare.is_some(), input.unjudged);
        }
        if self.has(Part::Tune) {
            tune::show(ui, &input.tune, command);
        }
        ui.add_space(4.0);
        self.technique_head(ui, input, command);
        Rows::search_field(ui, &mut self.search);
        if self.search.trim().is_empty() {
            self.sections(ui, input, command);
        } else {
            self.found(ui, input);
        }
    }

    /// Shows the controls for the technique as a whole: the side, and the menu.
    fn technique_head(&mut self, ui: &mut Ui, input: &mut PanelInput<'_>, command: &mut Option<Command>) {
        let mut side = 0;
        match &mut input.compare {
            Some(compare) => {
                compare::tabs(ui, compare, command);
                side = usize::from(*compare.edits_other);
            }
            None if self.has(Part::Compare) => compare::start(ui, command),
            None => {
                widgets::title(ui, "Technique");
            }
        }
        let saved = self.has(Part::UserPresets).then_some(input.presets);
        let menu = &mut self.technique;
        edit(input, |settings| menu.show(ui, &mut settings.technique, side, saved, command));
    }

    /// Shows the most used rows, the groups of the technique, the figures, and the groups of the tools.
    fn sections(&mut self, ui: &mut Ui, input: &mut PanelInput<'_>, command: &mut Option<Command>) {
        let hidden = &self.hidden;
        let rows = Rows { defaults: &self.defaults, has: &|parameter: &Parameter| !hidden.contains(parameter.id) };
        edit(input, |settings| {
            rows.quick(ui, settings);
            ui.add_space(4.0);
            rows.groups(ui, technique_groups(), settings);
        });
        let summary = figures::summary(input.figures);
        let help = "Contents and cost of each map, and the time of the passes.";
        Section { title: "Figures", help, summary: &summary, is_open: false }
            .show(ui, |ui| figures::show(ui, input.figures));
        if !self.hidden_parts.contains(&Part::Plots) {
            let plots = &mut self.plots;
            Section { title: "Plots", help: "The figures of the last minute.", summary: "", is_open: false }
                .show(ui, |ui| plots.show(ui, command));
        }
        edit_shared(input, |settings| rows.groups(ui, TOOL_GROUPS, settings));
    }

    /// Shows the rows that match the search.
    fn found(&self, ui: &mut Ui, input: &mut PanelInput<'_>) {
        let rows = Rows { defaults: &self.defaults, has: &|parameter| !self.hidden.contains(parameter.id) };
        let of_technique: Vec<_> = technique_groups().collect();
        let mut count = 0;
        edit(input, |settings| count += rows.found(ui, &self.search, &of_technique, settings));
        edit_shared(input, |settings| count += rows.found(ui, &self.search, &TOOL_GROUPS, settings));
        if count == 0 {
            caption(ui, "No active setting has these words in its name or help.");
        }
    }
}

/// Edits settings that both techniques share. A change of the near plane also changes the shadow distance of
/// both techniques.
fn edit_shared(input: &mut PanelInput<'_>, change: impl FnOnce(&mut Settings)) {
    let near = input.settings.camera.near;
    change(input.settings);
    if input.settings.camera.near != near
        && let Some(compare) = &mut input.compare
        && let Some(parameter) = parameter("camera.near")
    {
        let mut other = input.settings.with_technique(*compare.other);
        parameter.copy(&mut other, input.settings);
        *compare.other = other.technique;
    }
}

/// Edits the settings with the technique of the selected side.
fn edit(input: &mut PanelInput<'_>, change: impl FnOnce(&mut Settings)) {
    let mut other = input.compare.as_mut().filter(|compare| *compare.edits_other).map(|compare| &mut *compare.other);
    if let Some(other) = &mut other {
        std::mem::swap(&mut input.settings.technique, *other);
    }
    change(input.settings);
    if let Some(other) = &mut other {
        std::mem::swap(&mut input.settings.technique, *other);
    }
}
