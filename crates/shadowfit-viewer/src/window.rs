//! The window: surface, events, frames.

mod frame_log;
#[cfg(feature = "gamepad")]
mod gamepad;

use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow};
use shadowfit_egui::Command;
use shadowfit_render::{AdapterChoice, Gpu, Spent, own_time};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::window::{Window, WindowId};

use crate::arguments::Arguments;
use crate::keep::store::Store;
use crate::platform::StateFile;
use crate::play::script::Refusal;
use crate::stage::Stage;
use crate::viewer::{Renewals, Start, Viewer};
use frame_log::FrameLog;

/// Samples per pixel. Software rasterisers take time for each sample.
const GPU_SAMPLES: u32 = 4;
const SOFTWARE_SAMPLES: u32 = 1;

/// Runs the viewer in a window until it is closed.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    let start = Start::new(arguments)?;
    let event_loop = EventLoop::new().map_err(|error| {
        anyhow!(
            "no window can be opened: {error}. Start the viewer in a graphical session, or under `xvfb-run` for a \
             virtual one; `--headless DIR` renders the same views to files without a window"
        )
    })?;
    event_loop.set_control_flow(ControlFlow::Poll);
    let mut app = App { start: Some(start), running: None, result: Ok(()) };
    event_loop.run_app(&mut app).context("the window's event loop failed")?;
    app.result
}

struct App {
    start: Option<Start>,
    running: Option<Running>,
    result: Result<()>,
}

/// State with the lifetime of the window.
struct Running {
    window: Arc<Window>,
    surface: Surface,
    viewer: Viewer,
    egui: egui_winit::State,
    #[cfg(feature = "gamepad")]
    gamepads: gamepad::Gamepads,
    adapter: AdapterChoice,
    renewals: Renewals,
    last_frame: Instant,
    log: Option<FrameLog>,
}

/// The surface on which frames are presented.
struct Surface {
    instance: wgpu::Instance,
    window: Arc<Window>,
    handle: wgpu::Surface<'static>,
    /// Whether the surface must be configured again before the next frame.
    is_stale: bool,
    configuration: wgpu::SurfaceConfiguration,
    /// Size of the surface's textures, in pixels, from the last configuration; `None` before the first one.
    size: Option<[u32; 2]>,
    /// Whether the window has an area to draw on.
    has_area: bool,
    /// The answer of a script in place of the next texture.
    refusal: Option<Refusal>,
}

impl ApplicationHandler for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        let Some(start) = self.start.take() else { return };
        match Running::start(event_loop, start) {
            Ok(running) => self.running = Some(running),
            Err(error) => self.stop(event_loop, Err(error)),
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, window: WindowId, event: WindowEvent) {
        // The event may belong to a window whose device was lost.
        let Some(running) = self.running.as_mut().filter(|running| running.window.id() == window) else { return };
        let stop = match event {
            WindowEvent::CloseRequested => Some(Ok(())),
            WindowEvent::RedrawRequested => running.frame(event_loop).transpose(),
            event => {
                running.event(&event);
                None
            }
        };
        if let Some(result) = stop {
            self.stop(event_loop, result);
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        if let Some(running) = &mut self.running {
            let visible = running.surface.has_area && running.window.is_minimized() != Some(true);
            // A script continues even if its window is hidden.
            let goes_on = visible || !running.viewer.player.is_done();
            event_loop.set_control_flow(if goes_on { ControlFlow::Poll } else { ControlFlow::Wait });
            if visible {
                running.window.request_redraw();
            } else if goes_on {
                std::thread::sleep(HIDDEN_FRAME);
                if let Some(result) = running.frame(event_loop).transpose() {
                    self.stop(event_loop, result);
                }
            }
        }
    }
}

/// Time of a frame without a visible window.
const HIDDEN_FRAME: Duration = Duration::from_millis(16);

impl App {
    fn stop(&mut self, event_loop: &ActiveEventLoop, result: Result<()>) {
        if let Some(mut running) = self.running.take() {
            running.viewer.save();
            self.result = running.viewer.outcome().and(result);
            if let Some(log) = &running.log {
                log.end();
            }
        } else {
            self.result = result;
        }
        event_loop.exit();
    }
}

