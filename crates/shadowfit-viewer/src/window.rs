//! The window: surface, events, frames.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use anyhow::{Context, Result, anyhow};
use shadowfit::tool::{InsetMaps, ViewMode};
use shadowfit_egui::{Action, Artefact};
use shadowfit_render::Gpu;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, KeyEvent, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::keyboard::{KeyCode, PhysicalKey};
use winit::window::{Window, WindowId};

use crate::cli::Arguments;
use crate::files::write_png;
use crate::input::Input;
use crate::interface::Interface;
use crate::stage::Stage;

/// Samples per pixel: software rasterisers pay for each.
const GPU_SAMPLES: u32 = 4;
const SOFTWARE_SAMPLES: u32 = 1;
/// Frames between two lines of `--log-frames`.
const LOG_EVERY: u64 = 60;
/// Weight of the newest frame in the frame time shown.
const FRAME_TIME_WEIGHT: f32 = 0.1;

/// Runs the viewer in a window until it is closed.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    let event_loop = EventLoop::new().map_err(|error| {
        anyhow!(
            "no window can be opened: {error}. Start the viewer in a graphical session, or under `xvfb-run` for a \
             virtual one; `--headless DIR` renders the same views to files without any"
        )
    })?;
    event_loop.set_control_flow(ControlFlow::Poll);
    let mut app = App { arguments: arguments.clone(), running: None, result: Ok(()) };
    event_loop.run_app(&mut app).context("the window's event loop failed")?;
    app.result
}

struct App {
    arguments: Arguments,
    running: Option<Running>,
    result: Result<()>,
}

/// Everything that lives as long as the window.
struct Running {
    window: Arc<Window>,
    surface: Surface,
    stage: Stage,
    interface: Interface,
    egui: egui_winit::State,
    input: Input,
    #[cfg(feature = "gamepad")]
    gamepads: crate::gamepad::Gamepads,
    device_lost: Arc<AtomicBool>,
    last_frame: Instant,
    frames: u64,
    screenshots: u32,
    log_frames: bool,
}

/// The surface that frames are presented on.
struct Surface {
    instance: wgpu::Instance,
    window: Arc<Window>,
    handle: wgpu::Surface<'static>,
    /// Whether the surface should be configured anew before the next frame.
    is_stale: bool,
    configuration: wgpu::SurfaceConfiguration,
    /// Whether the window has an area to draw on.
    has_area: bool,
}

impl ApplicationHandler for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.running.is_none() {
            match Running::start(event_loop, &self.arguments) {
                Ok(running) => self.running = Some(running),
                Err(error) => self.stop(event_loop, Err(error)),
            }
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(running) = &mut self.running else { return };
        let stop = match event {
            WindowEvent::CloseRequested => Some(Ok(())),
            WindowEvent::RedrawRequested => running.frame().transpose(),
            event => running.event(&event).then_some(Ok(())),
        };
        if let Some(result) = stop {
            self.stop(event_loop, result);
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        if let Some(running) = &self.running {
            let visible = running.surface.has_area && running.window.is_minimized() != Some(true);
            event_loop.set_control_flow(if visible { ControlFlow::Poll } else { ControlFlow::Wait });
            if visible {
                running.window.request_redraw();
            }
        }
    }
}

impl App {
    fn stop(&mut self, event_loop: &ActiveEventLoop, result: Result<()>) {
        self.result = result;
        self.running = None;
        event_loop.exit();
    }
}

impl Running {
    fn start(event_loop: &ActiveEventLoop, arguments: &Arguments) -> Result<Self> {
        let scene = arguments.load_scene()?;
        let window = open_window(event_loop, arguments.size)?;
        let instance = Gpu::instance();
        let surface = instance.create_surface(window.clone()).context("the window cannot be drawn on")?;
        let gpu = pollster::block_on(Gpu::for_surface(arguments.adapter(), &instance, &surface))?;
        let device_lost = watch_device(&gpu);
        let surface = Surface::new(instance, window.clone(), surface, &gpu)?;
        let samples = if gpu.is_software() { SOFTWARE_SAMPLES } else { GPU_SAMPLES };
        let mut stage = Stage::new(gpu, scene, samples)?;
        stage.read_depths(samples);
        let technique = arguments.apply(&mut stage.settings)?;
        stage.animation = arguments.animation;
        stage.set_home();
        let mut interface = Interface::new(&stage, surface.configuration.format);
        if let Some(technique) = technique {
            interface.name_technique(technique);
        }
        let egui = egui_winit::State::new(
            interface.context.clone(),
            egui::ViewportId::ROOT,
            &window,
            Some(window.scale_factor() as f32),
            None,
            Some(stage.gpu().device.limits().max_texture_dimension_2d as usize),
        );
        let running = Self {
            window,
            surface,
            stage,
            interface,
            egui,
            input: Input::default(),
            #[cfg(feature = "gamepad")]
            gamepads: crate::gamepad::Gamepads::new(),
            device_lost,
            last_frame: Instant::now(),
            frames: 0,
            screenshots: 0,
            log_frames: arguments.log_frames,
        };
        running.set_title();
        Ok(running)
    }

