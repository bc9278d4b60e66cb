//! The forest: thin trunks and cut-out leaves over a floor of dappled light.
//!
//! Trunks of 0.1 to 0.5 m are a few texels wide in a far map. Branches and leaves are narrower than a texel.
//! Bark faces the sun at every angle. The subject is an old stump by the path. In animation 0, "wind", boughs
//! near the start view sway, and their shadows move with them.

mod floor;
mod palette;
mod textures;
mod trees;
mod undergrowth;

use glam::Vec3;

use crate::Scene;
use crate::parts::{Builder, looped, sunlight};

/// Direction of the sun from +z toward +x, in radians: ahead of the start view and to its left, so that the
/// shadows of trunks point toward the eye.
const SUN_AZIMUTH: f32 = -1.82;
/// Height of the sun above the horizon, in radians: high enough for light to reach the floor between the crowns.
const SUN_ELEVATION: f32 = 0.72;
/// Vertical field of view of the start view, in radians.
const FOV_Y: f32 = 0.82;
/// Far plane of the start view, in metres: beyond the last trees, near enough for haze between them.
const FAR: f32 = 90.0;

/// Builds the scene.
pub(super) fn build() -> Scene {
    let mut builder = Builder::new("forest", palette::Paint::all(), textures::Picture::all());
    let stump = floor::build(&mut builder);
    let sway = trees::build(&mut builder);
    undergrowth::build(&mut builder);
    builder.start_view(Vec3::new(-0.7, 1.55, 4.6), Vec3::new(0.15, 1.95, -4.0), FOV_Y, FAR);
    let sun = Some(sunlight(SUN_AZIMUTH, SUN_ELEVATION));
    Scene { subject: Some(stump), animations: vec![looped("wind", trees::WIND_TIME, sway)], sun, ..builder.scene }
}
