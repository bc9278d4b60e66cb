//! The area of the picture: the stage's pictures, the bar between two techniques, the view from outside, and
//! the texts over them.

use egui::{
    Align2, Color32, CornerRadius, CursorIcon, FontId, Pos2, Rect, Response, Sense, Stroke, StrokeKind, TextStyle, Ui,
    UiBuilder, Vec2,
};
use shadowfit_egui::Command;
use shadowfit_params::figures::Figures;
use shadowfit_params::tool::ViewMode;
use shadowfit_render::{ReadBack, RenderTarget};

use super::paint::Painter;
use super::{InterfaceInput, InterfaceOutput};
use crate::stage::Stage;

/// Scroll travel that counts as one notch of the wheel, in points, for devices that scroll smoothly.
const POINTS_PER_NOTCH: f32 = 50.0;
/// Width of the view from outside, as a share of the picture's width.
const BESIDE: f32 = 0.36;
/// Distance of overlays from the edge of the picture, in points.
const MARGIN: f32 = 12.0;
/// Width of the handle around the bar between two pictures, for a mouse and for a finger, in points.
const GRIP: f32 = 12.0;
const FINGER_GRIP: f32 = 36.0;

/// A picture of the stage, and its texture in egui.
struct Shot {
    target: RenderTarget,
    texture: egui::TextureId,
    /// Size of its place, in pixels.
    wanted: [u32; 2],
    /// Size of the place that it was made for. The picture is smaller if the device has too little memory.
    made_for: [u32; 2],
}

/// Size of pictures until their places are known, in pixels.
const FIRST_SIZE: [u32; 2] = [16; 2];

impl Shot {
    fn new(stage: &Stage, painter: &mut Painter) -> Self {
        let target = stage.target(FIRST_SIZE);
        let texture = painter.register(stage.gpu(), &target);
        Self { target, texture, wanted: FIRST_SIZE, made_for: FIRST_SIZE }
    }

    fn fit_place(&mut self, stage: &Stage, painter: &mut Painter) {
        if self.wanted == self.made_for {
            return;
        }
        self.made_for = self.wanted;
        let mut size = self.wanted;
        loop {
            match stage.gpu().try_making(|| stage.target(size)) {
                Ok(target) => {
                    self.target = target;
                    return painter.replace(stage.gpu(), self.texture, &self.target);
                }
                Err(_) if size.iter().all(|side| *side <= 1) => return,
                Err(_) => size = size.map(|side| side.div_ceil(2)),
            }
        }
    }
}

/// The pictures of the stage: of one technique or two, and the view from outside.
pub(crate) struct Pictures {
    main: Shot,
    beside: Shot,
    /// Position of the last tap, which explains the pixel there, as shares of the picture. A finger leaves no
    /// pointer.
    tapped: Option<[f32; 2]>,
}

impl Pictures {
    pub(super) fn new(stage: &Stage, painter: &mut Painter) -> Self {
        let mut shot = || Shot::new(stage, painter);
        Self { main: shot(), beside: shot(), tapped: None }
    }

    /// Makes the pictures again for the device of a stage that has moved.
    pub(super) fn move_to(&mut self, stage: &Stage, painter: &mut Painter) {
        for shot in [&mut self.main, &mut self.beside] {
            *shot = Shot { wanted: shot.wanted, ..Shot::new(stage, painter) };
        }
    }

