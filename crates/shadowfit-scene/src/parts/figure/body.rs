//! Meshes of the wanderer below the head: clothes, limbs, hands, boots, scarf.
//!
//! Each part is rigid and modelled in the axes of its joint. Neighbours overlap with rounded ends, like the
//! parts of a wooden artist's figure, so that no gap opens when a joint bends.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::{Affine3A, Quat, Vec3};

use super::rig::{ANKLE, Joint, TOE};
use super::wear::{Part, Wear};
use crate::Primitive;
use crate::parts::build::{CRISP, SMOOTH};
use crate::parts::shapes::{Section, capsule, ellipsoid, limb, loft, rounded_box, section, torus, tube};
use crate::parts::solid::Solid;

/// Builds all meshes below the head.
pub(super) fn meshes() -> Vec<Part> {
    vec![
        (&[Joint::Hips], "hips", hips()),
        (&[Joint::Chest], "chest", chest()),
        (&[Joint::Neck], "neck", vec![smooth(&neck(), Wear::Skin)]),
        (&[Joint::TailA, Joint::TailB, Joint::TailC], "scarf end", vec![smooth(&scarf_end(), Wear::Scarf)]),
        (&[Joint::ArmL, Joint::ArmR], "upper arm", vec![smooth(&upper_arm(), Wear::Jacket)]),
        (&[Joint::ForearmL, Joint::ForearmR], "forearm", forearm()),
        (&[Joint::HandL], "left hand", vec![smooth(&hand(), Wear::Skin)]),
        (&[Joint::HandR], "right hand", vec![smooth(&hand().mirrored(), Wear::Skin)]),
        (&[Joint::ThighL, Joint::ThighR], "thigh", vec![smooth(&thigh(), Wear::Trousers)]),
        (&[Joint::ShinL, Joint::ShinR], "shin", shin()),
        (&[Joint::FootL, Joint::FootR], "foot", foot()),
        (&[Joint::ToeL, Joint::ToeR], "toes", toes()),
    ]
}

/// Converts a rounded solid to a primitive of one colour.
fn smooth(solid: &Solid, paint: Wear) -> Primitive {
    solid.primitive(paint.into(), SMOOTH)
}

/// Builds an elliptical ring about y at `height`: a hem, belt or cuff.
fn band(height: f32, rx: f32, rz: f32, thick: f32, tall: f32) -> Solid {
    let scale = Affine3A::from_scale(Vec3::new(rx, 1.0, rz));
    let ring = torus(1.0, thick / rx.min(rz), tall, 28, 6);
    ring.transformed(scale).moved(Vec3::Y * height)
}

/// Builds the trousers' seat, the jacket's skirt, the belt and its pouch.
fn hips() -> Vec<Primitive> {
    let seat =
        [section(-0.10, 0.115, 0.085, 0.0), section(-0.03, 0.158, 0.108, -0.004), section(0.06, 0.148, 0.1, 0.0)];
    let skirt = [
        section(-0.085, 0.187, 0.142, 0.0),
        section(-0.045, 0.181, 0.133, 0.0),
        section(0.0, 0.171, 0.119, 0.0),
        section(0.06, 0.153, 0.107, 0.0),
        section(0.12, 0.146, 0.101, 0.0),
        section(0.20, 0.146, 0.101, 0.0),
    ];
    let buckle = rounded_box([0.026, 0.021, 0.008], 0.005, 1).moved([0.0, 0.075, 0.116]);
    let pouch = rounded_box([0.042, 0.036, 0.021], 0.010, 1)
        .with(rounded_box([0.044, 0.016, 0.009], 0.006, 1).moved([0.0, 0.022, 0.015]));
    let pouch = pouch
        .transformed(Affine3A::from_rotation_translation(Quat::from_rotation_y(0.55), Vec3::new(0.096, 0.026, 0.117)));
    let skirt = loft(&skirt, 2.3, 3, 40).with(band(-0.087, 0.182, 0.137, 0.011, 0.012));
    vec![
        smooth(&loft(&seat, 2.3, 3, 32), Wear::Trousers),
        smooth(&skirt, Wear::Jacket),
        smooth(&band(0.075, 0.147, 0.101, 0.011, 0.022).with(pouch), Wear::Leather),
        smooth(&buckle, Wear::Bronze),
    ]
}

