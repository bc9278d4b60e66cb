//! The key table, which menus, the help, the docs and the host's keyboard handling share.

use std::borrow::Cow;
use std::str::FromStr;
use std::sync::LazyLock;

use egui::Key;
use shadowfit_params::tool::ViewMode;
use shadowfit_params::view_option;

use crate::command::VIEW_KEYS;
use crate::{Artefact, Command, Toggle};

/// A key with its modifiers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chord {
    /// The key.
    pub key: Key,
    /// Whether Control is held.
    pub ctrl: bool,
    /// Whether Shift is held.
    pub shift: bool,
    /// Whether Alt is held.
    pub alt: bool,
}

/// A group of keys.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyGroup {
    /// Subject of the group.
    pub heading: &'static str,
    /// The keys, in display order.
    pub keys: Vec<KeyHelp>,
}

/// A line of the table of keys.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyHelp {
    /// The keys as printed on a keyboard, with `or` between two that do the same.
    pub keys: &'static str,
    /// Action of the keys.
    pub does: Cow<'static, str>,
    /// Command of the keys; `None` for keys to hold, drags, wheels and gamepads.
    pub command: Option<Command>,
}

/// Makes a line for a key with a command.
fn key(keys: &'static str, does: impl Into<Cow<'static, str>>, command: Command) -> KeyHelp {
    KeyHelp { keys, does: does.into(), command: Some(command) }
}

/// Makes a line for a key to hold, a drag, a wheel or a gamepad control.
const fn held(keys: &'static str, does: &'static str) -> KeyHelp {
    KeyHelp { keys, does: Cow::Borrowed(does), command: None }
}

const fn group(heading: &'static str, keys: Vec<KeyHelp>) -> KeyGroup {
    KeyGroup { heading, keys }
}

/// Returns the lines of the views, with a digit each.
fn views() -> Vec<KeyHelp> {
    let line = |(keys, mode)| key(keys, view_option(mode).label.to_lowercase(), Command::View(mode));
    VIEW_KEYS.into_iter().zip(ViewMode::ALL).map(line).collect()
}

/// The environment of the keys. Browsers reserve some keys, so that these commands have other keys there, and
/// no key quits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyLayout {
    /// A window of the system.
    Window,
    /// A page in a browser.
    Browser,
}

impl KeyLayout {
    /// Layout of this program. WebAssembly runs in pages.
    pub const HERE: Self = if cfg!(target_family = "wasm") { Self::Browser } else { Self::Window };

    const fn either(self, window: &'static str, browser: &'static str) -> &'static str {
        match self {
            Self::Window => window,
            Self::Browser => browser,
        }
    }
}

/// The keys that a host of the panel handles [here](KeyLayout::HERE), in display order.
pub static KEYS: LazyLock<Vec<KeyGroup>> = LazyLock::new(|| key_table(KeyLayout::HERE));

/// Returns the keys that a host of the panel handles, in display order.
pub fn key_table(layout: KeyLayout) -> Vec<KeyGroup> {
    let mut groups = vec![
        group("Fly", fly(layout)),
        group("Views", views()),
        group("Artefacts", artefacts()),
        group("Picture", picture()),
        group("Bookmarks", bookmarks(layout)),
        group("Settings and files", files(layout)),
        group("Window", window(layout)),
        group(TOUCH, touch()),
        group("Gamepad", gamepad()),
    ];
    if layout == KeyLayout::Browser {
        for group in &mut groups {
            group.keys.retain(|line| line.does != QUIT);
        }
    }
    groups
}

/// Heading of touch gestures.
pub(crate) const TOUCH: &str = "Touch";

/// Action that pages lack.
const QUIT: &str = "quit";

/// Returns the keys for flying. Pages can lock the pointer.
fn fly(layout: KeyLayout) -> Vec<KeyHelp> {
    let mut keys = vec![
        held("W A S D", "move"),
        held("Q, E", "down, up"),
        held("Arrow keys", "look around"),
        held("Left mouse drag", "look around"),
        held("Double click", "focus on this point"),
        held("Shift", "move fast"),
        held("Wheel", "flying speed"),
    ];
    if layout == KeyLayout::Browser {
        keys.insert(4, held("V", "look around with the mouse, until Esc"));
    }
    keys
}

fn artefacts() -> Vec<KeyHelp> {
    vec![
        key("Z", "show acne", Command::ShowArtefact(Artefact::Acne)),
        key("X", "show aliasing", Command::ShowArtefact(Artefact::Aliasing)),
        key("C", "show a clipping hole", Command::ShowArtefact(Artefact::ClippingHole)),
        key("F", "fix the artefact", Command::FixArtefact),
        key("T", "auto-tune", Command::StartTune),
    ]
}

