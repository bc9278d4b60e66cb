//! The street: a road with a kerb, a pavement and a wall on its right, two cars and two lamp posts, for a
//! headlight.
//!
//! Strip, places and sizes are from a classic sample of shadow maps for a lamp with perspective. The models
//! are our own. Lengths are in the sample's units: a car is about 13 long. There is no ground beyond the
//! strip, so one of the cars hovers beside it.

mod atlas;
mod body;
mod cabin;
mod car;
mod lamp_post;
mod palette;
mod panel;
mod strip;
mod wheel;

use std::f32::consts::{FRAC_PI_4, PI};

use glam::{Quat, Vec3};
use shadowfit_scene::parts::{Builder, sunlight};
use shadowfit_scene::{Lens, Scene, Transform};

/// Direction of the sun from +z toward +x, in radians: from the road's open side, so that objects on the
/// pavement cast shadows on the wall.
const SUN_AZIMUTH: f32 = -0.9;
/// Height of the sun above the horizon, in radians.
const SUN_ELEVATION: f32 = 0.62;

/// Positions of the cars, and their turn about y in radians. At 0 a car faces +z. The first car drives ahead
/// on the right of the road, and the second faces the direction of the sample's headlight.
const CARS: [(Vec3, f32); 2] = [(Vec3::new(-3.0, 0.0, -15.0), PI), (Vec3::new(-28.0, 0.0, -1.9), 5.0 / 8.0 * PI)];
/// Scale of the cars.
const CAR_SCALE: f32 = 4.0;
/// Positions of the lamp posts on the pavement.
const LAMP_POSTS: [Vec3; 2] = [Vec3::new(4.0, 1.0, -35.0), Vec3::new(4.0, 1.0, -5.0)];
/// Scale of the lamp posts.
const LAMP_POST_SCALE: f32 = 0.05;

/// Eye and target of the start view.
const VIEW: (Vec3, Vec3) = (Vec3::new(-25.0, 13.0, 18.0), Vec3::new(0.0, 2.0, -12.0));

/// Builds the scene.
pub(super) fn build() -> Scene {
    let mut builder = Builder::new("street", palette::Paint::all(), vec![atlas::image()]);
    let strip = builder.mesh("strip", vec![strip::primitive()]);
    builder.node("strip", None, Transform::default(), Some(strip));
    let car = builder.mesh("car", car::primitives());
    for (at, turn) in CARS {
        builder.node("car", None, placed(at, turn, CAR_SCALE), Some(car));
    }
    let lamp_post = builder.mesh("lamp post", vec![lamp_post::primitive()]);
    for at in LAMP_POSTS {
        builder.node("lamp post", None, placed(at, 0.0, LAMP_POST_SCALE), Some(lamp_post));
    }
    builder.start_view(VIEW.0, VIEW.1, FRAC_PI_4, 200.0);
    let mut scene = builder.scene;
    scene.cameras[0].lens = Lens::Perspective { fov_y: FRAC_PI_4, near: 1.0, far: Some(200.0) };
    scene.sun = Some(sunlight(SUN_AZIMUTH, SUN_ELEVATION));
    scene
}

/// Returns a transform with a turn about y in radians and a scale.
fn placed(translation: Vec3, turn: f32, scale: f32) -> Transform {
    Transform::new(translation, Quat::from_rotation_y(turn), Vec3::splat(scale))
}
