//! Held keys and gamepad sticks as input of the camera.

use egui::Key;
use glam::{Vec2, Vec3};
use shadowfit_egui::Chord;
use shadowfit_render::FlyInput;

/// Held keys and gamepad sticks.
#[derive(Debug, Default)]
pub(crate) struct Input {
    held: Vec<Chord>,
    /// Whether Shift is held.
    pub(crate) fast: bool,
    /// Mouse movement that looks around without a button, in pixels, since the previous frame.
    pub(crate) look: Vec2,
    /// Sticks: movement and turn, each -1..=1, added to the keys.
    pub(crate) sticks: (Vec3, Vec2),
}

impl Input {
    /// Records a key press or release. Returns whether it is a press of a key that was not held.
    pub(crate) fn key(&mut self, chord: Chord, pressed: bool) -> bool {
        let is_held = self.held.iter().any(|held| held.key == chord.key);
        if pressed && !is_held {
            self.held.push(chord);
        } else if !pressed {
            self.held.retain(|held| held.key != chord.key);
        }
        pressed && !is_held
    }

    /// Releases everything: the window lost its focus, so that key releases will not arrive.
    pub(crate) fn release_all(&mut self) {
        *self = Self::default();
    }

    /// Returns the input of the camera; the caller adds drags and the wheel. Keys held with Control or Alt do
    /// not fly.
    pub(crate) fn fly(&self) -> FlyInput {
        let held = |key| f32::from(u8::from(self.held.iter().any(|held| held.key == key && !held.ctrl && !held.alt)));
        let axis = |positive, negative| held(positive) - held(negative);
        let movement = Vec3::new(axis(Key::D, Key::A), axis(Key::E, Key::Q), axis(Key::W, Key::S));
        let turn = Vec2::new(axis(Key::ArrowRight, Key::ArrowLeft), axis(Key::ArrowUp, Key::ArrowDown));
        FlyInput {
            movement: movement + self.sticks.0,
            turn: turn + self.sticks.1,
            fast: self.fast,
            ..FlyInput::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chord(keys: &str) -> Chord {
        keys.parse().expect(keys)
    }

    #[test]
    fn held_keys_move_until_they_are_released() {
        let mut input = Input { fast: true, ..Input::default() };
        assert!(input.key(chord("w"), true));
        assert!(!input.key(chord("w"), true), "a keyboard repeats keys that are held");
        input.key(chord("left"), true);
        let asked = input.fly();
        assert_eq!((asked.movement, asked.turn, asked.fast), (Vec3::Z, Vec2::NEG_X, true));
        input.key(chord("w"), false);
        assert_eq!(input.fly().movement, Vec3::ZERO);
        input.release_all();
        assert_eq!(input.fly(), FlyInput::default());
    }

    #[test]
    fn keys_with_control_or_alt_do_not_fly() {
        let mut input = Input::default();
        assert!(input.key(chord("ctrl+q"), true) && input.key(chord("alt+e"), true));
        assert_eq!(input.fly(), FlyInput::default());
    }

    #[test]
    fn sticks_add_to_the_keys() {
        let mut input = Input { sticks: (Vec3::X * 0.5, Vec2::Y * 0.25), ..Input::default() };
        input.key(chord("d"), true);
        let asked = input.fly();
        assert_eq!((asked.movement, asked.turn), (Vec3::X * 1.5, Vec2::Y * 0.25));
    }
}
