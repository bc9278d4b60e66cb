//! The plain: stones in the foreground, a mill below, a far tower, under a low sun.
//!
//! One view contains blades of grass and hills a kilometre away, so a single map is either too coarse in
//! front or too short behind. The tower's shadow falls 90 m across the fields toward the view. In animation
//! 0, "turn", the sails of the mill turn, and their shadow sweeps over the slope.

mod far;
mod land;
mod mill;
mod near;
mod palette;
mod textures;
mod tower;
mod tree;

use glam::Vec3;

use crate::Scene;
use crate::parts::{Builder, looped, sunlight};
use land::on_land;

/// Direction of the sun from +z toward +x, in radians: ahead of the start view and to its left, just out of
/// sight.
const SUN_AZIMUTH: f32 = -2.44;
/// Height of the sun above the horizon, in radians: shadows are two and a half times as long as objects are
/// tall.
const SUN_ELEVATION: f32 = 0.375;
/// Vertical field of view of the start view, in radians.
const FOV_Y: f32 = 0.785;
/// Far plane of the start view, in metres: the corners of the land.
const FAR: f32 = 1500.0;
/// Height of the eye, in metres.
const EYE: f32 = 1.65;

/// Builds the scene.
pub(super) fn build() -> Scene {
    let mut builder = Builder::new("plain", palette::Paint::all(), textures::Picture::all());
    land::build(&mut builder);
    let hut = near::build(&mut builder);
    let sails = mill::build(&mut builder);
    tower::build(&mut builder);
    far::build(&mut builder);
    let eye = on_land(0.2, 2.5) + Vec3::Y * EYE;
    builder.start_view(eye, eye + Vec3::new(-0.05, -0.115, -1.0), FOV_Y, FAR);
    let animations = vec![looped("turn", mill::TURN_TIME, vec![sails])];
    let sun = Some(sunlight(SUN_AZIMUTH, SUN_ELEVATION));
    Scene { subject: Some(hut), animations, sun, ..builder.scene }
}