fn picture() -> Vec<KeyHelp> {
    vec![
        key("B", "compare A | B", Command::Compare(Toggle::Switch)),
        key("M", "mark wrong pixels", Command::NextMarks),
        key("I", "shadow map inset", Command::NextInset),
        key("O", "outside view", Command::ToggleOutside),
        key("G", "freeze the fit", Command::ToggleFreeze),
        key("N", "level the camera", Command::LevelCamera),
        key("L", "animate the sun", Command::ToggleSun),
        key("Space", "play or pause", Command::TogglePlay),
        held("Rest pointer", "explain this pixel, if paused"),
    ]
}

/// Returns the keys of bookmarks. Browsers change tabs with Control and a digit.
fn bookmarks(layout: KeyLayout) -> Vec<KeyHelp> {
    let [go, set] = [("Ctrl+1 … 9", "Alt+1 … 9"), ("Ctrl+Shift+1 … 9", "Alt+Shift+1 … 9")];
    vec![
        key(layout.either(go.0, go.1), "go to a bookmark", Command::GoToBookmark(1)),
        key(layout.either(set.0, set.1), "set a bookmark", Command::SetBookmark(1)),
    ]
}

/// Returns the keys of files. Browsers open a page with Ctrl+O.
fn files(layout: KeyLayout) -> Vec<KeyHelp> {
    vec![
        key("Ctrl+Z", "undo", Command::Undo),
        key("Ctrl+Shift+Z or Ctrl+Y", "redo", Command::Redo),
        key("R", "reset", Command::Reset),
        key("K", "copy as Rust code", Command::CopyRust),
        key("U", "copy a link", Command::CopyLink),
        key("P", "screenshot", Command::Screenshot(None)),
        key(layout.either("Ctrl+O", "Alt+O"), "open a scene", Command::ChooseFile),
    ]
}

/// Returns the keys of the window. Browsers show their own help with F1.
fn window(layout: KeyLayout) -> Vec<KeyHelp> {
    let escape = layout.either("close a menu or this help; else quit", "close a menu or this help");
    vec![
        key("Tab", "hide or show the panel", Command::TogglePanel),
        key(layout.either("H or F1", "H"), "this help", Command::ToggleHelp),
        key("Esc", escape, Command::Escape),
        key("Ctrl+Q", QUIT, Command::Quit),
    ]
}

fn touch() -> Vec<KeyHelp> {
    vec![
        held("Drag", "look around"),
        held("Two fingers", "move"),
        held("Pinch", "fly forward or back"),
        held("Tap", "explain this pixel"),
        held("Double tap", "focus on this point"),
    ]
}

fn gamepad() -> Vec<KeyHelp> {
    vec![
        held("Left stick", "move"),
        held("Right stick", "look around, click: first view"),
        held("Triggers", "down, up"),
        held("Back", QUIT),
    ]
}

/// End of the keys of a line for all digits from 1.
const DIGITS: &str = "1 … 9";

/// Returns the lines with a command, and that command.
fn commands(groups: &[KeyGroup]) -> impl Iterator<Item = (&KeyHelp, &Command)> {
    groups.iter().flat_map(|group| &group.keys).filter_map(|line| Some((line, line.command.as_ref()?)))
}

/// Returns the keys of a command as printed on a keyboard; empty if it has none.
pub fn keys_of(command: &Command) -> &'static str {
    commands(&KEYS).find(|(_, other)| *other == command).map_or("", |(line, _)| line.keys)
}

/// Returns a help text followed by the keys of a command.
pub fn with_keys(text: &str, command: &Command) -> String {
    match keys_of(command) {
        "" => text.to_owned(),
        keys => format!("{text} ({keys})"),
    }
}

impl KeyHelp {
    /// Returns each chord of the line with its command.
    fn chords(&self) -> impl Iterator<Item = (Chord, Command)> {
        self.command.iter().flat_map(|command| match self.keys.strip_suffix(DIGITS) {
            Some(modifiers) => (1..=9)
                .filter_map(|digit| Some((chord(&format!("{modifiers}{digit}"))?, of_digit(command, digit))))
                .collect(),
            None => {
                self.keys.split(" or ").filter_map(|keys| Some((chord(keys)?, command.clone()))).collect::<Vec<_>>()
            }
        })
    }
}

/// Returns the command of a digit, for a line for all digits.
fn of_digit(command: &Command, digit: u8) -> Command {
    match command {
        Command::GoToBookmark(_) => Command::GoToBookmark(digit),
        Command::SetBookmark(_) => Command::SetBookmark(digit),
        other => other.clone(),
    }
}

fn chord(text: &str) -> Option<Chord> {
    text.parse().ok()
}

/// Error for a text that names no key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoSuchKey;

impl FromStr for Chord {
    type Err = NoSuchKey;

    /// Parses a key such as `w`, `Ctrl+Z` or `ctrl+shift+3`, in upper or lower case.
    fn from_str(text: &str) -> Result<Self, NoSuchKey> {
        let (modifiers, name) = text.rsplit_once('+').map_or(("", text), |(modifiers, name)| (modifiers, name));
        let is_it = |key: &&Key| key.name().eq_ignore_ascii_case(name);
        let found = Key::ALL.iter().find(is_it).copied().or_else(|| Key::from_name(name));
        let mut chord = Self { key: found.ok_or(NoSuchKey)?, ctrl: false, shift: false, alt: false };
        for modifier in modifiers.split('+').filter(|modifier| !modifier.is_empty()) {
            match modifier.to_ascii_lowercase().as_str() {
                "ctrl" => chord.ctrl = true,
                "shift" => chord.shift = true,
                "alt" => chord.alt = true,
                _ => return Err(NoSuchKey),
            }
        }
        Ok(chord)
    }
}

