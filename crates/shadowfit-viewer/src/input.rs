//! Keys held down and sticks pushed, as the camera's input.

use glam::{Vec2, Vec3};
use shadowfit_render::FlyInput;
use winit::keyboard::KeyCode;

/// What the person is doing.
#[derive(Debug, Default)]
pub(crate) struct Input {
    held: Vec<KeyCode>,
    /// Sticks: movement and turn, each -1..=1, added to the keys.
    pub(crate) sticks: (Vec3, Vec2),
}

impl Input {
    pub(crate) fn key(&mut self, code: KeyCode, pressed: bool) {
        self.held.retain(|held| *held != code);
        if pressed {
            self.held.push(code);
        }
    }

    /// Forgets everything held: the window lost its focus, and releases will not arrive.
    pub(crate) fn release_all(&mut self) {
        *self = Self::default();
    }

    /// What the camera is asked for; drags and wheel are added by whoever sees them.
    pub(crate) fn fly(&self) -> FlyInput {
        let axis = |positive, negative| {
            f32::from(u8::from(self.held.contains(&positive))) - f32::from(u8::from(self.held.contains(&negative)))
        };
        let movement = Vec3::new(
            axis(KeyCode::KeyD, KeyCode::KeyA),
            axis(KeyCode::KeyE, KeyCode::KeyQ),
            axis(KeyCode::KeyW, KeyCode::KeyS),
        );
        let turn = Vec2::new(axis(KeyCode::ArrowRight, KeyCode::ArrowLeft), axis(KeyCode::ArrowUp, KeyCode::ArrowDown));
        FlyInput {
            movement: movement + self.sticks.0,
            turn: turn + self.sticks.1,
            fast: self.held.iter().any(|key| matches!(key, KeyCode::ShiftLeft | KeyCode::ShiftRight)),
            ..FlyInput::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn held_keys_move_until_they_are_released() {
        let mut input = Input::default();
        input.key(KeyCode::KeyW, true);
        input.key(KeyCode::KeyW, true);
        input.key(KeyCode::ArrowLeft, true);
        input.key(KeyCode::ShiftLeft, true);
        let asked = input.fly();
        assert_eq!((asked.movement, asked.turn, asked.fast), (Vec3::Z, Vec2::NEG_X, true));
        input.key(KeyCode::KeyW, false);
        assert_eq!(input.fly().movement, Vec3::ZERO);
        input.release_all();
        assert_eq!(input.fly(), FlyInput::default());
    }

    #[test]
    fn sticks_add_to_the_keys() {
        let mut input = Input { sticks: (Vec3::X * 0.5, Vec2::Y * 0.25), ..Input::default() };
        input.key(KeyCode::KeyD, true);
        let asked = input.fly();
        assert_eq!((asked.movement, asked.turn), (Vec3::X * 1.5, Vec2::Y * 0.25));
    }
}
