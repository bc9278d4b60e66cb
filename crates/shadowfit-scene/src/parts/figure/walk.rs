//! Animations of the wanderer: walk and turn.
//!
//! The walk starts from the feet. Each is planted at a fixed point of a circular path and rolls from heel to
//! toe there, so it cannot slide. Two-bone inverse kinematics compute thighs and shins. Hips, shoulders and
//! arms swing by sines in step with the feet.

use std::f32::consts::TAU;

use glam::{Quat, Vec3};

use super::posture::{Posture, standing};
use super::rig::{ANKLE, JOINTS, Joint, Joints, Side, TOE};
use crate::parts::motion::{ease, take_nearer_signs};
use crate::{Animation, Channel, ChannelValues, Interpolation};

/// Radius of the path, in metres.
const PATH_RADIUS: f32 = 2.0;
/// Strides (two steps) per lap.
const STRIDES: usize = 11;
/// Length of a stride along the path, in metres.
const STRIDE: f32 = TAU * PATH_RADIUS / STRIDES as f32;
/// Time of a stride, in seconds.
const STRIDE_TIME: f32 = 1.08;
/// Keyframes per stride.
const STRIDE_KEYS: usize = 36;
/// Share of a stride during which a foot is on the ground.
const STANCE: f32 = 0.62;
/// Half of the distance between the feet's tracks, in metres.
const TRACK: f32 = 0.075;
/// Distance of a planted foot behind the body's centre in the middle of its stance, in metres.
const LAG: f32 = 0.035;
/// Angle by which the feet point outwards, in radians.
const TOE_OUT: f32 = 0.1;
/// Point that the heel rolls over, relative to the ankle.
const HEEL: Vec3 = Vec3::new(0.0, -ANKLE, -0.055);
/// Time of a turn on the spot, in seconds.
const TURN_TIME: f32 = 12.0;
/// Keyframes of a turn on the spot.
const TURN_KEYS: usize = 72;

/// Returns both animations: "walk" and "turn".
pub(super) fn animations(joints: &Joints) -> Vec<Animation> {
    let stride: Vec<Posture> = (0..STRIDE_KEYS).map(|key| walking(key as f32 / STRIDE_KEYS as f32)).collect();
    let lap = (0..=STRIDES * STRIDE_KEYS).map(|key| {
        let mut posture = stride[key % STRIDE_KEYS].clone();
        let (at, turn) = path(key as f32 / STRIDE_KEYS as f32);
        posture.root = at;
        posture.rotations[Joint::Root as usize] = turn;
        posture
    });
    let around = (0..=TURN_KEYS).map(|key| {
        let mut posture = standing();
        let turn = key as f32 / TURN_KEYS as f32 * TAU;
        posture.turn(Joint::Root, 0.0, turn, 0.0);
        breathe(&mut posture, turn * 3.0);
        posture
    });
    vec![
        animation("walk", STRIDES as f32 * STRIDE_TIME, &lap.collect::<Vec<_>>(), joints),
        animation("turn", TURN_TIME, &around.collect::<Vec<_>>(), joints),
    ]
}

/// Lifts and lowers chest and head a little with the breath.
fn breathe(posture: &mut Posture, phase: f32) {
    let breath = Quat::from_rotation_x(0.012 * phase.sin());
    for joint in [Joint::Chest, Joint::TailB] {
        posture.rotations[joint as usize] *= breath;
    }
    posture.rotations[Joint::Neck as usize] *= breath.inverse();
}

/// Returns the root's position and heading after `strides` strides: a circle through the origin, to the left.
fn path(strides: f32) -> (Vec3, Quat) {
    path_at(strides * STRIDE)
}

/// Returns the root's position and heading after `length` metres of path.
fn path_at(length: f32) -> (Vec3, Quat) {
    let angle = length / PATH_RADIUS;
    let (sin, cos) = angle.sin_cos();
    (Vec3::new(1.0 - cos, 0.0, sin) * PATH_RADIUS, Quat::from_rotation_y(angle))
}

