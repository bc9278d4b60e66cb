//! The free-flying camera: a position, two angles and a speed, moved by plain input values so that
//! it needs no window. World space, right-handed, y up; yaw 0 and pitch 0 look along -z.

use glam::{DVec3, Vec2, Vec3};
use shadowfit::PerspectiveCamera;
use shadowfit_params::tool::{CameraSettings, FLYING_SPEEDS};

/// Steepest look up or down, in radians: just short of the vertical, where "up" would flip.
pub const MAX_PITCH: f32 = 1.55;
/// Turning speed of the arrow keys and of a fully pressed stick, in radians a second.
pub const TURN_SPEED: f32 = 1.5;
/// How many times faster the camera flies while "fast" is held.
pub const FAST_FACTOR: f32 = 4.0;
/// Turn per pixel of mouse drag, in radians.
pub const DRAG_RADIANS_PER_PIXEL: f32 = 0.004;
/// Flight for each point that two fingers move, in seconds at the camera's speed.
pub const PAN_SECONDS_PER_POINT: f32 = 0.005;
/// Flight while two fingers come e times as far apart, in seconds at the camera's speed.
pub const PINCH_SECONDS: f32 = 2.0;
/// Speed factor per notch of the wheel.
pub const WHEEL_FACTOR: f32 = 1.2;

/// Longest step that is integrated at once, in seconds: turning while moving follows the same curve
/// at any frame rate.
const MAX_STEP: f32 = 1.0 / 240.0;
/// Longest frame time that is used, in seconds, so that a stall does not fling the camera away.
const MAX_FRAME: f32 = 0.25;

/// The camera's position and direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlyCamera {
    /// Eye, world space, in metres.
    pub position: DVec3,
    /// Turn about +y, in radians; 0 looks along -z, positive turns left.
    pub yaw: f32,
    /// Look up (positive) or down, in radians, within ±[`MAX_PITCH`].
    pub pitch: f32,
}

/// The user's input during one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlyInput {
    /// Movement along the camera's right, world up and the look direction, each -1..=1.
    pub movement: Vec3,
    /// Turning rate from keys and sticks: x to the right, y upward, each -1..=1.
    pub turn: Vec2,
    /// Mouse drag since the last frame, in pixels, x right, y down.
    pub drag: Vec2,
    /// Movement of two fingers since the last frame, in points, x right, y down: the scene goes with them.
    pub pan: Vec2,
    /// Natural logarithm of the factor by which two fingers came apart since the last frame; apart flies forward.
    pub pinch: f32,
    /// Wheel notches since the last frame; up is positive.
    pub wheel: f32,
    /// Flies [`FAST_FACTOR`] times as fast.
    pub fast: bool,
}

impl FlyCamera {
    /// A camera at `eye` that looks at `target` (world space, metres). Straight up or down is
    /// limited to [`MAX_PITCH`]; a target at the eye looks along -z.
    pub fn look_at(eye: DVec3, target: DVec3) -> Self {
        let look = (target - eye).as_vec3();
        let mut camera = Self { position: eye, yaw: 0.0, pitch: 0.0 };
        camera.look_along(look);
        camera
    }

    /// Turns the camera to look along `direction` (world space, any length).
    pub fn look_along(&mut self, direction: Vec3) {
        let flat = Vec2::new(direction.x, direction.z).length();
        if direction.is_finite() && direction != Vec3::ZERO {
            self.yaw = if flat > 0.0 { (-direction.x).atan2(-direction.z) } else { self.yaw };
            self.pitch = direction.y.atan2(flat).clamp(-MAX_PITCH, MAX_PITCH);
        }
    }

    /// Unit look direction, world space.
    pub fn forward(&self) -> Vec3 {
        let (sin_yaw, cos_yaw) = self.yaw.sin_cos();
        let (sin_pitch, cos_pitch) = self.pitch.sin_cos();
        Vec3::new(-sin_yaw * cos_pitch, sin_pitch, -cos_yaw * cos_pitch)
    }

