//! Picture and panel laid out by egui, the same in the window and in headless pictures.

use egui::{CentralPanel, Color32, Frame, MouseWheelUnit, Pos2, Rect, Sense, Ui};
use egui_wgpu::{Renderer as EguiRenderer, RendererOptions, ScreenDescriptor};
use glam::Vec2;
use shadowfit_egui::{Action, PANEL_WIDTH, Panel, PanelInput, SceneLine};
use shadowfit_render::RenderTarget;
use shadowfit_study::NamedTechnique;

use crate::stage::Stage;

/// Scroll travel that counts as one notch of the wheel, in points, for devices that scroll
/// smoothly.
const POINTS_PER_NOTCH: f32 = 50.0;

/// egui, the panel, and the picture between them.
pub(crate) struct Interface {
    pub(crate) context: egui::Context,
    renderer: EguiRenderer,
    panel: Panel,
    picture: RenderTarget,
    texture: egui::TextureId,
    pub(crate) help_open: bool,
    pub(crate) panel_hidden: bool,
    /// Time of the last frame, in milliseconds.
    pub(crate) frame_ms: Option<f32>,
    /// A readable message, such as where a screenshot was saved.
    pub(crate) message: Option<String>,
}

/// What a frame of the interface asks for.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Asked {
    pub(crate) action: Option<Action>,
    /// Mouse drag over the picture, in pixels.
    pub(crate) drag: Vec2,
    /// Wheel notches over the picture.
    pub(crate) wheel: f32,
}

impl Interface {
    /// An interface that is painted to a surface of the given format.
    pub(crate) fn new(stage: &Stage, format: wgpu::TextureFormat) -> Self {
        let gpu = stage.gpu();
        let context = egui::Context::default();
        shadowfit_egui::apply_style(&context);
        let mut renderer = EguiRenderer::new(&gpu.device, format, RendererOptions::default());
        let picture = stage.target([16, 16]);
        let texture = renderer.register_native_texture(&gpu.device, &picture.encoded_view(), wgpu::FilterMode::Nearest);
        let mut interface = Self {
            context,
            renderer,
            panel: Panel::new(),
            picture,
            texture,
            help_open: false,
            panel_hidden: false,
            frame_ms: None,
            message: None,
        };
        interface.scene_changed(stage);
        interface
    }

    /// Takes the settings of a newly opened scene as what resets go back to.
    pub(crate) fn scene_changed(&mut self, stage: &Stage) {
        self.panel.defaults = stage.settings;
    }

    /// Puts a technique that was opened from a file among those of the menu.
    pub(crate) fn name_technique(&mut self, opened: NamedTechnique) {
        self.panel.name_technique(opened.name, &opened.technique);
    }

    /// What the picture was last drawn into.
    pub(crate) fn picture(&self) -> &RenderTarget {
        &self.picture
    }

    /// Lays out a frame, draws the picture, and paints both to `target` of `size` pixels.
    pub(crate) fn frame(
        &mut self,
        stage: &mut Stage,
        raw_input: egui::RawInput,
        target: &wgpu::TextureView,
        size: [u32; 2],
    ) -> (Asked, egui::PlatformOutput) {
        let mut asked = Asked::default();
        let mut picture_size = self.picture.size;
        let context = self.context.clone();
        let output = context.run_ui(raw_input, |ui| picture_size = self.layout(ui, stage, &mut asked));
        if picture_size != self.picture.size {
            self.picture = stage.target(picture_size);
            self.renderer.update_egui_texture_from_wgpu_texture(
                &stage.gpu().device,
                &self.picture.encoded_view(),
                wgpu::FilterMode::Nearest,
                self.texture,
            );
        }
        stage.draw(&self.picture);
        self.paint(stage, output.shapes, output.textures_delta, output.pixels_per_point, target, size);
        (asked, output.platform_output)
    }

    /// Panel on the right, picture in the rest; returns the picture's size in pixels.
    fn layout(&mut self, ui: &mut Ui, stage: &mut Stage, asked: &mut Asked) -> [u32; 2] {
        if !self.panel_hidden {
            egui::Panel::right("tuning").exact_size(PANEL_WIDTH).resizable(false).show(ui, |ui| {
                asked.action = self.show_panel(ui, stage);
            });
        }
        let texture = self.texture;
        let size = CentralPanel::default().frame(Frame::NONE).show(ui, |ui| {
            let rect = ui.available_rect_before_wrap();
            let response = ui.allocate_rect(rect, Sense::click_and_drag());
            let pixels = ui.pixels_per_point();
            if response.dragged() {
                let delta = response.drag_delta() * pixels;
                asked.drag = Vec2::new(delta.x, delta.y);
            }
            if response.clicked() {
                ui.memory_mut(egui::Memory::stop_text_input);
            }
            if response.contains_pointer() {
                asked.wheel = wheel_notches(ui);
            }
            let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
            ui.painter().image(texture, rect, whole, Color32::WHITE);
            [(rect.width() * pixels).round() as u32, (rect.height() * pixels).round() as u32]
        });
        let context = ui.ctx().clone();
        shadowfit_egui::help_overlay(&context, &mut self.help_open);
        size.inner.map(|side| side.max(1))
    }

    fn show_panel(&mut self, ui: &mut Ui, stage: &mut Stage) -> Option<Action> {
        let mut figures = stage.figures(self.picture.size);
        figures.frame_ms = self.frame_ms;
        let shown = stage.shown();
        let name = stage.scene().name.clone();
        let notes = stage.scene().notes.clone();
        let message = stage.problem().or(stage.notice()).map(str::to_owned).or_else(|| self.message.clone());
        let input = PanelInput {
            figures: &figures,
            scene: SceneLine { name: &name, triangles: stage.prepared_scene().triangles(), notes: &notes },
            artefact: shown.map(|shown| shown.artefact),
            artefact_fixed: shown.is_some_and(|shown| shown.fixed),
            message: message.as_deref(),
            settings: &mut stage.settings,
        };
        self.panel.show(ui, input).action
    }

    fn paint(
        &mut self,
        stage: &Stage,
        shapes: Vec<egui::epaint::ClippedShape>,
        mut textures: egui::TexturesDelta,
        pixels_per_point: f32,
        target: &wgpu::TextureView,
        size: [u32; 2],
    ) {
        let gpu = stage.gpu();
        let jobs = self.context.tessellate(shapes, pixels_per_point);
        for (id, deltas) in &textures.set {
            for delta in deltas {
                self.renderer.update_texture(&gpu.device, &gpu.queue, *id, delta);
            }
        }
        let screen = ScreenDescriptor { size_in_pixels: size, pixels_per_point };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let commands = self.renderer.update_buffers(&gpu.device, &gpu.queue, &mut encoder, &jobs, &screen);
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("interface"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        self.renderer.render(&mut pass.forget_lifetime(), &jobs, &screen);
        gpu.queue.submit(commands.into_iter().chain([encoder.finish()]));
        for id in &textures.free {
            self.renderer.free_texture(id);
        }
        // All applied; egui asks to be told so.
        textures.clear();
    }
}

/// Notches that the wheel was turned in this frame.
fn wheel_notches(ui: &Ui) -> f32 {
    ui.input(|input| {
        input.events.iter().fold(0.0, |notches, event| match event {
            egui::Event::MouseWheel { unit: MouseWheelUnit::Point, delta, .. } => notches + delta.y / POINTS_PER_NOTCH,
            egui::Event::MouseWheel { delta, .. } => notches + delta.y,
            _ => notches,
        })
    })
}
