//! The free-flying camera: a position, three angles and a speed. Plain input values move it, so it needs no
//! window. World space, right-handed, y up; yaw 0 and pitch 0 look along -z.

use glam::{DVec3, Vec2, Vec3};
use shadowfit::{Camera, Lens, PerspectiveCamera};
use shadowfit_params::tool::{CameraSettings, FLYING_SPEEDS, HEIGHTS};

/// Steepest pitch that turning reaches, in radians: just short of the vertical, where "up" would flip.
pub const MAX_PITCH: f32 = 1.55;
/// Turning speed of the arrow keys and of a fully pressed stick, in radians per second.
pub const TURN_SPEED: f32 = 1.5;
/// Factor on the flying speed while "fast" is held.
pub const FAST_FACTOR: f32 = 4.0;
/// Turn per pixel of mouse drag, in radians.
pub const DRAG_RADIANS_PER_PIXEL: f32 = 0.004;
/// Flight per point that two fingers move, in seconds at the camera's speed.
pub const PAN_SECONDS_PER_POINT: f32 = 0.005;
/// Flight while the distance of two fingers grows by a factor of e, in seconds at the camera's speed.
pub const PINCH_SECONDS: f32 = 2.0;
/// Speed factor per notch of the wheel.
pub const WHEEL_FACTOR: f32 = 1.2;

/// Sine of the angle to the vertical below which a view direction has no defined yaw. A placed camera then
/// gets the yaw that needs no roll.
const VERTICAL_SINE: f32 = 1e-4;

/// Roll of a placed camera below which it counts as rounding of its directions, in radians: 0.01 pixels at
/// the side of a picture 2000 pixels wide.
const LEAST_ROLL: f32 = 1e-5;

/// Longest step that is integrated at once, in seconds, so that turning while moving follows the same curve
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
    /// Pitch in radians within ±π/2, positive upward. Turning keeps it within ±[`MAX_PITCH`].
    pub pitch: f32,
    /// Turn about the view direction, in radians; positive tilts the head to the right. Flying keeps it.
    pub roll: f32,
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
    /// Movement of two fingers since the last frame, in points, x right, y down. The scene follows the
    /// fingers.
    pub pan: Vec2,
    /// Natural logarithm of the factor by which the distance of two fingers grew since the last frame.
    /// Positive flies forward.
    pub pinch: f32,
    /// Wheel notches since the last frame; up is positive.
    pub wheel: f32,
    /// Whether the camera flies [`FAST_FACTOR`] times faster.
    pub fast: bool,
}

impl FlyInput {
    /// Returns whether the input moves or turns the camera.
    pub fn moves(&self) -> bool {
        let Self { movement, turn, drag, pan, pinch, wheel: _, fast: _ } = *self;
        movement != Vec3::ZERO || [turn, drag, pan].iter().any(|turned| *turned != Vec2::ZERO) || pinch != 0.0
    }
}

impl FlyCamera {
    /// Returns a camera at `eye` that looks at `target` (world space, metres). The pitch is limited to
    /// [`MAX_PITCH`]. If the target is at the eye, the camera looks along -z.
    pub fn look_at(eye: DVec3, target: DVec3) -> Self {
        let look = (target - eye).as_vec3();
        let mut camera = Self { position: eye, yaw: 0.0, pitch: 0.0, roll: 0.0 };
        camera.look_along(look);
        camera
    }

    /// Returns a camera at `eye` (world space, metres) with exactly these unit view and up directions, which
    /// must be perpendicular. A view straight up or down gets no roll.
    pub fn placed(eye: DVec3, forward: Vec3, up: Vec3) -> Self {
        let flat = Vec2::new(forward.x, forward.z).length();
        let pitch = forward.y.atan2(flat);
        let ahead = if flat > VERTICAL_SINE { forward } else { up * -forward.y };
        let level = Self { position: eye, yaw: (-ahead.x).atan2(-ahead.z), pitch, roll: 0.0 };
        if flat <= VERTICAL_SINE {
            return level;
        }
        let roll = up.dot(level.right()).atan2(up.dot(level.right().cross(level.forward())));
        Self { roll: if roll.abs() < LEAST_ROLL { 0.0 } else { roll }, ..level }
    }

    /// Turns the camera to look along `direction` (world space, any length).
    pub fn look_along(&mut self, direction: Vec3) {
        let flat = Vec2::new(direction.x, direction.z).length();
        if direction.is_finite() && direction != Vec3::ZERO {
            self.yaw = if flat > 0.0 { (-direction.x).atan2(-direction.z) } else { self.yaw };
            self.pitch = direction.y.atan2(flat).clamp(-MAX_PITCH, MAX_PITCH);
        }
    }

    /// Returns the unit view direction, world space.
    pub fn forward(&self) -> Vec3 {
        let (sin_yaw, cos_yaw) = self.yaw.sin_cos();
        let (sin_pitch, cos_pitch) = self.pitch.sin_cos();
        Vec3::new(-sin_yaw * cos_pitch, sin_pitch, -cos_yaw * cos_pitch)
    }

