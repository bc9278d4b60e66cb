//! Random actions: keys, clicks, drags, turns of the wheel, resizes and dropped files, good and hostile. What it proves
//! is that the viewer does not fall over; the memory that it takes is measured at the same scene before and after.

use std::path::PathBuf;

use egui::{Event, PointerButton, Pos2};

use crate::command::Command;
use crate::keys::Chord;
use crate::playback::{Deed, Doing, clicks, wheel};
use crate::script::Monkey;
use crate::source::SceneSource;

/// Seconds from one action to the next, on average.
const PACE: f32 = 0.06;
/// Share of the time after which memory is measured for the first time: all that is made once has been made then.
const WARM_UP: f32 = 0.25;
/// Sizes of windows, in pixels.
const SIZES: [[u32; 2]; 6] = [[1280, 720], [640, 360], [960, 600], [1, 1], [333, 777], [1024, 300]];
/// Largest file that is dropped, in bytes: others are loaded for so long that nothing else is tried.
const LARGEST: u64 = 20_000_000;
/// Seconds that the scene is left alone before memory is measured.
const REST: f32 = 3.0;

/// A small generator of random numbers: `SplitMix64` (G. Steele, D. Lea and C. Flood, 2014).
#[derive(Clone, Debug)]
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// 0 up to 1.
    fn share(&mut self) -> f32 {
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

/// Where a run stands.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    /// Random actions; when they began, memory had not been measured yet.
    Warm,
    /// Nothing, until memory is measured: seconds left.
    Resting(f32),
    /// Random actions.
    Wild,
    /// As [`Self::Resting`], before the end.
    Ending(f32),
}

/// Random actions under way.
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
    /// Bytes at the first measurement.
    memory: Option<u64>,
}

impl MonkeyRun {
    pub(crate) fn new(monkey: &Monkey) -> Self {
        let mut files: Vec<PathBuf> = monkey.files.iter().flat_map(|folder| files_below(folder.as_ref())).collect();
        files.retain(|file| std::fs::metadata(file).is_ok_and(|data| data.len() <= LARGEST));
        files.sort();
        let unwanted =
            |chord: &Chord| matches!(chord.command(), Some(Command::Quit | Command::Escape | Command::ChooseFile));
        let with_modifiers = |chord: Chord| {
            [
                chord,
                Chord { ctrl: true, ..chord },
                Chord { shift: true, ..chord },
                Chord { ctrl: true, shift: true, ..chord },
            ]
        };
        Self {
            random: Random(monkey.seed),
            seconds: monkey.seconds,
            passed: 0.0,
            actions: 0,
            next: 0.0,
            phase: Phase::Warm,
            files,
            keys: Chord::all().flat_map(with_modifiers).filter(|chord| !unwanted(chord)).collect(),
            held: Vec::new(),
            memory: None,
        }
    }

    /// Does what is due in this frame; returns whether it goes on.
    pub(crate) fn advance(&mut self, seconds: f32, doing: &Doing, deeds: &mut Vec<Deed>) -> bool {
        self.passed += seconds;
        match self.phase {
            Phase::Warm if self.passed >= self.seconds * WARM_UP => self.rest(Phase::Resting(REST), deeds),
            Phase::Wild if self.passed >= self.seconds => self.rest(Phase::Ending(REST), deeds),
            Phase::Warm | Phase::Wild => self.act(seconds, doing, deeds),
            // What is being loaded belongs to the scene that is measured.
            Phase::Resting(_) | Phase::Ending(_) if doing.is_loading || doing.is_searching || doing.is_tuning => {}
            Phase::Resting(left) if left > 0.0 => self.phase = Phase::Resting(left - seconds),
            Phase::Ending(left) if left > 0.0 => self.phase = Phase::Ending(left - seconds),
            Phase::Resting(_) => {
                self.memory = memory();
                self.phase = Phase::Wild;
            }
            Phase::Ending(_) => {
                deeds.push(Deed::Say(self.report()));
                return false;
            }
        }
        true
    }

