//! Furniture of the gallery: an urn, pots, benches, and lanterns that swing.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::{Affine3A, Quat, Vec3};

use super::palette::Paint;
use super::plan::{HALF, arch_crowns, bay_middles};
use crate::parts::{
    Builder, CRISP, Card, Cards, Dice, GOLDEN_ANGLE, Limbs, SMOOTH, Solid, block, capsule, lathe, pillar, rotations,
    torus, turned,
};
use crate::{Channel, Primitive};

/// Period of the lanterns' swing, in seconds.
pub(super) const SWING_TIME: f32 = 9.0;
/// Keyframes of a lantern's swing.
const SWING_KEYS: usize = 72;

/// Adds the furniture. Returns the urn's node and the animation channels of the lanterns.
pub(super) fn build(builder: &mut Builder) -> (usize, Vec<Channel>) {
    let urn = urn(builder);
    let group = builder.group("furniture", Vec3::ZERO, 0.0);
    benches(builder, group);
    pots(builder, group);
    (urn, lanterns(builder, group))
}

/// Adds a marble urn with an agave, on a pedestal.
fn urn(builder: &mut Builder) -> usize {
    let foot = [(0.15, 0.0), (0.165, 0.015), (0.15, 0.04), (0.085, 0.07), (0.06, 0.11), (0.075, 0.135), (0.10, 0.145)];
    let belly = [(0.16, 0.17), (0.215, 0.22), (0.24, 0.28), (0.245, 0.32), (0.23, 0.36), (0.20, 0.40), (0.185, 0.46)];
    let rim = [(0.19, 0.54), (0.21, 0.60), (0.25, 0.65), (0.275, 0.668), (0.272, 0.685), (0.25, 0.688), (0.21, 0.66)];
    let inside = [(0.17, 0.58), (0.0, 0.57)];
    let vessel = lathe(&[&foot[..], &belly, &rim, &inside].concat(), 36);
    let handle = torus(0.085, 0.018, 0.018, 22, 10).posed(Quat::from_rotation_x(FRAC_PI_2), [0.225, 0.45, 0.0]);
    let vessel = vessel.with(handle.and_mirrored()).moved(Vec3::Y * 0.86);
    let pedestal = [
        (0.30, [-0.01, 0.12], 0.012),
        (0.26, [0.10, 0.17], 0.02),
        (0.21, [0.15, 0.76], 0.008),
        (0.25, [0.74, 0.80], 0.018),
        (0.28, [0.79, 0.87], 0.012),
    ];
    let pedestal: Solid = pedestal.into_iter().map(|(half, ends, edge)| pillar([half; 2], ends, edge)).collect();
    let primitives = vec![
        vessel.primitive(Paint::Marble.into(), 0.75),
        pedestal.primitive(Paint::Stone.into(), CRISP),
        agave(Vec3::Y * 1.44, 1.0),
    ];
    let mesh = builder.mesh("urn", primitives);
    builder.node("urn", None, turned([-1.0, 0.0, -2.3], 0.5), Some(mesh))
}

/// Builds a rosette of thick pointed leaves that grows from `at`.
fn agave(at: Vec3, size: f32) -> Primitive {
    let mut dice = Dice::new(40);
    let mut limbs = Limbs::default();
    for index in 0..17 {
        let turn = index as f32 * GOLDEN_ANGLE;
        let steep = 0.35 + 0.065 * index as f32;
        let out = Vec3::new(turn.sin(), 0.0, turn.cos());
        let length = size * dice.between(0.42, 0.52);
        let path: Vec<Vec3> = (0..=4)
            .map(|step| {
                let t = step as f32 / 4.0;
                let bend = steep + 0.5 * (1.0 - t) - 0.35 * t;
                at + (out * bend.cos() + Vec3::Y * bend.sin()) * length * t
            })
            .collect();
        limbs.add(&path, 6, |turn, t| {
            let flat = 1.0 - 0.6 * turn.sin().powi(2);
            size * 0.042 * flat * (0.55 + 1.5 * t * (1.0 - t)) * (1.0 - 0.93 * t * t)
        });
    }
    limbs.primitive(Paint::Agave)
}

/// Adds stone benches along the rear wall.
fn benches(builder: &mut Builder, group: usize) {
    let seat = pillar([0.22, 0.85], [0.42, 0.50], 0.015);
    let leg = |z: f32| block([-0.16, -0.01, z - 0.07], [0.16, 0.43, z + 0.07], 0.012);
    let bench = seat.with(leg(-0.55)).with(leg(0.55));
    let bench = builder.solid("bench", &bench, Paint::Stone, CRISP);
    for z in bay_middles().skip(5).step_by(2) {
        builder.place(group, bench, [-HALF + 0.30, 0.0, z], 0.0);
    }
}

