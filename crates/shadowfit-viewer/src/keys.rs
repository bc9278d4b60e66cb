//! Keys and what they do at once; those that are held fly the camera, see [`crate::input`].

use shadowfit_egui::Artefact;
use shadowfit_params::tool::ViewMode;
use winit::keyboard::KeyCode;

use crate::command::{Command, Toggle};

/// A key with the modifiers that it is pressed with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Chord {
    pub(crate) key: KeyCode,
    pub(crate) ctrl: bool,
    pub(crate) shift: bool,
}

/// Keys with the names that scripts give them.
const NAMES: [(&str, KeyCode); 52] = [
    ("a", KeyCode::KeyA),
    ("b", KeyCode::KeyB),
    ("c", KeyCode::KeyC),
    ("d", KeyCode::KeyD),
    ("e", KeyCode::KeyE),
    ("f", KeyCode::KeyF),
    ("g", KeyCode::KeyG),
    ("h", KeyCode::KeyH),
    ("i", KeyCode::KeyI),
    ("j", KeyCode::KeyJ),
    ("k", KeyCode::KeyK),
    ("l", KeyCode::KeyL),
    ("m", KeyCode::KeyM),
    ("n", KeyCode::KeyN),
    ("o", KeyCode::KeyO),
    ("p", KeyCode::KeyP),
    ("q", KeyCode::KeyQ),
    ("r", KeyCode::KeyR),
    ("s", KeyCode::KeyS),
    ("t", KeyCode::KeyT),
    ("u", KeyCode::KeyU),
    ("v", KeyCode::KeyV),
    ("w", KeyCode::KeyW),
    ("x", KeyCode::KeyX),
    ("y", KeyCode::KeyY),
    ("z", KeyCode::KeyZ),
    ("1", KeyCode::Digit1),
    ("2", KeyCode::Digit2),
    ("3", KeyCode::Digit3),
    ("4", KeyCode::Digit4),
    ("5", KeyCode::Digit5),
    ("6", KeyCode::Digit6),
    ("7", KeyCode::Digit7),
    ("8", KeyCode::Digit8),
    ("9", KeyCode::Digit9),
    ("0", KeyCode::Digit0),
    ("up", KeyCode::ArrowUp),
    ("down", KeyCode::ArrowDown),
    ("left", KeyCode::ArrowLeft),
    ("right", KeyCode::ArrowRight),
    ("space", KeyCode::Space),
    ("tab", KeyCode::Tab),
    ("enter", KeyCode::Enter),
    ("escape", KeyCode::Escape),
    ("backspace", KeyCode::Backspace),
    ("delete", KeyCode::Delete),
    ("home", KeyCode::Home),
    ("end", KeyCode::End),
    ("f1", KeyCode::F1),
    ("f2", KeyCode::F2),
    ("f11", KeyCode::F11),
    ("f12", KeyCode::F12),
];

impl Chord {
    pub(crate) const fn new(key: KeyCode) -> Self {
        Self { key, ctrl: false, shift: false }
    }

    /// A key as a script writes it: `w`, `Ctrl+Z`, `ctrl+shift+3`.
    pub(crate) fn from_text(text: &str) -> Option<Self> {
        let text = text.to_ascii_lowercase();
        let mut parts: Vec<&str> = text.split('+').collect();
        let name = parts.pop()?;
        let (_, key) = NAMES.iter().find(|(other, _)| *other == name)?;
        let mut chord = Self::new(*key);
        for modifier in parts {
            match modifier {
                "ctrl" => chord.ctrl = true,
                "shift" => chord.shift = true,
                _ => return None,
            }
        }
        Some(chord)
    }