impl Running {
    fn start(event_loop: &ActiveEventLoop, start: Start) -> Result<Self> {
        let begin = Instant::now();
        let arguments = &start.arguments;
        let window = open_window(event_loop, arguments.size())?;
        let adapter = arguments.adapter();
        let (surface, gpu) = Surface::new(window.clone(), &adapter)?;
        gpu.keep_faults();
        let samples = if gpu.is_software() { SOFTWARE_SAMPLES } else { GPU_SAMPLES };
        let mut stage = Stage::empty(gpu, samples)?;
        stage.read_depths();
        let log = arguments.log_frames.then(|| FrameLog::new(begin));
        let store = match (&arguments.state, arguments.no_state) {
            (_, true) => None,
            (Some(path), _) => Some(Store::new(StateFile::at(path.clone()))),
            (None, false) => Some(Store::new(StateFile::of_person())),
        };
        let viewer = Viewer::new(stage, surface.configuration.format, start, store);
        let egui = egui_state(&window, &viewer);
        Ok(Self {
            window,
            surface,
            viewer,
            egui,
            #[cfg(feature = "gamepad")]
            gamepads: gamepad::Gamepads::new(),
            adapter,
            renewals: Renewals::default(),
            last_frame: Instant::now(),
            log,
        })
    }

    fn event(&mut self, event: &WindowEvent) {
        match event {
            // The surface is resized with the next frame, after any number of size events.
            WindowEvent::Resized(size) => self.surface.expect(*size),
            WindowEvent::Focused(false) => self.viewer.input.release_all(),
            WindowEvent::DroppedFile(path) => self.viewer.ask(Command::OpenFile(path.clone())),
            _ => {}
        }
        // egui's response comes with the next frame.
        let _ = self.egui.on_window_event(&self.window, event);
    }

    /// Draws a frame. `Some` is a request to quit.
    fn frame(&mut self, event_loop: &ActiveEventLoop) -> Result<Option<()>> {
        if let Some(why) = self.viewer.stage.gpu().lost() {
            self.renew(event_loop, &why)?;
        }
        self.viewer.tell_faults();
        // If the device is lost, the frame is abandoned, and the next frame gets another device. The window's
        // texture is dropped outside the code that may panic.
        let gpu = self.viewer.stage.gpu().clone();
        if let Some(mut texture) = gpu.unless_lost(|| self.surface.acquire(&gpu)).transpose()? {
            gpu.unless_lost(|| self.draw(&mut texture));
        }
        let requests = std::mem::take(&mut self.viewer.window_requests);
        if let Some([width, height]) = requests.resize {
            // The window reports its new size in a later event.
            let _ = self.window.request_inner_size(PhysicalSize::new(width, height));
        }
        if requests.new_title {
            self.window.set_title(&self.viewer.title());
        }
        self.surface.refusal = requests.refusal;
        Ok(requests.quit.then_some(()))
    }

    /// Draws a frame into a texture of the window, if there is one, and presents it.
    fn draw(&mut self, texture: &mut Option<(wgpu::SurfaceTexture, [u32; 2])>) {
        let seconds = self.last_frame.elapsed().as_secs_f32();
        self.last_frame = Instant::now();
        #[cfg(feature = "gamepad")]
        {
            let (sticks, commands) = self.gamepads.poll();
            self.viewer.input.sticks = sticks;
            for command in commands {
                self.viewer.ask(command);
            }
        }
        let raw_input = self.egui.take_egui_input(&self.window);
        let was_loading = self.viewer.is_loading();
        let ((layout, output), laid_out) = own_time(|| self.viewer.frame(raw_input, seconds));
        self.egui.handle_platform_output(&self.window, output);
        let Some((surface, size)) = texture else {
            // Without a texture, nothing else limits the frame rate.
            return std::thread::sleep(HIDDEN_FRAME);
        };
        let view = surface.texture.create_view(&Default::default());
        let ((), painted) = own_time(|| self.viewer.paint(&layout, &view, *size));
        self.log_frame(laid_out.plus(painted), was_loading);
        self.window.pre_present_notify();
        if let Some((surface, _)) = texture.take() {
            self.viewer.stage.gpu().queue.present(surface);
        }
    }

    /// Opens a device in place of a lost one, and a window in place of the old one. The lost device's
    /// swapchain may still occupy the old window, since wgpu 30 cannot always destroy it.
    fn renew(&mut self, event_loop: &ActiveEventLoop, why: &str) -> Result<()> {
        self.viewer.save();
        self.renewals.next(why)?;
        let window = open_window(event_loop, self.window.inner_size().into())?;
        if let Ok(place) = self.window.outer_position() {
            window.set_outer_position(place);
        }
        let opened = Surface::new(window.clone(), &self.adapter);
        let (surface, gpu) = opened.context("the graphics device was lost, and there is no other")?;
        gpu.keep_faults();
        let lost = self.viewer.stage.gpu().clone();
        self.viewer.move_to(gpu, surface.configuration.format, why)?;
        let old = std::mem::replace(&mut self.surface, surface);
        lost.unless_lost(|| drop(old));
        self.egui = egui_state(&window, &self.viewer);
        self.window = window;
        self.window.set_title(&self.viewer.title());
        Ok(())
    }

