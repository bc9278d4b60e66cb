//! The knight of the chess pieces: a horse's head that faces +z, on a turned foot.

use glam::{Affine3A, Quat, Vec3};
use shadowfit_scene::parts::{Solid, Stop, capsule, ellipsoid, lathe, smooth, sweep};

/// Builds the whole piece. `foot` is the profile of its turned foot: radii and heights, upwards.
pub(super) fn solid(foot: &[(f32, f32)]) -> Solid {
    let stand = lathe(&[foot, &[(0.15, 0.20), (0.155, 0.215), (0.14, 0.235)]].concat(), 36);
    stand.with(neck_and_head()).with(mane()).with(sides().and_mirrored())
}

/// Returns a stop of the head with its width across x: height and z of its middle, half width and half depth.
fn section(y: f32, z: f32, wide: f32, deep: f32) -> Stop {
    Stop { at: Vec3::new(0.0, y, z), half: [wide, deep] }
}

/// Builds the part from the chest over the crest to the muzzle.
fn neck_and_head() -> Solid {
    let stops = [
        section(0.18, 0.0, 0.10, 0.12),
        section(0.20, 0.0, 0.115, 0.14),
        section(0.30, -0.005, 0.112, 0.155),
        section(0.45, -0.03, 0.100, 0.15),
        section(0.60, -0.055, 0.090, 0.135),
        section(0.74, -0.055, 0.082, 0.125),
        section(0.845, 0.0, 0.080, 0.118),
        section(0.865, 0.085, 0.082, 0.112),
        section(0.815, 0.175, 0.074, 0.094),
        section(0.745, 0.255, 0.060, 0.072),
        section(0.69, 0.315, 0.055, 0.064),
        section(0.655, 0.352, 0.046, 0.052),
        section(0.645, 0.365, 0.020, 0.022),
    ];
    sweep(&smooth(&stops, 4), Vec3::X, 28)
}

/// Builds the mane: a ridge along the back of the neck.
fn mane() -> Solid {
    let stops = [
        section(0.27, -0.13, 0.02, 0.02),
        section(0.30, -0.15, 0.030, 0.035),
        section(0.45, -0.175, 0.034, 0.045),
        section(0.60, -0.185, 0.034, 0.05),
        section(0.74, -0.175, 0.034, 0.05),
        section(0.86, -0.115, 0.034, 0.048),
        section(0.945, -0.02, 0.030, 0.038),
        section(0.965, 0.05, 0.022, 0.022),
        section(0.965, 0.07, 0.010, 0.010),
    ];
    sweep(&smooth(&stops, 3), Vec3::X, 12)
}

/// Builds the details on the +x side of the head: an ear, an eye, a nostril, the edge of the jaw.
fn sides() -> Solid {
    let ear = lathe(&[(0.012, 0.0), (0.034, 0.03), (0.036, 0.06), (0.026, 0.10), (0.0, 0.15)], 14)
        .transformed(Affine3A::from_scale(Vec3::new(1.0, 1.0, 0.7)))
        .transformed(Affine3A::from_rotation_translation(
            Quat::from_euler(glam::EulerRot::XYZ, -0.15, 0.0, -0.22),
            Vec3::new(0.042, 0.925, 0.015),
        ));
    let eye = ellipsoid([0.014, 0.019, 0.024], 12, 8).moved([0.077, 0.855, 0.135]);
    let brow = capsule([0.070, 0.895, 0.10], 0.014, [0.066, 0.872, 0.17], 0.010, 10);
    let nostril = ellipsoid([0.012, 0.016, 0.020], 12, 8).moved([0.046, 0.69, 0.335]);
    let jaw = ellipsoid([0.03, 0.062, 0.062], 16, 10).moved([0.058, 0.785, 0.06]);
    ear.with(eye).with(brow).with(nostril).with(jaw)
}
