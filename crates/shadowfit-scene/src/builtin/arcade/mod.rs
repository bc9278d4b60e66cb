//! The arcade: a vaulted gallery seen from inside, with sunlight that falls between its columns.
//!
//! Most casters are outside the picture: the vault, the roof, and the columns behind the eye. Light leaks
//! show in the dark where walls, vault and floor meet. Vessels, benches and columns cast contact shadows. In
//! animation 0, "swing", the lanterns in the arches swing, and their shadows move with them.

mod columns;
mod furniture;
mod garden;
mod palette;
mod plan;
mod shell;
mod textures;

use glam::Vec3;

use crate::Scene;
use crate::parts::{Builder, looped, sunlight};

/// Direction of the sun from +z toward +x, in radians. The sun shines from the garden, ahead of the start
/// view, so that the patches of light point toward the eye.
const SUN_AZIMUTH: f32 = 2.30;
/// Height of the sun above the horizon, in radians: low enough for the light of the arches' crowns to reach
/// the rear wall.
const SUN_ELEVATION: f32 = 0.37;
/// Vertical field of view of the start view, in radians.
const FOV_Y: f32 = 0.87;
/// Far plane of the start view, in metres: beyond the trees of the garden.
const FAR: f32 = 100.0;

/// Builds the scene.
pub(super) fn build() -> Scene {
    let mut builder = Builder::new("arcade", palette::Paint::all(), textures::Picture::all());
    shell::build(&mut builder);
    columns::build(&mut builder);
    garden::build(&mut builder);
    let (urn, swing) = furniture::build(&mut builder);
    builder.start_view(Vec3::new(0.28, 1.6, 4.3), Vec3::new(-0.2, 1.68, -4.0), FOV_Y, FAR);
    let sun = Some(sunlight(SUN_AZIMUTH, SUN_ELEVATION));
    Scene { subject: Some(urn), animations: vec![looped("swing", furniture::SWING_TIME, swing)], sun, ..builder.scene }
}