    /// Returns why the picture is coarser than its place, as a line.
    pub(super) fn problem(&self) -> Option<&'static str> {
        let Shot { target, made_for, .. } = &self.main;
        (target.size != *made_for).then_some("The picture is coarser than the window: the GPU has too little memory")
    }

    /// Returns the size of the picture, in pixels.
    pub(crate) fn size(&self) -> [u32; 2] {
        self.main.wanted
    }

    /// Draws the visible pictures.
    pub(crate) fn draw(&mut self, stage: &mut Stage) {
        stage.draw(&self.main.target);
        if stage.settings.view.outside_beside {
            stage.draw_beside(&self.beside.target);
        }
    }

    /// Starts to read the picture, with both halves of a comparison: sRGB pixels, four bytes each, rows from
    /// the top.
    pub(crate) fn read_back(&self, stage: &Stage) -> ReadBack {
        self.main.target.read_back(stage.gpu())
    }

    /// Makes the pictures as large as their places.
    pub(super) fn fit_places(&mut self, stage: &Stage, painter: &mut Painter) {
        self.main.fit_place(stage, painter);
        if stage.settings.view.outside_beside {
            self.beside.fit_place(stage, painter);
        }
    }

    /// Shows the pictures in the whole of `ui`, with a legend if there are figures for it.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        stage: &mut Stage,
        input: &InterfaceInput<'_>,
        figures: Option<&Figures>,
        output: &mut InterfaceOutput,
    ) {
        let rect = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        self.main.wanted = pixels(ui, rect.size());
        self.pointer(ui, &response, rect, output);
        let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
        ui.painter().image(self.main.texture, rect, whole, Color32::WHITE);
        if let Some(names) = halves(stage) {
            show_bar(ui, stage, names, rect, output);
        }
        if input.has_scene && stage.draws_sample() {
            // No view of a technique, so no legend.
        } else if input.has_scene {
            over(ui, stage, figures, rect);
            if stage.settings.view.outside_beside {
                self.show_beside(ui, rect);
            }
        } else {
            ui.painter().rect_filled(rect, CornerRadius::ZERO, ui.visuals().extreme_bg_color);
        }
        loading(ui, input, rect);
        if let (Some(card), Some([x, y])) = (stage.why(), output.hover) {
            shadowfit_egui::why_overlay(ui.ctx(), rect, rect.lerp_inside(Vec2::new(x, y)), &card);
        }
    }

    /// Handles mouse and fingers on the picture.
    fn pointer(&mut self, ui: &Ui, response: &Response, rect: Rect, output: &mut InterfaceOutput) {
        let share = |at: Pos2| [(at.x - rect.left()) / rect.width(), (at.y - rect.top()) / rect.height()];
        let (fingers, is_touch, is_gone) =
            ui.input(|input| (input.multi_touch(), input.any_touches(), input.pointer.latest_pos().is_none()));
        if let Some(fingers) = fingers.filter(|_| response.is_pointer_button_down_on()) {
            output.pan = glam::Vec2::new(fingers.translation_delta.x, fingers.translation_delta.y);
            output.pinch = fingers.zoom_delta.max(f32::MIN_POSITIVE).ln();
            self.tapped = None;
        } else if response.dragged() {
            // A finger drags the picture; a mouse turns the camera.
            let delta = response.drag_delta() * if is_touch { -1.0 } else { ui.pixels_per_point() };
            output.drag = glam::Vec2::new(delta.x, delta.y);
            self.tapped = None;
        }
        if response.clicked() {
            ui.memory_mut(egui::Memory::stop_text_input);
            self.tapped = response.interact_pointer_pos().filter(|_| is_gone).map(share);
        }
        if response.double_clicked()
            && let Some(at) = response.interact_pointer_pos()
        {
            output.commands.push(Command::Focus(share(at)));
            self.tapped = None;
        }
        if response.contains_pointer() {
            output.wheel = wheel_notches(ui);
            output.hover = response.hover_pos().filter(|_| !response.dragged()).map(share);
        }
        output.hover = output.hover.or(self.tapped);
    }

    /// Shows the view from outside, in the upper right corner.
    fn show_beside(&mut self, ui: &mut Ui, rect: Rect) {
        let width = rect.width() * BESIDE;
        let size = Vec2::new(width, width * 0.62);
        let min = Pos2::new(rect.right() - size.x - MARGIN, rect.top() + MARGIN);
        let place = Rect::from_min_size(min, size);
        self.beside.wanted = pixels(ui, size);
        let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
        let painter = ui.painter();
        painter.image(self.beside.texture, place, whole, Color32::WHITE);
        let frame = Stroke::new(1.5, Color32::from_white_alpha(200));
        painter.rect_stroke(place, CornerRadius::same(4), frame, StrokeKind::Outside);
        let text = "Hatched: in no map";
        label(ui, place.left_bottom() + Vec2::new(8.0, -8.0), Align2::LEFT_BOTTOM, text);
    }
}

/// Returns names of both halves of the picture, if they differ.
fn halves(stage: &Stage) -> Option<[String; 2]> {
    if stage.draws_sample() {
        return stage.sample_halves();
    }
    stage.is_comparing().then(|| {
        let [a, b] = stage.side_names();
        [format!("A  {a}"), format!("B  {b}")]
    })
}

