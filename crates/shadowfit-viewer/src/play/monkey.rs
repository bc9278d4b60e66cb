//! Random actions: keys, clicks, drags, turns of the wheel, resizes and dropped files, valid and hostile.
//! They prove that the viewer survives them, and measure its memory with the same scene and settings before
//! and after.

use std::path::PathBuf;

use egui::{Event, Key};
use shadowfit_egui::{Chord, Command};

use super::effect::{Activity, Effect};
use super::script::{Monkey, Refusal};
use crate::platform::memory;
use crate::scene_source::SceneSource;

/// Seconds from one action to the next, on average.
const PACE: f32 = 0.06;
/// Share of the time before memory is first measured. By then all one-time allocations are done.
const WARM_UP: f32 = 0.25;
/// Sizes of windows, in pixels.
const SIZES: [[u32; 2]; 6] = [[1280, 720], [640, 360], [960, 600], [1, 1], [333, 777], [1024, 300]];
/// Answers of the window's surface that refuse a frame.
const REFUSALS: [Refusal; 4] = [Refusal::Lost, Refusal::Outdated, Refusal::Timeout, Refusal::Occluded];
/// Largest dropped file, in bytes. Larger files would take most of the time to load.
const LARGEST: u64 = 20_000_000;
/// Seconds without actions before memory is measured.
const REST: f32 = 3.0;

/// A small generator of random numbers: `SplitMix64` (G. Steele, D. Lea and C. Flood, 2014).
#[derive(Clone, Debug)]
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Returns a random number from 0 to below 1.
    pub(crate) fn share(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1_u32 << 24) as f32
    }

    fn pick<'a, T>(&mut self, items: &'a [T]) -> Option<&'a T> {
        let index = (self.next() % items.len().max(1) as u64) as usize;
        items.get(index)
    }

    fn place(&mut self, [width, height]: [f32; 2]) -> [f32; 2] {
        [self.share() * width, self.share() * height]
    }
}

/// The phases of a run, in order.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    /// Random actions, before the first memory measurement.
    Warm,
    /// No actions for this many more seconds, then memory is measured.
    Resting(f32),
    /// Random actions.
    Wild,
    /// No actions for this many more seconds, then memory is measured again and the run ends.
    Ending(f32),
}

/// A run of random actions.
#[derive(Debug)]
pub(crate) struct MonkeyRun {
    random: Random,
    seconds: f32,
    passed: f32,
    actions: u64,
    next: f32,
    phase: Phase,
    files: Vec<PathBuf>,
    keys: Vec<Chord>,
    held: Vec<Chord>,
    /// Memory at the first measurement, in bytes.
    memory: Option<u64>,
}

impl MonkeyRun {
    pub(crate) fn new(monkey: &Monkey) -> Self {
        let mut files: Vec<PathBuf> = monkey.files.iter().flat_map(|folder| files_below(folder.as_ref())).collect();
        files.retain(|file| std::fs::metadata(file).is_ok_and(|data| data.len() <= LARGEST));
        files.sort();
        let unwanted =
            |chord: &Chord| matches!(chord.command(), Some(Command::Quit | Command::Escape | Command::ChooseFile));
        let modifiers = [(false, false), (true, false), (false, true), (true, true)];
        let with_modifiers = |key: &Key| modifiers.map(|(ctrl, shift)| Chord { key: *key, ctrl, shift, alt: false });
        Self {
            random: Random(monkey.seed),
            seconds: monkey.seconds,
            passed: 0.0,
            actions: 0,
            next: 0.0,
            phase: Phase::Warm,
            files,
            keys: Key::ALL.iter().flat_map(with_modifiers).filter(|chord| !unwanted(chord)).collect(),
            held: Vec::new(),
            memory: None,
        }
    }

