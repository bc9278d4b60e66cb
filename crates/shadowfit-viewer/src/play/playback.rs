//! Plays a script: turns its steps into keys, pointer events and commands, frame by frame.

use std::collections::VecDeque;

use egui::Event;
use shadowfit_egui::{Chord, Command};

use super::effect::{Activity, Effect};
use super::monkey::MonkeyRun;
use super::script::{Awaited, Line, Step};

/// Seconds that a script waits for something before it reports a failure and continues.
const PATIENCE: f32 = 600.0;
/// Frames that egui may need for a stable layout before the window is saved.
const SETTLING: u32 = 4;
/// Frames over which a drag is spread.
const DRAG_FRAMES: u32 = 6;

/// A step that takes more than one frame.
#[derive(Debug)]
enum Ongoing {
    Seconds(f32),
    Frames(u32),
    Release(Chord, f32),
    Drag { from: [f32; 2], to: [f32; 2], frame: u32 },
    Await(Awaited, f32),
    Save(Command, u32),
    Monkey(Box<MonkeyRun>),
}

/// The playback of a script.
#[derive(Debug, Default)]
pub(crate) struct Player {
    lines: VecDeque<Line>,
    /// The current line: file, number and text.
    place: String,
    ongoing: Option<Ongoing>,
    /// Whether the script shows the verdicts of every frame, and not only of frames that it awaits or saves.
    plots: bool,
    /// Whether a line failed, so that the script ends with an error.
    pub(crate) failed: bool,
}

impl Player {
    pub(crate) fn new(lines: Vec<Line>) -> Self {
        let plots = lines.is_empty() || lines.iter().any(|line| plots(&line.step));
        Self { lines: lines.into(), plots, ..Self::default() }
    }

    /// Returns whether the verdicts of this frame are needed even if the frame is not saved: a line awaits
    /// them, or a later line saves the plots of every frame.
    pub(crate) fn needs_verdicts(&self) -> bool {
        self.plots || matches!(self.ongoing, Some(Ongoing::Await(Awaited::Judged, _)))
    }

    pub(crate) fn is_done(&self) -> bool {
        self.lines.is_empty() && self.ongoing.is_none()
    }

    /// Returns whether random actions are playing.
    pub(crate) fn is_random(&self) -> bool {
        matches!(self.ongoing, Some(Ongoing::Monkey(_)))
    }

    /// Returns the line that causes this frame's effects; `None` for random actions, some of which are meant
    /// to fail.
    pub(crate) fn place(&self) -> Option<String> {
        (!self.is_random()).then(|| self.place.clone())
    }

    /// Returns the effects of this frame. `seconds` is the time since the previous one.
    pub(crate) fn advance(&mut self, seconds: f32, activity: &Activity) -> Vec<Effect> {
        let mut effects = Vec::new();
        if let Some(ongoing) = self.ongoing.take() {
            self.ongoing = self.go_on(ongoing, seconds, activity, &mut effects);
        }
        // One step per frame, so that each step sees the effect of the previous one.
        if self.ongoing.is_none()
            && effects.is_empty()
            && let Some(line) = self.lines.pop_front()
        {
            self.place = line.place;
            self.ongoing = start(line.step, &mut effects);
        }
        effects
    }

    fn go_on(
        &mut self,
        ongoing: Ongoing,
        seconds: f32,
        activity: &Activity,
        effects: &mut Vec<Effect>,
    ) -> Option<Ongoing> {
        match ongoing {
            Ongoing::Seconds(left) => (left > seconds).then_some(Ongoing::Seconds(left - seconds)),
            Ongoing::Frames(left) => (left > 1).then_some(Ongoing::Frames(left - 1)),
            Ongoing::Release(chord, left) if left > seconds => Some(Ongoing::Release(chord, left - seconds)),
            Ongoing::Release(chord, _) => {
                effects.push(Effect::Key(chord, false));
                None
            }
            Ongoing::Drag { from, to, frame } => drag(from, to, frame, effects),
            Ongoing::Await(what, waited) => self.wait(what, waited + seconds, activity, effects),
            Ongoing::Save(command, 0) => {
                effects.push(Effect::Run(command));
                None
            }
            Ongoing::Save(command, left) => Some(Ongoing::Save(command, left - 1)),
            Ongoing::Monkey(mut run) => run.advance(seconds, activity, effects).then_some(Ongoing::Monkey(run)),
        }
    }

