//! Plays a script: turns its steps into keys, pointer events and commands, frame by frame.

use std::collections::VecDeque;
use std::path::PathBuf;

use egui::{Event, Modifiers, PointerButton, Pos2};

use crate::command::Command;
use crate::keys::Chord;
use crate::monkey::MonkeyRun;
use crate::script::{Awaited, Line, Step};

/// Seconds that a script waits for something before it goes on and says so.
const PATIENCE: f32 = 600.0;
/// Frames that egui may take until a layout stands, before the window is saved.
const SETTLING: u32 = 4;
/// Frames over which a drag is spread.
const DRAG_FRAMES: u32 = 6;

/// What a step asks for in a frame.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Deed {
    Do(Command),
    /// Whether it is pressed.
    Key(Chord, bool),
    Pointer(Event),
    Resize([u32; 2]),
    Drop(PathBuf),
    /// To the standard error.
    Say(String),
}

/// What the viewer is doing, for steps that wait for it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is asked about by a step of its own")]
pub(crate) struct Doing {
    pub(crate) is_loading: bool,
    pub(crate) is_searching: bool,
    pub(crate) is_judged: bool,
    pub(crate) is_tuning: bool,
    /// Window, in points.
    pub(crate) size: [f32; 2],
}

/// A step that takes more than a frame.
#[derive(Debug)]
enum Under {
    Seconds(f32),
    Frames(u32),
    Release(Chord, f32),
    Drag { from: [f32; 2], to: [f32; 2], frame: u32 },
    Await(Awaited, f32),
    Save(Command, u32),
    Monkey(Box<MonkeyRun>),
}

/// A script being played.
#[derive(Debug, Default)]
pub(crate) struct Player {
    lines: VecDeque<Line>,
    /// Where the line stands that is being played.
    place: String,
    under: Option<Under>,
    /// Whether something went wrong that a script should not end well with.
    pub(crate) failed: bool,
}

impl Player {
    pub(crate) fn new(lines: Vec<Line>) -> Self {
        Self { lines: lines.into(), ..Self::default() }
    }

    pub(crate) fn is_done(&self) -> bool {
        self.lines.is_empty() && self.under.is_none()
    }

    /// Whether random actions are under way.
    pub(crate) fn is_random(&self) -> bool {
        matches!(self.under, Some(Under::Monkey(_)))
    }

    /// Where the line stands that asks for what is to be done in this frame; `None` for random actions, some of which
    /// are meant to fail.
    pub(crate) fn place(&self) -> Option<String> {
        (!self.is_random()).then(|| self.place.clone())
    }

    /// What is to be done in this frame, which follows the one before after a number of seconds.
    pub(crate) fn advance(&mut self, seconds: f32, doing: &Doing) -> Vec<Deed> {
        let mut deeds = Vec::new();
        if let Some(under) = self.under.take() {
            self.under = self.go_on(under, seconds, doing, &mut deeds);
        }
        // One step a frame, so that each sees what the one before has done.
        if self.under.is_none()
            && deeds.is_empty()
            && let Some(line) = self.lines.pop_front()
        {
            self.place = line.place;
            self.under = begin(line.step, &mut deeds);
        }
        deeds
    }

    fn go_on(&mut self, under: Under, seconds: f32, doing: &Doing, deeds: &mut Vec<Deed>) -> Option<Under> {
        match under {
            Under::Seconds(left) => (left > seconds).then_some(Under::Seconds(left - seconds)),
            Under::Frames(left) => (left > 1).then_some(Under::Frames(left - 1)),
            Under::Release(chord, left) if left > seconds => Some(Under::Release(chord, left - seconds)),
            Under::Release(chord, _) => {
                deeds.push(Deed::Key(chord, false));
                None
            }
            Under::Drag { from, to, frame } => drag(from, to, frame, deeds),
            Under::Await(what, waited) => self.wait(what, waited + seconds, doing, deeds),
            Under::Save(command, 0) => {
                deeds.push(Deed::Do(command));
                None
            }
            Under::Save(command, left) => Some(Under::Save(command, left - 1)),
            Under::Monkey(mut run) => run.advance(seconds, doing, deeds).then_some(Under::Monkey(run)),
        }
    }

