//! The terrain sample's scene: hills from a height map, and three vehicles on level ground.
//!
//! The light of the sample is at (128, 100, 0) and points at (128, 0, 128). Shadows fall on the ground, of
//! each vehicle on itself, and of the helicopter's rotor on the jeep.

mod heights;
mod helicopter;
mod jeep;
mod land;
mod palette;
mod parts;
mod tractor;
mod vehicles;

use glam::Vec3;
use shadowfit_scene::parts::Builder;
use shadowfit_scene::{Lens, Scene, Sun};

#[cfg(test)]
pub(crate) use heights::HeightMap;
#[cfg(test)]
pub(crate) use vehicles::PLACES;

/// Eye and target of the start view: over the tractor along the valley, with the jeep beside the inset at the
/// top left.
const VIEW: (Vec3, Vec3) = (Vec3::new(160.0, 30.0, 62.0), Vec3::new(139.0, 0.0, 130.0));
/// Lens of the start view.
const LENS: Lens = Lens::Perspective { fov_y: std::f32::consts::FRAC_PI_4, near: 1.0, far: Some(400.0) };
/// Position and target of the sample's light. The sun shines along its axis.
const LIGHT: (Vec3, Vec3) = (Vec3::new(128.0, 100.0, 0.0), Vec3::new(128.0, 0.0, 128.0));

/// Builds the scene.
pub(super) fn build() -> Scene {
    let mut builder = Builder::new("terrain", palette::Paint::all(), vec![land::image()]);
    land::build(&mut builder);
    let vehicles = vehicles::build(&mut builder);
    builder.view(VIEW.0, VIEW.1, LENS);
    let mut scene = builder.scene;
    scene.subject = Some(vehicles);
    scene.sun = Some(Sun { direction: (LIGHT.1 - LIGHT.0).normalize(), color: Vec3::ONE, intensity: 80_000.0 });
    scene
}