    /// Records a frame's own time for `--log-frames`.
    fn log_frame(&mut self, own: Spent, is_loading: bool) {
        let ready = self.viewer.is_ready().then(|| self.viewer.title());
        let frame_ms = self.viewer.interface.frame_ms.unwrap_or(0.0);
        if let Some(log) = &mut self.log {
            log.frame(own, frame_ms, is_loading, ready);
        }
    }
}

impl Surface {
    /// Makes the surface of a window, and a device that draws on it.
    fn new(window: Arc<Window>, adapter: &AdapterChoice) -> Result<(Self, Gpu)> {
        let instance = Gpu::instance();
        let handle = instance.create_surface(window.clone()).context("the window cannot be drawn on")?;
        let gpu = pollster::block_on(Gpu::for_surface(adapter, &instance, &handle))?;
        let configuration = configured(&handle, &gpu, window.inner_size())?;
        let has_area = has_area(window.inner_size());
        let size = Some([configuration.width, configuration.height]);
        let (is_stale, refusal) = (false, None);
        Ok((Self { instance, window, handle, is_stale, configuration, size, has_area, refusal }, gpu))
    }

    /// Records a new size of the window.
    fn expect(&mut self, size: PhysicalSize<u32>) {
        self.has_area = has_area(size);
        self.is_stale = true;
    }

    fn resize(&mut self, gpu: &Gpu, size: PhysicalSize<u32>) {
        self.has_area = has_area(size);
        if self.has_area {
            let limit = gpu.device.limits().max_texture_dimension_2d;
            self.configuration.width = size.width.min(limit);
            self.configuration.height = size.height.min(limit);
            // A surface can only be configured while the GPU is idle. If the thread that loads a scene
            // submits work at that time, configuring fails, the surface stays unchanged, and the next frame
            // tries again. Its textures then report a wrong size (wgpu 30), so the size is stored here.
            let scope = gpu.device.push_error_scope(wgpu::ErrorFilter::Validation);
            self.handle.configure(&gpu.device, &self.configuration);
            self.is_stale = pollster::block_on(scope.pop()).is_some();
            if !self.is_stale {
                self.size = Some([self.configuration.width, self.configuration.height]);
            }
        }
    }

    /// Returns the next frame's texture and its size in pixels; `None` while there is nothing to draw on.
    fn acquire(&mut self, gpu: &Gpu) -> Result<Option<(wgpu::SurfaceTexture, [u32; 2])>> {
        use wgpu::CurrentSurfaceTexture as Current;
        if self.is_stale {
            self.resize(gpu, self.window.inner_size());
        }
        let Some(size) = self.size.filter(|_| self.has_area) else { return Ok(None) };
        let answer = match self.refusal.take() {
            None => self.handle.get_current_texture(),
            Some(Refusal::Lost) => Current::Lost,
            Some(Refusal::Outdated) => Current::Outdated,
            Some(Refusal::Timeout) => Current::Timeout,
            Some(Refusal::Occluded) => Current::Occluded,
        };
        match answer {
            Current::Success(texture) => Ok(Some((texture, size))),
            Current::Suboptimal(texture) => {
                // This texture can still be shown, but the surface should be resized for the next one.
                self.is_stale = true;
                Ok(Some((texture, size)))
            }
            Current::Outdated => {
                self.is_stale = true;
                Ok(None)
            }
            Current::Lost => {
                self.handle =
                    self.instance.create_surface(self.window.clone()).context("the window's surface was lost")?;
                (self.is_stale, self.size) = (true, None);
                Ok(None)
            }
            Current::Timeout | Current::Occluded => Ok(None),
            // The next frame opens another device.
            Current::Validation if gpu.lost().is_some() => Ok(None),
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

/// Makes egui's state for a window.
fn egui_state(window: &Window, viewer: &Viewer) -> egui_winit::State {
    egui_winit::State::new(
        viewer.interface.context.clone(),
        egui::ViewportId::ROOT,
        window,
        Some(window.scale_factor() as f32),
        window.theme(),
        Some(viewer.stage.gpu().device.limits().max_texture_dimension_2d as usize),
    )
}

fn has_area(size: PhysicalSize<u32>) -> bool {
    size.width > 0 && size.height > 0
}

/// Configures a surface for a window of a size.
fn configured(handle: &wgpu::Surface<'_>, gpu: &Gpu, size: PhysicalSize<u32>) -> Result<wgpu::SurfaceConfiguration> {
    let limit = gpu.device.limits().max_texture_dimension_2d;
    let mut configuration = handle
        .get_default_config(&gpu.adapter, size.width.clamp(1, limit), size.height.clamp(1, limit))
        .ok_or_else(|| anyhow!("{} cannot draw on this window", gpu.name()))?;
    // The interface blends encoded colours, so the surface must not encode them again.
    configuration.format = configuration.format.remove_srgb_suffix();
    configuration.present_mode = wgpu::PresentMode::AutoVsync;
    handle.configure(&gpu.device, &configuration);
    Ok(configuration)
}
