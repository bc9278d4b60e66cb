//! The viewer in a browser.
//!
//! ```text
//!   page (web/page.js)                         worker (web/worker.js)
//!   canvas, keys, pointers, files   ──events──►  this module: the same viewer as in a window,
//!   storage, downloads, clipboard   ◄─messages─  which draws on the page's canvas
//! ```
//!
//! The worker keeps the page responsive: while the viewer computes, the page scrolls, types and shows
//! progress.

mod input;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use anyhow::{Context, Result, anyhow};
use egui::{FontData, FontDefinitions, FontFamily, OutputCommand, Pos2, RawInput, Rect, ViewportInfo};
use epaint_default_fonts::EGUI_ICONS;
use shadowfit_egui::Command;
use shadowfit_render::{AdapterChoice, Gpu};
use wasm_bindgen::JsError;
use wasm_bindgen::prelude::wasm_bindgen;
use web_sys::OffscreenCanvas;
use web_time::Instant;
use wgpu::CurrentSurfaceTexture as Current;

use crate::arguments::Arguments;
use crate::keep::link::Link;
use crate::keep::store::Store;
use crate::platform::StateFile;
use crate::platform::page::{self, files};
use crate::stage::Stage;
use crate::viewer::{Start, Viewer};
use input::Events;

/// Samples per pixel. Software rasterisers take time for each sample.
const GPU_SAMPLES: u32 = 4;
const SOFTWARE_SAMPLES: u32 = 1;
/// Greatest number of unfinished frames on the GPU when a new one starts. Browsers accept any number.
const MOST_AHEAD: u32 = 2;

/// The viewer of a page.
#[wasm_bindgen]
pub struct Page {
    canvas: OffscreenCanvas,
    surface: wgpu::Surface<'static>,
    configuration: wgpu::SurfaceConfiguration,
    viewer: Viewer,
    events: Events,
    /// Pixels per point.
    scale: f32,
    /// Whether the surface must be configured before the next frame.
    is_stale: bool,
    is_focused: bool,
    theme: Option<egui::Theme>,
    /// Number of frames that the GPU has not finished.
    ahead: Arc<AtomicU32>,
    start: Instant,
    last_frame: Instant,
    told: Told,
}

/// State last sent to the page.
#[derive(Debug, Default)]
struct Told {
    cursor: Option<egui::CursorIcon>,
    is_ready: bool,
    types: bool,
    looks: bool,
}