impl Chord {
    /// Returns the command of the pressed key. Shift is ignored unless [`KEYS`] has the key with and without
    /// it, so that keys work while Shift is held to fly fast.
    pub fn command(self) -> Option<Command> {
        self.command_in(&KEYS)
    }

    fn command_in(self, groups: &[KeyGroup]) -> Option<Command> {
        let listed = |chord: Self| {
            let mut all = commands(groups).flat_map(|(line, _)| line.chords());
            all.find(|(other, _)| *other == chord).map(|(_, command)| command)
        };
        listed(self).or_else(|| listed(Self { shift: false, ..self }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn command(keys: &str) -> Option<Command> {
        keys.parse::<Chord>().expect(keys).command()
    }

    #[test]
    fn every_view_has_its_digit_and_control_makes_bookmarks_of_them() {
        for (digit, mode) in VIEW_KEYS.into_iter().zip(ViewMode::ALL) {
            assert_eq!(command(digit), Some(Command::View(mode)));
        }
        for number in 1..=9 {
            assert_eq!(command(&format!("Ctrl+{number}")), Some(Command::GoToBookmark(number)));
            assert_eq!(command(&format!("Ctrl+Shift+{number}")), Some(Command::SetBookmark(number)));
        }
    }

    #[test]
    fn keys_are_read_by_name_whatever_their_case() {
        assert_eq!(command("Ctrl+Z"), Some(Command::Undo));
        assert_eq!(command("ctrl+shift+z"), Some(Command::Redo));
        assert_eq!((command("escape"), command("Esc")), (Some(Command::Escape), Some(Command::Escape)));
        assert_eq!("W".parse::<Chord>().map(|chord| chord.key), Ok(Key::W));
        for bad in ["", "+", "ctrl", "meta+a", "f99", "w+ctrl"] {
            assert_eq!(bad.parse::<Chord>(), Err(NoSuchKey), "{bad:?}");
        }
    }

    #[test]
    fn shift_matters_only_where_both_are_listed() {
        assert_eq!(command("Shift+G"), command("G"));
        assert_eq!(command("Ctrl+Shift+Q"), Some(Command::Quit));
        assert_ne!(command("Ctrl+Shift+Z"), command("Ctrl+Z"));
        assert_eq!((command("W"), command("Ctrl+G")), (None, None));
    }

    #[test]
    fn every_line_with_a_command_names_keys_and_no_key_or_command_has_two_lines() {
        for layout in [KeyLayout::Window, KeyLayout::Browser] {
            let groups = key_table(layout);
            let mut chords: Vec<Chord> = Vec::new();
            let mut seen: Vec<&Command> = Vec::new();
            for (line, command) in commands(&groups) {
                let is_new = line.chords().all(|(chord, _)| !chords.contains(&chord));
                assert!(line.chords().next().is_some() && is_new, "{line:?}");
                chords.extend(line.chords().map(|(chord, _)| chord));
                assert!(!seen.contains(&command), "{line:?}");
                seen.push(command);
            }
        }
        assert!(commands(&KEYS).all(|(line, command)| keys_of(command) == line.keys));
    }

    #[test]
    fn in_browsers_every_command_but_quitting_has_keys_that_they_leave_to_pages() {
        let (window, browser) = (key_table(KeyLayout::Window), key_table(KeyLayout::Browser));
        for (line, command) in commands(&window) {
            let is_there = commands(&browser).any(|(_, other)| other == command);
            assert_eq!(is_there, *command != Command::Quit, "{line:?}");
        }
        let letters = "WTNSORFPQLDJHUEG0123456789".chars();
        let with_control = letters.flat_map(|key| [format!("Ctrl+{key}"), format!("Ctrl+Shift+{key}")]);
        let zoom = ["Ctrl+Plus", "Ctrl+Minus", "F1", "F3", "F5", "F6", "F7", "F11", "F12"].map(str::to_owned);
        for keys in with_control.chain(zoom) {
            let owned = keys.parse::<Chord>().expect(&keys);
            let all = commands(&browser).flat_map(|(line, _)| line.chords());
            assert!(all.into_iter().all(|(chord, _)| chord != owned), "{keys}");
        }
        let bookmark = "Alt+Shift+7".parse::<Chord>().expect("a key");
        assert_eq!(bookmark.command_in(&browser), Some(Command::SetBookmark(7)));
        assert_eq!(bookmark.command_in(&window), None);
        assert!(browser.iter().flat_map(|group| &group.keys).all(|line| !line.does.contains("quit")));
    }
}