    /// Returns the unit direction that appears upward, world space.
    pub fn up(&self) -> Vec3 {
        let (sin_roll, cos_roll) = self.roll.sin_cos();
        self.right().cross(self.forward()) * cos_roll + self.right() * sin_roll
    }

    /// Returns the unit direction to the right, world space, level: without the roll.
    pub fn right(&self) -> Vec3 {
        let (sin_yaw, cos_yaw) = self.yaw.sin_cos();
        Vec3::new(cos_yaw, 0.0, -sin_yaw)
    }

    /// Moves and turns for `seconds` and applies the wheel to `settings.speed`. Two half frames give the same
    /// result as one whole frame. In an orthographic picture, flying forward or back changes
    /// `settings.height` instead, because motion along the view would not change the picture.
    pub fn update(&mut self, settings: &mut CameraSettings, input: &FlyInput, seconds: f32) {
        let (slowest, fastest) = FLYING_SPEEDS;
        settings.speed = (settings.speed * WHEEL_FACTOR.powf(input.wheel)).clamp(slowest, fastest);
        self.turn(Vec2::new(input.drag.x, -input.drag.y) * DRAG_RADIANS_PER_PIXEL);
        let speed = settings.speed * if input.fast { FAST_FACTOR } else { 1.0 };
        let seconds = seconds.clamp(0.0, MAX_FRAME);
        let mut input = *input;
        if let Some(height) = &mut settings.height {
            let ahead = speed * (input.movement.z.clamp(-1.0, 1.0) * seconds + input.pinch * PINCH_SECONDS);
            let (least, most) = HEIGHTS;
            *height = (*height - ahead).clamp(least, most);
            (input.movement.z, input.pinch) = (0.0, 0.0);
        }
        let along = (self.right() * -input.pan.x + Vec3::Y * input.pan.y) * PAN_SECONDS_PER_POINT;
        self.position += ((along + self.forward() * (input.pinch * PINCH_SECONDS)) * speed).as_dvec3();
        let steps = (seconds / MAX_STEP).ceil().max(1.0);
        for _ in 0..steps as u32 {
            self.step(&input, speed, seconds / steps);
        }
    }

    /// Does a small step: half of the turn, the move, and the other half.
    fn step(&mut self, input: &FlyInput, speed: f32, seconds: f32) {
        let half_turn = input.turn.clamp(Vec2::NEG_ONE, Vec2::ONE) * (TURN_SPEED * seconds * 0.5);
        self.turn(half_turn);
        let movement = input.movement.clamp_length_max(1.0) * (speed * seconds);
        let step = self.right() * movement.x + Vec3::Y * movement.y + self.forward() * movement.z;
        self.position += step.as_dvec3();
        self.turn(half_turn);
    }

    /// Turns by angles to the right and upward in the picture, in radians. If the camera has a roll, the axes
    /// are rolled too.
    fn turn(&mut self, angles: Vec2) {
        if angles == Vec2::ZERO {
            return;
        }
        let (sin_roll, cos_roll) = self.roll.sin_cos();
        self.yaw -= angles.x * cos_roll + angles.y * sin_roll;
        let raised = angles.y * cos_roll - angles.x * sin_roll;
        self.pitch = (self.pitch + raised).clamp(-MAX_PITCH, MAX_PITCH);
    }

    /// Returns the camera with its lens, for a picture of the given aspect (width over height).
    pub fn camera(&self, settings: &CameraSettings, aspect: f32) -> Camera {
        let camera = Camera::from(self.perspective(settings, aspect));
        match settings.height {
            Some(height) => Camera { lens: Lens::Orthographic { half_height: height * 0.5 }, ..camera },
            None => camera,
        }
    }

    /// Returns the camera with a perspective lens, regardless of `settings.height`, for a picture of the
    /// given aspect (width over height).
    pub fn perspective(&self, settings: &CameraSettings, aspect: f32) -> PerspectiveCamera {
        // The vertical is exact, and usable unless the camera looks along it.
        let is_level = self.roll == 0.0 && self.pitch.abs() <= MAX_PITCH;
        PerspectiveCamera {
            eye: self.position,
            forward: self.forward(),
            up: if is_level { Vec3::Y } else { self.up() },
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
            // The midpoint steps differ by the square of their length, far below a millimetre.
            assert!((fine.position - coarse.position).length() < 1e-3, "{frames} frames: {fine:?} {coarse:?}");
            assert!((fine.yaw - coarse.yaw).abs() < 1e-4);
        }
    }

    #[test]
    fn each_key_moves_along_its_axis() {
        let level = FlyCamera { position: DVec3::ZERO, yaw: 0.0, pitch: 0.0, roll: 0.0 };
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
            let mut camera = FlyCamera { position: DVec3::ZERO, yaw: 0.0, pitch: 0.0, roll: 0.0 };
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
        let mut camera = FlyCamera { position: DVec3::ZERO, yaw: 0.0, pitch: 0.0, roll: 0.0 };
        let mut settings = CameraSettings { speed: 1.0, ..Default::default() };
        camera.update(&mut settings, &FlyInput { movement: Vec3::Z, ..Default::default() }, 60.0);
        assert!(camera.position.length() <= f64::from(MAX_FRAME) + 1e-6);
    }