    /// Plays the actions of this frame. Returns whether the run continues.
    pub(crate) fn advance(&mut self, seconds: f32, activity: &Activity, effects: &mut Vec<Effect>) -> bool {
        self.passed += seconds;
        match self.phase {
            Phase::Warm if self.passed >= self.seconds * WARM_UP => self.rest(Phase::Resting(REST), effects),
            Phase::Wild if self.passed >= self.seconds => self.rest(Phase::Ending(REST), effects),
            Phase::Warm | Phase::Wild => self.act(seconds, activity, effects),
            // A loading scene is part of the measured memory.
            Phase::Resting(_) | Phase::Ending(_)
                if activity.is_loading || activity.is_searching || activity.is_tuning => {}
            Phase::Resting(left) if left > 0.0 => self.phase = Phase::Resting(left - seconds),
            Phase::Ending(left) if left > 0.0 => self.phase = Phase::Ending(left - seconds),
            Phase::Resting(_) => {
                self.memory = memory();
                self.phase = Phase::Wild;
            }
            Phase::Ending(_) => {
                effects.push(Effect::Print(self.report()));
                return false;
            }
        }
        true
    }

    /// Releases all keys, and restores the scene and the settings with which memory is measured, since maps
    /// alone may take a gigabyte.
    fn rest(&mut self, phase: Phase, effects: &mut Vec<Effect>) {
        effects.extend(self.held.drain(..).map(|chord| Effect::Key(chord, false)));
        effects.push(Effect::Resize(SIZES[0]));
        let open = Command::Open(SceneSource::default().text());
        effects.extend([Command::CancelTune, Command::Reset, open].map(Effect::Run));
        self.phase = phase;
    }

    fn act(&mut self, seconds: f32, activity: &Activity, effects: &mut Vec<Effect>) {
        self.next -= seconds;
        // On a slow machine a frame catches up on missed actions, up to a limit.
        for _ in 0..8 {
            if self.next > 0.0 {
                break;
            }
            self.next += 2.0 * PACE * self.random.share();
            self.actions += 1;
            self.one(activity, effects);
        }
    }

    fn one(&mut self, activity: &Activity, effects: &mut Vec<Effect>) {
        let at = self.random.place(activity.size);
        match self.random.next() % 100 {
            0..30 => self.key(effects),
            30..60 => effects.extend(Effect::clicks(at, 1 + u32::from(self.random.next().is_multiple_of(4)))),
            60..78 => self.drag(at, activity, effects),
            78..86 => effects.push(Effect::wheel(6.0 * self.random.share() - 3.0)),
            86..94 => effects.push(Effect::moved(at)),
            94 => effects.extend(self.random.pick(&SIZES).map(|size| Effect::Resize(*size))),
            95 => effects.extend(self.random.pick(&self.files).map(|file| Effect::Drop(file.clone()))),
            96 => effects.push(Effect::Input(Event::Text("1.5e3".to_owned()))),
            97 => effects.extend(self.random.pick(&REFUSALS).map(|refusal| Effect::Refuse(*refusal))),
            _ => effects.extend(self.held.drain(..).map(|chord| Effect::Key(chord, false))),
        }
    }

    /// Presses a key, and releases it now or later.
    fn key(&mut self, effects: &mut Vec<Effect>) {
        let Some(chord) = self.random.pick(&self.keys).copied() else { return };
        effects.push(Effect::Key(chord, true));
        if self.random.share() < 0.7 {
            effects.push(Effect::Key(chord, false));
        } else {
            self.held.push(chord);
        }
    }

    /// Drags from one place to another within one frame.
    fn drag(&mut self, from: [f32; 2], activity: &Activity, effects: &mut Vec<Effect>) {
        let to = self.random.place(activity.size);
        effects.extend([Effect::moved(from), Effect::button(from, true), Effect::moved(to), Effect::button(to, false)]);
    }

    fn report(&self) -> String {
        let actions = format!("monkey: {} actions in {:.0} s", self.actions, self.passed);
        let megabytes = |bytes: u64| bytes as f64 / 1e6;
        match (self.memory, memory()) {
            (Some(before), Some(after)) => format!(
                "{actions}; memory {:.1} MB after a quarter of the time, {:.1} MB at the end, growth {:.1} MB",
                megabytes(before),
                megabytes(after),
                megabytes(after) - megabytes(before)
            ),
            _ => format!("{actions}; memory is unknown on this system"),
        }
    }
}

/// Returns all files in a folder and its subfolders.
fn files_below(folder: &std::path::Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    entries.flat_map(|path| if path.is_dir() { files_below(&path) } else { vec![path] }).collect()
}