/// Shows the bar between both halves of the picture, which can be dragged, and their names.
fn show_bar(ui: &Ui, stage: &Stage, [left, right]: [String; 2], rect: Rect, output: &mut InterfaceOutput) {
    let x = rect.left() + rect.width() * stage.split;
    let width = if ui.input(egui::InputState::has_touch_screen) { FINGER_GRIP } else { GRIP };
    let grip = Rect::from_center_size(Pos2::new(x, rect.center().y), Vec2::new(width, rect.height()));
    let bar =
        ui.interact(grip, ui.scope_id().with("split"), Sense::drag()).on_hover_cursor(CursorIcon::ResizeHorizontal);
    let name = "Bar between A and B";
    bar.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Splitter, true, name));
    if bar.dragged() && rect.width() > 1.0 {
        output.commands.push(Command::Split(stage.split + bar.drag_delta().x / rect.width()));
    }
    let (dark, bright) = (Stroke::new(4.0, Color32::from_black_alpha(120)), Stroke::new(2.0, Color32::WHITE));
    for stroke in [dark, bright] {
        ui.painter().vline(x, rect.y_range(), stroke);
    }
    ui.painter().circle(Pos2::new(x, rect.center().y), 9.0, Color32::WHITE, dark);
    let y = rect.top() + MARGIN;
    label(ui, Pos2::new(x - MARGIN, y), Align2::RIGHT_TOP, &left);
    label(ui, Pos2::new(x + MARGIN, y), Align2::LEFT_TOP, &right);
}

/// Returns the size of a place, in pixels.
fn pixels(ui: &Ui, size: Vec2) -> [u32; 2] {
    let scale = ui.pixels_per_point();
    [size.x, size.y].map(|side| ((side * scale).round() as u32).max(1))
}

/// Returns the notches that the wheel was turned in this frame.
fn wheel_notches(ui: &Ui) -> f32 {
    ui.input(|input| {
        input.events.iter().fold(0.0, |notches, event| match event {
            egui::Event::MouseWheel { unit: egui::MouseWheelUnit::Point, delta, .. } => {
                notches + delta.y / POINTS_PER_NOTCH
            }
            egui::Event::MouseWheel { delta, .. } => notches + delta.y,
            _ => notches,
        })
    })
}

/// Shows the legend and notes of the view over the picture.
fn over(ui: &Ui, stage: &Stage, figures: Option<&Figures>, rect: Rect) {
    let view = &stage.settings.view;
    if let Some(figures) = figures {
        shadowfit_egui::legend_overlay(ui.ctx(), rect, view, figures);
    }
    let note = match view.mode {
        ViewMode::Final if !view.shadows => "Shadows are off",
        // Other techniques place their maps without visible demand.
        ViewMode::Demand if !stage.settings.inputs.tell(&stage.settings.technique) => {
            "These fits do not use visible demand"
        }
        _ => return,
    };
    label(ui, rect.left_top() + Vec2::splat(MARGIN), Align2::LEFT_TOP, note);
}

/// Shows the progress of loading a scene, or of the search for an artefact.
fn loading(ui: &mut Ui, input: &InterfaceInput<'_>, rect: Rect) {
    if input.loading.is_none() && !input.is_searching {
        return;
    }
    let size = Vec2::new(300.0_f32.min(rect.width()), 64.0);
    let place = Rect::from_center_size(rect.center(), size);
    let mut card = ui.new_child(UiBuilder::new().max_rect(place));
    egui::Frame::popup(ui.style()).show(&mut card, |ui| {
        ui.set_width((size.x - 24.0).max(0.0));
        if let Some((name, share)) = input.loading {
            ui.label(format!("Loading {name}"));
            ui.add(egui::ProgressBar::new(share).show_percentage().animate(true));
        } else {
            ui.horizontal(|ui| {
                ui.spinner();
                ui.label("Searching for the best view…");
            });
        }
    });
    // The bar is animated.
    ui.ctx().request_repaint();
}

/// Shows a line of text on a dark background, readable on any picture.
fn label(ui: &Ui, at: Pos2, anchor: Align2, text: &str) {
    let font: FontId = TextStyle::Body.resolve(ui.style());
    let galley = ui.painter().layout_no_wrap(text.to_owned(), font, Color32::WHITE);
    let padding = Vec2::new(8.0, 4.0);
    let place = anchor.anchor_size(at, galley.size() + 2.0 * padding);
    ui.painter().rect_filled(place, CornerRadius::same(5), Color32::from_black_alpha(170));
    ui.painter().galley(place.min + padding, galley, Color32::WHITE);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keep::saved::Saved;

    #[test]
    fn a_place_too_small_for_the_progress_of_loading_is_no_error() {
        let saved = Saved::default();
        let shown =
            InterfaceInput { loading: Some(("a scene with a long name", 0.5)), ..InterfaceInput::at_rest(&saved) };
        for side in [1.0, 20.0, 400.0] {
            let place = Rect::from_min_size(Pos2::ZERO, Vec2::splat(side));
            let input = egui::RawInput { screen_rect: Some(place), ..Default::default() };
            let mut output = egui::Context::default().run_ui(input, |ui| loading(ui, &shown, place));
            // Nothing is painted, but egui requires clearing this.
            output.textures_delta.clear();
        }
    }
}
