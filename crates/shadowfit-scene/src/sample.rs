//! Values of animation channels between keyframes.
//!
//! The formulas are from the glTF 2.0 specification, appendix C "Animation Sampler Interpolation Modes".

use std::ops::{Add, Mul};

use glam::{Quat, Vec3};

use crate::{Channel, ChannelValues, Interpolation};

/// One interpolated value.
pub(crate) enum Sample {
    /// Translation, in metres.
    Translation(Vec3),
    /// Unit rotation.
    Rotation(Quat),
    /// Scale.
    Scale(Vec3),
    /// Morph weights.
    MorphWeights(Vec<f32>),
}

/// Returns the value of `channel` at `seconds`, clamped to its first and last key. Returns `None` for a
/// channel without keys or with too few values.
pub(crate) fn sample(channel: &Channel, seconds: f32) -> Option<Sample> {
    let at = Segment::find(&channel.times, seconds)?;
    let mode = channel.interpolation;
    Some(match &channel.values {
        ChannelValues::Translation(v) => Sample::Translation(at.value(v, 1, 0, mode, Vec3::lerp)?),
        ChannelValues::Scale(v) => Sample::Scale(at.value(v, 1, 0, mode, Vec3::lerp)?),
        ChannelValues::Rotation(v) => {
            let rotation = at.value(v, 1, 0, mode, Quat::slerp)?;
            Sample::Rotation(normalized(rotation))
        }
        ChannelValues::MorphWeights(v) => {
            let values_per_key = if mode == Interpolation::CubicSpline { 3 } else { 1 };
            let count = v.len() / (channel.times.len() * values_per_key);
            let weights = (0..count).map(|i| at.value(v, count, i, mode, lerp));
            Sample::MorphWeights(weights.collect::<Option<_>>()?)
        }
    })
}

fn lerp(a: f32, b: f32, fraction: f32) -> f32 {
    a + (b - a) * fraction
}

/// Returns the rotation as a unit quaternion. Cubic splines may pass through zero, which counts as no
/// rotation.
fn normalized(rotation: Quat) -> Quat {
    let length = rotation.length();
    if length > 1e-12 && length.is_finite() { rotation * (1.0 / length) } else { Quat::IDENTITY }
}

/// Position of a time between two keys.
struct Segment {
    /// Key at or before the time.
    from: usize,
    /// Key after the time. Equals `from` at the ends.
    to: usize,
    /// Position between them, 0..1.
    fraction: f32,
    /// Time between them, in seconds.
    length: f32,
}

impl Segment {
    fn find(times: &[f32], seconds: f32) -> Option<Self> {
        let last = times.len().checked_sub(1)?;
        let after = times.partition_point(|&t| t <= seconds);
        if after == 0 || after > last {
            let end = if after == 0 { 0 } else { last };
            return Some(Self { from: end, to: end, fraction: 0.0, length: 0.0 });
        }
        let length = times[after] - times[after - 1];
        let fraction = (seconds - times[after - 1]) / length;
        Some(Self { from: after - 1, to: after, fraction, length })
    }

    /// Interpolates value `element` of the `count` values of each key.
    fn value<T>(
        &self,
        values: &[T],
        count: usize,
        element: usize,
        mode: Interpolation,
        blend: fn(T, T, f32) -> T,
    ) -> Option<T>
    where
        T: Copy + Add<Output = T> + Mul<f32, Output = T>,
    {
        let at = |slot: usize| values.get(slot * count + element).copied();
        match mode {
            Interpolation::Step => at(self.from),
            Interpolation::Linear if self.from == self.to => at(self.from),
            Interpolation::Linear => Some(blend(at(self.from)?, at(self.to)?, self.fraction)),
            Interpolation::CubicSpline if self.from == self.to => at(3 * self.from + 1),
            Interpolation::CubicSpline => {
                let start = Key { value: at(3 * self.from + 1)?, tangent: at(3 * self.from + 2)? };
                let end = Key { value: at(3 * self.to + 1)?, tangent: at(3 * self.to)? };
                Some(hermite(start, end, self.fraction, self.length))
            }
        }
    }
}

/// A key of a cubic spline.
struct Key<T> {
    value: T,
    /// Change of the value per second, on the side of the other key.
    tangent: T,
}

/// Evaluates a cubic Hermite spline between two keys that are `length` seconds apart, at a share `s` of the
/// way, 0..1.
fn hermite<T>(start: Key<T>, end: Key<T>, s: f32, length: f32) -> T
where
    T: Add<Output = T> + Mul<f32, Output = T>,
{
    let (s2, s3) = (s * s, s * s * s);
    start.value * (2.0 * s3 - 3.0 * s2 + 1.0)
        + start.tangent * (length * (s3 - 2.0 * s2 + s))
        + end.value * (3.0 * s2 - 2.0 * s3)
        + end.tangent * (length * (s3 - s2))
}
