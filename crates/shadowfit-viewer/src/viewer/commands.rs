//! Running of commands.

use std::sync::mpsc::channel;

use anyhow::{Context, Result, anyhow};
use shadowfit::Technique;
use shadowfit_egui::{Artefact, Command, Toggle, UserPreset, keys_of};
use shadowfit_params as params;
use shadowfit_params::tool::{ErrorMarks, HEIGHTS, InsetMaps, ViewMode};
use shadowfit_render::FlyCamera;
use shadowfit_study::{NamedTechnique, in_background};

use super::Viewer;
use crate::arguments::find_technique;
use crate::background::tuning::Task;
use crate::keep::command_line::command_line;
use crate::keep::saved::Bookmark;
use crate::keep::undo::State;
use crate::scene_source::{OPTION_PREFIX, SceneSource};
use crate::stage::compared_with;

/// Share of the distance to a point that the camera flies. The height of an orthographic picture shrinks by
/// the same share.
const FOCUS: f64 = 0.6;

impl Viewer {
    /// Runs a command.
    pub(super) fn run(&mut self, command: Command) {
        let takes_compute = match command {
            Command::View(mode) => mode.needs_compute(),
            Command::NextMarks => true,
            _ => false,
        };
        if let Some(reason) = self.stage.no_compute().filter(|_| takes_compute) {
            return self.say(reason);
        }
        let Some(command) = self.run_on_view(command) else { return };
        match command {
            Command::ToggleHelp => self.interface.help_open = !self.interface.help_open,
            Command::TogglePanel => self.interface.bare = !self.interface.bare,
            Command::SetTheme(theme) => {
                self.saved.theme = theme.into();
                self.interface.context.set_theme(theme);
            }
            Command::CheckDevice => self.device_check.start(self.stage.gpu()),
            Command::CancelCheck => self.device_check.cancel(),
            Command::CloseCheck => self.device_check.close(),
            Command::CopyCheck => self.copy_check(),
            Command::Escape => self.escape(),
            Command::Quit => self.window_requests.quit = self.page.is_none(),
            // Everything else needs a scene.
            _ if !self.has_scene => {
                if self.line.is_some() {
                    self.tell(Err(anyhow!("no scene has been loaded yet; begin the script with `await loaded`")));
                }
            }
            command => self.run_on_scene(command),
        }
    }

    /// Runs a command that changes the contents of the picture. Returns any other command.
    fn run_on_view(&mut self, command: Command) -> Option<Command> {
        let view = &mut self.stage.settings.view;
        match command {
            Command::View(mode) => view.mode = mode,
            Command::ToggleOutside => {
                view.mode = if view.mode == ViewMode::Outside { ViewMode::Final } else { ViewMode::Outside };
            }
            Command::NextMarks => {
                view.marks = match view.marks {
                    ErrorMarks::Off => ErrorMarks::Outline,
                    ErrorMarks::Outline => ErrorMarks::Blink,
                    ErrorMarks::Blink => ErrorMarks::Off,
                }
            }
            Command::NextInset => {
                view.inset = match view.inset {
                    InsetMaps::Off => InsetMaps::One,
                    InsetMaps::One => InsetMaps::All,
                    InsetMaps::All => InsetMaps::Off,
                }
            }
            Command::ToggleFreeze => view.freeze_fit = !view.freeze_fit,
            Command::TogglePlay => view.play = !view.play,
            Command::ToggleSun => self.stage.settings.light.animate = !self.stage.settings.light.animate,
            Command::Scrub(seconds) if seconds.is_finite() => {
                view.play = false;
                self.stage.set_time(seconds.max(0.0));
            }
            other => return Some(other),
        }
        None
    }

    /// Copies the report of the device check.
    fn copy_check(&mut self) {
        if let Some(report) = self.device_check.report() {
            self.interface.context.copy_text(report.text());
            self.say("Copied the report of the check");
        }
    }

