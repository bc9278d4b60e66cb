//! Undo for every change, with egui's undoer: a change counts once it has lasted for a moment.

use egui::util::undoer::Undoer;
use shadowfit::Technique;
use shadowfit_classics::SampleValues;
use shadowfit_params::PARAMETERS;
use shadowfit_params::tool::Settings;
use shadowfit_render::FlyCamera;

use crate::stage::ArtefactShow;

/// State that undo restores. It includes the followed camera of the file, but not the position of a flown
/// camera.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct State {
    pub(crate) settings: Settings,
    /// The second technique of a comparison.
    pub(crate) other: Option<Technique>,
    pub(crate) artefact: ArtefactShow,
    /// Values of the current sample.
    pub(crate) sample: Option<SampleValues>,
}

impl State {
    /// Returns the state without values that change by themselves from frame to frame.
    fn still(&self) -> Self {
        let mut settings = self.settings;
        if settings.light.animate {
            (settings.light.azimuth, settings.light.hour) = (0.0, settings.light.hour.map(|_| 0.0));
        }
        if settings.light.file.is_some() {
            (settings.light.azimuth, settings.light.elevation) = (0.0, 0.0);
        }
        // The wheel changes the speed often, and flights change the height. While a camera of the file is
        // followed, only the user changes the height.
        settings.camera.speed = 0.0;
        if settings.camera.file.is_none() {
            settings.camera.height = settings.camera.height.map(|_| 1.0);
        }
        Self { settings, ..self.clone() }
    }

    /// Returns this state with the self-changing values of `now`. `height` is the last height of a flown
    /// orthographic picture, in metres.
    fn with_motion_of(mut self, now: &Self, height: Option<f32>) -> Self {
        let (light, last) = (&mut self.settings.light, &now.settings.light);
        if light.animate {
            light.azimuth = last.azimuth;
            light.hour = light.hour.map(|_| last.hour.unwrap_or(12.0));
        }
        if light.file.is_some() {
            (light.azimuth, light.elevation) = (last.azimuth, last.elevation);
        }
        let camera = &mut self.settings.camera;
        camera.speed = now.settings.camera.speed;
        if camera.file.is_none() {
            camera.height = camera.height.map(|masked| height.unwrap_or(masked));
        }
        self
    }

    /// Returns the differences from another state in a few words.
    fn difference(&self, other: &Self) -> String {
        let differs = |a: &Settings, b: &Settings| {
            PARAMETERS.iter().filter(|parameter| !parameter.is_equal(a, b)).map(|parameter| parameter.label).collect()
        };
        let mut names: Vec<&str> = differs(&self.settings, &other.settings);
        if self.other != other.other {
            names.push("comparison");
        }
        if let (Some(a), Some(b)) = (&self.sample, &other.sample) {
            let differs = a.iter().zip(b.iter()).filter(|((_, a), (_, b))| a != b);
            names.extend(differs.map(|((option, _), _)| option.label));
        }
        if self.artefact != other.artefact && names.is_empty() {
            names.push("artefact");
        }
        match names[..] {
            [] => "change".to_owned(),
            [one] => one.to_owned(),
            [first, ..] => format!("{first} and {} more", names.len() - 1),
        }
    }
}

/// The stored states.
#[derive(Debug, Default)]
pub(crate) struct History {
    undoer: Undoer<State>,
    /// Names of the next changes to undo and redo.
    undo: Option<String>,
    redo: Option<String>,
    last: Option<State>,
    /// Last height of an orthographic picture without a camera of the file, in metres.
    height: Option<f32>,
    /// Last view of a flown camera.
    flown: Option<FlyCamera>,
}

impl History {
    /// Stores the current state and the camera's view, at a time in seconds.
    pub(crate) fn feed(&mut self, seconds: f64, state: &State, place: FlyCamera) {
        let still = state.still();
        let camera = &state.settings.camera;
        if camera.file.is_none() {
            self.height = camera.height.or(self.height);
            self.flown = Some(place);
        }
        self.undoer.feed_state(seconds, &still);
        if self.last.as_ref() != Some(&still) {
            self.name(&still);
            self.last = Some(still);
        }
    }

    /// Returns the state before the last change.
    pub(crate) fn undo(&mut self, now: &State) -> Option<State> {
        let still = now.still();
        let state = self.undoer.undo(&still).cloned()?;
        self.name(&state);
        self.last = Some(state.clone());
        Some(state.with_motion_of(now, self.height))
    }

    /// Returns the state after the change that was undone.
    pub(crate) fn redo(&mut self, now: &State) -> Option<State> {
        let still = now.still();
        let state = self.undoer.redo(&still).cloned()?;
        self.name(&state);
        self.last = Some(state.clone());
        Some(state.with_motion_of(now, self.height))
    }

