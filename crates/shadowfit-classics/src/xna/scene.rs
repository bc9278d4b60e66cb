//! The shadow mapping sample's scene: a figure on a grid floor under a sun from its right.
//!
//! In the sample's units a person is about 70 tall. Only the figure casts. Figure and floor receive.

use glam::{Quat, Vec3};
use shadowfit_scene::parts::{Builder, figure_at_ease, looped, rotations};
use shadowfit_scene::{Lens, Scene, Sun};

use super::floor;

/// Scale of the figure, in the sample's units per metre: the largest at which its head fits into the sample's
/// picture, whose upper edge is 63 units above the origin.
const UNITS_PER_METRE: f32 = 35.4;
/// Initial eye of the sample's camera.
const EYE: Vec3 = Vec3::new(0.0, 70.0, 100.0);
/// Direction of view: two forward, one down.
const FORWARD: Vec3 = Vec3::new(0.0, -0.447_213_6, -0.894_427_2);
/// Lens of the sample's camera.
const LENS: Lens = Lens::Perspective { fov_y: std::f32::consts::FRAC_PI_4, near: 1.0, far: Some(1000.0) };
/// Direction toward the light.
const TO_LIGHT: Vec3 = Vec3::new(-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0);

/// Time of a whole turn of the figure, in seconds: 200° a second, like the sample's controls.
const TURN: f32 = 1.8;
/// Keyframes of a turn.
const TURN_KEYS: usize = 12;

/// Builds the scene. Its animation turns the figure once.
pub(super) fn build() -> Scene {
    let mut builder = Builder::new("shadow-mapping", vec![floor::material()], vec![floor::image()]);
    floor::build(&mut builder);
    let root = figure_at_ease(&mut builder);
    builder.scene.nodes[root].rest.scale = Vec3::splat(UNITS_PER_METRE).as_dvec3();
    builder.view(EYE, EYE + FORWARD, LENS);
    let mut scene = builder.scene;
    let turn = rotations(root, TURN, TURN_KEYS, Quat::from_rotation_y);
    scene.animations.push(looped("turn", TURN, vec![turn]));
    scene.subject = Some(root);
    scene.sun = Some(Sun { direction: -TO_LIGHT.normalize(), color: Vec3::ONE, intensity: 80_000.0 });
    scene
}
