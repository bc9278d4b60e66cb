//! Loops: what turns and sways, as keyframes that end where they begin.

use std::f32::consts::TAU;

use glam::Quat;

use crate::{Animation, Channel, ChannelValues, Interpolation};

/// A loop of `duration` seconds.
pub fn looped(name: &str, duration: f32, channels: Vec<Channel>) -> Animation {
    Animation { name: name.to_owned(), duration, channels }
}

/// Rotations of a node at `keys` even times of a loop of `duration` seconds: `turn` gives that of a phase of 0..2π,
/// and must give the same rotation for both ends.
pub fn rotations(node: usize, duration: f32, keys: usize, turn: impl Fn(f32) -> Quat) -> Channel {
    let share = |key: usize| key as f32 / keys as f32;
    let mut values: Vec<Quat> = (0..keys).map(|key| turn(share(key) * TAU)).collect();
    values.push(values[0]);
    // A rotation has two signs; neighbours take the nearer one.
    for key in 1..=keys {
        if values[key].dot(values[key - 1]) < 0.0 {
            values[key] = -values[key];
        }
    }
    Channel {
        node,
        times: (0..=keys).map(|key| share(key) * duration).collect(),
        interpolation: Interpolation::Linear,
        values: ChannelValues::Rotation(values),
    }
}
