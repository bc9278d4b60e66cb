//! Postures: positions of root and hips, rotations of the joints, and inverse kinematics of legs and arms.

use glam::{EulerRot, Mat3, Quat, Vec3};

use super::rig::{ANKLE, FOREARM, HIP, JOINTS, Joint, RIG, SHIN, SHOULDER, Side, THIGH, UPPER_ARM};
use crate::Transform;

/// A pose: positions of root and hips, and the rotation of every joint.
#[derive(Clone, Debug)]
pub(super) struct Posture {
    pub(super) root: Vec3,
    pub(super) hips: Vec3,
    pub(super) rotations: [Quat; JOINTS],
}

impl Posture {
    /// Returns an upright posture above the root, every joint straight.
    pub(super) fn upright(hips: impl Into<Vec3>) -> Self {
        Self { root: Vec3::ZERO, hips: hips.into(), rotations: [Quat::IDENTITY; JOINTS] }
    }

    /// Returns the rest transforms of the joints, relative to their parents.
    pub(super) fn transforms(&self) -> [Transform; JOINTS] {
        let mut transforms = [Transform::default(); JOINTS];
        for (joint, bone) in RIG.iter().enumerate() {
            transforms[joint] = Transform::new(bone.offset, self.rotations[joint], Vec3::ONE);
        }
        transforms[Joint::Root as usize].translation = self.root.as_dvec3();
        transforms[Joint::Hips as usize].translation = self.hips.as_dvec3();
        transforms
    }

    /// Turns a joint by pitch (about x), yaw (about y) and roll (about z), in radians.
    pub(super) fn turn(&mut self, joint: Joint, pitch: f32, yaw: f32, roll: f32) {
        self.rotations[joint as usize] = Quat::from_euler(EulerRot::YXZ, yaw, pitch, roll);
    }

    /// Returns the position and orientation of a joint relative to the root.
    fn frame(&self, joint: Joint) -> (Vec3, Quat) {
        match RIG[joint as usize].parent {
            None => (Vec3::ZERO, Quat::IDENTITY),
            Some(parent) => {
                let (at, turn) = self.frame(parent);
                let offset = if joint == Joint::Hips { self.hips } else { RIG[joint as usize].offset };
                (at + turn * offset, turn * self.rotations[joint as usize])
            }
        }
    }

    /// Poses a leg so that its ankle is at `ankle` and its foot has the rotation `foot`, in the root's axes.
    /// The knee points in the foot's direction.
    pub(super) fn reach_foot(&mut self, side: Side, ankle: Vec3, foot: Quat, toes: f32) {
        let (hips, hips_turn) = self.frame(Joint::Hips);
        let start = hips + hips_turn * side.mirror(HIP);
        let [thigh_turn, shin_turn] = two_bones(ankle - start, THIGH, SHIN, foot * Vec3::Z);
        let [thigh, shin, ankle_joint, toe] = side.leg();
        self.rotations[thigh as usize] = hips_turn.inverse() * thigh_turn;
        self.rotations[shin as usize] = thigh_turn.inverse() * shin_turn;
        self.rotations[ankle_joint as usize] = shin_turn.inverse() * foot;
        self.turn(toe, toes, 0.0, 0.0);
    }

    /// Poses an arm so that its wrist is at `wrist`, in the chest's axes, with the elbow toward `elbow`.
    fn reach_hand(&mut self, side: Side, wrist: Vec3, elbow: Vec3) {
        // The elbow bends opposite to the knee: its inner side faces forward.
        let [upper, lower] = two_bones(wrist - side.mirror(SHOULDER), UPPER_ARM, FOREARM, elbow);
        let flip = Quat::from_rotation_y(std::f32::consts::PI);
        let [arm, forearm, _] = side.arm();
        self.rotations[arm as usize] = upper * flip;
        self.rotations[forearm as usize] = (upper * flip).inverse() * lower * flip;
    }
}