    fn escape(&mut self) {
        let context = &self.interface.context;
        if egui::Popup::is_any_open(context) {
            egui::Popup::close_all(context);
        } else if self.device_check.report().is_some() {
            self.device_check.close();
        } else if self.interface.help_open {
            self.interface.help_open = false;
        } else if self.interface.drawer_open {
            self.interface.drawer_open = false;
        } else {
            self.run(Command::Quit);
        }
    }

    fn run_on_scene(&mut self, command: Command) {
        let is_of_techniques = matches!(
            command,
            Command::ShowArtefact(_) | Command::Compare(Toggle::On | Toggle::Switch) | Command::StartTune
        );
        if is_of_techniques && self.stage.draws_sample() {
            return self.say("This needs modern maps: choose them as the sample's shadows first");
        }
        match command {
            Command::ShowArtefact(artefact) => self.search(artefact),
            Command::FixArtefact => self.fix(),
            Command::CloseArtefact => self.stage.close_artefact(),
            Command::Compare(toggle) => self.compare(toggle),
            Command::Split(share) => self.stage.set_split(share),
            Command::SwapSides => {
                self.stage.swap_sides();
                self.tuning.is_of_other ^= self.stage.is_comparing();
            }
            Command::CopyToOther => self.copy_to_other(),
            Command::Undo => self.go_back(),
            Command::Redo => self.go_forward(),
            Command::Reset => {
                self.searching = None;
                self.stage.reset();
                self.stage.compare_with(None);
                self.interface.edits_other = false;
            }
            Command::ShowSampleVariant(variant) => self.show_sample_variant(variant),
            Command::SetSampleOption { index, value } => self.stage.set_sample_option(index, value),
            Command::MeasureSample => self.measure_sample(),
            Command::StartTune => self.start_tune(),
            Command::CancelTune => self.tuning.cancel(),
            Command::ApplyTune => self.apply_tune(),
            Command::DiscardTune => self.tuning.discard(),
            command => self.run_on_camera(command),
        }
    }

    fn run_on_camera(&mut self, command: Command) {
        match command {
            Command::ResetCamera => self.stage.reset_camera(),
            Command::LevelCamera => self.stage.level_camera(),
            Command::LookAt { eye, target } => self.stage.set_camera(FlyCamera::look_at(eye.into(), target.into())),
            Command::Focus(at) => self.focus(at),
            Command::SetBookmark(key) => self.set_bookmark(key),
            command => self.run_with_files(command),
        }
    }

    fn run_with_files(&mut self, command: Command) {
        let outcome = match command {
            Command::Open(name) => return self.open(SceneSource::from_text(&name)),
            Command::OpenFile(path) => return self.open_file(&path),
            Command::ChooseFile => return self.choose_file(),
            Command::SaveWindow(path) => return self.ask_for_window(path),
            Command::GoToBookmark(key) => self.go_to_bookmark(key),
            Command::Set(id, value) => self.set(&id, &value),
            Command::Technique(name) => {
                find_technique(&name, &self.edited_technique()).map(|named| self.take_technique(named))
            }
            Command::Screenshot(path) => match self.save_picture(path) {
                Ok(()) => return,
                Err(error) => Err(error),
            },
            Command::SaveFigures(path) => {
                let text = self.interface.panel().figures_csv();
                self.save_text(path, &text)
            }
            Command::CopyLink => Ok(self.copy_link()),
            Command::CopyRust => {
                let code = params::to_rust(&self.edited_technique());
                self.interface.context.copy_text(code);
                Ok("Copied the technique as Rust code".to_owned())
            }
            Command::CopyCommandLine => {
                self.interface.context.copy_text(self.command_line());
                Ok("Copied the command line".to_owned())
            }
            Command::SavePreset(name) => self.save_preset(&name),
            Command::DeletePreset(name) => {
                self.saved.presets.retain(|preset| preset.name != name);
                self.presets.retain(|preset| preset.name != name);
                Ok(format!("Deleted {name}"))
            }
            _ => return,
        };
        self.tell(outcome);
    }