    fn wait(&mut self, what: Awaited, waited: f32, doing: &Doing, deeds: &mut Vec<Deed>) -> Option<Under> {
        let is_there = match what {
            Awaited::Loaded => !doing.is_loading && !doing.is_searching,
            Awaited::Judged => doing.is_judged,
            Awaited::Tuned => !doing.is_tuning,
        };
        if is_there {
            return None;
        }
        if waited > PATIENCE {
            self.failed = true;
            let place = &self.place;
            deeds
                .push(Deed::Say(format!("error: {place}: it did not come within {PATIENCE:.0} s; the script goes on")));
            return None;
        }
        Some(Under::Await(what, waited))
    }
}

/// Begins a step; returns what is left of it for the next frames.
fn begin(step: Step, deeds: &mut Vec<Deed>) -> Option<Under> {
    match step {
        Step::Do(command @ (Command::Window(_) | Command::Picture(_))) => return Some(Under::Save(command, SETTLING)),
        Step::Do(command) => deeds.push(Deed::Do(command)),
        Step::Press(chord) => return Some(hold(chord, 0.0, deeds)),
        Step::Hold(chord, seconds) => return Some(hold(chord, seconds, deeds)),
        Step::Type(text) => deeds.push(Deed::Pointer(Event::Text(text))),
        Step::Hover(at) => deeds.push(moved(at)),
        Step::Click(at, times) => deeds.extend(clicks(at, times)),
        Step::Drag(from, to) => return drag(from, to, 0, deeds),
        Step::Wheel(notches) => deeds.push(wheel(notches)),
        Step::Resize(size) => deeds.push(Deed::Resize(size)),
        Step::Drop(path) => deeds.push(Deed::Drop(path.into())),
        Step::Wait(seconds) => return Some(Under::Seconds(seconds)),
        Step::Frames(frames) => return (frames > 0).then_some(Under::Frames(frames)),
        Step::Await(what) => return Some(Under::Await(what, 0.0)),
        Step::Monkey(monkey) => return Some(Under::Monkey(Box::new(MonkeyRun::new(&monkey)))),
    }
    None
}

fn hold(chord: Chord, seconds: f32, deeds: &mut Vec<Deed>) -> Under {
    deeds.push(Deed::Key(chord, true));
    Under::Release(chord, seconds)
}

fn moved([x, y]: [f32; 2]) -> Deed {
    Deed::Pointer(Event::PointerMoved(Pos2::new(x, y)))
}

fn button([x, y]: [f32; 2], pressed: bool) -> Deed {
    let modifiers = Modifiers::NONE;
    Deed::Pointer(Event::PointerButton { pos: Pos2::new(x, y), button: PointerButton::Primary, pressed, modifiers })
}

/// Clicks, all in one frame.
pub(crate) fn clicks(at: [f32; 2], times: u32) -> impl Iterator<Item = Deed> {
    std::iter::once(moved(at)).chain((0..times).flat_map(move |_| [button(at, true), button(at, false)]))
}

/// Notches of the wheel.
pub(crate) fn wheel(notches: f32) -> Deed {
    let (unit, phase) = (egui::MouseWheelUnit::Line, egui::TouchPhase::Move);
    let delta = egui::Vec2::new(0.0, notches);
    Deed::Pointer(Event::MouseWheel {
        unit,
        delta,
        phase,
        modifiers: Modifiers::NONE,
        source: egui::MouseWheelSource::Unknown,
    })
}

/// A frame of a drag.
fn drag(from: [f32; 2], to: [f32; 2], frame: u32, deeds: &mut Vec<Deed>) -> Option<Under> {
    let share = frame as f32 / DRAG_FRAMES as f32;
    let at = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * share);
    deeds.push(moved(at));
    if frame == 0 {
        deeds.push(button(from, true));
    }
    if frame < DRAG_FRAMES {
        return Some(Under::Drag { from, to, frame: frame + 1 });
    }
    deeds.push(button(to, false));
    None
}

#[cfg(test)]
mod tests {
    use shadowfit_params::tool::ViewMode;

