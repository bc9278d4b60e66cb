//! The still life: stone shapes and large chess pieces on a wooden floor in front of a wall, for a lamp at a
//! position.
//!
//! It has surfaces at all angles to the light: flutes, a ring, a ball, a vase that is open at the top, and
//! faces in grazing light. All casters are closed and extend a centimetre into the object below them.

mod chess;
mod knight;
mod palette;
mod room;
mod stones;
mod textures;

use std::f32::consts::FRAC_PI_4;

use glam::Vec3;
use shadowfit_scene::Scene;
use shadowfit_scene::parts::{Builder, sunlight};

/// Depth of objects inside the object below them, in metres.
const SUNK: f32 = 0.01;

/// Direction of the sun from +z toward +x and its height above the horizon, in radians: roughly the lamp's.
const SUN: (f32, f32) = (-0.90, 0.67);
/// Eye and target of the start view, in metres.
const VIEW: (Vec3, Vec3) = (Vec3::new(1.3, 3.5, 8.9), Vec3::new(0.1, 1.2, -0.9));
/// Far plane of the start view, in metres: beyond the wall.
const FAR: f32 = 40.0;

/// Builds the scene.
pub(super) fn build() -> Scene {
    let mut builder = Builder::new("still-life", palette::Paint::all(), textures::Picture::all());
    let group = builder.group("still life", Vec3::ZERO, 0.0);
    room::build(&mut builder, group);
    stones::build(&mut builder, group);
    chess::build(&mut builder, group);
    builder.start_view(VIEW.0, VIEW.1, FRAC_PI_4, FAR);
    let mut scene = builder.scene;
    scene.sun = Some(sunlight(SUN.0, SUN.1));
    scene
}

/// Returns position and target of the lamp, world positions in metres. It shines from the front left, 39°
/// downwards. A light image of 60° each way, with near 4 and far 20, contains all objects. An image of 75°
/// also contains most of the floor.
pub(crate) fn lamp() -> (Vec3, Vec3) {
    (Vec3::new(-7.2, 7.6, 4.2), Vec3::new(-0.6, 0.9, -1.0))
}