    fn wait(&mut self, what: Awaited, waited: f32, activity: &Activity, effects: &mut Vec<Effect>) -> Option<Ongoing> {
        let is_there = match what {
            Awaited::Loaded => !activity.is_loading && !activity.is_searching,
            Awaited::Judged => activity.is_judged,
            Awaited::Tuned => !activity.is_tuning,
        };
        if is_there {
            return None;
        }
        if waited > PATIENCE {
            self.failed = true;
            let place = &self.place;
            effects.push(Effect::Print(format!(
                "error: {place}: the awaited state was not reached within {PATIENCE:.0} s; the script continues"
            )));
            return None;
        }
        Some(Ongoing::Await(what, waited))
    }
}

/// Returns whether a step shows the verdicts of every frame, as the window's plots do, or may have any
/// effect, as a click does.
fn plots(step: &Step) -> bool {
    match step {
        Step::Run(command) => matches!(command, Command::SaveWindow(_) | Command::SaveFigures(_)),
        Step::Wait(_) | Step::Frames(_) | Step::Await(_) | Step::Resize(_) => false,
        _ => true,
    }
}

/// Starts a step. Returns the part that remains for the next frames.
fn start(step: Step, effects: &mut Vec<Effect>) -> Option<Ongoing> {
    match step {
        Step::Run(command @ (Command::SaveWindow(_) | Command::Screenshot(_))) => {
            return Some(Ongoing::Save(command, SETTLING));
        }
        Step::Run(command) => effects.push(Effect::Run(command)),
        Step::Press(chord) => return Some(hold(chord, 0.0, effects)),
        Step::Hold(chord, seconds) => return Some(hold(chord, seconds, effects)),
        Step::Type(text) => effects.push(Effect::Input(Event::Text(text))),
        Step::Hover(at) => effects.push(Effect::moved(at)),
        Step::Click(at, times) => effects.extend(Effect::clicks(at, times)),
        Step::Drag(from, to) => return drag(from, to, 0, effects),
        Step::Wheel(notches) => effects.push(Effect::wheel(notches)),
        Step::Resize(size) => effects.push(Effect::Resize(size)),
        Step::LoseDevice => effects.push(Effect::LoseDevice),
        Step::Refuse(refusal) => effects.push(Effect::Refuse(refusal)),
        Step::Drop(path) => effects.push(Effect::Drop(path.into())),
        Step::Wait(seconds) => return Some(Ongoing::Seconds(seconds)),
        Step::Frames(frames) => return (frames > 0).then_some(Ongoing::Frames(frames)),
        Step::Await(what) => return Some(Ongoing::Await(what, 0.0)),
        Step::Monkey(monkey) => return Some(Ongoing::Monkey(Box::new(MonkeyRun::new(&monkey)))),
    }
    None
}

fn hold(chord: Chord, seconds: f32, effects: &mut Vec<Effect>) -> Ongoing {
    effects.push(Effect::Key(chord, true));
    Ongoing::Release(chord, seconds)
}

/// Plays a frame of a drag.
fn drag(from: [f32; 2], to: [f32; 2], frame: u32, effects: &mut Vec<Effect>) -> Option<Ongoing> {
    let share = frame as f32 / DRAG_FRAMES as f32;
    let at = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * share);
    effects.push(Effect::moved(at));
    if frame == 0 {
        effects.push(Effect::button(from, true));
    }
    if frame < DRAG_FRAMES {
        return Some(Ongoing::Drag { from, to, frame: frame + 1 });
    }
    effects.push(Effect::button(to, false));
    None
}

#[cfg(test)]
mod tests {
    use shadowfit_params::tool::ViewMode;

    use super::*;
    use crate::play::script::Monkey;

    const FRAME: f32 = 0.1;

    fn player(steps: Vec<Step>) -> Player {
        Player::new((1..).zip(steps).map(|(number, step)| Line { step, place: format!("script:{number}") }).collect())
    }

    fn play(steps: Vec<Step>, frames: usize, activity: &Activity) -> Vec<Vec<Effect>> {
        let mut player = player(steps);
        (0..frames).map(|_| player.advance(FRAME, activity)).collect()
    }

    #[test]
    fn steps_follow_each_other_and_wait_as_long_as_they_say() {
        let view = |mode| Step::Run(Command::View(mode));
        let steps = vec![
            view(ViewMode::Truth),
            Step::Wait(0.25),
            view(ViewMode::Error),
            Step::Frames(2),
            view(ViewMode::Final),
        ];
        let seen: Vec<usize> = play(steps, 12, &Activity::default()).iter().map(Vec::len).collect();
        assert_eq!(seen, [1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0]);
    }

