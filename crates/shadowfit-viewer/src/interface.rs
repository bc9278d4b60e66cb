//! Picture, bars and panel, laid out by egui in the same way in the window and in headless pictures.

mod bar;
mod narrow;
mod paint;
mod picture;
mod sample;
mod timeline;

use egui::{CentralPanel, Frame, Ui};
use glam::Vec2;
use shadowfit_egui::{
    CardFigure, Changes, Command, Compare, PANEL_WIDTH, Panel, PanelInput, SceneLine, ShownArtefact, Tune, UserPreset,
};
use shadowfit_params::device_check::CheckReport;
use shadowfit_params::figures::Figures;

use crate::keep::saved::Saved;
use crate::stage::Stage;

use paint::Painter;
pub(crate) use paint::{Canvas, Layout, red_first};
pub(crate) use picture::Pictures;

/// egui, the panel, and the pictures between the bars.
#[expect(clippy::struct_excessive_bools, reason = "each is a state of the window of its own")]
pub(crate) struct Interface {
    pub(crate) context: egui::Context,
    painter: Painter,
    panel: Panel,
    pub(crate) pictures: Pictures,
    pub(crate) help_open: bool,
    /// Whether the panel is open over the picture, in a narrow window.
    pub(crate) drawer_open: bool,
    /// Whether controls are high enough for fingers.
    is_touched: bool,
    /// Whether bars and panel are hidden.
    pub(crate) bare: bool,
    /// Whether the panel edits the second of two techniques.
    pub(crate) edits_other: bool,
    /// Time of the last frame, in milliseconds.
    pub(crate) frame_ms: Option<f32>,
    format: wgpu::TextureFormat,
    /// The figures of the last frame.
    figures: Figures,
}

/// State outside the stage that the interface shows.
pub(crate) struct InterfaceInput<'a> {
    pub(crate) saved: &'a Saved,
    pub(crate) presets: &'a [UserPreset],
    pub(crate) tune: Tune<'a>,
    /// The report of the device check, while its dialog is open.
    pub(crate) device_check: Option<&'a CheckReport>,
    /// The figures of the current sample.
    pub(crate) sample_figures: &'a [CardFigure],
    pub(crate) changes: Changes<'a>,
    /// A message, such as where a screenshot was saved.
    pub(crate) message: Option<&'a str>,
    /// Name of the scene that is loading, and the loaded share.
    pub(crate) loading: Option<(&'a str, f32)>,
    /// Whether a search for the view of an artefact is running.
    pub(crate) is_searching: bool,
    /// Whether a scene has been loaded.
    pub(crate) has_scene: bool,
}

impl<'a> InterfaceInput<'a> {
    /// Returns the input for a scene without background work or messages.
    pub(crate) fn at_rest(saved: &'a Saved) -> Self {
        Self {
            saved,
            presets: &[],
            tune: Tune::Idle,
            device_check: None,
            sample_figures: &[],
            changes: Changes::default(),
            message: None,
            loading: None,
            is_searching: false,
            has_scene: true,
        }
    }
}

/// The user's input to the interface in a frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct InterfaceOutput {
    pub(crate) commands: Vec<Command>,
    /// Mouse drag over the picture, in pixels.
    pub(crate) drag: Vec2,
    /// Movement of two fingers on the picture, in points, and the logarithm of the factor by which their
    /// distance grew.
    pub(crate) pan: Vec2,
    pub(crate) pinch: f32,
    /// Wheel notches over the picture.
    pub(crate) wheel: f32,
    /// Position of the resting pointer on the picture, as shares of its width and height from the top left.
    pub(crate) hover: Option<[f32; 2]>,
}

impl Interface {
    /// Makes an interface that is painted to a surface of the given format.
    pub(crate) fn new(stage: &Stage, format: wgpu::TextureFormat) -> Self {
        let context = egui::Context::default();
        shadowfit_egui::apply_theme(&context, egui::ThemePreference::Dark);
        let mut painter = Painter::new(&stage.gpu().device, format);
        let pictures = Pictures::new(stage, &mut painter);
        let mut interface = Self {
            context,
            painter,
            panel: Panel::new(),
            pictures,
            help_open: false,
            drawer_open: false,
            is_touched: false,
            bare: false,
            edits_other: false,
            frame_ms: None,
            format,
            figures: Figures::default(),
        };
        interface.scene_changed(stage);
        interface
    }

    /// Sets the settings that resets restore: the initial settings of the scene.
    pub(crate) fn scene_changed(&mut self, stage: &Stage) {
        self.panel.defaults = stage.home_settings();
        self.edits_other = false;
    }

    /// Continues with the device of a stage that has [moved](Stage::move_to), and with a surface of a format.
    pub(crate) fn move_to(&mut self, stage: &Stage, format: wgpu::TextureFormat) {
        self.painter = Painter::new(&stage.gpu().device, format);
        self.pictures.move_to(stage, &mut self.painter);
        self.format = format;
        // egui uploads its whole font texture again only after it reloads the fonts. No providers are used.
        self.context.set_font_providers(Vec::new());
    }

