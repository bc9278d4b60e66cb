//! The town: a street and a square seen by a pedestrian, with gabled houses, a church tower and a clock tower.
//!
//! The towers cast shadows of 40 to 55 m over square, street and roofs. Railings, balconies and chains cast thin ones,
//! sills and steps contact shadows. The street recedes 220 m ahead of the start view. In animation 0, "sway", the shop
//! signs swing and the church's weather vane turns.

mod body;
mod church;
mod dress;
mod far;
mod front;
mod ground;
mod hall;
mod house;
mod kit;
mod market;
mod palette;
mod plan;
mod roof;
mod rows;
mod street;
mod textures;
mod timber;
mod trees;

use glam::Vec3;

use crate::Scene;
use crate::parts::{Builder, looped, sunlight};

/// Direction of the sun from +z toward +x, in radians: behind the start view and to its left, so that shadows cross the
/// street and the fronts ahead are lit.
const SUN_AZIMUTH: f32 = -0.82;
/// Height of the sun above the horizon, in radians: shadows are one and a half times as long as casters are tall.
const SUN_ELEVATION: f32 = 0.6;
/// Vertical field of view of the start view, in radians: the church's spire and the cobbles at the feet.
const FOV_Y: f32 = 0.88;
/// Far plane of the start view, in metres: beyond the hills at the street's end.
const FAR: f32 = 380.0;
/// Eye of the start view, in metres: in the southern street, before the square.
const EYE: Vec3 = Vec3::new(2.6, 1.6, 23.0);
/// Target of the start view, in metres.
const TARGET: Vec3 = Vec3::new(-2.4, 3.6, -4.0);
/// Time in which signs and vane move once through their whole pattern, in seconds.
const SWAY_TIME: f32 = 9.0;
/// Keyframes of that pattern.
const SWAY_KEYS: usize = 72;

/// Builds the scene.
pub(super) fn build() -> Scene {
    let mut builder = Builder::new("town", palette::Paint::all(), textures::Picture::all());
    ground::build(&mut builder);
    let fountain = market::build(&mut builder);
    let mut sway = rows::build(&mut builder);
    sway.push(church::build(&mut builder));
    hall::build(&mut builder);
    far::build(&mut builder);
    street::build(&mut builder);
    trees::build(&mut builder);
    builder.start_view(EYE, TARGET, FOV_Y, FAR);
    let sun = Some(sunlight(SUN_AZIMUTH, SUN_ELEVATION));
    Scene { subject: Some(fountain), animations: vec![looped("sway", SWAY_TIME, sway)], sun, ..builder.scene }
}
