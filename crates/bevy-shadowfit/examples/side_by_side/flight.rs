//! Camera and sun, the keys that move them, and an automatic camera path.

use bevy::input::mouse::AccumulatedMouseMotion;
use bevy::prelude::*;

use crate::scene::Content;

/// Speed of flight, in diagonals of the scene per second.
const SPEED: f32 = 0.03;
/// Least and greatest speed, in metres per second.
const SPEEDS: [f32; 2] = [1.0, 20.0];
/// Factor of the speed while Shift is pressed.
const FASTER: f32 = 4.0;
/// Rotation speed of the camera by arrow keys, in radians per second.
const TURN: f32 = 1.0;
/// Rotation speed of the sun, in radians per second.
const SUN_TURN: f32 = 0.4;
/// Rotation of the camera by a mouse drag, in radians per pixel.
const DRAG: f32 = 0.003;
/// Greatest angle above and below the horizon, in radians, so that no direction is vertical.
const MAX_HEIGHT: f32 = 1.5;
/// Least height of the sun, in radians.
const MIN_SUN: f32 = 0.05;
/// Longest time step, in seconds, so that slow frames do not jump.
const MAX_STEP: f32 = 0.1;
/// Angular speed on the path, in radians per second. Its radius is one second of flight.
const PATH_TURN: f32 = 0.25;

/// A direction in angles, in radians.
#[derive(Clone, Copy, Debug)]
struct Angles {
    /// Rotation about the vertical, from +z toward +x.
    turn: f32,
    /// Height above the horizon.
    height: f32,
}

impl Angles {
    fn of(direction: Vec3) -> Self {
        let height = direction.y.clamp(-1.0, 1.0).asin().clamp(-MAX_HEIGHT, MAX_HEIGHT);
        Self { turn: direction.x.atan2(direction.z), height }
    }

    fn direction(self) -> Vec3 {
        let flat = self.height.cos();
        Vec3::new(self.turn.sin() * flat, self.height.sin(), self.turn.cos() * flat)
    }
}

/// Pose of both cameras and direction of both suns.
#[derive(Resource, Clone, Debug)]
pub(crate) struct Flight {
    eye: Vec3,
    look: Angles,
    to_sun: Angles,
    /// Speed in metres per second.
    speed: f32,
    /// Time on the path, in seconds, while the camera follows it.
    path: Option<f32>,
}

impl Flight {
    pub(crate) fn new(content: &Content) -> Self {
        let start = content.start();
        let to_sun = Angles::of(content.to_sun());
        Self {
            eye: start.translation,
            look: Angles::of(*start.forward()),
            to_sun: Angles { height: to_sun.height.max(MIN_SUN), ..to_sun },
            speed: (SPEED * content.extent()).clamp(SPEEDS[0], SPEEDS[1]),
            path: None,
        }
    }

    /// Returns the matrix from camera to world.
    fn camera(&self) -> Transform {
        // The path is a circle that begins at the eye, sideways and forward. The camera keeps its direction.
        let (sin, cos) = (self.path.unwrap_or(0.0) * PATH_TURN).sin_cos();
        let aside = Quat::from_rotation_y(self.look.turn) * Vec3::new(-sin, 0.0, 1.0 - cos);
        Transform::from_translation(self.eye + aside * self.speed).looking_to(self.look.direction(), Vec3::Y)
    }
}

/// Moves the cameras and the suns.
pub(crate) fn fly(
    time: Res<Time>,
    keys: Res<ButtonInput<KeyCode>>,
    buttons: Res<ButtonInput<MouseButton>>,
    mouse: Res<AccumulatedMouseMotion>,
    mut flight: ResMut<Flight>,
    mut cameras: Query<&mut Transform, (With<Camera3d>, Without<DirectionalLight>)>,
    mut suns: Query<&mut Transform, With<DirectionalLight>>,
) {
    use KeyCode as Key;
    let step = time.delta_secs().min(MAX_STEP);
    let axis = |less: Key, more: Key| f32::from(keys.pressed(more)) - f32::from(keys.pressed(less));
    let fast = if keys.any_pressed([Key::ShiftLeft, Key::ShiftRight]) { FASTER } else { 1.0 };
    let along = Vec3::new(axis(Key::KeyA, Key::KeyD), axis(Key::KeyQ, Key::KeyE), axis(Key::KeyW, Key::KeyS));
    let moved = flight.camera().rotation * along * flight.speed * fast * step;
    flight.eye += moved;
    let drag = if buttons.pressed(MouseButton::Left) { mouse.delta * DRAG } else { Vec2::ZERO };
    flight.look.turn += axis(Key::ArrowRight, Key::ArrowLeft) * TURN * step - drag.x;
    let height = flight.look.height + axis(Key::ArrowDown, Key::ArrowUp) * TURN * step - drag.y;
    flight.look.height = height.clamp(-MAX_HEIGHT, MAX_HEIGHT);
    flight.to_sun.turn += axis(Key::KeyK, Key::KeyL) * SUN_TURN * step;
    let height = flight.to_sun.height + axis(Key::KeyO, Key::KeyI) * SUN_TURN * step;
    flight.to_sun.height = height.clamp(MIN_SUN, MAX_HEIGHT);
    flight.path = flight.path.map(|seconds| seconds + step);
    if keys.just_pressed(Key::KeyT) {
        // After the path, flight continues from its end.
        flight.eye = flight.camera().translation;
        flight.path = if flight.path.is_none() { Some(0.0) } else { None };
    }
    for mut camera in &mut cameras {
        camera.set_if_neq(flight.camera());
    }
    for mut sun in &mut suns {
        sun.set_if_neq(Transform::default().looking_to(-flight.to_sun.direction(), Vec3::Y));
    }
}