    /// Lets go of everything and goes back to the scene that memory is measured at.
    fn rest(&mut self, phase: Phase, deeds: &mut Vec<Deed>) {
        deeds.extend(self.held.drain(..).map(|chord| Deed::Key(chord, false)));
        deeds.push(Deed::Resize(SIZES[0]));
        for command in
            [Command::Compare(crate::command::Toggle::Off), Command::CancelTune, Command::Open(SceneSource::default())]
        {
            deeds.push(Deed::Do(command));
        }
        self.phase = phase;
    }

    fn act(&mut self, seconds: f32, doing: &Doing, deeds: &mut Vec<Deed>) {
        self.next -= seconds;
        // A frame of a slow machine makes up for the time that it took, within reason.
        for _ in 0..8 {
            if self.next > 0.0 {
                break;
            }
            self.next += 2.0 * PACE * self.random.share();
            self.actions += 1;
            self.one(doing, deeds);
        }
    }

    fn one(&mut self, doing: &Doing, deeds: &mut Vec<Deed>) {
        let at = self.random.place(doing.size);
        match self.random.next() % 100 {
            0..30 => self.key(deeds),
            30..60 => deeds.extend(clicks(at, 1 + u32::from(self.random.next().is_multiple_of(4)))),
            60..78 => self.drag(at, doing, deeds),
            78..86 => deeds.push(wheel(6.0 * self.random.share() - 3.0)),
            86..94 => deeds.push(Deed::Pointer(Event::PointerMoved(Pos2::new(at[0], at[1])))),
            94 => deeds.extend(self.random.pick(&SIZES).map(|size| Deed::Resize(*size))),
            95 => deeds.extend(self.random.pick(&self.files).map(|file| Deed::Drop(file.clone()))),
            96 => deeds.push(Deed::Pointer(Event::Text("1.5e3".to_owned()))),
            _ => deeds.extend(self.held.drain(..).map(|chord| Deed::Key(chord, false))),
        }
    }

    /// Presses a key, which is let go at once or later.
    fn key(&mut self, deeds: &mut Vec<Deed>) {
        let Some(chord) = self.random.pick(&self.keys).copied() else { return };
        deeds.push(Deed::Key(chord, true));
        if self.random.share() < 0.7 {
            deeds.push(Deed::Key(chord, false));
        } else {
            self.held.push(chord);
        }
    }

    /// A drag within a frame, from one place to another.
    fn drag(&mut self, [x, y]: [f32; 2], doing: &Doing, deeds: &mut Vec<Deed>) {
        let [to_x, to_y] = self.random.place(doing.size);
        let (from, to) = (Pos2::new(x, y), Pos2::new(to_x, to_y));
        let button = |pos, pressed| Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: egui::Modifiers::NONE,
        };
        let events = [Event::PointerMoved(from), button(from, true), Event::PointerMoved(to), button(to, false)];
        deeds.extend(events.map(Deed::Pointer));
    }

    fn report(&self) -> String {
        let actions = format!("monkey: {} actions in {:.0} s", self.actions, self.passed);
        let megabytes = |bytes: u64| bytes as f64 / 1e6;
        match (self.memory, memory()) {
            (Some(before), Some(after)) => format!(
                "{actions}; memory {:.1} MB after a quarter of it, {:.1} MB at the end, growth {:.1} MB",
                megabytes(before),
                megabytes(after),
                megabytes(after) - megabytes(before)
            ),
            _ => format!("{actions}; memory cannot be told on this system"),
        }
    }
}

/// Bytes of memory that the process holds; `None` where the system does not tell as Linux does.
pub(crate) fn memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}

/// All files of a folder and of those in it.
fn files_below(folder: &std::path::Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    entries.flat_map(|path| if path.is_dir() { files_below(&path) } else { vec![path] }).collect()
}
