//! The viewer without its window: scene, interface, commands and background work. The window and the headless
//! mode call it once per frame.

mod commands;
#[cfg(target_family = "wasm")]
mod facts;
mod faults;
mod following;
mod input;
mod opening;
mod sample;
mod saving;
mod start;
#[cfg(test)]
mod tests;

use std::collections::{HashSet, VecDeque};
use std::path::PathBuf;
use std::sync::mpsc::Receiver;

use anyhow::{Result, anyhow};
use egui::{Event, RawInput};
use shadowfit_egui::{Changes, Chord, Command, UserPreset};
use shadowfit_params::tool::Settings;

use crate::background::device_check::DeviceCheck;
use crate::background::loading::Loading;
use crate::background::measuring::Measuring;
use crate::background::tuning::Tuning;
use crate::interface::{Interface, InterfaceInput, InterfaceOutput, Layout};
use crate::keep::link::Link;
use crate::keep::saved::Saved;
use crate::keep::store::Store;
use crate::keep::undo::{History, State};
use crate::platform::{TemporaryFolder, output};
use crate::play::effect::{Activity, Effect};
use crate::play::playback::Player;
use crate::play::script::Refusal;
use crate::scene_source::SceneSource;
use crate::stage::Stage;
use crate::stage::artefact::Found;
use input::Input;

#[cfg(not(target_family = "wasm"))]
pub(crate) use faults::Renewals;
use saving::{Destination, Saving};
pub(crate) use start::Start;

/// Interval between two writes of the saved settings, in seconds.
const SAVE_EVERY: f64 = 5.0;
/// Weight of the newest frame in the displayed frame time.
const FRAME_TIME_WEIGHT: f32 = 0.1;

/// The whole viewer except its window.
pub(crate) struct Viewer {
    pub(crate) stage: Stage,
    pub(crate) interface: Interface,
    pub(crate) input: Input,
    pub(crate) player: Player,
    start: Start,
    source: SceneSource,
    /// The scene's own settings, without arguments and saved settings.
    own_settings: Settings,
    /// Whether a scene has been loaded.
    has_scene: bool,
    loading: Option<Loading>,
    searching: Option<Receiver<Found>>,
    chooser: Option<Receiver<Option<PathBuf>>>,
    tuning: Tuning,
    device_check: DeviceCheck,
    measuring: Measuring,
    history: History,
    /// State at the end of the last frame.
    last_state: Option<State>,
    saved: Saved,
    store: Option<Store>,
    /// The link to apply once its scene is loaded.
    link: Option<Link>,
    /// Address of the page in which the viewer runs, without a fragment; `None` in a window. Only a window
    /// can be quit.
    pub(crate) page: Option<String>,
    presets: Vec<UserPreset>,
    message: Option<Message>,
    /// Seconds since the start.
    clock: f64,
    saved_at: f64,
    commands: VecDeque<Request>,
    /// The line of the script that requested the current command.
    line: Option<String>,
    /// Files for the next picture of the whole window.
    shots: Vec<Destination>,
    /// Pictures that wait for their pixels.
    saving: Vec<Saving>,
    /// Folder for files that random actions save, so that they do not fill the user's folder. It is removed
    /// at the end.
    litter: Option<TemporaryFolder>,
    pub(crate) window_requests: WindowRequests,
    /// Whether the mouse drags the picture. Pages lock the pointer then.
    pub(crate) is_looking: bool,
    /// Device faults that were reported.
    told_faults: HashSet<String>,
    /// The viewer's final error.
    pub(crate) failure: Option<anyhow::Error>,
}

/// A command, and the line of the script that requested it.
struct Request {
    command: Command,
    line: Option<String>,
}

impl From<Command> for Request {
    fn from(command: Command) -> Self {
        Self { command, line: None }
    }
}

/// A message, and the time when it was first shown, in seconds since the start.
struct Message {
    text: String,
    since: f64,
}

/// Duration of a message, in seconds.
const MESSAGE_TIME: f64 = 8.0;