    use super::*;
    use crate::script::Monkey;

    const FRAME: f32 = 0.1;

    fn player(steps: Vec<Step>) -> Player {
        Player::new((1..).zip(steps).map(|(number, step)| Line { step, place: format!("script:{number}") }).collect())
    }

    fn play(steps: Vec<Step>, frames: usize, doing: &Doing) -> Vec<Vec<Deed>> {
        let mut player = player(steps);
        (0..frames).map(|_| player.advance(FRAME, doing)).collect()
    }

    #[test]
    fn steps_follow_each_other_and_wait_as_long_as_they_say() {
        let view = |mode| Step::Do(Command::View(mode));
        let steps = vec![
            view(ViewMode::Truth),
            Step::Wait(0.25),
            view(ViewMode::Error),
            Step::Frames(2),
            view(ViewMode::Final),
        ];
        let seen: Vec<usize> = play(steps, 12, &Doing::default()).iter().map(Vec::len).collect();
        assert_eq!(seen, [1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0]);
    }

    #[test]
    fn keys_are_released_and_drags_arrive() {
        let chord = Chord::from_text("w").expect("a key");
        let deeds = play(vec![Step::Hold(chord, 0.25)], 6, &Doing::default()).concat();
        assert_eq!(deeds, [Deed::Key(chord, true), Deed::Key(chord, false)]);
        let deeds = play(vec![Step::Drag([10.0, 20.0], [40.0, 20.0])], 10, &Doing::default()).concat();
        assert_eq!(deeds.first(), Some(&moved([10.0, 20.0])));
        assert_eq!(deeds.last(), Some(&button([40.0, 20.0], false)));
    }

    #[test]
    fn waiting_ends_when_the_thing_is_done_or_patience_is() {
        let mut player = player(vec![Step::Await(Awaited::Loaded), Step::Do(Command::Quit)]);
        let loading = Doing { is_loading: true, ..Doing::default() };
        for _ in 0..5 {
            assert_eq!(player.advance(FRAME, &loading), []);
        }
        assert_eq!(player.advance(FRAME, &Doing::default()), [Deed::Do(Command::Quit)]);
        assert!(player.is_done() && !player.failed);
        assert_eq!(player.place().as_deref(), Some("script:2"), "what it asked for");
        let mut player = self::player(vec![Step::Await(Awaited::Tuned)]);
        let tuning = Doing { is_tuning: true, ..Doing::default() };
        player.advance(FRAME, &tuning);
        assert!(matches!(&player.advance(2.0 * PATIENCE, &tuning)[..], [Deed::Say(text)] if text.contains("script:1")));
        assert!(player.failed);
    }

    #[test]
    fn a_monkey_does_the_same_for_the_same_seed() {
        let steps = |seed| vec![Step::Monkey(Monkey { seconds: 3.0, seed, files: None })];
        let doing = Doing { size: [800.0, 600.0], ..Doing::default() };
        let deeds = |seed| {
            let all = play(steps(seed), 40, &doing).concat();
            all.into_iter().filter(|deed| !matches!(deed, Deed::Say(_))).collect::<Vec<_>>()
        };
        assert_eq!(deeds(1), deeds(1));
        assert_ne!(deeds(1), deeds(2));
        assert!(deeds(3).len() > 10);
    }

    #[test]
    fn a_monkey_neither_quits_nor_opens_a_dialog_and_its_failures_are_nobodys() {
        let mut player = player(vec![Step::Monkey(Monkey { seconds: 600.0, seed: 5, files: None })]);
        let doing = Doing { size: [800.0, 600.0], ..Doing::default() };
        let mut keys = 0;
        for _ in 0..2000 {
            for deed in player.advance(FRAME, &doing) {
                assert!(player.is_random() && player.place().is_none());
                let Deed::Key(chord, _) = deed else { continue };
                keys += 1;
                let unwanted = matches!(chord.command(), Some(Command::Quit | Command::ChooseFile));
                assert!(!unwanted, "{chord:?}");
            }
        }
        assert!(keys > 500, "{keys} keys");
    }
}
