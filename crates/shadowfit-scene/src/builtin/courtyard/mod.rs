//! The courtyard: a figure in the sun, among columns, posts and arches.
//!
//! It contains typical difficulties of shadow maps: a face that shadows itself, thin posts and a tall pole,
//! columns under an overhanging roof, a lattice with holes, and a floor of 120 m with a metre grid for
//! reading distances.

mod architecture;
mod garden;
mod palette;
mod textures;

use glam::Vec3;

use crate::Scene;
use crate::parts::{Builder, sunlight, wanderer};

/// Direction of the sun from +z toward +x, in radians.
const SUN_AZIMUTH: f32 = 0.6;
/// Height of the sun above the horizon, in radians: shadows are about as long as objects are tall.
const SUN_ELEVATION: f32 = 0.75;
/// Vertical field of view of the start view, in radians (45°).
const FOV_Y: f32 = 0.785;
/// Far plane of the start view, in metres: beyond the far corners of the floor.
const FAR: f32 = 200.0;

/// Builds the scene that [`super::default_scene`] describes.
pub(super) fn build() -> Scene {
    let mut builder = Builder::new("courtyard", palette::materials(), textures::Picture::all());
    let (figure, animations) = wanderer(&mut builder, palette::worn);
    architecture::build(&mut builder);
    garden::build(&mut builder);
    let (eye, target) = start_view();
    builder.start_view(eye, target, FOV_Y, FAR);
    let sun = Some(sunlight(SUN_AZIMUTH, SUN_ELEVATION));
    Scene { subject: Some(figure), animations, sun, ..builder.scene }
}

/// Returns eye and target of the start view, world positions in metres.
pub(super) fn start_view() -> (Vec3, Vec3) {
    (Vec3::new(-2.1, 1.6, 4.5), Vec3::new(1.3, 1.3, -1.0))
}