    fn set_title(&self) {
        self.window.set_title(&format!("shadowfit: {} ({})", self.stage.scene().name, self.stage.gpu().name()));
    }

    /// Handles an event; `true` asks to quit.
    fn event(&mut self, event: &WindowEvent) -> bool {
        match event {
            WindowEvent::Resized(size) => self.surface.resize(self.stage.gpu(), *size),
            WindowEvent::Focused(false) => self.input.release_all(),
            WindowEvent::DroppedFile(path) => self.open(path),
            WindowEvent::KeyboardInput { event, .. } => return self.key(event),
            _ => {}
        }
        // What egui makes of it comes back with the next frame.
        let _ = self.egui.on_window_event(&self.window, event);
        false
    }

    /// Handles a key; `true` asks to quit.
    fn key(&mut self, event: &KeyEvent) -> bool {
        let PhysicalKey::Code(code) = event.physical_key else { return false };
        let pressed = event.state == ElementState::Pressed;
        // Typing into a field is not flying, but a release must always arrive.
        if self.interface.context.egui_wants_keyboard_input() && pressed {
            let window_event = WindowEvent::KeyboardInput {
                device_id: winit::event::DeviceId::dummy(),
                event: event.clone(),
                is_synthetic: false,
            };
            let _ = self.egui.on_window_event(&self.window, &window_event);
            return false;
        }
        self.input.key(code, pressed);
        if pressed && !event.repeat {
            return self.command(code);
        }
        false
    }

    /// What a key does at once; `true` asks to quit.
    fn command(&mut self, code: KeyCode) -> bool {
        let view = &mut self.stage.settings.view;
        match code {
            KeyCode::Escape => return true,
            KeyCode::Space => view.play = !view.play,
            KeyCode::KeyO => {
                view.mode = if view.mode == ViewMode::Outside { ViewMode::Final } else { ViewMode::Outside };
            }
            KeyCode::KeyI => {
                view.inset = match view.inset {
                    InsetMaps::Off => InsetMaps::One,
                    InsetMaps::One => InsetMaps::All,
                    InsetMaps::All => InsetMaps::Off,
                }
            }
            KeyCode::KeyL => self.stage.settings.light.animate = !self.stage.settings.light.animate,
            KeyCode::Digit1 => self.act(Action::ShowArtefact(Artefact::Acne)),
            KeyCode::Digit2 => self.act(Action::ShowArtefact(Artefact::Aliasing)),
            KeyCode::Digit3 => self.act(Action::ShowArtefact(Artefact::ClippingHole)),
            KeyCode::KeyF => {
                if let Some(shown) = self.stage.shown() {
                    self.act(Action::FixArtefact(shown.artefact));
                }
            }
            KeyCode::KeyR => self.act(Action::Reset),
            KeyCode::KeyP => self.act(Action::Screenshot),
            KeyCode::KeyH | KeyCode::F1 => self.interface.help_open = !self.interface.help_open,
            KeyCode::Tab => self.interface.panel_hidden = !self.interface.panel_hidden,
            _ => {}
        }
        false
    }

    fn act(&mut self, action: Action) {
        self.interface.message = None;
        match action {
            Action::ShowArtefact(artefact) => self.stage.show_artefact(artefact),
            Action::FixArtefact(artefact) => self.stage.fix_artefact(artefact),
            Action::Reset => self.stage.reset(),
            Action::ResetCamera => self.stage.reset_camera(),
            Action::OpenHelp => self.interface.help_open = true,
            Action::Screenshot => self.screenshot(),
        }
    }

    /// Saves the picture, without the panel, under the first free name in the working folder.
    fn screenshot(&mut self) {
        let path = loop {
            self.screenshots += 1;
            let path = std::path::PathBuf::from(format!("shadowfit-{:03}.png", self.screenshots));
            if !path.exists() {
                break path;
            }
        };
        let picture = self.interface.picture();
        let pixels = picture.read(self.stage.gpu()).map_err(anyhow::Error::from);
        let saved = pixels.and_then(|pixels| write_png(&path, picture.size, &pixels));
        self.interface.message = Some(match saved {
            Ok(()) => format!("Saved {}", path.display()),
            Err(error) => format!("{error:#}"),
        });
    }

    /// Opens a dropped file; on an error the old scene stays and the panel tells why.
    fn open(&mut self, path: &Path) {
        let opened = shadowfit_scene::load_gltf(path)
            .map_err(anyhow::Error::from)
            .and_then(|scene| Ok(self.stage.set_scene(scene)?));
        match opened {
            Ok(()) => {
                self.interface.message = None;
                self.interface.scene_changed(&self.stage);
                self.set_title();
            }
            Err(error) => self.interface.message = Some(format!("{error:#}")),
        }
    }