    /// All keys that a script can press, without modifiers.
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        NAMES.iter().map(|(_, key)| Self::new(*key))
    }

    /// Number of a digit key.
    fn digit(self) -> Option<u8> {
        let digits = NAMES.iter().skip_while(|(name, _)| *name != "1").take(9);
        (1..).zip(digits).find(|(_, (_, key))| *key == self.key).map(|(number, _)| number)
    }

    /// What the key does when it is pressed; `None` where it does nothing at once.
    pub(crate) fn command(self) -> Option<Command> {
        match (self.digit(), self.ctrl, self.shift) {
            (Some(digit), true, true) => return Some(Command::SetBookmark(digit)),
            (Some(digit), true, false) => return Some(Command::GoToBookmark(digit)),
            (Some(digit), false, _) => return ViewMode::ALL.get(usize::from(digit) - 1).copied().map(Command::View),
            (None, true, shift) => return self.with_ctrl(shift),
            (None, false, _) => {}
        }
        Some(match self.key {
            KeyCode::Escape => Command::Escape,
            KeyCode::Space => Command::TogglePlay,
            KeyCode::KeyO => Command::ToggleOutside,
            KeyCode::KeyI => Command::NextInset,
            KeyCode::KeyM => Command::NextMarks,
            KeyCode::KeyG => Command::ToggleFreeze,
            KeyCode::KeyL => Command::ToggleSun,
            KeyCode::KeyZ => Command::ShowArtefact(Artefact::Acne),
            KeyCode::KeyX => Command::ShowArtefact(Artefact::Aliasing),
            KeyCode::KeyC => Command::ShowArtefact(Artefact::ClippingHole),
            KeyCode::KeyF => Command::Fix,
            KeyCode::KeyB => Command::Compare(Toggle::Other),
            KeyCode::KeyT => Command::StartTune,
            KeyCode::KeyK => Command::CopyRust,
            KeyCode::KeyR => Command::Reset,
            KeyCode::KeyP => Command::Picture(None),
            KeyCode::KeyH | KeyCode::F1 => Command::ToggleHelp,
            KeyCode::Tab => Command::TogglePanel,
            _ => return None,
        })
    }

    fn with_ctrl(self, shift: bool) -> Option<Command> {
        Some(match (self.key, shift) {
            (KeyCode::KeyZ, false) => Command::Undo,
            (KeyCode::KeyZ, true) | (KeyCode::KeyY, _) => Command::Redo,
            (KeyCode::KeyO, _) => Command::ChooseFile,
            (KeyCode::KeyQ, _) => Command::Quit,
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_view_has_its_digit_and_control_makes_bookmarks_of_them() {
        for (number, mode) in (1..=9).zip(ViewMode::ALL) {
            let chord = Chord::from_text(&number.to_string()).expect("a digit");
            assert_eq!(chord.command(), Some(Command::View(mode)));
            assert_eq!(Chord { ctrl: true, ..chord }.command(), Some(Command::GoToBookmark(number)));
            assert_eq!(Chord { ctrl: true, shift: true, ..chord }.command(), Some(Command::SetBookmark(number)));
        }
    }

    #[test]
    fn keys_are_read_by_name_whatever_their_case() {
        assert_eq!(Chord::from_text("Ctrl+Z").and_then(Chord::command), Some(Command::Undo));
        assert_eq!(Chord::from_text("ctrl+shift+z").and_then(Chord::command), Some(Command::Redo));
        assert_eq!(Chord::from_text("W").map(|chord| chord.key), Some(KeyCode::KeyW));
        for bad in ["", "+", "ctrl", "alt+a", "f99", "w+ctrl"] {
            assert_eq!(Chord::from_text(bad), None, "{bad:?}");
        }
    }

    /// The chords of a line of the table of the keys.
    fn chords(keys: &str) -> Vec<Chord> {
        let one = |text: &str| {
            let text = text.trim().to_lowercase().replace("esc", "escape");
            Chord::from_text(&text).unwrap_or_else(|| panic!("{keys:?}: {text:?}"))
        };
        match keys.split_once("1 … 9") {
            Some((modifiers, _)) => (1..=9).map(|digit| one(&format!("{modifiers}{digit}"))).collect(),
            None => keys.split(" or ").map(one).collect(),
        }
    }

    #[test]
    fn the_table_of_the_keys_has_every_key_that_does_something_at_once_and_no_other() {
        let groups = shadowfit_egui::KEYS.iter().filter(|group| !["Fly", "Gamepad"].contains(&group.heading));
        let listed: Vec<Chord> = groups.flat_map(|group| group.keys).flat_map(|key| chords(key.keys)).collect();
        for chord in &listed {
            assert!(chord.command().is_some(), "{chord:?} is listed and does nothing");
        }
        let with_modifiers =
            |chord: Chord| [chord, Chord { ctrl: true, ..chord }, Chord { ctrl: true, shift: true, ..chord }];
        for chord in Chord::all().flat_map(with_modifiers) {
            let Some(command) = chord.command() else { continue };
            // Shift beside Control matters to some keys only.
            let same = |other: &Chord| other.key == chord.key && other.command().as_ref() == Some(&command);
            assert!(listed.iter().any(same), "{chord:?} is not listed");
        }
    }

    #[test]
    fn no_two_keys_do_the_same_but_those_that_are_meant_to() {
        let mut seen: Vec<(Command, Chord)> = Vec::new();
        for chord in Chord::all().flat_map(|chord| [chord, Chord { ctrl: true, ..chord }]) {
            let Some(command) = chord.command() else { continue };
            let twice = [Command::ToggleHelp];
            let known = seen.iter().find(|(other, _)| *other == command);
            assert!(known.is_none() || twice.contains(&command), "{chord:?} and {known:?}");
            seen.push((command, chord));
        }
    }
}
