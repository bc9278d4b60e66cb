//! The arcade: a vaulted gallery seen from inside, with sunlight that falls between its columns.
//!
//! What casts is mostly out of the picture: vault, roof, and the columns behind the eye. Light leaks show where walls,
//! vault and floor meet in the dark, and vessels, benches and columns stand in contact shadows. In animation 0,
//! "swing", the lanterns that hang in the arches swing, and with them their shadows.

mod columns;
mod furniture;
mod garden;
mod palette;
mod shell;
mod textures;

use glam::Vec3;

use super::build::{Builder, sunlight};
use super::motion::looped;
use crate::Scene;

/// Length of a bay, from column to column, in metres.
const BAY: f32 = 3.4;
/// Bays of the gallery.
const BAYS: usize = 12;
/// Where the gallery begins along z, in metres: behind the start view. It goes on toward -z.
const START: f32 = 10.2;
/// Where it ends, in metres.
const END: f32 = START - BAY * BAYS as f32;
/// Half of the gallery's width between its walls, in metres.
const HALF: f32 = 2.1;
/// Thickness of the wall above the columns, in metres: one that a bias of a decimetre does not pass.
const THICK: f32 = 0.6;
/// Where the row of columns stands along x, in metres.
const ROW: f32 = HALF + THICK / 2.0;
/// Height at which arches spring from the columns, in metres.
const SPRING: f32 = 2.5;
/// Height of the garden, below the gallery's floor at 0, in metres.
const GARDEN: f32 = -0.3;

/// Direction of the sun from +z toward +x, in radians: from the garden, ahead of the start view, so that the patches of
/// light come toward the eye.
const SUN_AZIMUTH: f32 = 2.30;
/// Height of the sun above the horizon, in radians: low enough for the crowns of the arches to climb the rear wall.
const SUN_ELEVATION: f32 = 0.37;
/// Vertical field of view of the start view, in radians.
const FOV_Y: f32 = 0.87;
/// Far plane of the start view, in metres: beyond the trees of the garden.
const FAR: f32 = 100.0;
/// Time in which the lanterns swing once through their whole pattern, in seconds.
const SWING_TIME: f32 = 9.0;

/// The scene.
pub(super) fn build() -> Scene {
    let mut builder = Builder::new("arcade", palette::materials(), textures::images());
    shell::build(&mut builder);
    columns::build(&mut builder);
    garden::build(&mut builder);
    let furniture = furniture::build(&mut builder);
    builder.start_view((Vec3::new(0.28, 1.6, 4.3), Vec3::new(-0.2, 1.68, -4.0)), FOV_Y, FAR);
    let mut scene = builder.scene;
    scene.subject = Some(furniture.urn);
    scene.animations = vec![looped("swing", SWING_TIME, furniture.swing)];
    scene.sun = Some(sunlight(SUN_AZIMUTH, SUN_ELEVATION));
    scene
}

/// Where the columns stand along z, those at the ends included, from the start on.
fn column_places() -> impl Iterator<Item = f32> {
    (0..=BAYS).map(|index| START - BAY * index as f32)
}

/// Where the middles of the bays are along z, from the start on.
fn bay_middles() -> impl Iterator<Item = f32> {
    (0..BAYS).map(|index| START - BAY * (index as f32 + 0.5))
}
