//! The wanderer: a jointed figure about 1.8 m tall, its skeleton and its node tree.
//!
//! At rest every bone hangs or stands straight in its parent's axes: x to the figure's left, y up,
//! z ahead. Poses come from [`super::walk`], meshes from [`super::body`] and [`super::face`].

use glam::Vec3;

use super::walk::Posture;
use super::{body, face};
use crate::builtin::build::Builder;

/// Length of the upper arm, in metres.
pub(super) const UPPER_ARM: f32 = 0.27;
/// Length of the forearm.
pub(super) const FOREARM: f32 = 0.245;
/// Length of the thigh.
pub(super) const THIGH: f32 = 0.43;
/// Length of the shin.
pub(super) const SHIN: f32 = 0.415;
/// Height of the ankle above the sole.
pub(super) const ANKLE: f32 = 0.09;
/// Position of the toe joint relative to the ankle.
pub(super) const TOE: Vec3 = Vec3::new(0.0, -0.055, 0.115);
/// Position of the left hip joint relative to the hips' node.
pub(super) const HIP: Vec3 = Vec3::new(0.092, -0.02, 0.0);
/// Position of the left shoulder relative to the chest's node.
pub(super) const SHOULDER: Vec3 = Vec3::new(0.160, 0.136, -0.008);

/// A joint of the figure; its number is its index in [`RIG`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Joint {
    Root,
    Hips,
    Spine,
    Chest,
    Neck,
    Head,
    TailA,
    TailB,
    TailC,
    ArmL,
    ForearmL,
    HandL,
    ArmR,
    ForearmR,
    HandR,
    ThighL,
    ShinL,
    FootL,
    ToeL,
    ThighR,
    ShinR,
    FootR,
    ToeR,
}

/// Number of joints.
pub(super) const JOINTS: usize = 23;

impl Joint {
    /// All joints, in order.
    #[rustfmt::skip]
    pub(super) const ALL: [Self; JOINTS] = [
        Self::Root, Self::Hips, Self::Spine, Self::Chest, Self::Neck, Self::Head,
        Self::TailA, Self::TailB, Self::TailC,
        Self::ArmL, Self::ForearmL, Self::HandL, Self::ArmR, Self::ForearmR, Self::HandR,
        Self::ThighL, Self::ShinL, Self::FootL, Self::ToeL,
        Self::ThighR, Self::ShinR, Self::FootR, Self::ToeR,
    ];
}

/// Left or right, seen by the figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Left,
    Right,
}

impl Side {
    /// Sign of x on this side.
    pub(super) const fn sign(self) -> f32 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }

    /// `v` given for the left side, on this side.
    pub(super) fn mirror(self, v: Vec3) -> Vec3 {
        Vec3::new(v.x * self.sign(), v.y, v.z)
    }

    /// Upper arm, forearm and hand.
    pub(super) const fn arm(self) -> [Joint; 3] {
        match self {
            Self::Left => [Joint::ArmL, Joint::ForearmL, Joint::HandL],
            Self::Right => [Joint::ArmR, Joint::ForearmR, Joint::HandR],
        }
    }

    /// Thigh, shin, foot and toes.
    pub(super) const fn leg(self) -> [Joint; 4] {
        match self {
            Self::Left => [Joint::ThighL, Joint::ShinL, Joint::FootL, Joint::ToeL],
            Self::Right => [Joint::ThighR, Joint::ShinR, Joint::FootR, Joint::ToeR],
        }
    }
}

/// A joint's name, parent and position in its parent's axes, in metres.
pub(super) struct Bone {
    name: &'static str,
    pub(super) parent: Option<Joint>,
    pub(super) offset: Vec3,
}

const fn bone(name: &'static str, parent: Joint, x: f32, y: f32, z: f32) -> Bone {
    Bone { name, parent: Some(parent), offset: Vec3::new(x, y, z) }
}

/// The skeleton, in the order of [`Joint`].
pub(super) const RIG: [Bone; JOINTS] = {
    use Joint::{ArmL, ArmR, Chest, FootL, FootR, ForearmL, ForearmR, Hips, Neck, Root, ShinL, ShinR, Spine};
    use Joint::{TailA, TailB, ThighL, ThighR};
    [
        Bone { name: "wanderer", parent: None, offset: Vec3::ZERO },
        bone("hips", Root, 0.0, 0.95, 0.0),
        bone("spine", Hips, 0.0, 0.10, 0.0),
        bone("chest", Spine, 0.0, 0.15, 0.0),
        bone("neck", Chest, 0.0, 0.225, -0.005),
        bone("head", Neck, 0.0, 0.07, 0.008),
        bone("scarf end 1", Chest, 0.062, 0.185, -0.105),
        bone("scarf end 2", TailA, 0.0, -0.15, 0.0),
        bone("scarf end 3", TailB, 0.0, -0.15, 0.0),
        bone("left arm", Chest, SHOULDER.x, SHOULDER.y, SHOULDER.z),
        bone("left forearm", ArmL, 0.0, -UPPER_ARM, 0.0),
        bone("left hand", ForearmL, 0.0, -FOREARM, 0.0),
        bone("right arm", Chest, -SHOULDER.x, SHOULDER.y, SHOULDER.z),
        bone("right forearm", ArmR, 0.0, -UPPER_ARM, 0.0),
        bone("right hand", ForearmR, 0.0, -FOREARM, 0.0),
        bone("left thigh", Hips, HIP.x, HIP.y, HIP.z),
        bone("left shin", ThighL, 0.0, -THIGH, 0.0),
        bone("left foot", ShinL, 0.0, -SHIN, 0.0),
        bone("left toes", FootL, TOE.x, TOE.y, TOE.z),
        bone("right thigh", Hips, -HIP.x, HIP.y, HIP.z),
        bone("right shin", ThighR, 0.0, -THIGH, 0.0),
        bone("right foot", ShinR, 0.0, -SHIN, 0.0),
        bone("right toes", FootR, TOE.x, TOE.y, TOE.z),
    ]
};

/// The scene nodes of the joints.
pub(super) struct Joints([usize; JOINTS]);

impl Joints {
    /// Node of a joint.
    pub(super) fn node(&self, joint: Joint) -> usize {
        self.0[joint as usize]
    }

    /// Node that carries the whole figure.
    pub(super) fn root(&self) -> usize {
        self.node(Joint::Root)
    }
}

/// Adds the figure to a scene in a posture, standing at the origin and facing +z.
pub(super) fn build(builder: &mut Builder, posture: &Posture) -> Joints {
    let rest = posture.transforms();
    let mut nodes = [0; JOINTS];
    for (joint, bone) in RIG.iter().enumerate() {
        let parent = bone.parent.map(|parent| nodes[parent as usize]);
        nodes[joint] = builder.node(bone.name, parent, rest[joint], None);
    }
    for (joint, name, primitives) in body::meshes().into_iter().chain([face::mesh()]) {
        let mesh = builder.mesh(name, primitives);
        for &joint in joint {
            builder.scene.nodes[nodes[joint as usize]].mesh = Some(mesh);
        }
    }
    Joints(nodes)
}