    /// Draws a frame; `Some` asks to quit.
    fn frame(&mut self) -> Result<Option<()>> {
        if self.device_lost.load(Ordering::Relaxed) {
            return Err(anyhow!("the graphics device was lost (driver reset or removed); start the viewer again"));
        }
        let seconds = self.last_frame.elapsed().as_secs_f32();
        self.last_frame = Instant::now();
        let old = self.interface.frame_ms.unwrap_or(seconds * 1e3);
        self.interface.frame_ms = Some(old + (seconds * 1e3 - old) * FRAME_TIME_WEIGHT);
        #[cfg(feature = "gamepad")]
        {
            let (sticks, quits) = self.gamepads.poll();
            self.input.sticks = sticks;
            if quits {
                return Ok(Some(()));
            }
        }
        let Some(texture) = self.surface.acquire(self.stage.gpu())? else {
            return Ok(None);
        };
        let view = texture.texture.create_view(&Default::default());
        let raw_input = self.egui.take_egui_input(&self.window);
        let size = [self.surface.configuration.width, self.surface.configuration.height];
        let (asked, output) = self.interface.frame(&mut self.stage, raw_input, &view, size);
        self.egui.handle_platform_output(&self.window, output);
        self.window.pre_present_notify();
        self.stage.gpu().queue.present(texture);
        let mut fly = self.input.fly();
        (fly.drag, fly.wheel) = (asked.drag, asked.wheel);
        self.stage.update(&fly, seconds);
        if let Some(action) = asked.action {
            self.act(action);
        }
        self.log_frame();
        Ok(None)
    }

    fn log_frame(&mut self) {
        self.frames += 1;
        if !self.log_frames {
            return;
        }
        if self.frames == 1 {
            eprintln!("ready: {} on {}", self.stage.scene().name, self.stage.gpu().name());
        }
        if self.frames.is_multiple_of(LOG_EVERY) {
            eprintln!("frame {}: {:.1} ms", self.frames, self.interface.frame_ms.unwrap_or(0.0));
        }
    }
}

impl Surface {
    fn new(instance: wgpu::Instance, window: Arc<Window>, handle: wgpu::Surface<'static>, gpu: &Gpu) -> Result<Self> {
        let size = window.inner_size();
        let mut configuration = handle
            .get_default_config(&gpu.adapter, size.width.max(1), size.height.max(1))
            .ok_or_else(|| anyhow!("{} cannot draw on this window", gpu.name()))?;
        // The interface blends encoded colours, so the surface must not encode them again.
        configuration.format = configuration.format.remove_srgb_suffix();
        configuration.present_mode = wgpu::PresentMode::AutoVsync;
        handle.configure(&gpu.device, &configuration);
        let has_area = size.width > 0 && size.height > 0;
        Ok(Self { instance, window, handle, is_stale: false, configuration, has_area })
    }

    fn resize(&mut self, gpu: &Gpu, size: PhysicalSize<u32>) {
        self.has_area = size.width > 0 && size.height > 0;
        if self.has_area {
            let limit = gpu.device.limits().max_texture_dimension_2d;
            self.configuration.width = size.width.min(limit);
            self.configuration.height = size.height.min(limit);
            self.handle.configure(&gpu.device, &self.configuration);
            self.is_stale = false;
        }
    }

    /// The next frame's texture; `None` while there is nothing to draw on.
    fn acquire(&mut self, gpu: &Gpu) -> Result<Option<wgpu::SurfaceTexture>> {
        use wgpu::CurrentSurfaceTexture as Current;
        if self.is_stale {
            self.resize(gpu, self.window.inner_size());
        }
        if !self.has_area {
            return Ok(None);
        }
        match self.handle.get_current_texture() {
            Current::Success(texture) => Ok(Some(texture)),
            Current::Suboptimal(texture) => {
                // It can still be shown; the next one should fit again.
                self.is_stale = true;
                Ok(Some(texture))
            }
            Current::Outdated => {
                self.is_stale = true;
                Ok(None)
            }
            Current::Lost => {
                self.handle =
                    self.instance.create_surface(self.window.clone()).context("the window's surface was lost")?;
                self.is_stale = true;
                Ok(None)
            }
            Current::Timeout | Current::Occluded => Ok(None),
            Current::Validation => Err(anyhow!("the window's surface failed validation; this is a bug of the viewer")),
        }
    }
}

fn open_window(event_loop: &ActiveEventLoop, size: [u32; 2]) -> Result<Arc<Window>> {
    let attributes = Window::default_attributes()
        .with_title("shadowfit")
        .with_inner_size(PhysicalSize::new(size[0], size[1]))
        .with_min_inner_size(PhysicalSize::new(1u32, 1u32));
    Ok(Arc::new(event_loop.create_window(attributes).context("no window could be opened")?))
}

/// A flag that is set when the device is lost.
fn watch_device(gpu: &Gpu) -> Arc<AtomicBool> {
    let lost = Arc::new(AtomicBool::new(false));
    let flag = lost.clone();
    gpu.device.set_device_lost_callback(move |reason, message| {
        if reason != wgpu::DeviceLostReason::Destroyed {
            eprintln!("graphics device lost: {message}");
            flag.store(true, Ordering::Relaxed);
        }
    });
    lost
}
