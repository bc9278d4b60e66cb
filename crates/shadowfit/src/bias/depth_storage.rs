//! Precision of stored depths, by the format of a map's texels.

use crate::base::{FitError, checks};
use crate::technique::settings::MapFormat;

/// Storage of a map's depths of 0..=1, independent of the format's name in a graphics API.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum DepthStorage {
    /// 8 bits, as one channel of an ordinary colour target (the naïve grey map).
    Unorm8,
    /// 16 bits (D16).
    Unorm16,
    /// 24 bits (D24).
    Unorm24,
    /// 16-bit float, 11 significant bits (R16F).
    Float16,
    /// 32-bit float, 24 significant bits (D32F, R32F, and its bits packed in four channels of 8).
    #[default]
    Float32,
}

impl DepthStorage {
    /// Returns the depth storage of a map format.
    pub(crate) const fn of(format: MapFormat) -> Self {
        match format {
            MapFormat::Depth32Float | MapFormat::R32Float | MapFormat::Rgba8Packed => Self::Float32,
            MapFormat::Depth24Unorm => Self::Unorm24,
            MapFormat::Depth16Unorm => Self::Unorm16,
            MapFormat::R16Float => Self::Float16,
            MapFormat::R8Grey => Self::Unorm8,
        }
    }
}

impl From<MapFormat> for DepthStorage {
    fn from(format: MapFormat) -> Self {
        Self::of(format)
    }
}

/// Returns the smallest depth difference, in metres, that a map resolves everywhere in its range of
/// `depth_range` metres (pass 1 for units of the stored depth). For floats it is the step at the end of the
/// range where they are coarsest: at the far end, or with reversed depth at the near end. A range that is not
/// finite gives a step that is not finite.
pub fn depth_step(storage: impl Into<DepthStorage>, depth_range: f32) -> f32 {
    (step(storage.into(), 1.0) * f64::from(depth_range)) as f32
}

/// Returns the depth difference, in metres, that a map resolves around the stored `depth` (0..=1, where
/// reversed depth has 1 at the near end), in its range of `depth_range` metres: the distance to the next
/// stored value, away from 0. Floats count as flushed to zero below their least normal number (32 bits:
/// 2⁻¹²⁶), as on some GPUs, or below their least number (16 bits: 2⁻²⁴).
///
/// # Errors
///
/// Returns [`FitError::NotFinite`] and [`FitError::OutOfRange`] for the depth or the range.
pub fn depth_step_at(storage: impl Into<DepthStorage>, depth_range: f32, depth: f32) -> Result<f32, FitError> {
    let range = checks::within("the depth range", f64::from(depth_range), checks::MIN_LENGTH, checks::MAX_LENGTH)?;
    let depth = checks::within("the stored depth", f64::from(depth), 0.0, 1.0)?;
    Ok((step(storage.into(), depth) * range) as f32)
}

/// Returns the step of the stored values at a depth of 0..=1.
fn step(storage: DepthStorage, depth: f64) -> f64 {
    match storage {
        DepthStorage::Unorm8 => 1.0 / 255.0,
        DepthStorage::Unorm16 => 1.0 / 65_535.0,
        DepthStorage::Unorm24 => 1.0 / 16_777_215.0,
        DepthStorage::Float16 => float_step(depth, 11, -24),
        DepthStorage::Float32 => float_step(depth, 24, -126),
    }
}

/// Returns the step of floats with a number of significant bits at a depth: 2^(exponent + 1 - bits), but at
/// least 2^least. Depth 1 is the end of the range and has the step of the numbers just below it.
fn float_step(depth: f64, bits: i32, least: i32) -> f64 {
    // An f32 widened to f64 is never subnormal, so the exponent bits alone give the exponent.
    let exponent = ((depth.to_bits() >> 52) as i32 - 1023).min(-1);
    let power = (exponent + 1 - bits).max(least);
    f64::from_bits(((power + 1023) as u64) << 52)
}
