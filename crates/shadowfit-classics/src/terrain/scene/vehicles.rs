//! The vehicles: their places, and the nodes of their meshes.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Quat, Vec3};
use shadowfit_scene::Transform;
use shadowfit_scene::parts::Builder;

use super::{helicopter, jeep, tractor};

/// Scale of the vehicles in the terrain's units.
const SIZE: f32 = 2.0;

/// Place of a vehicle.
pub(crate) struct Place {
    /// Name of its node.
    pub(crate) name: &'static str,
    /// Position on the level ground, in the terrain's units.
    pub(crate) at: Vec3,
    /// Rotation about the vertical, in radians.
    pub(crate) yaw: f32,
}

/// The places of tractor, helicopter and jeep.
pub(crate) const PLACES: [Place; 3] = [
    Place { name: "tractor", at: Vec3::new(150.0, 0.0, 100.0), yaw: 0.5 },
    Place { name: "helicopter", at: Vec3::new(120.0, 0.0, 140.0), yaw: -0.3 },
    Place { name: "jeep", at: Vec3::new(140.0, 0.0, 170.0), yaw: 0.3 },
];

/// Adds the vehicles and returns their parent node.
pub(super) fn build(builder: &mut Builder) -> usize {
    let all = builder.group("vehicles", Vec3::ZERO, 0.0);
    // Models face +z. Tractor and jeep are turned to the light. The helicopter is turned to +x and centred on
    // its place.
    let models = [
        (tractor::parts(), PI, Vec3::ZERO),
        (helicopter::parts(), FRAC_PI_2, Vec3::X * helicopter::MIDDLE),
        (jeep::parts(), PI, Vec3::ZERO),
    ];
    for (place, (parts, facing, at)) in PLACES.iter().zip(models) {
        let rest = Transform::new(place.at, Quat::from_rotation_y(place.yaw), Vec3::splat(SIZE));
        let vehicle = builder.node(place.name, Some(all), rest, None);
        let mesh = builder.mesh(place.name, parts.primitives());
        builder.place(vehicle, mesh, at, facing);
    }
    all
}
