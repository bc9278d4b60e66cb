//! Picture, bars and panel laid out by egui, the same in the window and in headless pictures.

mod bar;
mod paint;
mod picture;
mod sample;
mod timeline;

use egui::{CentralPanel, Frame, Ui};
use glam::Vec2;
use shadowfit_egui::{
    CardFigure, Changes, Command, Compare, PANEL_WIDTH, Panel, PanelInput, SceneLine, ShownArtefact, Tune, UserPreset,
};
use shadowfit_params::figures::Figures;

use crate::saved::Saved;
use crate::stage::Stage;

use paint::Painter;
pub(crate) use paint::{Canvas, Layout, red_first};
pub(crate) use picture::Pictures;

/// egui, the panel, and the pictures between them.
pub(crate) struct Interface {
    pub(crate) context: egui::Context,
    painter: Painter,
    panel: Panel,
    pub(crate) pictures: Pictures,
    pub(crate) help_open: bool,
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

/// State that the interface shows besides the stage.
pub(crate) struct InterfaceInput<'a> {
    pub(crate) saved: &'a Saved,
    pub(crate) presets: &'a [UserPreset],
    pub(crate) tune: Tune<'a>,
    /// The figures of the sample that is shown.
    pub(crate) sample_figures: &'a [CardFigure],
    pub(crate) changes: Changes<'a>,
    /// A message, such as where a screenshot was saved.
    pub(crate) message: Option<&'a str>,
    /// The scene that is being loaded, and the share of it that is loaded.
    pub(crate) loading: Option<(&'a str, f32)>,
    /// Whether the view of an artefact is being searched.
    pub(crate) is_searching: bool,
    /// Whether there is a scene to show.
    pub(crate) has_scene: bool,
}

impl<'a> InterfaceInput<'a> {
    /// A scene without background work or messages.
    pub(crate) fn at_rest(saved: &'a Saved) -> Self {
        Self {
            saved,
            presets: &[],
            tune: Tune::Idle,
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
    /// Wheel notches over the picture.
    pub(crate) wheel: f32,
    /// Where the pointer rests on the picture, as shares of its width and height from the top left.
    pub(crate) hover: Option<[f32; 2]>,
}

impl Interface {
    /// An interface that is painted to a surface of the given format.
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
            bare: false,
            edits_other: false,
            frame_ms: None,
            format,
            figures: Figures::default(),
        };
        interface.scene_changed(stage);
        interface
    }

    /// Sets the settings to which resets go back: those that a scene was opened with.
    pub(crate) fn scene_changed(&mut self, stage: &Stage) {
        self.panel.defaults = stage.home_settings();
        self.edits_other = false;
    }

    /// Format of the surface that it is painted to.
    pub(crate) fn format(&self) -> wgpu::TextureFormat {
        self.format
    }

    /// The panel, which keeps the plotted figures.
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
        let mut full = context.run_ui(raw_input, |ui| self.show(ui, stage, input, &mut output));
        self.pictures.fit_places(stage, &mut self.painter);
        self.painter.take(stage.gpu(), &mut full.textures_delta);
        let jobs = context.tessellate(full.shapes, full.pixels_per_point);
        (output, Layout { jobs, pixels_per_point: full.pixels_per_point }, full.platform_output)
    }

    /// Paints a frame that was laid out to `target` of `size` pixels.
    pub(crate) fn paint(&mut self, stage: &Stage, layout: &Layout, target: &wgpu::TextureView, size: [u32; 2]) {
        self.painter.paint(stage.gpu(), layout, target, size);
    }

    fn show(&mut self, ui: &mut Ui, stage: &mut Stage, input: &InterfaceInput<'_>, output: &mut InterfaceOutput) {
        self.figures = stage.figures(self.pictures.size(), self.frame_ms);
        if !self.bare {
            bar::show(ui, stage, input, output);
            timeline::show(ui, stage, self.frame_ms, output);
            egui::Panel::right("tuning").exact_size(PANEL_WIDTH).resizable(false).show(ui, |ui| {
                self.show_panel(ui, stage, input, output);
            });
        }
        let figures = &self.figures;
        CentralPanel::default()
            .frame(Frame::NONE)
            .show(ui, |ui| self.pictures.show(ui, stage, (input, figures), output));
        let context = ui.ctx().clone();
        shadowfit_egui::help_overlay(&context, &mut self.help_open);
    }

    fn show_panel(&mut self, ui: &mut Ui, stage: &mut Stage, input: &InterfaceInput<'_>, output: &mut InterfaceOutput) {
        let (name, notes) = (stage.scene().name.clone(), stage.scene().notes.clone());
        let scene = SceneLine { name: &name, triangles: stage.prepared_scene().triangles(), notes: &notes };
        let message = stage.problem().map(str::to_owned).or_else(|| input.message.map(str::to_owned));
        let (narration, changes) = (stage.narration().to_owned(), stage.cure_changes().to_vec());
        let shown = stage.shown();
        let figures = self.figures;
        let artefact = shown.map(|shown| ShownArtefact {
            artefact: shown.artefact,
            fixed: shown.fixed,
            narration: &narration,
            changes: &changes,
        });
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
            message: message.as_deref(),
            ..PanelInput::new(settings, &figures, scene)
        };
        output.commands.extend(self.panel.show(ui, panel_input).command);
    }
}
