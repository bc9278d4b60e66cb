//! Loops of rotating and swaying objects, as keyframes that end where they begin.

use std::f32::consts::TAU;

use glam::Quat;

use crate::{Animation, Channel, ChannelValues, Interpolation};

/// Creates a loop of `duration` seconds.
pub fn looped(name: &str, duration: f32, channels: Vec<Channel>) -> Animation {
    Animation { name: name.to_owned(), duration, channels }
}

/// Chooses the sign of each rotation that is nearer to the previous rotation. A quaternion and its negative
/// are one rotation.
pub(crate) fn take_nearer_signs(turns: &mut [Quat]) {
    for key in 1..turns.len() {
        if turns[key].dot(turns[key - 1]) < 0.0 {
            turns[key] = -turns[key];
        }
    }
}

/// Rises smoothly from 0 to 1 as `x` goes from `from` to `to`.
pub fn ease(x: f32, from: f32, to: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Returns the rotations of a node at `keys` even times of a loop of `duration` seconds. `turn` returns the
/// rotation at a phase of 0..2π, and must return the same rotation for both ends.
pub fn rotations(node: usize, duration: f32, keys: usize, turn: impl Fn(f32) -> Quat) -> Channel {
    let share = |key: usize| key as f32 / keys as f32;
    let mut values: Vec<Quat> = (0..keys).map(|key| turn(share(key) * TAU)).collect();
    values.push(values[0]);
    take_nearer_signs(&mut values);
    Channel {
        node,
        times: (0..=keys).map(|key| share(key) * duration).collect(),
        interpolation: Interpolation::Linear,
        values: ChannelValues::Rotation(values),
    }
}
