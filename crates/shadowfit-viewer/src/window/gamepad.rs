//! Gamepads: the left stick moves, the right stick looks around, a click of it restores the initial camera,
//! the triggers move down and up, BACK quits.

use gilrs::{Axis, Button, EventType, Gilrs};
use glam::{Vec2, Vec3};
use shadowfit_egui::Command;

/// Greatest stick travel that counts as rest.
const DEAD_ZONE: f32 = 0.12;

/// Every connected gamepad.
pub(crate) struct Gamepads {
    gilrs: Option<Gilrs>,
}

impl Gamepads {
    /// Opens the gamepads. A machine without support has none.
    pub(crate) fn new() -> Self {
        Self { gilrs: Gilrs::new().ok() }
    }

    /// Returns movement and turn by sticks and triggers, and the commands of the pressed buttons.
    pub(crate) fn poll(&mut self) -> ((Vec3, Vec2), Vec<Command>) {
        let Some(gilrs) = &mut self.gilrs else { return Default::default() };
        let mut commands = Vec::new();
        while let Some(event) = gilrs.next_event() {
            match event.event {
                EventType::ButtonPressed(Button::Select, _) => commands.push(Command::Quit),
                EventType::ButtonPressed(Button::RightThumb, _) => commands.push(Command::ResetCamera),
                _ => {}
            }
        }
        let mut sticks = (Vec3::ZERO, Vec2::ZERO);
        for (_, gamepad) in gilrs.gamepads() {
            let value = |axis| beyond_dead_zone(gamepad.value(axis));
            let pressed = |button| gamepad.button_data(button).map_or(0.0, |data| beyond_dead_zone(data.value()));
            let rise = pressed(Button::RightTrigger2) - pressed(Button::LeftTrigger2);
            sticks.0 += Vec3::new(value(Axis::LeftStickX), rise, value(Axis::LeftStickY));
            sticks.1 += Vec2::new(value(Axis::RightStickX), value(Axis::RightStickY));
        }
        (sticks, commands)
    }
}

/// Returns the travel beyond the dead zone, scaled so that a full push is still 1.
fn beyond_dead_zone(value: f32) -> f32 {
    value.signum() * ((value.abs() - DEAD_ZONE) / (1.0 - DEAD_ZONE)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::beyond_dead_zone;

    #[test]
    fn sticks_rest_in_the_dead_zone_and_reach_one() {
        assert_eq!(beyond_dead_zone(0.1), 0.0);
        assert_eq!(beyond_dead_zone(-1.0), -1.0);
        assert!((beyond_dead_zone(0.56) - 0.5).abs() < 1e-6);
    }
}
