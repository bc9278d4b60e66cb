//! Effects of a script and of random actions on the viewer in a frame, and the viewer's activity that they
//! depend on.

use std::path::PathBuf;

use egui::{Event, Modifiers, PointerButton, Pos2};
use shadowfit_egui::{Chord, Command};

use super::script::Refusal;

/// An event in a frame, caused by a script.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Effect {
    /// Runs a command.
    Run(Command),
    /// Presses (`true`) or releases a key.
    Key(Chord, bool),
    /// Moves the pointer, presses its buttons, turns the wheel, or types a text.
    Input(Event),
    /// Resizes the window, in pixels.
    Resize([u32; 2]),
    /// Drops a file on the window.
    Drop(PathBuf),
    /// Destroys the graphics device.
    LoseDevice,
    /// Makes the window's surface refuse the next frame.
    Refuse(Refusal),
    /// Prints a line to the standard error.
    Print(String),
}

/// The viewer's current work, for actions that wait for its end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is asked about by an action of its own")]
pub(crate) struct Activity {
    pub(crate) is_loading: bool,
    pub(crate) is_searching: bool,
    pub(crate) is_judged: bool,
    pub(crate) is_tuning: bool,
    /// Size of the window, in points.
    pub(crate) size: [f32; 2],
}

impl Effect {
    /// Moves the pointer to a point of the window.
    pub(crate) fn moved([x, y]: [f32; 2]) -> Self {
        Self::Input(Event::PointerMoved(Pos2::new(x, y)))
    }

    /// Presses or releases the left button at a point of the window.
    pub(crate) fn button([x, y]: [f32; 2], pressed: bool) -> Self {
        let modifiers = Modifiers::NONE;
        Self::Input(Event::PointerButton { pos: Pos2::new(x, y), button: PointerButton::Primary, pressed, modifiers })
    }

    /// Clicks at a point of the window a number of times, all in one frame.
    pub(crate) fn clicks(at: [f32; 2], times: u32) -> impl Iterator<Item = Self> {
        let presses = (0..times).flat_map(move |_| [Self::button(at, true), Self::button(at, false)]);
        std::iter::once(Self::moved(at)).chain(presses)
    }

    /// Turns the wheel by a number of notches.
    pub(crate) fn wheel(notches: f32) -> Self {
        let (unit, phase) = (egui::MouseWheelUnit::Line, egui::TouchPhase::Move);
        let (delta, source) = (egui::Vec2::new(0.0, notches), egui::MouseWheelSource::Unknown);
        Self::Input(Event::MouseWheel { unit, delta, phase, modifiers: Modifiers::NONE, source })
    }
}
