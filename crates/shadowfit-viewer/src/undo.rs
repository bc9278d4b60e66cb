//! Undo for every change, by egui's own undoer: a change counts once it has lasted for a moment.

use egui::util::undoer::Undoer;
use shadowfit::Technique;
use shadowfit_classics::SampleValues;
use shadowfit_params::PARAMETERS;
use shadowfit_params::tool::Settings;

use crate::stage::ArtefactShow;

/// Everything that undo restores. The camera is not part of it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct State {
    pub(crate) settings: Settings,
    /// The technique that the first one is compared with.
    pub(crate) other: Option<Technique>,
    pub(crate) artefact: ArtefactShow,
    /// Values of the sample on show.
    pub(crate) sample: Option<SampleValues>,
}

impl State {
    /// The same without values that change by themselves from frame to frame.
    fn still(&self) -> Self {
        let mut settings = self.settings;
        if settings.light.animate {
            (settings.light.azimuth, settings.light.hour) = (0.0, settings.light.hour.map(|_| 0.0));
        }
        if settings.light.file.is_some() {
            (settings.light.azimuth, settings.light.elevation) = (0.0, 0.0);
        }
        // The wheel, flights and the view search change them all the time.
        let camera = &mut settings.camera;
        (camera.speed, camera.file, camera.height) = (0.0, None, camera.height.map(|_| 1.0));
        Self { settings, ..self.clone() }
    }

    /// This state, with the values of `now` for those that change by themselves.
    fn with_motion_of(mut self, now: &Self) -> Self {
        let (light, last) = (&mut self.settings.light, &now.settings.light);
        if light.animate {
            light.azimuth = last.azimuth;
            light.hour = light.hour.map(|_| last.hour.unwrap_or(12.0));
        }
        if light.file.is_some() {
            (light.azimuth, light.elevation) = (last.azimuth, last.elevation);
        }
        let (camera, last) = (&mut self.settings.camera, &now.settings.camera);
        (camera.speed, camera.file) = (last.speed, last.file);
        camera.height = camera.height.map(|height| last.height.unwrap_or(height));
        self
    }

    /// Differences to another state, in a few words.
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

/// The states that can be gone back to.
#[derive(Debug, Default)]
pub(crate) struct History {
    undoer: Undoer<State>,
    /// Names of the changes that undo and redo would concern.
    undo: Option<String>,
    redo: Option<String>,
    last: Option<State>,
}

impl History {
    /// Notes the present state, at a time in seconds.
    pub(crate) fn feed(&mut self, seconds: f64, state: &State) {
        let still = state.still();
        self.undoer.feed_state(seconds, &still);
        if self.last.as_ref() != Some(&still) {
            self.name(&still);
            self.last = Some(still);
        }
    }

    /// The state before the last change.
    pub(crate) fn undo(&mut self, now: &State) -> Option<State> {
        let still = now.still();
        let state = self.undoer.undo(&still).cloned()?;
        self.name(&state);
        self.last = Some(state.clone());
        Some(state.with_motion_of(now))
    }

    /// The state after the change that was undone.
    pub(crate) fn redo(&mut self, now: &State) -> Option<State> {
        let still = now.still();
        let state = self.undoer.redo(&still).cloned()?;
        self.name(&state);
        self.last = Some(state.clone());
        Some(state.with_motion_of(now))
    }

    /// Name of the change that undo would take back.
    pub(crate) fn undo_name(&self) -> Option<&str> {
        self.undo.as_deref()
    }

    /// Name of the change that redo would make.
    pub(crate) fn redo_name(&self) -> Option<&str> {
        self.redo.as_deref()
    }

    /// Names both changes: by going there and back on a copy.
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
                history.feed(seconds, state);
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

    #[test]
    fn a_sun_that_moves_is_no_change_and_goes_on_from_where_it_is() {
        let mut history = History::default();
        let mut moving = state(4);
        moving.settings.light.animate = true;
        for frame in 0..100 {
            moving.settings.light.azimuth = frame as f32 * 0.01;
            history.feed(f64::from(frame) * 0.1, &moving);
        }
        assert_eq!(history.undo_name(), None);
        let mut fewer = moving.clone();
        fewer.settings.technique = fewer.settings.technique.with_count(2);
        for frame in 100..200 {
            fewer.settings.light.azimuth = frame as f32 * 0.01;
            history.feed(f64::from(frame) * 0.1, &fewer);
        }
        let back = history.undo(&fewer).expect("a change");
        assert_eq!(back.settings.technique.maps.count(), 4);
        assert_eq!(back.settings.light.azimuth, fewer.settings.light.azimuth);
    }
}
