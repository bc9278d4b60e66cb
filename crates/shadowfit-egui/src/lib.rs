//! The shadow tuning panel, embeddable in any [egui] application.
//!
//! It edits a [`Settings`], shows a [`Figures`] live, and asks its host for what only the host can
//! do (moving the camera, taking a picture) by returning an [`Action`]. Its controls come from
//! [`shadowfit::params`], so that a new parameter gets a control without further code.
//!
//! ```
//! use shadowfit::figures::Figures;
//! use shadowfit::tool::Settings;
//! use shadowfit_egui::{PANEL_WIDTH, Panel, PanelInput, SceneLine};
//!
//! # fn host(ui: &mut egui::Ui, panel: &mut Panel, settings: &mut Settings) {
//! egui::Panel::right("shadows").exact_size(PANEL_WIDTH).show(ui, |ui| {
//!     let input = PanelInput {
//!         settings,
//!         figures: &Figures::default(),
//!         scene: SceneLine { name: "Courtyard", triangles: 262_144, notes: &[] },
//!         artefact: None,
//!         artefact_fixed: false,
//!         message: None,
//!     };
//!     if let Some(action) = panel.show(ui, input).action {
//!         println!("{action:?}");
//!     }
//! });
//! # }
//! ```

#![forbid(unsafe_code)]

mod accessibility;
mod artefact;
mod figures;
mod help;
mod maps;
mod rows;
mod style;
mod technique;
mod units;

use std::collections::BTreeSet;

use egui::{RichText, ScrollArea, Sense, TextStyle, Ui, Vec2};
use shadowfit::Technique;
use shadowfit::figures::Figures;
use shadowfit::params::Group;
use shadowfit::tool::Settings;

pub use artefact::Artefact;
pub use help::{KEYS, KeyHelp, help_overlay};
pub use style::apply_style;

/// Width that the panel is laid out for, in points, margins included.
pub const PANEL_WIDTH: f32 = 360.0;

/// The tuning panel. Keep one for as long as its host lives: it remembers the plotted times
/// and the name of the technique.
#[derive(Clone, Debug, Default)]
pub struct Panel {
    /// What the reset button of a parameter goes back to. A host that begins with settings of its
    /// own puts them here.
    pub defaults: Settings,
    /// Ids of parameters that the host does not use and that get no control.
    pub hidden: BTreeSet<&'static str>,
    technique: technique::Menu,
    frame_times: figures::History,
}

/// What the panel shows and edits in one frame.
#[derive(Debug)]
pub struct PanelInput<'a> {
    /// The settings that the controls edit.
    pub settings: &'a mut Settings,
    /// The figures of the last frame.
    pub figures: &'a Figures,
    /// What is being looked at.
    pub scene: SceneLine<'a>,
    /// The artefact that is being shown, if any.
    pub artefact: Option<Artefact>,
    /// Whether its cure is applied.
    pub artefact_fixed: bool,
    /// A readable message, such as the outcome of the last action.
    pub message: Option<&'a str>,
}

/// The scene, in a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneLine<'a> {
    /// Its name.
    pub name: &'a str,
    /// Number of its triangles.
    pub triangles: u64,
    /// Notes about it, such as parts that could not be shown.
    pub notes: &'a [String],
}

/// What the person asked for in this frame, beside the settings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PanelOutput {
    /// The request, if any.
    pub action: Option<Action>,
}

/// A request to the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Move camera and settings so that the artefact is plainly visible.
    ShowArtefact(Artefact),
    /// Apply the artefact's cure.
    FixArtefact(Artefact),
    /// Put settings and camera back to where they began.
    Reset,
    /// Put the camera back to where it began.
    ResetCamera,
    /// Save the picture.
    Screenshot,
    /// Show the table of the keys, see [`help_overlay`].
    OpenHelp,
}

impl Panel {
    /// A panel with nothing plotted yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Gives the parameters of these ids no control.
    #[must_use]
    pub fn with_hidden(mut self, ids: impl IntoIterator<Item = &'static str>) -> Self {
        self.hidden.extend(ids);
        self
    }

    /// Names the technique of the settings after a file or whatever else the host opened it from. The
    /// menu of techniques shows that name and, once the technique is changed, offers it again.
    pub fn name_technique(&mut self, name: impl Into<String>, technique: &Technique) {
        self.technique.open(name.into(), technique);
    }

    /// Shows the panel in the whole of `ui`, with a scroll bar when it is higher than that. Call
    /// it once a frame.
    pub fn show(&mut self, ui: &mut Ui, input: PanelInput<'_>) -> PanelOutput {
        let PanelInput { settings, figures, scene, artefact, artefact_fixed, message } = input;
        let mut action = None;
        self.frame_times.push(figures.frame_ms);
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.visuals_mut().collapsing_header_frame = true;
            header(ui, &scene, message, &mut action);
            ui.separator();
            artefact::show(ui, artefact, artefact_fixed, &mut action);
            section(ui, "Figures", true, |ui| {
                figures::show(ui, figures);
                self.frame_times.plot(ui);
            });
            ui.add_space(6.0);
            self.technique.show(ui, &mut settings.technique);
            for group in Group::ALL {
                self.group(ui, group, settings);
            }
        });
        PanelOutput { action }
    }

    fn group(&self, ui: &mut Ui, group: Group, settings: &mut Settings) {
        let mut rows = group.parameters().filter(|parameter| !self.hidden.contains(parameter.id)).peekable();
        if rows.peek().is_none() {
            return;
        }
        let open = !matches!(group, Group::Override | Group::Camera);
        section(ui, group.label(), open, |ui| {
            for parameter in rows {
                // Asked row by row, since each may change what the next ones are.
                if rows::is_shown(parameter, settings) {
                    rows::show(ui, parameter, settings, &self.defaults);
                }
            }
        })
        .on_hover_text(group.help());
    }
}

fn section(ui: &mut Ui, title: &str, open: bool, contents: impl FnOnce(&mut Ui)) -> egui::Response {
    ui.add_space(2.0);
    egui::CollapsingHeader::new(RichText::new(title).strong())
        .default_open(open)
        .show_unindented(ui, contents)
        .header_response
}

fn header(ui: &mut Ui, scene: &SceneLine<'_>, message: Option<&str>, action: &mut Option<Action>) {
    ui.heading("Shadow tuning");
    ui.add(egui::Label::new(format!("{}, {} triangles", scene.name, units::grouped(scene.triangles))).wrap());
    for note in scene.notes {
        ui.add(egui::Label::new(RichText::new(note).color(ui.visuals().warn_fg_color)).wrap());
    }
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        for (label, help, asked) in [
            ("Reset", "Puts settings and camera back to where they began (R).", Action::Reset),
            ("Reset camera", "Puts the camera back to where it began.", Action::ResetCamera),
            ("Screenshot", "Saves the picture (P).", Action::Screenshot),
            ("Help", "Shows the table of the keys (H or F1).", Action::OpenHelp),
        ] {
            if ui.button(label).on_hover_text(help).clicked() {
                *action = Some(asked);
            }
        }
    });
    match message {
        Some(message) => ui.add(egui::Label::new(RichText::new(message).color(ui.visuals().hyperlink_color)).wrap()),
        // The line stays free, so that a message does not push what is below it.
        None => ui.allocate_response(Vec2::new(0.0, ui.text_style_height(&TextStyle::Body)), Sense::hover()),
    };
}