/// State of a foot: ankle, orientation, bend of the toes.
#[derive(Clone, Copy)]
struct Foot {
    ankle: Vec3,
    turn: Quat,
    toes: f32,
}

/// Returns the ankle, the pitch and the toes' bend of a foot planted at the origin. `stance` goes from heel
/// strike (0) to toe-off (1).
fn roll(stance: f32) -> (Vec3, f32, f32) {
    let strike = -0.34 * (1.0 - ease(stance, -0.12, 0.2));
    if strike < 0.0 {
        let pitch = Quat::from_rotation_x(strike);
        return (Vec3::new(0.0, ANKLE, 0.0) + HEEL - pitch * HEEL, strike, 0.0);
    }
    // Starts near half of the stance and ends beyond it, so that the heel still rises fast at toe-off.
    let lift = 0.80 * ease(stance, 0.45, 1.25);
    let pitch = Quat::from_rotation_x(lift);
    (Vec3::new(0.0, ANKLE, 0.0) + TOE - pitch * TOE, lift, -lift)
}

/// Returns the foot of a side during its `step`-th contact, in the scene's axes.
fn planted(side: Side, step: f32, stance: f32) -> (Foot, f32) {
    let (at, heading) = path_at((step + 0.5 * STANCE) * STRIDE - LAG);
    let turn = heading * Quat::from_rotation_y(side.sign() * TOE_OUT);
    let (ankle, pitch, toes) = roll(stance);
    let at = at + heading * Vec3::new(side.sign() * TRACK, 0.0, 0.0);
    (Foot { ankle: at + turn * ankle, turn: turn * Quat::from_rotation_x(pitch), toes }, pitch)
}

/// Returns the foot of a side after `strides` strides, in the scene's axes.
fn foot(side: Side, strides: f32) -> Foot {
    let shift = if side == Side::Left { 0.0 } else { 0.5 };
    let step = (strides - shift).floor() + shift;
    let phase = strides - step;
    if phase < STANCE {
        return planted(side, step, phase / STANCE).0;
    }
    let swing = (phase - STANCE) / (1.0 - STANCE);
    let ((from, pitch_from), (to, pitch_to)) = (planted(side, step, 1.0), planted(side, step + 1.0, 0.0));
    // The ankle leaves and arrives with the speed that it has on the ground (per unit of swing).
    let rate = 0.01 * STANCE / (1.0 - STANCE);
    let leave = (from.ankle - planted(side, step, 0.99).0.ankle) / rate;
    let arrive = (planted(side, step + 1.0, 0.01).0.ankle - to.ankle) / rate;
    let lift = Vec3::Y * 0.035 * (swing * TAU / 2.0).sin().powi(2);
    let ankle = hermite([from.ankle, leave, to.ankle, arrive], swing) + lift;
    let (heading_from, heading_to) =
        (from.turn * Quat::from_rotation_x(-pitch_from), to.turn * Quat::from_rotation_x(-pitch_to));
    // The foot hangs briefly, then the toes lift for the next heel strike.
    let hang = pitch_from + 0.12 * (swing / 0.3).min(1.0) * (1.0 - ease(swing, 0.1, 0.5));
    let pitch = hang * (1.0 - ease(swing, 0.05, 0.62)) + pitch_to * ease(swing, 0.5, 1.0);
    let turn = heading_from.slerp(heading_to, swing) * Quat::from_rotation_x(pitch);
    Foot { ankle, turn, toes: from.toes * (1.0 - ease(swing, 0.0, 0.35)) }
}

/// Evaluates a cubic Hermite curve, given value and slope at its start, then value and slope at its end.
fn hermite([a, slope_a, b, slope_b]: [Vec3; 4], t: f32) -> Vec3 {
    let (t2, t3) = (t * t, t * t * t);
    a * (2.0 * t3 - 3.0 * t2 + 1.0) + slope_a * (t3 - 2.0 * t2 + t) + b * (3.0 * t2 - 2.0 * t3) + slope_b * (t3 - t2)
}