/// Returns the orientations of two bones that hang along -y, so that their end is at `reach` from their
/// start, or as close as their lengths allow. The joint between them points toward `pole`, which becomes
/// their +z.
fn two_bones(reach: Vec3, upper: f32, lower: f32, pole: Vec3) -> [Quat; 2] {
    let distance = reach.length().clamp(0.05, (upper + lower) * 0.9995);
    let along = reach.normalize();
    let aside = (pole - along * pole.dot(along)).normalize();
    let cos = (upper * upper + distance * distance - lower * lower) / (2.0 * upper * distance);
    let middle = (along * cos + aside * (1.0 - cos * cos).max(0.0).sqrt()) * upper;
    let hang = |bone: Vec3| {
        let y = -bone.normalize();
        let x = y.cross(aside).normalize();
        Quat::from_mat3(&Mat3::from_cols(x, y, x.cross(y)))
    };
    [hang(middle), hang(along * distance - middle)]
}

/// Returns the posture at ease: weight on the left leg, a hand on the hip, the head turned aside.
pub(super) fn standing() -> Posture {
    let mut posture = Posture::upright([0.035, 0.938, 0.0]);
    posture.turn(Joint::Hips, 0.0, 0.08, 0.075);
    posture.turn(Joint::Spine, -0.02, 0.0, -0.07);
    posture.turn(Joint::Chest, -0.03, -0.12, -0.06);
    posture.turn(Joint::Neck, 0.05, -0.12, 0.02);
    posture.turn(Joint::Head, 0.0, -0.28, 0.05);
    posture.turn(Joint::TailA, 0.10, 0.0, 0.04);
    posture.turn(Joint::TailB, 0.06, 0.0, 0.0);
    posture.turn(Joint::TailC, -0.06, 0.0, 0.0);
    posture.reach_foot(Side::Left, Vec3::new(0.07, ANKLE, -0.015), Quat::from_rotation_y(0.15), 0.0);
    posture.reach_foot(Side::Right, Vec3::new(-0.15, ANKLE, 0.11), Quat::from_rotation_y(-0.42), 0.0);
    posture.turn(Joint::ArmL, 0.06, 0.0, 0.16);
    posture.turn(Joint::ForearmL, -0.32, 0.0, 0.0);
    posture.turn(Joint::HandL, -0.1, 0.2, 0.0);
    posture.reach_hand(Side::Right, Vec3::new(-0.205, -0.17, 0.06), Vec3::new(-1.0, 0.0, -0.75));
    posture.turn(Joint::HandR, 0.15, 0.0, 0.75);
    posture
}

/// Returns an upright posture with hanging arms slightly apart from the body, so that sunlight passes
/// between.
pub(super) fn at_ease() -> Posture {
    let mut posture = Posture::upright([0.012, 0.937, 0.0]);
    posture.turn(Joint::Hips, 0.0, 0.04, 0.03);
    posture.turn(Joint::Spine, -0.02, 0.0, -0.03);
    posture.turn(Joint::Chest, -0.04, -0.03, -0.02);
    posture.turn(Joint::Neck, 0.06, -0.05, 0.0);
    posture.turn(Joint::Head, 0.02, -0.10, 0.02);
    posture.turn(Joint::TailA, 0.10, 0.0, 0.04);
    posture.turn(Joint::TailB, 0.06, 0.0, 0.0);
    posture.turn(Joint::TailC, -0.06, 0.0, 0.0);
    posture.reach_foot(Side::Left, Vec3::new(0.125, ANKLE, -0.03), Quat::from_rotation_y(0.25), 0.0);
    posture.reach_foot(Side::Right, Vec3::new(-0.15, ANKLE, 0.06), Quat::from_rotation_y(-0.32), 0.0);
    for (side, ahead, bend) in [(Side::Left, 0.04, -0.34), (Side::Right, -0.22, -0.75)] {
        let [arm, forearm, hand] = side.arm();
        posture.turn(arm, ahead, 0.0, side.sign() * 0.36);
        posture.turn(forearm, bend, 0.0, side.sign() * -0.12);
        posture.turn(hand, -0.1, side.sign() * 0.3, side.sign() * -0.06);
    }
    posture
}
