//! Where the camera and the sun are, the keys that move them, and a path that the camera takes by itself.

use bevy::input::mouse::AccumulatedMouseMotion;
use bevy::prelude::*;

use crate::content::Content;

/// Speed of flight, in lengths of the scene's diagonal a second.
const SPEED: f32 = 0.03;
/// Least and greatest speed, in metres a second.
const SPEEDS: [f32; 2] = [1.0, 20.0];
/// Shift makes the flight faster by this factor.
const FASTER: f32 = 4.0;
/// Turns of the camera by arrow keys, and of the sun, in radians a second.
const TURN: [f32; 2] = [1.0, 0.4];
/// Turn of the camera by a mouse drag, in radians a pixel.
const DRAG: f32 = 0.003;
/// Greatest angle of view above and below the horizon, in radians.
const MAX_PITCH: f32 = 1.5;
/// Least and greatest height of the sun, in radians.
const SUN_HEIGHTS: [f32; 2] = [0.05, 1.5];
/// Longest step of time, in seconds, so that slow frames do not jump.
const MAX_STEP: f32 = 0.1;
/// Radius of the path, in seconds of flight, and its turns, in radians a second.
const PATH: (f32, f32) = (1.0, 0.25);

/// The pose of both cameras and the direction of both suns. Angles in radians.
#[derive(Resource, Clone, Debug)]
pub(crate) struct Flight {
    eye: Vec3,
    /// Turn about the vertical; 0 looks along -z.
    yaw: f32,
    /// Angle above the horizon.
    pitch: f32,
    /// Metres a second.
    speed: f32,
    /// Direction toward the sun: turn about the vertical from +z toward +x, and height above the horizon.
    sun: [f32; 2],
    /// Time on the path, in seconds, while the camera takes it.
    path: Option<f32>,
}

impl Flight {
    fn new(content: &Content) -> Self {
        let view = content.start_view();
        let forward = Vec3::from_array(view.forward.normalize_or(-shadowfit::glam::Vec3::Z).to_array());
        let to_sun = -Vec3::from_array(content.sunlight().normalize_or(-shadowfit::glam::Vec3::Y).to_array());
        Self {
            eye: Vec3::from_array(view.eye.to_array()),
            yaw: (-forward.x).atan2(-forward.z),
            pitch: forward.y.clamp(-1.0, 1.0).asin().clamp(-MAX_PITCH, MAX_PITCH),
            speed: (SPEED * content.extent()).clamp(SPEEDS[0], SPEEDS[1]),
            sun: [to_sun.x.atan2(to_sun.z), to_sun.y.clamp(-1.0, 1.0).asin().clamp(SUN_HEIGHTS[0], SUN_HEIGHTS[1])],
            path: None,
        }
    }

    /// World from camera.
    pub(crate) fn camera(&self) -> Transform {
        let here = Transform::from_translation(self.eye).with_rotation(self.rotation());
        let Some(seconds) = self.path else { return here };
        // A circle that begins here, sideways and forward, on which the camera keeps its direction.
        let (sin, cos) = (seconds * PATH.1).sin_cos();
        let aside = Quat::from_rotation_y(self.yaw) * Vec3::new(sin, 0.0, cos - 1.0);
        here.with_translation(self.eye + aside * self.speed * PATH.0)
    }

    /// World from light, which looks along -z.
    pub(crate) fn sun(&self) -> Transform {
        let [azimuth, height] = self.sun;
        let flat = height.cos();
        let to_sun = Vec3::new(azimuth.sin() * flat, height.sin(), azimuth.cos() * flat);
        Transform::default().looking_to(-to_sun, Vec3::Y)
    }

    fn rotation(&self) -> Quat {
        Quat::from_euler(EulerRot::YXZ, self.yaw, self.pitch, 0.0)
    }
}

/// Adds the flight and its keys.
pub(crate) fn plugin(app: &mut App, content: &Content) {
    app.insert_resource(Flight::new(content)).add_systems(Update, fly);
}

/// Moves the camera and the sun.
pub(crate) fn fly(
    time: Res<Time>,
    keys: Res<ButtonInput<KeyCode>>,
    buttons: Res<ButtonInput<MouseButton>>,
    mouse: Res<AccumulatedMouseMotion>,
    mut flight: ResMut<Flight>,
) {
    let step = time.delta_secs().min(MAX_STEP);
    let axis = |less: KeyCode, more: KeyCode| f32::from(keys.pressed(more)) - f32::from(keys.pressed(less));
    let move_by = Vec3::new(
        axis(KeyCode::KeyA, KeyCode::KeyD),
        axis(KeyCode::KeyQ, KeyCode::KeyE),
        axis(KeyCode::KeyW, KeyCode::KeyS),
    );
    let fast = if keys.any_pressed([KeyCode::ShiftLeft, KeyCode::ShiftRight]) { FASTER } else { 1.0 };
    let moved = flight.rotation() * move_by * flight.speed * fast * step;
    flight.eye += moved;

    let drag = if buttons.pressed(MouseButton::Left) { mouse.delta * DRAG } else { Vec2::ZERO };
    flight.yaw += axis(KeyCode::ArrowRight, KeyCode::ArrowLeft) * TURN[0] * step - drag.x;
    let pitch = flight.pitch + axis(KeyCode::ArrowDown, KeyCode::ArrowUp) * TURN[0] * step - drag.y;
    flight.pitch = pitch.clamp(-MAX_PITCH, MAX_PITCH);

    flight.sun[0] += axis(KeyCode::KeyK, KeyCode::KeyL) * TURN[1] * step;
    let height = flight.sun[1] + axis(KeyCode::KeyO, KeyCode::KeyI) * TURN[1] * step;
    flight.sun[1] = height.clamp(SUN_HEIGHTS[0], SUN_HEIGHTS[1]);

    let on_path = flight.path.map(|seconds| seconds + step);
    flight.path = on_path;
    if keys.just_pressed(KeyCode::KeyT) {
        match on_path {
            None => flight.path = Some(0.0),
            // The flight goes on from where the path has led.
            Some(_) => {
                flight.eye = flight.camera().translation;
                flight.path = None;
            }
        }
    }
}