/// Builds the jacket from the waist to the collar, with buttons, and the scarf around the neck.
fn chest() -> Vec<Primitive> {
    let jacket = [
        section(-0.15, 0.144, 0.099, 0.0),
        section(-0.07, 0.152, 0.105, 0.002),
        section(0.02, 0.172, 0.117, 0.006),
        section(0.10, 0.184, 0.119, 0.004),
        section(0.145, 0.178, 0.106, -0.002),
        section(0.186, 0.140, 0.084, -0.006),
        section(0.222, 0.07, 0.065, -0.006),
    ];
    let button = |y: f32, z: f32| ellipsoid([0.012, 0.012, 0.006], 14, 6).moved([0.0, y, z]);
    let buttons = button(-0.10, 0.104).with(button(-0.025, 0.114)).with(button(0.05, 0.124));
    let wrap = |radius: f32, y: f32, z: f32, pitch: f32, roll: f32| {
        let turn = Quat::from_rotation_x(pitch) * Quat::from_rotation_z(roll);
        let transform = Affine3A::from_rotation_translation(turn, Vec3::new(0.0, y, z));
        torus(radius, 0.036, 0.034, 32, 10).transformed(transform)
    };
    let knot = ellipsoid([0.036, 0.042, 0.03], 20, 12).moved([0.062, 0.20, -0.085]);
    let scarf = wrap(0.084, 0.205, 0.004, 0.24, 0.06).with(wrap(0.073, 0.248, 0.004, 0.12, -0.10)).with(knot);
    vec![smooth(&loft(&jacket, 2.35, 3, 40), Wear::Jacket), smooth(&buttons, Wear::Bronze), smooth(&scarf, Wear::Scarf)]
}

fn neck() -> Solid {
    let sections =
        [section(-0.04, 0.056, 0.058, -0.002), section(0.03, 0.05, 0.053, 0.004), section(0.11, 0.055, 0.06, 0.012)];
    loft(&sections, 2.0, 2, 28)
}

/// Builds a third of the hanging end of the scarf.
fn scarf_end() -> Solid {
    rounded_box([0.046, 0.083, 0.010], 0.0095, 2).moved([0.0, -0.072, 0.0])
}

fn upper_arm() -> Solid {
    limb(0.27, &[0.060, 0.060, 0.055, 0.05, 0.05], 24)
}

/// Builds the sleeve with its cuff, and the wrist.
fn forearm() -> Vec<Primitive> {
    let sleeve = limb(0.215, &[0.051, 0.05, 0.045, 0.041], 24).with(band(-0.215, 0.037, 0.037, 0.012, 0.018));
    vec![smooth(&sleeve, Wear::Jacket), smooth(&limb(0.25, &[0.03, 0.028, 0.027], 16), Wear::Skin)]
}

/// Builds the left hand, hanging at ease: palm toward the body (-x), thumb forward (+z).
fn hand() -> Solid {
    let palm = [
        section(-0.095, 0.014, 0.038, 0.003),
        section(-0.06, 0.019, 0.042, 0.003),
        section(-0.02, 0.021, 0.033, 0.002),
        section(0.005, 0.022, 0.026, 0.0),
    ];
    let mut hand = loft(&palm, 2.5, 2, 24);
    for (z, length, radius) in
        [(0.033, 0.066, 0.0115), (0.012, 0.076, 0.012), (-0.009, 0.071, 0.0115), (-0.028, 0.056, 0.0105)]
    {
        let root = Vec3::new(0.001, -0.092, z);
        let knuckle = root + Vec3::new(-0.16, -0.98, 0.05 * z.signum()) * length * 0.55;
        let tip = knuckle + Vec3::new(-0.55, -0.83, 0.0) * length * 0.45;
        hand = hand.with(capsule(root, radius, knuckle, radius * 0.97, 12));
        hand = hand.with(capsule(knuckle, radius * 0.97, tip, radius * 0.85, 12));
    }
    let [base, joint, tip] =
        [Vec3::new(-0.004, -0.03, 0.026), Vec3::new(-0.012, -0.066, 0.052), Vec3::new(-0.02, -0.096, 0.056)];
    hand.with(capsule(base, 0.017, joint, 0.0135, 12)).with(capsule(joint, 0.0135, tip, 0.011, 12))
}

