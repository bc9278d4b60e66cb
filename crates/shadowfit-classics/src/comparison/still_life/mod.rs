//! The still life: stone shapes and large chess pieces on a wooden floor before a wall, made for a lamp at a position.
//!
//! It has surfaces at all angles to the light: flutes, a ring, a ball, a vase that is open at the top, and faces that
//! the light grazes. All that casts is closed and reaches a centimetre into what it stands on.

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

/// How deep things reach into what they stand on, in metres.
const SUNK: f32 = 0.01;

/// Direction of the sun from +z toward +x, in radians, and its height above the horizon: those of the lamp, about.
const SUN: (f32, f32) = (-0.90, 0.67);
/// Eye and target of the start view, in metres.
const VIEW: (Vec3, Vec3) = (Vec3::new(1.3, 3.5, 8.9), Vec3::new(0.1, 1.2, -0.9));
/// Far plane of the start view, in metres: beyond the wall.
const FAR: f32 = 40.0;

/// The scene.
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

/// Position and target of the lamp, world positions in metres: it shines from the left and from the front, 39° downwards. A
/// light image of 60° each way holds everything that stands there, with near 4 and far 20 too; one of 75° holds most of the
/// floor besides.
pub(crate) fn lamp() -> (Vec3, Vec3) {
    (Vec3::new(-7.2, 7.6, 4.2), Vec3::new(-0.6, 0.9, -1.0))
}