/// Requests of the viewer to its window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct WindowRequests {
    pub(crate) quit: bool,
    /// A new size, in pixels.
    pub(crate) resize: Option<[u32; 2]>,
    pub(crate) new_title: bool,
    /// The answer of the window's surface to the next frame, instead of a texture.
    pub(crate) refusal: Option<Refusal>,
}

impl Viewer {
    /// Makes a viewer whose frames are painted to a surface of a format. The scene of `stage` is not shown;
    /// the first scene is loaded later.
    pub(crate) fn new(stage: Stage, format: wgpu::TextureFormat, start: Start, store: Option<Store>) -> Self {
        let mut viewer = Self {
            interface: Interface::new(&stage, format),
            stage,
            input: Input::default(),
            player: Player::new(start.script.clone()),
            source: SceneSource::default(),
            own_settings: Settings::default(),
            start,
            has_scene: false,
            loading: None,
            searching: None,
            chooser: None,
            tuning: Tuning::default(),
            device_check: DeviceCheck::default(),
            measuring: Measuring::default(),
            history: History::default(),
            last_state: None,
            saved: Saved::default(),
            store,
            link: None,
            page: None,
            presets: Vec::new(),
            message: None,
            clock: 0.0,
            saved_at: 0.0,
            commands: VecDeque::new(),
            line: None,
            shots: Vec::new(),
            saving: Vec::new(),
            litter: None,
            window_requests: WindowRequests::default(),
            is_looking: false,
            told_faults: HashSet::new(),
            failure: None,
        };
        viewer.restore();
        viewer
    }

    /// Takes keys out of the input, unless the panel has the focus. Typing must not fly the camera, but a key
    /// release must always arrive.
    fn take_keys(&mut self, raw_input: &mut RawInput) {
        for event in &raw_input.events {
            if let Event::ModifiersChanged(modifiers) = event {
                self.input.fast = modifiers.shift;
            }
        }
        let types = self.types();
        let is_taken = |event: &mut Event| matches!(event, Event::Key { pressed, .. } if !(*pressed && types));
        for event in raw_input.events.extract_if(.., is_taken) {
            let Event::Key { key, physical_key, pressed, modifiers, .. } = event else { continue };
            // The position of a key matters for flying, not its letter in the keyboard layout.
            let chord = Chord {
                key: physical_key.unwrap_or(key),
                ctrl: modifiers.ctrl,
                shift: modifiers.shift,
                alt: modifiers.alt,
            };
            let is_new = self.input.key(chord, pressed);
            self.commands.extend(self.key_command(chord).filter(|_| is_new).map(Request::from));
        }
    }

    /// Returns the command of a key. A sample's own controls override those of the viewer.
    fn key_command(&self, chord: Chord) -> Option<Command> {
        match chord.command() {
            Some(Command::Reset) if self.stage.has_sample_reset() => Some(Command::ResetCamera),
            command => command,
        }
    }

    /// Queues a command for the next frame.
    pub(crate) fn ask(&mut self, command: Command) {
        self.commands.push_back(command.into());
    }

    /// Returns whether a mouse button is pressed.
    fn presses(&self) -> bool {
        self.interface.context.input(|input| input.pointer.any_down())
    }

    /// Returns whether keys go to a widget of the panel.
    fn types(&self) -> bool {
        self.interface.context.egui_wants_keyboard_input()
    }

