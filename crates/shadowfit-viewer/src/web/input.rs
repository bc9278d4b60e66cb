//! The page's events, converted to egui's events.

use egui::{
    Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, Pos2, TouchDeviceId, TouchId, TouchPhase,
    vec2,
};

/// Bits of the modifier keys.
const SHIFT: u32 = 1;
const CTRL: u32 = 2;
const ALT: u32 = 4;
const META: u32 = 8;

/// Events for the next frame, and the resulting state.
#[derive(Debug, Default)]
pub(super) struct Events {
    pub(super) waiting: Vec<Event>,
    modifiers: Modifiers,
    /// The finger that moves the pointer.
    finger: Option<u64>,
}

impl Events {
    /// Records the held modifier keys.
    pub(super) fn held(&mut self, bits: u32) {
        let is_on = |bit| bits & bit != 0;
        let modifiers = Modifiers {
            alt: is_on(ALT),
            ctrl: is_on(CTRL),
            shift: is_on(SHIFT),
            mac_cmd: is_on(META),
            command: is_on(CTRL) || is_on(META),
        };
        if modifiers != self.modifiers {
            self.modifiers = modifiers;
            self.waiting.push(Event::ModifiersChanged(modifiers));
        }
    }

    /// Records a mouse movement to a point of the page, in points. `by` is the distance, also while the mouse
    /// is locked.
    pub(super) fn moved(&mut self, at: Pos2, by: [f32; 2]) {
        self.waiting.push(Event::PointerMoved(at));
        self.waiting.push(Event::MouseMoved(by.into()));
    }

    /// Records a mouse button, by its number in browsers.
    pub(super) fn button(&mut self, pos: Pos2, number: u32, pressed: bool) {
        let button = match number {
            0 => PointerButton::Primary,
            1 => PointerButton::Middle,
            2 => PointerButton::Secondary,
            3 => PointerButton::Extra1,
            _ => PointerButton::Extra2,
        };
        self.waiting.push(Event::PointerMoved(pos));
        self.waiting.push(Event::PointerButton { pos, button, pressed, modifiers: self.modifiers });
    }

    pub(super) fn gone(&mut self) {
        self.waiting.push(Event::PointerGone);
    }

    /// Records a turn of the wheel, in a unit by its number in browsers.
    pub(super) fn wheel(&mut self, [x, y]: [f32; 2], unit: u32) {
        let unit = match unit {
            0 => MouseWheelUnit::Point,
            1 => MouseWheelUnit::Line,
            _ => MouseWheelUnit::Page,
        };
        let (delta, modifiers) = (-vec2(x, y), self.modifiers);
        // Browsers report a pinch on a touchpad as a wheel with Control.
        let event = if modifiers.ctrl && unit == MouseWheelUnit::Point {
            Event::Zoom((delta.y / 200.0).exp())
        } else {
            Event::MouseWheel { unit, delta, phase: TouchPhase::Move, source: MouseWheelSource::Unknown, modifiers }
        };
        self.waiting.push(event);
    }

    /// Records a touch. The first finger also moves the pointer.
    pub(super) fn touch(&mut self, finger: u64, phase: &str, pos: Pos2) {
        let phase = match phase {
            "pointerdown" => TouchPhase::Start,
            "pointermove" => TouchPhase::Move,
            "pointerup" => TouchPhase::End,
            _ => TouchPhase::Cancel,
        };
        let touch = Event::Touch { device_id: TouchDeviceId(0), id: TouchId(finger), phase, pos, force: None };
        self.waiting.push(touch);
        if phase == TouchPhase::Start && self.finger.is_none() {
            self.finger = Some(finger);
            self.button(pos, 0, true);
        } else if self.finger == Some(finger) {
            match phase {
                TouchPhase::Start | TouchPhase::Move => self.waiting.push(Event::PointerMoved(pos)),
                TouchPhase::End | TouchPhase::Cancel => {
                    self.finger = None;
                    self.button(pos, 0, false);
                    self.gone();
                }
            }
        }
    }

    /// Records a key by its position and by its label, as browsers name both.
    pub(super) fn key(&mut self, code: &str, name: &str, pressed: bool, repeat: bool) {
        let physical_key = Key::from_name(code);
        if let Some(key) = Key::from_name(name).or(physical_key) {
            self.waiting.push(Event::Key { key, physical_key, pressed, repeat, modifiers: self.modifiers });
        }
        let types = pressed && !self.modifiers.command && !self.modifiers.alt && name.chars().count() == 1;
        if types {
            self.waiting.push(Event::Text(name.to_owned()));
        }
    }
}
