//! The figure's skeleton. At rest every bone points straight down or up in its parent's axes: x to the
//! figure's left, y up, z forward.

use std::sync::LazyLock;

use glam::Vec3;

use crate::parts::numbered::numbered;

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

numbered! {
    /// A joint of the figure. Its number is its index in [`RIG`].
    Joint: Bone {
        Root = Bone { name: "wanderer", parent: None, offset: Vec3::ZERO },
        Hips = bone("hips", Self::Root, [0.0, 0.95, 0.0]),
        Spine = bone("spine", Self::Hips, [0.0, 0.10, 0.0]),
        Chest = bone("chest", Self::Spine, [0.0, 0.15, 0.0]),
        Neck = bone("neck", Self::Chest, [0.0, 0.225, -0.005]),
        Head = bone("head", Self::Neck, [0.0, 0.07, 0.008]),
        TailA = bone("scarf end 1", Self::Chest, [0.062, 0.185, -0.105]),
        TailB = bone("scarf end 2", Self::TailA, [0.0, -0.15, 0.0]),
        TailC = bone("scarf end 3", Self::TailB, [0.0, -0.15, 0.0]),
        ArmL = bone("left arm", Self::Chest, [SHOULDER.x, SHOULDER.y, SHOULDER.z]),
        ForearmL = bone("left forearm", Self::ArmL, [0.0, -UPPER_ARM, 0.0]),
        HandL = bone("left hand", Self::ForearmL, [0.0, -FOREARM, 0.0]),
        ArmR = bone("right arm", Self::Chest, [-SHOULDER.x, SHOULDER.y, SHOULDER.z]),
        ForearmR = bone("right forearm", Self::ArmR, [0.0, -UPPER_ARM, 0.0]),
        HandR = bone("right hand", Self::ForearmR, [0.0, -FOREARM, 0.0]),
        ThighL = bone("left thigh", Self::Hips, [HIP.x, HIP.y, HIP.z]),
        ShinL = bone("left shin", Self::ThighL, [0.0, -THIGH, 0.0]),
        FootL = bone("left foot", Self::ShinL, [0.0, -SHIN, 0.0]),
        ToeL = bone("left toes", Self::FootL, [TOE.x, TOE.y, TOE.z]),
        ThighR = bone("right thigh", Self::Hips, [-HIP.x, HIP.y, HIP.z]),
        ShinR = bone("right shin", Self::ThighR, [0.0, -THIGH, 0.0]),
        FootR = bone("right foot", Self::ShinR, [0.0, -SHIN, 0.0]),
        ToeR = bone("right toes", Self::FootR, [TOE.x, TOE.y, TOE.z]),
    }
}

/// Number of joints.
pub(super) const JOINTS: usize = 23;

/// The skeleton, in the order of [`Joint`].
pub(super) static RIG: LazyLock<Vec<Bone>> = LazyLock::new(Joint::all);

/// A joint's name, parent and position in its parent's axes, in metres.
#[derive(Debug)]
pub(crate) struct Bone {
    pub(super) name: &'static str,
    pub(super) parent: Option<Joint>,
    pub(super) offset: Vec3,
}

fn bone(name: &'static str, parent: Joint, offset: [f32; 3]) -> Bone {
    Bone { name, parent: Some(parent), offset: offset.into() }
}

/// Left or right of the figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Left,
    Right,
}

impl Side {
    /// Returns the sign of x on this side.
    pub(super) const fn sign(self) -> f32 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }

    /// Mirrors `v`, given for the left side, to this side.
    pub(super) fn mirror(self, v: Vec3) -> Vec3 {
        Vec3::new(v.x * self.sign(), v.y, v.z)
    }

    /// Returns the upper arm, forearm and hand.
    pub(super) const fn arm(self) -> [Joint; 3] {
        match self {
            Self::Left => [Joint::ArmL, Joint::ForearmL, Joint::HandL],
            Self::Right => [Joint::ArmR, Joint::ForearmR, Joint::HandR],
        }
    }

    /// Returns the thigh, shin, foot and toes.
    pub(super) const fn leg(self) -> [Joint; 4] {
        match self {
            Self::Left => [Joint::ThighL, Joint::ShinL, Joint::FootL, Joint::ToeL],
            Self::Right => [Joint::ThighR, Joint::ShinR, Joint::FootR, Joint::ToeR],
        }
    }
}

/// The scene nodes of the joints.
pub(super) struct Joints([usize; JOINTS]);

impl Joints {
    /// Stores the nodes in the order of [`Joint`].
    pub(super) fn new(nodes: [usize; JOINTS]) -> Self {
        Self(nodes)
    }

    /// Returns the node of a joint, by the joint's number.
    pub(super) fn node(&self, joint: usize) -> usize {
        self.0[joint]
    }

    /// Returns the root node of the figure.
    pub(super) fn root(&self) -> usize {
        self.node(Joint::Root as usize)
    }
}