/// Returns the posture at `phase` of a stride. The left heel strikes at 0.
fn walking(phase: f32) -> Posture {
    let mut posture = Posture::upright(Vec3::ZERO);
    let turn = TAU * phase;
    // Middle of the left stance: the body is over the left foot and at its highest.
    let over = TAU * (phase - 0.5 * STANCE);
    posture.hips = Vec3::new(0.02 * over.cos(), 0.926 + 0.016 * (2.0 * over).cos(), 0.0);
    posture.turn(Joint::Hips, 0.05, -0.13 * turn.cos(), 0.05 * over.cos());
    posture.turn(Joint::Spine, 0.01, 0.10 * turn.cos(), -0.03 * over.cos());
    posture.turn(Joint::Chest, 0.0, 0.16 * turn.cos() + 0.05, -0.03 * over.cos() + 0.02);
    posture.turn(Joint::Neck, 0.02, -0.07 * turn.cos(), 0.0);
    posture.turn(Joint::Head, -0.06 + 0.02 * (2.0 * over).sin(), -0.06 * turn.cos() + 0.08, 0.012 * over.cos());
    swing_arms(&mut posture, turn);
    swing_scarf(&mut posture, turn);
    let (at, heading) = path(phase);
    let back = heading.inverse();
    for side in [Side::Left, Side::Right] {
        let foot = foot(side, phase);
        posture.reach_foot(side, back * (foot.ankle - at), back * foot.turn, foot.toes);
    }
    posture
}

/// Swings the arms opposite to the legs. The elbows bend as the hands come forward.
fn swing_arms(posture: &mut Posture, turn: f32) {
    for side in [Side::Left, Side::Right] {
        let [arm, forearm, hand] = side.arm();
        let back = side.sign() * (turn - 0.15).cos();
        let late = side.sign() * (turn - 0.6).cos();
        posture.turn(arm, 0.02 + 0.46 * back, 0.0, side.sign() * 0.13);
        posture.turn(forearm, -0.42 + 0.24 * late, 0.0, 0.0);
        posture.turn(hand, -0.08 + 0.1 * late, side.sign() * 0.15, 0.0);
    }
}

/// Lets the end of the scarf trail behind. Each piece follows the one above with a delay.
fn swing_scarf(posture: &mut Posture, turn: f32) {
    for (index, joint) in [Joint::TailA, Joint::TailB, Joint::TailC].into_iter().enumerate() {
        let late = index as f32 * 0.9;
        let pitch = [0.30, 0.12, -0.05][index] + [0.07, 0.10, 0.14][index] * (2.0 * turn - late).sin();
        let roll = [0.05, 0.06, 0.10][index] * (turn - late).sin();
        posture.turn(joint, pitch, 0.0, roll);
    }
}

/// Returns an animation with a channel for every joint that moves, from poses at even times.
fn animation(name: &str, duration: f32, poses: &[Posture], joints: &Joints) -> Animation {
    let last = (poses.len() - 1) as f32;
    let times: Vec<f32> = (0..poses.len()).map(|key| key as f32 / last * duration).collect();
    let channel = |joint: usize, values: ChannelValues| Channel {
        node: joints.node(joint),
        times: times.clone(),
        interpolation: Interpolation::Linear,
        values,
    };
    let translations = |get: fn(&Posture) -> Vec3| ChannelValues::Translation(poses.iter().map(get).collect());
    let mut channels = vec![
        channel(Joint::Root as usize, translations(|pose| pose.root)),
        channel(Joint::Hips as usize, translations(|pose| pose.hips)),
    ];
    for joint in 0..JOINTS {
        let mut turns: Vec<Quat> = poses.iter().map(|pose| pose.rotations[joint]).collect();
        take_nearer_signs(&mut turns);
        channels.push(channel(joint, ChannelValues::Rotation(turns)));
    }
    Animation { name: name.to_owned(), duration, channels }
}