    /// Lays out a frame, draws it and runs its commands, whose effect the next frame shows. `seconds` is the
    /// time since the previous frame.
    pub(crate) fn frame(&mut self, mut raw_input: RawInput, seconds: f32) -> (Layout, egui::PlatformOutput) {
        self.clock += f64::from(seconds);
        let old = self.interface.frame_ms.unwrap_or(seconds * 1e3);
        self.interface.frame_ms = Some(old + (seconds * 1e3 - old) * FRAME_TIME_WEIGHT);
        // Messages of the start wait until the panel is visible.
        self.message.take_if(|message| self.has_scene && self.clock - message.since > MESSAGE_TIME);
        self.take_keys(&mut raw_input);
        self.play(&mut raw_input, seconds);
        self.take_background();
        let (asked, layout, output) = self.lay_out(raw_input);
        if self.has_scene {
            // The card that explains a pixel only applies to techniques.
            let hover = asked.hover.filter(|_| !self.stage.draws_sample());
            self.stage.ask_why(hover, self.interface.pictures.size());
            self.interface.pictures.draw(&mut self.stage);
        }
        let mut fly = self.input.fly();
        (fly.drag, fly.wheel) = (asked.drag + std::mem::take(&mut self.input.look), asked.wheel);
        self.is_looking = asked.drag != glam::Vec2::ZERO || (self.is_looking && self.presses());
        (fly.pan, fly.pinch) = (asked.pan, asked.pinch);
        self.stage.update(&fly, seconds);
        self.commands.extend(asked.commands.into_iter().map(Request::from));
        while let Some(request) = self.commands.pop_front() {
            self.line = request.line;
            self.run(request.command);
        }
        self.line = None;
        if self.has_scene {
            let state = self.state();
            self.history.feed(self.clock, &state, self.stage.camera);
            self.last_state = Some(state);
        }
        if self.clock - self.saved_at > SAVE_EVERY {
            self.save();
        }
        (layout, output)
    }

    fn lay_out(&mut self, raw_input: RawInput) -> (InterfaceOutput, Layout, egui::PlatformOutput) {
        let request = self.link.as_ref().and_then(|link| link.scene.request());
        let message = self.message.as_ref().map(|message| message.text.as_str());
        let loading = self.loading.as_ref().map(|loading| (loading.source.label(), loading.share()));
        let input = InterfaceInput {
            saved: &self.saved,
            presets: &self.presets,
            tune: self.tuning.shown(),
            device_check: self.device_check.report(),
            sample_figures: self.measuring.lines(),
            changes: Changes { undo: self.history.undo_name(), redo: self.history.redo_name() },
            message: message.or(request.as_deref()),
            loading: loading.as_ref().map(|(name, share)| (name.as_str(), *share)),
            is_searching: self.searching.is_some(),
            has_scene: self.has_scene,
        };
        self.interface.layout(&mut self.stage, &input, raw_input)
    }

    /// Paints a laid out frame to `target` of `size` pixels, and saves it if a command requested that.
    pub(crate) fn paint(&mut self, layout: &Layout, target: &wgpu::TextureView, size: [u32; 2]) {
        self.interface.paint(&self.stage, layout, target, size);
        for destination in std::mem::take(&mut self.shots) {
            self.save_window(layout, destination, size);
        }
    }

    /// Plays a frame of the script.
    fn play(&mut self, raw_input: &mut RawInput, seconds: f32) {
        let size = raw_input.screen_rect.map_or([0.0; 2], |rect| [rect.width(), rect.height()]);
        let activity = Activity {
            is_loading: self.loading.is_some() || !self.has_scene,
            is_searching: self.searching.is_some(),
            is_judged: self.has_scene && self.stage.is_judged(),
            is_tuning: self.tuning.is_running() || self.measuring.is_running(),
            size,
        };
        let effects = self.player.advance(seconds, &activity);
        let line = self.player.place();
        let request = |command| Request { command, line: line.clone() };
        for effect in effects {
            match effect {
                Effect::Run(command) => self.commands.push_back(request(command)),
                Effect::Key(chord, true) if self.types() => raw_input.events.push(typed(chord)),
                Effect::Key(chord, pressed) => {
                    self.commands.extend(self.key_command(chord).filter(|_| pressed).map(request));
                    self.input.key(chord, pressed);
                }
                Effect::Input(event) => raw_input.events.push(event),
                Effect::Resize(size) => self.window_requests.resize = Some(size),
                Effect::Drop(path) => self.commands.push_back(request(Command::OpenFile(path))),
                Effect::LoseDevice => self.stage.gpu().device.destroy(),
                Effect::Refuse(refusal) => self.window_requests.refusal = Some(refusal),
                Effect::Print(text) => output::tell(text),
            }
        }
        let saves = self.commands.iter().any(|request| matches!(request.command, Command::Screenshot(_)));
        self.stage.set_unseen(!saves && !self.player.needs_verdicts());
    }