#[wasm_bindgen]
impl Page {
    /// Opens the graphics device and draws on a canvas. `scale` is the number of pixels per point. `kept` is
    /// the saved text of the last visit, `page` the address of the page without its fragment, and `fragment`
    /// the fragment.
    ///
    /// # Errors
    ///
    /// With a message for users, if the browser provides no device.
    pub async fn open(
        canvas: OffscreenCanvas,
        scale: f32,
        kept: Option<String>,
        page: String,
        fragment: String,
    ) -> Result<Page, JsError> {
        console_error_panic_hook::set_once();
        let hook = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            page::tell("panic", &panic.to_string());
            hook(panic);
        }));
        Self::new(canvas, scale, kept, page, fragment).await.map_err(|error| JsError::new(&format!("{error:#}")))
    }

    async fn new(
        canvas: OffscreenCanvas,
        scale: f32,
        kept: Option<String>,
        page: String,
        fragment: String,
    ) -> Result<Self> {
        let (surface, gpu, configuration) = open_surface(&canvas).await?;
        let samples = if gpu.is_software() { SOFTWARE_SAMPLES } else { GPU_SAMPLES };
        let mut stage = Stage::empty(gpu, samples)?;
        stage.read_depths();
        let (start, problem) = start_of(fragment)?;
        let mut viewer = Viewer::new(stage, configuration.format, start, Some(Store::new(StateFile::of_text(kept))));
        viewer.page = Some(page);
        if let Some(problem) = problem {
            viewer.say(format!("This link cannot be followed: {problem:#}"));
        }
        viewer.interface.context.set_fonts(fonts());
        let now = Instant::now();
        Ok(Self {
            canvas,
            surface,
            configuration,
            viewer,
            events: Events::default(),
            scale,
            is_stale: false,
            is_focused: true,
            theme: None,
            ahead: Arc::default(),
            start: now,
            last_frame: now,
            told: Told::default(),
        })
    }

    /// Draws a frame, unless the GPU has too many unfinished ones.
    ///
    /// # Errors
    ///
    /// With a message for users, if drawing is no longer possible.
    pub fn frame(&mut self) -> Result<(), JsError> {
        // WebGL2 reports finished work only here; WebGPU does so by itself. A lost device is reported by its
        // own callback.
        let _ = self.viewer.stage.gpu().device.poll(wgpu::PollType::Poll);
        if self.ahead.load(Ordering::Relaxed) >= MOST_AHEAD {
            return Ok(());
        }
        self.draw().map_err(|error| JsError::new(&format!("{error:#}")))
    }

    /// Resizes the canvas, in pixels. `scale` is the number of pixels per point.
    pub fn resize(&mut self, width: u32, height: u32, scale: f32) {
        let limit = self.viewer.stage.gpu().device.limits().max_texture_dimension_2d;
        (self.configuration.width, self.configuration.height) = (width.clamp(1, limit), height.clamp(1, limit));
        (self.scale, self.is_stale) = (scale, true);
    }

    /// Sets the held modifier keys.
    pub fn held(&mut self, bits: u32) {
        self.events.held(bits);
    }

    /// Reports a mouse movement to a point, and its distance, in points.
    pub fn moved(&mut self, x: f32, y: f32, by_x: f32, by_y: f32) {
        self.events.moved(Pos2::new(x, y), [by_x, by_y]);
    }

    /// Reports that a mouse button was pressed or released.
    pub fn button(&mut self, x: f32, y: f32, number: u32, pressed: bool) {
        self.events.button(Pos2::new(x, y), number, pressed);
    }

    /// Reports that the mouse left the page.
    pub fn gone(&mut self) {
        self.events.gone();
    }

    /// Reports a turn of the wheel.
    pub fn wheel(&mut self, x: f32, y: f32, unit: u32) {
        self.events.wheel([x, y], unit);
    }

    /// Reports a touch.
    pub fn touch(&mut self, finger: u32, phase: &str, x: f32, y: f32) {
        self.events.touch(finger.into(), phase, Pos2::new(x, y));
    }

    /// Reports that a key was pressed or released.
    pub fn key(&mut self, code: &str, name: &str, pressed: bool, repeat: bool) {
        self.events.key(code, name, pressed, repeat);
    }

    /// Pastes a text.
    pub fn paste(&mut self, text: String) {
        self.events.waiting.push(egui::Event::Paste(text));
    }

    /// Copies the selection.
    pub fn copy(&mut self) {
        self.events.waiting.push(egui::Event::Copy);
    }

    /// Cuts the selection.
    pub fn cut(&mut self) {
        self.events.waiting.push(egui::Event::Cut);
    }

    /// Reports that the page got or lost the keyboard focus.
    pub fn focus(&mut self, is_focused: bool) {
        self.is_focused = is_focused;
        if !is_focused {
            self.viewer.input.release_all();
        }
    }

    /// Sets whether the browser prefers dark pages.
    pub fn dark(&mut self, is_dark: bool) {
        self.theme = Some(if is_dark { egui::Theme::Dark } else { egui::Theme::Light });
    }

    /// Removes the earlier files, before newly chosen ones are added.
    #[expect(clippy::unused_self, reason = "the page calls what it opened")]
    pub fn files(&mut self) {
        files::clear();
    }

    /// Adds one of the files that were chosen together.
    #[expect(clippy::unused_self, reason = "the page calls what it opened")]
    pub fn file(&mut self, name: String, bytes: Vec<u8>) {
        files::keep(name, bytes);
    }

    /// Opens one of the files.
    pub fn open_file(&mut self, name: String) {
        self.viewer.ask(Command::OpenFile(PathBuf::from(name)));
    }

    /// Follows a link after the page's fragment has changed.
    pub fn follow(&mut self, fragment: String) {
        let Some(text) = link_of(fragment) else { return };
        match Link::parse(&text) {
            Ok(link) => self.viewer.follow(link),
            Err(error) => self.viewer.say(format!("This link cannot be followed: {error:#}")),
        }
    }

    /// Turns the camera by a movement of the locked mouse, in points.
    pub fn look(&mut self, x: f32, y: f32) {
        self.viewer.input.look += glam::vec2(x, y) * self.scale;
    }

    /// Sets the sticks of a gamepad: movement and turn, each -1..=1.
    pub fn sticks(&mut self, right: f32, up: f32, forward: f32, turn: f32, tilt: f32) {
        self.viewer.input.sticks = (glam::vec3(right, up, forward), glam::vec2(turn, tilt));
    }

    /// Resets the camera, for a button of a gamepad.
    pub fn reset_camera(&mut self) {
        self.viewer.ask(Command::ResetCamera);
    }

    /// Saves the settings, before the page is hidden.
    pub fn save(&mut self) {
        self.viewer.save();
    }

    /// Returns facts for tests of the page, as a line of JSON.
    pub fn facts(&self) -> String {
        self.viewer.facts([self.configuration.width, self.configuration.height])
    }
}