    /// Returns the format of the surface.
    pub(crate) fn format(&self) -> wgpu::TextureFormat {
        self.format
    }

    /// Returns the panel, which stores the plotted figures.
    pub(crate) fn panel(&mut self) -> &mut Panel {
        &mut self.panel
    }

    /// Lays out a frame: bars, panel and picture. The pictures get the sizes of their places.
    pub(crate) fn layout(
        &mut self,
        stage: &mut Stage,
        input: &InterfaceInput<'_>,
        raw_input: egui::RawInput,
    ) -> (InterfaceOutput, Layout, egui::PlatformOutput) {
        let mut output = InterfaceOutput::default();
        let context = self.context.clone();
        let is_narrow = raw_input.screen_rect.is_some_and(|screen| narrow::is_narrow(screen.size()));
        let is_touched = is_narrow || context.input(egui::InputState::has_touch_screen);
        if std::mem::replace(&mut self.is_touched, is_touched) != is_touched {
            shadowfit_egui::size_for_fingers(&context, is_touched);
        }
        let mut full = context.run_ui(raw_input, |ui| self.show(ui, stage, input, &mut output));
        self.pictures.fit_places(stage, &mut self.painter);
        self.painter.take(stage.gpu(), &mut full.textures_delta);
        let jobs = context.tessellate(full.shapes, full.pixels_per_point);
        (output, Layout { jobs, pixels_per_point: full.pixels_per_point }, full.platform_output)
    }

    /// Paints a laid out frame to `target` of `size` pixels.
    pub(crate) fn paint(&mut self, stage: &Stage, layout: &Layout, target: &wgpu::TextureView, size: [u32; 2]) {
        self.painter.paint(stage.gpu(), layout, target, size);
    }

    fn show(&mut self, ui: &mut Ui, stage: &mut Stage, input: &InterfaceInput<'_>, output: &mut InterfaceOutput) {
        self.figures = stage.figures(self.pictures.size(), self.frame_ms);
        let is_narrow = narrow::is_narrow(ui.max_rect().size());
        self.drawer_open &= is_narrow && !self.bare;
        if !self.bare {
            if is_narrow || ui.max_rect().width() < bar::least_width(self.is_touched) {
                self.drawer_open |= bar::show_narrow(ui, stage, input, output, is_narrow);
            } else {
                bar::show(ui, stage, input, output);
            }
            timeline::show(ui, stage, self.frame_ms, output);
            if !is_narrow {
                egui::Panel::right("tuning").exact_size(PANEL_WIDTH).resizable(false).show(ui, |ui| {
                    self.show_panel(ui, stage, input, output);
                });
            }
        }
        // The drawer covers the legend.
        let has_legend = !self.drawer_open;
        let figures = Some(&self.figures).filter(|_| has_legend);
        let picture = CentralPanel::default()
            .frame(Frame::NONE)
            .show(ui, |ui| self.pictures.show(ui, stage, input, figures, output));
        if self.drawer_open {
            self.show_drawer(ui, stage, input, output);
        } else if is_narrow && !self.bare {
            narrow::show_notes(ui, picture.response.rect, stage, input, output);
        }
        let context = ui.ctx().clone();
        shadowfit_egui::help_overlay(&context, &mut self.help_open);
        let asked = input.device_check.and_then(|report| shadowfit_egui::device_check_overlay(&context, report));
        output.commands.extend(asked);
    }

    fn show_panel(&mut self, ui: &mut Ui, stage: &mut Stage, input: &InterfaceInput<'_>, output: &mut InterfaceOutput) {
        let (name, notes) = (stage.scene().name.clone(), stage.scene().notes.clone());
        let scene = SceneLine { name: &name, triangles: stage.prepared_scene().triangles(), notes: &notes };
        let problem = stage.problem().or(self.pictures.problem());
        let message = problem.or(input.message).map(str::to_owned);
        let (narration, changes) = (stage.narration().to_owned(), stage.cure_changes().to_vec());
        let shown = stage.shown();
        let figures = self.figures;
        let artefact = shown.map(|shown| ShownArtefact {
            artefact: shown.artefact,
            fixed: shown.fixed,
            narration: &narration,
            changes: &changes,
        });
        let unjudged = stage.no_compute();
        let sample = stage.sample().map(sample::Parts::new);
        let (settings, other) = stage.settings_and_other();
        let compare = other.map(|other| Compare { other, edits_other: &mut self.edits_other });
        let panel_input = PanelInput {
            artefact,
            card: sample.as_ref().map(|sample| sample.card(input.sample_figures)),
            compare,
            tune: input.tune,
            changes: input.changes,
            presets: input.presets,
            unjudged,
            message: message.as_deref(),
            ..PanelInput::new(settings, &figures, scene)
        };
        output.commands.extend(self.panel.show(ui, panel_input).command);
    }
}
