//! Limits of shadow maps.

/// Widths and heights that a map may have, in texels.
pub const RESOLUTIONS: core::ops::RangeInclusive<u32> = 256..=8192;