    /// Takes the results of background work.
    fn take_background(&mut self) {
        self.take_scene();
        if let Some(searching) = &self.searching {
            match searching.try_recv() {
                Ok(found) => {
                    self.searching = None;
                    self.stage.show_found(found);
                }
                Err(std::sync::mpsc::TryRecvError::Empty) => {}
                Err(std::sync::mpsc::TryRecvError::Disconnected) => {
                    self.searching = None;
                    self.say("The search for a view ended without a result; this is a bug of the viewer");
                }
            }
        }
        if let Some(chosen) = self.chooser.as_ref().map(Receiver::try_recv)
            && chosen != Err(std::sync::mpsc::TryRecvError::Empty)
        {
            self.chooser = None;
            self.commands.extend(chosen.ok().flatten().map(|path| Request::from(Command::OpenFile(path))));
        }
        self.take_saved();
        self.tuning.take();
        self.device_check.take();
        self.measuring.take();
    }

    /// Returns the state that undo and redo restore.
    fn state(&self) -> State {
        let stage = &self.stage;
        State {
            settings: stage.settings,
            other: stage.other_technique(),
            artefact: stage.artefact_show().clone(),
            sample: stage.sample().map(|show| show.values.clone()),
        }
    }

    /// Shows the outcome of a command. If it failed and a line of the script requested it, the script has
    /// failed, too.
    fn tell(&mut self, outcome: Result<String>) {
        let text = outcome.unwrap_or_else(|error| {
            if let Some(line) = &self.line {
                output::tell(format_args!("error: {line}: {error:#}"));
                self.player.failed = true;
            }
            format!("{error:#}")
        });
        self.say(text);
    }

    /// Returns the final error of the viewer or its script.
    pub(crate) fn outcome(&mut self) -> Result<()> {
        match self.failure.take() {
            Some(failure) => Err(failure),
            None if self.player.failed => Err(anyhow!("the script failed; see the errors above")),
            None => Ok(()),
        }
    }

    /// Shows a message for a while.
    pub(crate) fn say(&mut self, text: impl Into<String>) {
        self.message = Some(Message { text: text.into(), since: self.clock });
    }

    /// Returns the title of the window.
    pub(crate) fn title(&self) -> String {
        format!("shadowfit: {} ({})", self.source.label(), self.stage.gpu().name())
    }

    /// Returns whether background work is running that a script may wait for.
    pub(crate) fn is_waiting(&self) -> bool {
        self.loading.is_some()
            || self.searching.is_some()
            || !self.saving.is_empty()
            || self.tuning.is_running()
            || self.device_check.is_running()
            || self.measuring.is_running()
    }

    /// Returns whether a scene is loading.
    pub(crate) fn is_loading(&self) -> bool {
        self.loading.is_some()
    }

    /// Returns whether the script has ended and its last scene is loaded.
    pub(crate) fn has_played(&self) -> bool {
        self.player.is_done() && self.loading.is_none() && self.saving.is_empty()
    }

    /// Returns whether the first scene is shown.
    pub(crate) fn is_ready(&self) -> bool {
        self.has_scene
    }
}

/// Returns a key press for the panel's focused widget.
fn typed(chord: Chord) -> Event {
    let modifiers = egui::Modifiers {
        alt: chord.alt,
        ctrl: chord.ctrl,
        shift: chord.shift,
        command: chord.ctrl,
        ..Default::default()
    };
    Event::Key { key: chord.key, physical_key: None, pressed: true, repeat: false, modifiers }
}