impl Page {
    fn draw(&mut self) -> Result<()> {
        let now = Instant::now();
        let seconds = (now - self.last_frame).as_secs_f32();
        self.last_frame = now;
        let gpu = self.viewer.stage.gpu();
        if std::mem::take(&mut self.is_stale) {
            self.canvas.set_width(self.configuration.width);
            self.canvas.set_height(self.configuration.height);
            self.surface.configure(&gpu.device, &self.configuration);
        }
        let (layout, output) = {
            let raw_input = self.raw_input();
            self.viewer.frame(raw_input, seconds)
        };
        self.handle(&output);
        let texture = match self.surface.get_current_texture() {
            Current::Success(texture) => texture,
            Current::Suboptimal(texture) => {
                self.is_stale = true;
                texture
            }
            Current::Outdated | Current::Lost => {
                self.is_stale = true;
                return Ok(());
            }
            Current::Timeout | Current::Occluded => return Ok(()),
            Current::Validation => return Err(anyhow!("the canvas can no longer be drawn on")),
        };
        let view = texture.texture.create_view(&Default::default());
        let size = [self.configuration.width, self.configuration.height];
        self.viewer.paint(&layout, &view, size);
        let gpu = self.viewer.stage.gpu();
        gpu.queue.present(texture);
        self.ahead.fetch_add(1, Ordering::Relaxed);
        let ahead = Arc::clone(&self.ahead);
        gpu.queue.on_submitted_work_done(move || _ = ahead.fetch_sub(1, Ordering::Relaxed));
        Ok(())
    }

    fn raw_input(&mut self) -> RawInput {
        let size = [self.configuration.width, self.configuration.height].map(|side| side as f32 / self.scale);
        let viewport = ViewportInfo { native_pixels_per_point: Some(self.scale), ..ViewportInfo::default() };
        RawInput {
            viewports: std::iter::once((egui::ViewportId::ROOT, viewport)).collect(),
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, size.into())),
            max_texture_side: Some(self.viewer.stage.gpu().device.limits().max_texture_dimension_2d as usize),
            time: Some(self.start.elapsed().as_secs_f64()),
            events: std::mem::take(&mut self.events.waiting),
            focused: self.is_focused,
            system_theme: self.theme,
            ..RawInput::default()
        }
    }

    /// Sends the requests of egui and the viewer to the page.
    fn handle(&mut self, output: &egui::PlatformOutput) {
        for command in &output.commands {
            match command {
                OutputCommand::CopyText(text) => page::tell("copy", text),
                OutputCommand::OpenUrl(url) => page::tell("open", &url.url),
                _ => {}
            }
        }
        if self.told.cursor != Some(output.cursor_icon) {
            self.told.cursor = Some(output.cursor_icon);
            page::tell("cursor", cursor(output.cursor_icon));
        }
        if self.told.types != output.ime.is_some() {
            self.told.types = output.ime.is_some();
            page::tell("types", if self.told.types { "yes" } else { "" });
        }
        if self.told.looks != self.viewer.is_looking {
            self.told.looks = self.viewer.is_looking;
            page::tell("looks", if self.told.looks { "yes" } else { "" });
        }
        let requests = std::mem::take(&mut self.viewer.window_requests);
        if requests.new_title {
            page::tell("title", &self.viewer.title());
        }
        if !self.told.is_ready && self.viewer.is_ready() {
            self.told.is_ready = true;
            page::tell("ready", self.viewer.stage.gpu().name().as_str());
        }
        if let Some(failure) = self.viewer.failure.take() {
            page::tell("failure", &format!("{failure:#}"));
        }
    }
}