    /// Searches for a view that shows an artefact, on a thread.
    fn search(&mut self, artefact: Artefact) {
        let search = self.stage.search(artefact);
        let (sender, receiver) = channel();
        let work = move || {
            // The receiver is gone after another artefact was requested.
            let _ = sender.send(search.run());
        };
        if in_background("search", work).is_ok() {
            self.searching = Some(receiver);
        }
    }

    fn fix(&mut self) {
        if let Some(shown) = self.stage.shown().filter(|_| self.searching.is_none()) {
            self.stage.fix_artefact(shown.artefact);
        }
    }

    fn compare(&mut self, toggle: Toggle) {
        let now = self.stage.settings.technique;
        let other = toggle.apply(self.stage.is_comparing()).then(|| {
            let known = self.stage.other_technique();
            known.unwrap_or_else(|| compared_with(&now))
        });
        self.stage.compare_with(other);
        self.interface.edits_other &= self.stage.is_comparing();
    }

    fn copy_to_other(&mut self) {
        let edited = self.edited_technique();
        let edits_other = self.interface.edits_other;
        match self.stage.settings_and_other() {
            (settings, Some(_)) if edits_other => settings.technique = edited,
            (_, Some(other)) => *other = edited,
            _ => {}
        }
    }

    fn go_back(&mut self) {
        let now = self.state();
        if let Some(state) = self.history.undo(&now) {
            self.go_to(&now, state);
        }
    }

    fn go_forward(&mut self) {
        let now = self.state();
        if let Some(state) = self.history.redo(&now) {
            self.go_to(&now, state);
        }
    }

    /// Restores a state, and the last position of a flown camera.
    fn go_to(&mut self, now: &State, state: State) {
        let flown = self.history.flown_again(now, &state);
        self.restore_state(state);
        if let Some(place) = flown {
            self.stage.set_camera(place);
        }
    }

    pub(super) fn restore_state(&mut self, state: State) {
        self.stage.restore_settings(&state.settings);
        if let Some(values) = state.sample {
            self.stage.set_sample_values(values);
        }
        self.stage.compare_with(state.other);
        self.stage.restore_artefact(state.artefact);
    }

    /// Flies toward the surface at a point of the picture, in views of the camera. An orthographic camera
    /// keeps its direction, moves until the point is in the middle, and reduces its height. The roll stays.
    fn focus(&mut self, at: [f32; 2]) {
        if !self.stage.settings.view.mode.shows_camera() {
            return;
        }
        let Some(target) = self.stage.pick(at, self.interface.pictures.size()) else { return };
        let camera = self.stage.camera;
        let way = target - camera.position;
        let nearer = if let Some(height) = &mut self.stage.settings.camera.height {
            *height = (*height * (1.0 - FOCUS) as f32).clamp(HEIGHTS.0, HEIGHTS.1);
            let across = way.reject_from(camera.forward().as_dvec3());
            FlyCamera { position: camera.position + across, ..camera }
        } else {
            FlyCamera { roll: camera.roll, ..FlyCamera::look_at(camera.position + way * FOCUS, target) }
        };
        self.stage.set_camera(nearer);
    }

    fn set_bookmark(&mut self, key: u8) {
        let bookmark = Bookmark::new(key, &self.source, self.stage.camera);
        self.saved.bookmarks.retain(|other| !other.is_of(key, &self.source));
        self.saved.bookmarks.push(bookmark);
        self.say(format!("Bookmark {key}: {} returns to this view", digit_keys(&Command::GoToBookmark(1), key)));
    }

    fn go_to_bookmark(&mut self, key: u8) -> Result<String> {
        let known = self.saved.bookmarks.iter().find(|bookmark| bookmark.is_of(key, &self.source));
        let set = digit_keys(&Command::SetBookmark(1), key);
        let none = || format!("No bookmark {key} in this scene; {set} sets it");
        self.stage.set_camera(known.and_then(Bookmark::camera).with_context(none)?);
        Ok(format!("Bookmark {key}"))
    }