/// Adds clay pots with shrubs, between the benches and by the columns.
fn pots(builder: &mut Builder, group: usize) {
    #[rustfmt::skip]
    let profile = [
        (0.16, -0.005), (0.175, 0.01), (0.20, 0.12), (0.235, 0.30), (0.25, 0.36), (0.275, 0.365), (0.28, 0.43),
        (0.265, 0.44), (0.235, 0.43), (0.22, 0.38), (0.0, 0.37),
    ];
    let pot = lathe(&profile, 20).primitive(Paint::Terracotta.into(), CRISP);
    let mut wood = Limbs::default();
    wood.add(&[Vec3::Y * 0.35, Vec3::new(0.02, 0.7, 0.01), Vec3::new(-0.01, 0.95, 0.0)], 8, |_, t| 0.02 - 0.008 * t);
    let mut leaves = Cards::new(Paint::Blossom, 2);
    let mut dice = Dice::new(44);
    for index in 0..46 {
        let turn = index as f32 * GOLDEN_ANGLE;
        let height = 1.0 - 2.0 * (index as f32 + 0.5) / 46.0;
        let flat = (1.0 - height * height).sqrt();
        let out = Vec3::new(turn.sin() * flat, height, turn.cos() * flat);
        let across = Quat::from_axis_angle(out, dice.between(-1.5, 1.5)) * out.any_orthonormal_vector();
        let size = dice.between(0.24, 0.34);
        let base = Vec3::Y * 1.08 + out * 0.12;
        let droop = Vec3::Y * -0.08 * size;
        leaves.add(&Card { base, reach: out * size, half: across * 0.45 * size, droop }, out, 0.6);
    }
    let shrub = builder.mesh("potted shrub", vec![pot.clone(), wood.primitive(Paint::Timber), leaves.primitive]);
    let succulent = builder.mesh("potted agave", vec![pot, agave(Vec3::Y * 0.36, 1.15)]);
    for (index, z) in bay_middles().skip(3).step_by(2).enumerate() {
        let mesh = if index % 2 == 0 { shrub } else { succulent };
        let size = 1.0 + 0.12 * (index % 3) as f32;
        builder.place_sized(group, mesh, [-HALF + 0.42, 0.0, z - 0.3], [size; 3], index as f32);
    }
}

/// Adds iron lanterns on chains, in the crowns of arches. Returns their animation channels.
fn lanterns(builder: &mut Builder, group: usize) -> Vec<Channel> {
    let glass = lathe(&[(0.05, -0.98), (0.075, -0.93), (0.075, -0.76), (0.05, -0.72)], 16);
    let lantern = builder.solids("lantern", [(ironwork(), Paint::Iron, SMOOTH), (glass, Paint::Glass, CRISP)]);
    arch_crowns()
        .enumerate()
        .map(|(index, crown)| {
            let node = builder.place(group, lantern, crown + Vec3::Y * 0.02, 0.0);
            let late = index as f32 * 0.9;
            // Two swings at right angles with different periods, like a pendulum in a draught.
            rotations(node, SWING_TIME, SWING_KEYS, |phase| {
                let across = 0.17 * (5.0 * phase + late).sin() + 0.05 * (2.0 * phase).sin();
                let along = 0.10 * (4.0 * phase + 1.7 * late).sin();
                Quat::from_rotation_z(across) * Quat::from_rotation_x(along)
            })
        })
        .collect()
}

/// Builds chain, frame and roof of a lantern that hangs from the origin.
fn ironwork() -> Solid {
    let link = |link: u8| {
        let turn = Quat::from_rotation_y(FRAC_PI_2 * f32::from(link % 2)) * Quat::from_rotation_x(FRAC_PI_2);
        let stretch = Affine3A::from_scale(Vec3::new(1.0, 1.5, 1.0));
        let at = Affine3A::from_translation(Vec3::Y * (-0.03 - 0.062 * f32::from(link)));
        torus(0.024, 0.006, 0.006, 9, 5).transformed(at * stretch * Affine3A::from_quat(turn))
    };
    let roof = [(0.16, -0.70), (0.165, -0.685), (0.12, -0.62), (0.05, -0.56), (0.03, -0.53), (0.0, -0.50)];
    let floor = [(0.10, -1.05), (0.125, -1.03), (0.12, -1.0), (0.0, -0.99)];
    let bar = |bar: u8| {
        let turn = f32::from(bar) / 6.0 * TAU;
        let out = Vec3::new(turn.sin(), 0.0, turn.cos());
        capsule(out * 0.11 - Vec3::Y * 1.02, 0.008, out * 0.145 - Vec3::Y * 0.68, 0.008, 5)
    };
    let hoop = torus(0.128, 0.007, 0.007, 18, 5).moved(Vec3::Y * -0.86);
    (0..8).map(link).chain([lathe(&roof, 6), lathe(&floor, 6)]).chain((0..6).map(bar)).chain([hoop]).collect()
}