fn thigh() -> Solid {
    limb(0.43, &[0.080, 0.088, 0.081, 0.069, 0.062], 26)
}

/// Builds the trousers below the knee and the boot's shaft with its turned-down top.
fn shin() -> Vec<Primitive> {
    let shaft = [
        section(-0.425, 0.045, 0.052, 0.004),
        section(-0.36, 0.045, 0.05, 0.0),
        section(-0.27, 0.057, 0.062, -0.006),
        section(-0.20, 0.064, 0.067, -0.004),
    ];
    let top = band(-0.205, 0.062, 0.065, 0.012, 0.024).moved([0.0, 0.0, -0.004]);
    vec![
        smooth(&limb(0.26, &[0.061, 0.068, 0.063, 0.046], 26), Wear::Trousers),
        smooth(&loft(&shaft, 2.0, 3, 26).with(top), Wear::Leather),
    ]
}

/// Builds a loft along +z instead of +y. The `cz` of its sections is the depth of the centre below the joint.
fn along_z(sections: &[Section], floor: f32) -> Solid {
    let mut solid = loft(sections, 2.3, 3, 28).transformed(Affine3A::from_rotation_x(FRAC_PI_2));
    for position in &mut solid.positions {
        position.y = position.y.max(floor);
    }
    solid
}

/// Builds a sole between two heights, from `back` to `front` along z. It is `half` wide, and wider in front
/// by `flare`.
fn sole([low, high]: [f32; 2], [back, front]: [f32; 2], half: f32, flare: f32) -> Solid {
    let (middle, reach) = (f32::midpoint(back, front), (front - back) / 2.0);
    let ring = |y: f32, inset: f32| {
        let point = |index: usize| {
            let (sin, cos) = (index as f32 / 32.0 * TAU).sin_cos();
            let squarer = |v: f32| v.signum() * v.abs().powf(0.75);
            let width = half + flare * cos;
            Vec3::new(squarer(sin) * (width - inset), y, middle + squarer(cos) * (reach - inset))
        };
        (0..32).map(point).collect::<Vec<_>>()
    };
    let edge = 0.004;
    let rings = [ring(low, edge), ring(low + edge, 0.0), ring(high - edge, 0.0), ring(high, edge)];
    tube(&rings, Vec3::new(0.0, low, middle), Vec3::new(0.0, high, middle))
}

/// Builds the boot behind the toes.
fn foot() -> Vec<Primitive> {
    let upper = [
        section(-0.055, 0.034, 0.044, 0.045),
        section(-0.015, 0.041, 0.056, 0.034),
        section(0.035, 0.043, 0.052, 0.040),
        section(0.08, 0.047, 0.038, 0.052),
        section(0.115, 0.049, 0.031, 0.056),
    ];
    let heel = sole([-ANKLE, -0.06], [-0.088, -0.02], 0.037, -0.003);
    let sole = sole([-ANKLE + 0.006, -0.066], [-0.085, 0.135], 0.043, 0.009);
    vec![smooth(&along_z(&upper, -ANKLE + 0.012), Wear::Leather), sole.with(heel).primitive(Wear::Sole.into(), CRISP)]
}

/// Builds the boot's cap, around the toe joint.
fn toes() -> Vec<Primitive> {
    let ground = -ANKLE - TOE.y;
    let upper =
        [section(-0.01, 0.0485, 0.031, 0.001), section(0.025, 0.05, 0.030, 0.003), section(0.058, 0.042, 0.025, 0.008)];
    vec![
        smooth(&along_z(&upper, ground + 0.012), Wear::Leather),
        sole([ground, ground + 0.024], [-0.028, 0.086], 0.049, -0.006).primitive(Wear::Sole.into(), CRISP),
    ]
}