    #[test]
    fn the_scene_goes_with_two_fingers_and_comes_nearer_as_they_part() {
        let moved = |pan: Vec2, pinch: f32| {
            let mut camera = FlyCamera { position: DVec3::ZERO, yaw: 0.0, pitch: 0.0, roll: 0.0 };
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
        let mut camera = FlyCamera { position: DVec3::ZERO, yaw: 0.0, pitch: 0.0, roll: 0.0 };
        let mut settings = CameraSettings { speed: 1.0, ..Default::default() };
        camera.update(&mut settings, &FlyInput { wheel: 1.0, ..Default::default() }, 0.0);
        assert_eq!(settings.speed, WHEEL_FACTOR);
        camera.update(&mut settings, &FlyInput { wheel: 1e3, ..Default::default() }, 0.0);
        assert_eq!(settings.speed, FLYING_SPEEDS.1);
    }

    #[test]
    fn a_placed_camera_has_its_directions_whatever_they_are() {
        let mut directions =
            vec![Vec3::Y, Vec3::NEG_Y, Vec3::X, Vec3::new(1e-6, -1.0, 1e-6), Vec3::new(0.0, 0.99999, 0.004)];
        directions.extend([Vec3::new(1.0, -2.0, 3.0), Vec3::new(-3.0, 0.2, -0.1), Vec3::new(0.1, 5.0, -0.3)]);
        for forward in directions.into_iter().map(Vec3::normalize) {
            for angle in [0.0_f32, 0.6, 2.0, -3.0] {
                let up = glam::Quat::from_axis_angle(forward, angle) * forward.any_orthonormal_vector();
                let camera = FlyCamera::placed(DVec3::ONE, forward, up);
                let lens = camera.camera(&CameraSettings::default(), 1.0);
                let view = lens.view_from_world();
                let [found_up, found_back] = [view.row(1), view.row(2)].map(glam::Vec4::truncate);
                assert!((found_back + forward).length() < 2e-5, "{forward}, {angle}: {found_back}");
                assert!((found_up - up).length() < 2e-4, "{forward}, {angle}: {found_up} for {up}");
            }
        }
    }

    #[test]
    fn flying_keeps_a_roll_and_a_drag_turns_within_the_rolled_picture() {
        let start = FlyCamera { position: DVec3::ZERO, yaw: 0.3, pitch: 0.2, roll: 0.7 };
        let mut camera = start;
        let input = FlyInput { movement: Vec3::ONE, drag: Vec2::new(1.0, 0.0), ..Default::default() };
        camera.update(&mut CameraSettings::default(), &input, 0.1);
        assert_eq!(camera.roll, start.roll);
        let right = start.forward().cross(start.up());
        let turned = camera.forward() - start.forward();
        assert!(turned.dot(right) > 0.0, "toward the right of the picture");
        assert!(turned.dot(start.up()).abs() < 0.1 * turned.length(), "and not upward in it: {turned}");
        let straight_down = FlyCamera { pitch: -core::f32::consts::FRAC_PI_2, roll: 0.0, ..start };
        let mut flown = straight_down;
        flown.update(&mut CameraSettings::default(), &FlyInput { movement: Vec3::X, ..Default::default() }, 0.1);
        assert_eq!(flown.pitch, straight_down.pitch, "only turning limits the pitch");
    }

    #[test]
    fn the_height_of_an_orthographic_picture_does_not_depend_on_the_frame_rate() {
        let fly = |frames: u32| {
            let mut settings = CameraSettings { height: Some(3.0), ..Default::default() };
            let mut camera = FlyCamera { position: DVec3::ZERO, yaw: 0.0, pitch: 0.0, roll: 0.0 };
            let input = FlyInput { movement: Vec3::Z, ..Default::default() };
            (0..frames).for_each(|_| camera.update(&mut settings, &input, 0.5 / frames as f32));
            settings.height.expect("it stays orthographic")
        };
        for frames in [4, 37, 120] {
            assert!((fly(frames) - fly(2)).abs() < 1e-4, "{frames}: {} for {}", fly(frames), fly(2));
        }
    }

    #[test]
    fn flying_along_an_orthographic_view_changes_its_height_alone() {
        let mut settings = CameraSettings { height: Some(4.0), ..Default::default() };
        let mut camera = FlyCamera { position: DVec3::ZERO, yaw: 0.0, pitch: 0.0, roll: 0.0 };
        camera.update(&mut settings, &FlyInput { movement: Vec3::Z, ..Default::default() }, 0.1);
        assert_eq!(camera.position, DVec3::ZERO);
        assert!(settings.height.is_some_and(|height| height < 4.0));
        for _ in 0..1000 {
            camera.update(&mut settings, &FlyInput { pinch: 9.0, ..Default::default() }, 0.1);
        }
        assert_eq!(settings.height, Some(HEIGHTS.0));
        assert!(camera.camera(&settings, 1.5).lens.is_orthographic());
    }
}