    #[test]
    fn verdicts_are_needed_where_a_line_awaits_them_and_in_every_frame_where_the_window_is_saved() {
        let steps = |last| {
            let picture = Step::Run(Command::Screenshot(Some("a.png".into())));
            vec![Step::Frames(1), Step::Await(Awaited::Judged), picture, Step::Run(last)]
        };
        let needs = |last| {
            let mut player = player(steps(last));
            let frame = |player: &mut Player| {
                let saves = player.advance(FRAME, &Activity { is_judged: true, ..Activity::default() });
                (player.needs_verdicts(), !saves.is_empty())
            };
            (0..4 + SETTLING).map(|_| frame(&mut player)).collect::<Vec<_>>()
        };
        let unseen = (false, false);
        let alone = [unseen, (true, false), unseen, unseen, unseen, unseen, unseen, (false, true)];
        assert_eq!(needs(Command::Quit), alone);
        assert!(needs(Command::SaveWindow("b.png".into())).iter().all(|(needs, _)| *needs));
        assert!(player(Vec::new()).needs_verdicts(), "without a script");
    }

    #[test]
    fn keys_are_released_and_drags_arrive() {
        let chord = "w".parse::<Chord>().expect("a key");
        let effects = play(vec![Step::Hold(chord, 0.25)], 6, &Activity::default()).concat();
        assert_eq!(effects, [Effect::Key(chord, true), Effect::Key(chord, false)]);
        let effects = play(vec![Step::Drag([10.0, 20.0], [40.0, 20.0])], 10, &Activity::default()).concat();
        assert_eq!(effects.first(), Some(&Effect::moved([10.0, 20.0])));
        assert_eq!(effects.last(), Some(&Effect::button([40.0, 20.0], false)));
    }

    #[test]
    fn waiting_ends_when_the_thing_is_done_or_patience_is() {
        let mut player = player(vec![Step::Await(Awaited::Loaded), Step::Run(Command::Quit)]);
        let loading = Activity { is_loading: true, ..Activity::default() };
        for _ in 0..5 {
            assert_eq!(player.advance(FRAME, &loading), []);
        }
        assert_eq!(player.advance(FRAME, &Activity::default()), [Effect::Run(Command::Quit)]);
        assert!(player.is_done() && !player.failed);
        assert_eq!(player.place().as_deref(), Some("script:2"), "the line of the command");
        let mut player = self::player(vec![Step::Await(Awaited::Tuned)]);
        let tuning = Activity { is_tuning: true, ..Activity::default() };
        player.advance(FRAME, &tuning);
        assert!(
            matches!(&player.advance(2.0 * PATIENCE, &tuning)[..], [Effect::Print(text)] if text.contains("script:1"))
        );
        assert!(player.failed);
    }

    #[test]
    fn a_monkey_does_the_same_for_the_same_seed() {
        let steps = |seed| vec![Step::Monkey(Monkey { seconds: 3.0, seed, files: None })];
        let activity = Activity { size: [800.0, 600.0], ..Activity::default() };
        let effects = |seed| {
            let all = play(steps(seed), 40, &activity).concat();
            all.into_iter().filter(|effect| !matches!(effect, Effect::Print(_))).collect::<Vec<_>>()
        };
        assert_eq!(effects(1), effects(1));
        assert_ne!(effects(1), effects(2));
        assert!(effects(3).len() > 10);
    }

    #[test]
    fn a_monkey_neither_quits_nor_opens_a_dialog_and_its_failures_are_nobodys() {
        let mut player = player(vec![Step::Monkey(Monkey { seconds: 600.0, seed: 5, files: None })]);
        let activity = Activity { size: [800.0, 600.0], ..Activity::default() };
        let mut keys = 0;
        for _ in 0..2000 {
            for effect in player.advance(FRAME, &activity) {
                assert!(player.is_random() && player.place().is_none());
                let Effect::Key(chord, _) = effect else { continue };
                keys += 1;
                let unwanted = matches!(chord.command(), Some(Command::Quit | Command::ChooseFile));
                assert!(!unwanted, "{chord:?}");
            }
        }
        assert!(keys > 500, "{keys} keys");
    }
}