    fn start_tune(&mut self) {
        let technique = self.edited_technique();
        self.tuning.start(Task {
            adapter: self.start.arguments.adapter(),
            scene: self.stage.prepared_scene().shared_scene(),
            pose: (self.stage.animation, self.stage.seconds()),
            settings: self.stage.settings.with_technique(technique),
            ray_offset: self.stage.ray_offset(),
            views: self.stage.views_to_tune(self.interface.pictures.size()),
            is_of_other: self.interface.edits_other && self.stage.is_comparing(),
        });
    }

    /// Applies the result of the search, on the side where it started.
    fn apply_tune(&mut self) {
        let is_of_other = self.tuning.is_of_other;
        let side = match self.stage.settings_and_other() {
            (_, None) if is_of_other => {
                return self.say("Technique B, for which this was found, is no longer shown");
            }
            (_, Some(other)) if is_of_other => other,
            (settings, _) => &mut settings.technique,
        };
        if let Some(technique) = self.tuning.apply() {
            *side = technique;
        }
    }

    fn set(&mut self, id: &str, value: &str) -> Result<String> {
        if let Some(option) = id.strip_prefix(OPTION_PREFIX) {
            self.stage.set_sample_text(option, value)?;
            return Ok(format!("{id} = {value}"));
        }
        let is_technique = params::parameter(id).is_some_and(|parameter| parameter.group.is_technique());
        if is_technique {
            params::set_technique_from_str(self.edited(), id, value)?;
        } else {
            params::set_from_str(&mut self.stage.settings, id, value)?;
            // The next action may change the lens of the camera that this action chooses.
            self.stage.follow_file();
        }
        Ok(format!("{id} = {value}"))
    }

    /// Uses a technique on the side that the panel edits.
    pub(super) fn take_technique(&mut self, named: NamedTechnique) -> String {
        *self.edited() = named.technique;
        self.stage.settings.inputs = named.inputs;
        let told = format!("Technique {}", named.name);
        self.interface.panel().name_technique(named.name, &named.technique);
        told
    }

    /// Returns the technique that the panel edits.
    pub(super) fn edited_technique(&self) -> Technique {
        let other = self.stage.other_technique().filter(|_| self.interface.edits_other);
        other.unwrap_or(self.stage.settings.technique)
    }

    /// Returns the technique that the panel edits, for changes.
    pub(super) fn edited(&mut self) -> &mut Technique {
        let edits_other = self.interface.edits_other;
        let (settings, other) = self.stage.settings_and_other();
        match other {
            Some(other) if edits_other => other,
            _ => &mut settings.technique,
        }
    }

    /// Returns the command line that starts with this scene and these settings.
    pub(super) fn command_line(&self) -> String {
        command_line(
            &self.source,
            self.stage.animation,
            &self.stage.settings,
            &self.own_with_lens(),
            self.stage.sample(),
        )
    }

    fn save_preset(&mut self, name: &str) -> Result<String> {
        let name = name.trim();
        let is_built_in = NamedTechnique::preset(name).is_some();
        let named = NamedTechnique { name: name.to_owned(), ..self.edited_technique().into() };
        // A technique that cannot be written cannot be read back.
        named.to_toml().context("this technique cannot be saved")?;
        if name.is_empty() || is_built_in {
            return Err(anyhow!("a preset needs its own name; {name:?} is empty or the name of a built-in preset"));
        }
        self.saved.presets.retain(|preset| preset.name != name);
        self.presets.retain(|preset| preset.name != name);
        self.presets.push(preset(&named));
        self.saved.presets.push(named);
        Ok(format!("Saved the technique as {name}"))
    }
}

/// Returns the keys for a digit of a command that is listed for 1.
fn digit_keys(command: &Command, digit: u8) -> String {
    keys_of(command).replace("1 … 9", &digit.to_string())
}

/// Converts a saved technique for the panel.
pub(super) fn preset(named: &NamedTechnique) -> UserPreset {
    UserPreset { name: named.name.clone(), technique: named.technique }
}