    /// Returns the last view of a flown camera if the change from one state to another stops following a
    /// camera of the file.
    pub(crate) fn flown_again(&self, from: &State, to: &State) -> Option<FlyCamera> {
        let leaves = from.settings.camera.file.is_some() && to.settings.camera.file.is_none();
        self.flown.filter(|_| leaves)
    }

    /// Returns the name of the next change to undo.
    pub(crate) fn undo_name(&self) -> Option<&str> {
        self.undo.as_deref()
    }

    /// Returns the name of the next change to redo.
    pub(crate) fn redo_name(&self) -> Option<&str> {
        self.redo.as_deref()
    }

    /// Names both changes, by undoing and redoing on a copy.
    fn name(&mut self, still: &State) {
        let mut copy = self.undoer.clone();
        self.undo = copy.undo(still).map(|before| before.difference(still));
        let mut copy = self.undoer.clone();
        self.redo = copy.redo(still).map(|after| after.difference(still));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STILL: FlyCamera = FlyCamera { position: glam::DVec3::ZERO, yaw: 0.0, pitch: 0.0, roll: 0.0 };

    fn state(count: u32) -> State {
        let settings = Settings::default().with_technique(Technique::default().with_count(count));
        State { settings, other: None, artefact: ArtefactShow::default(), sample: None }
    }

    #[test]
    fn changes_are_named_taken_back_and_made_again() {
        let mut history = History::default();
        let mut seconds = 0.0;
        let mut feed = |history: &mut History, state: &State| {
            for _ in 0..40 {
                seconds += 0.1;
                history.feed(seconds, state, STILL);
            }
        };
        let (four, three) = (state(4), state(3));
        feed(&mut history, &four);
        assert_eq!((history.undo_name(), history.redo_name()), (None, None));
        feed(&mut history, &three);
        assert!(history.undo_name().is_some_and(|name| name == "Maps"), "{:?}", history.undo_name());
        assert_eq!(history.undo(&three), Some(four.clone()));
        assert!(history.redo_name().is_some());
        assert_eq!(history.redo(&four), Some(three));
    }

    /// Feeds a state for 4 s.
    fn rest(history: &mut History, seconds: &mut f64, state: &State) {
        for _ in 0..40 {
            *seconds += 0.1;
            history.feed(*seconds, state, STILL);
        }
    }

    #[test]
    fn a_camera_of_the_file_is_taken_back_and_made_again_with_its_whole_lens() {
        let (mut history, mut seconds) = (History::default(), 0.0);
        let (mut one, mut two) = (state(4), state(4));
        (one.settings.camera.file, one.settings.camera.fov_y) = (Some(1), 1.2);
        let camera = &mut two.settings.camera;
        (camera.file, camera.height, camera.near, camera.far) = (Some(2), Some(600.0), 3.0, 900.0);
        for state in [&one, &two] {
            rest(&mut history, &mut seconds, state);
        }
        assert_eq!(history.undo(&two).map(|state| state.settings.camera), Some(one.settings.camera));
        rest(&mut history, &mut seconds, &one);
        assert_eq!(history.redo(&one).map(|state| state.settings.camera), Some(two.settings.camera));
    }

    #[test]
    fn a_flown_orthographic_picture_comes_back_with_its_last_height() {
        let (mut history, mut seconds) = (History::default(), 0.0);
        let mut flown = state(4);
        for height in [900.0, 600.0] {
            flown.settings.camera.height = Some(height);
            rest(&mut history, &mut seconds, &flown);
        }
        assert_eq!(history.undo_name(), None, "a flight is no change");
        let mut perspective = flown.clone();
        perspective.settings.camera.height = None;
        rest(&mut history, &mut seconds, &perspective);
        let back = history.undo(&perspective).expect("a change");
        assert_eq!(back.settings.camera.height, Some(600.0));
    }

    #[test]
    fn a_sun_that_moves_is_no_change_and_goes_on_from_where_it_is() {
        let mut history = History::default();
        let mut moving = state(4);
        moving.settings.light.animate = true;
        for frame in 0..100 {
            moving.settings.light.azimuth = frame as f32 * 0.01;
            history.feed(f64::from(frame) * 0.1, &moving, STILL);
        }
        assert_eq!(history.undo_name(), None);
        let mut fewer = moving.clone();
        fewer.settings.technique = fewer.settings.technique.with_count(2);
        for frame in 100..200 {
            fewer.settings.light.azimuth = frame as f32 * 0.01;
            history.feed(f64::from(frame) * 0.1, &fewer, STILL);
        }
        let back = history.undo(&fewer).expect("a change");
        assert_eq!(back.settings.technique.maps.count(), 4);
        assert_eq!(back.settings.light.azimuth, fewer.settings.light.azimuth);
    }
}