/// Opens a graphics device that draws on a canvas, and configures the surface for it.
async fn open_surface(canvas: &OffscreenCanvas) -> Result<(wgpu::Surface<'static>, Gpu, wgpu::SurfaceConfiguration)> {
    let instance = Gpu::instance();
    let target = wgpu::SurfaceTarget::OffscreenCanvas(canvas.clone());
    let surface = instance.create_surface(target).context("the page cannot be drawn on")?;
    let gpu = Gpu::for_surface(&AdapterChoice::Any, &instance, &surface).await?;
    watch(&gpu);
    let mut configuration = surface
        .get_default_config(&gpu.adapter, canvas.width().max(1), canvas.height().max(1))
        .ok_or_else(|| anyhow!("{} cannot draw on this page", gpu.name()))?;
    // The interface blends encoded colours, so the surface must not encode them again.
    configuration.format = configuration.format.remove_srgb_suffix();
    surface.configure(&gpu.device, &configuration);
    Ok((surface, gpu, configuration))
}

/// Returns the start for a page's fragment. An invalid link opens the viewer as without a link, and its error
/// is returned, too.
fn start_of(fragment: String) -> Result<(Start, Option<anyhow::Error>)> {
    match Start::new(&Arguments { link: link_of(fragment), ..Arguments::default() }) {
        Ok(start) => Ok((start, None)),
        Err(problem) => Ok((Start::new(&Arguments::default())?, Some(problem))),
    }
}

/// Returns a fragment as a link; `None` if it is empty.
fn link_of(fragment: String) -> Option<String> {
    (fragment.len() > 1).then_some(fragment)
}

/// The font for text, and the font for code, which has arrows: see `fonts/README.md`.
const TEXT_FONT: &[u8] = include_bytes!("../fonts/text.ttf");
const CODE_FONT: &[u8] = include_bytes!("../fonts/code.ttf");

/// Returns some of egui's fonts. Its emoji fonts are left out, since they are larger than all others.
fn fonts() -> FontDefinitions {
    let mut fonts = FontDefinitions::empty();
    let all = [("text", TEXT_FONT), ("code", CODE_FONT), ("icons", EGUI_ICONS)];
    fonts.font_data.extend(all.map(|(name, bytes)| (name.to_owned(), Arc::new(FontData::from_static(bytes)))));
    for (family, names) in
        [(FontFamily::Proportional, ["text", "icons", "code"]), (FontFamily::Monospace, ["code", "icons", "text"])]
    {
        fonts.families.insert(family, names.map(str::to_owned).to_vec());
    }
    fonts
}

/// Reports device errors to the page that are not reported elsewhere.
fn watch(gpu: &Gpu) {
    gpu.device.set_device_lost_callback(|reason, message| {
        if reason != wgpu::DeviceLostReason::Destroyed {
            page::tell("lost", &message);
        }
    });
    gpu.device.on_uncaptured_error(Arc::new(|error: wgpu::Error| match error {
        wgpu::Error::OutOfMemory { .. } => page::tell("memory", &error.to_string()),
        _ => page::tell("error", &error.to_string()),
    }));
}

/// Returns the CSS name of a pointer's shape.
fn cursor(icon: egui::CursorIcon) -> &'static str {
    use egui::CursorIcon as Icon;
    match icon {
        Icon::None => "none",
        Icon::ContextMenu => "context-menu",
        Icon::Help => "help",
        Icon::PointingHand => "pointer",
        Icon::Progress => "progress",
        Icon::Wait => "wait",
        Icon::Cell => "cell",
        Icon::Crosshair => "crosshair",
        Icon::Text | Icon::VerticalText => "text",
        Icon::Move | Icon::AllScroll => "move",
        Icon::NoDrop | Icon::NotAllowed => "not-allowed",
        Icon::Grab => "grab",
        Icon::Grabbing => "grabbing",
        Icon::ResizeHorizontal | Icon::ResizeColumn | Icon::ResizeEast | Icon::ResizeWest => "ew-resize",
        Icon::ResizeVertical | Icon::ResizeRow | Icon::ResizeNorth | Icon::ResizeSouth => "ns-resize",
        Icon::ResizeNeSw | Icon::ResizeNorthEast | Icon::ResizeSouthWest => "nesw-resize",
        Icon::ResizeNwSe | Icon::ResizeNorthWest | Icon::ResizeSouthEast => "nwse-resize",
        Icon::ZoomIn => "zoom-in",
        Icon::ZoomOut => "zoom-out",
        _ => "default",
    }
}