    /// Unit direction to the right, world space, level.
    pub fn right(&self) -> Vec3 {
        let (sin_yaw, cos_yaw) = self.yaw.sin_cos();
        Vec3::new(cos_yaw, 0.0, -sin_yaw)
    }

    /// Moves and turns for `seconds` and applies the wheel to `settings.speed`. Two half frames
    /// give the same result as one whole frame.
    pub fn update(&mut self, settings: &mut CameraSettings, input: &FlyInput, seconds: f32) {
        let (slowest, fastest) = FLYING_SPEEDS;
        settings.speed = (settings.speed * WHEEL_FACTOR.powf(input.wheel)).clamp(slowest, fastest);
        self.yaw -= input.drag.x * DRAG_RADIANS_PER_PIXEL;
        self.pitch = (self.pitch - input.drag.y * DRAG_RADIANS_PER_PIXEL).clamp(-MAX_PITCH, MAX_PITCH);
        let speed = settings.speed * if input.fast { FAST_FACTOR } else { 1.0 };
        let along = (self.right() * -input.pan.x + Vec3::Y * input.pan.y) * PAN_SECONDS_PER_POINT;
        self.position += ((along + self.forward() * (input.pinch * PINCH_SECONDS)) * speed).as_dvec3();
        let seconds = seconds.clamp(0.0, MAX_FRAME);
        let steps = (seconds / MAX_STEP).ceil().max(1.0);
        for _ in 0..steps as u32 {
            self.step(input, speed, seconds / steps);
        }
    }

    /// One small step: half of the turn, the move, the other half.
    fn step(&mut self, input: &FlyInput, speed: f32, seconds: f32) {
        let half_turn = input.turn.clamp(Vec2::NEG_ONE, Vec2::ONE) * (TURN_SPEED * seconds * 0.5);
        self.turn(half_turn);
        let movement = input.movement.clamp_length_max(1.0) * (speed * seconds);
        let step = self.right() * movement.x + Vec3::Y * movement.y + self.forward() * movement.z;
        self.position += step.as_dvec3();
        self.turn(half_turn);
    }

    fn turn(&mut self, angles: Vec2) {
        self.yaw -= angles.x;
        self.pitch = (self.pitch + angles.y).clamp(-MAX_PITCH, MAX_PITCH);
    }

    /// The camera with its lens, for a picture of the given aspect (width over height).
    pub fn perspective(&self, settings: &CameraSettings, aspect: f32) -> PerspectiveCamera {
        PerspectiveCamera {
            eye: self.position,
            forward: self.forward(),
            up: Vec3::Y,
            fov_y: settings.fov_y,
            aspect,
            near: settings.near,
            far: settings.far,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fly(frames: u32, seconds: f32, input: &FlyInput) -> FlyCamera {
        let mut camera = FlyCamera::look_at(DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.0, 2.0, -4.0));
        let mut settings = CameraSettings::default();
        for _ in 0..frames {
            camera.update(&mut settings, input, seconds / frames as f32);
        }
        camera
    }

    #[test]
    fn the_path_does_not_depend_on_the_frame_rate() {
        let input = FlyInput { movement: Vec3::new(0.3, 0.2, 1.0), turn: Vec2::new(0.8, -0.4), ..Default::default() };
        let coarse = fly(10, 2.0, &input);
        for frames in [20, 60, 144, 500] {
            let fine = fly(frames, 2.0, &input);
            // The midpoint steps differ by the square of their length: far below a millimetre.
            assert!((fine.position - coarse.position).length() < 1e-3, "{frames} frames: {fine:?} {coarse:?}");
            assert!((fine.yaw - coarse.yaw).abs() < 1e-4);
        }
    }

    #[test]
    fn each_key_moves_along_its_axis() {
        let level = FlyCamera { position: DVec3::ZERO, yaw: 0.0, pitch: 0.0 };
        for (movement, expected) in
            [(Vec3::X, DVec3::X), (Vec3::Y, DVec3::Y), (Vec3::Z, DVec3::NEG_Z), (Vec3::NEG_Z, DVec3::Z)]
        {
            let mut camera = level;
            let mut settings = CameraSettings { speed: 3.0, ..Default::default() };
            camera.update(&mut settings, &FlyInput { movement, ..Default::default() }, 0.1);
            assert!((camera.position - expected * 0.3).length() < 1e-5, "{movement}: {}", camera.position);
        }
    }

    #[test]
    fn diagonal_flight_is_no_faster_and_fast_is() {
        let far = |input: FlyInput| {
            let mut camera = FlyCamera { position: DVec3::ZERO, yaw: 0.0, pitch: 0.0 };
            camera.update(&mut CameraSettings::default(), &input, 0.1);
            camera.position.length() as f32
        };
        let straight = far(FlyInput { movement: Vec3::Z, ..Default::default() });
        let diagonal = far(FlyInput { movement: Vec3::ONE, ..Default::default() });
        let fast = far(FlyInput { movement: Vec3::Z, fast: true, ..Default::default() });
        assert!((straight - diagonal).abs() < 1e-4);
        assert!((fast / straight - FAST_FACTOR).abs() < 1e-3);
    }

    #[test]
    fn looking_up_stops_short_of_flipping_over() {
        let camera = fly(100, 20.0, &FlyInput { turn: Vec2::Y, ..Default::default() });
        assert_eq!(camera.pitch, MAX_PITCH);
        assert!(camera.forward().y > 0.99 && camera.right().is_normalized());
    }

    #[test]
    fn look_at_looks_at_its_target() {
        for target in [DVec3::new(3.0, 1.0, -2.0), DVec3::new(-3.0, 9.0, 2.0), DVec3::new(0.0, -0.5, 7.0)] {
            let eye = DVec3::new(0.5, 1.5, 0.25);
            let camera = FlyCamera::look_at(eye, target);
            assert!((camera.forward() - (target - eye).normalize().as_vec3()).length() < 1e-5);
        }
    }

    #[test]
    fn a_stalled_frame_does_not_fling_the_camera_away() {
        let mut camera = FlyCamera { position: DVec3::ZERO, yaw: 0.0, pitch: 0.0 };
        let mut settings = CameraSettings { speed: 1.0, ..Default::default() };
        camera.update(&mut settings, &FlyInput { movement: Vec3::Z, ..Default::default() }, 60.0);
        assert!(camera.position.length() <= f64::from(MAX_FRAME) + 1e-6);
    }

    #[test]
    fn the_scene_goes_with_two_fingers_and_comes_nearer_as_they_part() {
        let moved = |pan: Vec2, pinch: f32| {
            let mut camera = FlyCamera { position: DVec3::ZERO, yaw: 0.0, pitch: 0.0 };
            let mut settings = CameraSettings { speed: 2.0, ..Default::default() };
            camera.update(&mut settings, &FlyInput { pan, pinch, ..Default::default() }, 0.1);
            camera.position.as_vec3()
        };
        assert!(
            moved(Vec2::new(100.0, 0.0), 0.0).abs_diff_eq(Vec3::NEG_X, 1e-6),
            "fingers to the right, eye to the left"
        );
        assert!(moved(Vec2::new(0.0, 100.0), 0.0).abs_diff_eq(Vec3::Y, 1e-6));
        assert!(moved(Vec2::ZERO, 0.5).abs_diff_eq(Vec3::NEG_Z * 2.0, 1e-6));
    }

    #[test]
    fn the_wheel_changes_the_speed_within_its_range() {
        let mut camera = FlyCamera { position: DVec3::ZERO, yaw: 0.0, pitch: 0.0 };
        let mut settings = CameraSettings { speed: 1.0, ..Default::default() };
        camera.update(&mut settings, &FlyInput { wheel: 1.0, ..Default::default() }, 0.0);
        assert_eq!(settings.speed, WHEEL_FACTOR);
        camera.update(&mut settings, &FlyInput { wheel: 1e3, ..Default::default() }, 0.0);
        assert_eq!(settings.speed, FLYING_SPEEDS.1);
    }
}
