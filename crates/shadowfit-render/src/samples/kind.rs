//! Which shader pieces a frame takes.

use super::{SampleFormat, Shading, ShadowTest};

/// [`ShadowTest`] without its numbers: which piece of WGSL it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TestKind {
    /// Everything is lit.
    Off,
    /// XNA Shadow Mapping.
    Xna,
    /// Headlight street, second stage.
    RealShadow,
    /// A comparison sampler.
    Comparison,
    /// Terrain.
    Terrain,
    /// The core's bias and filter.
    Ours,
}

/// [`Shading`] without its numbers: which piece of WGSL it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ShadingKind {
    /// XNA Shadow Mapping.
    Xna,
    /// Headlight street, first stage.
    Projective,
    /// Headlight street.
    Headlight,
    /// A comparison sampler.
    Comparison,
    /// Terrain.
    Terrain,
    /// Modern lighting.
    Modern,
}

impl TestKind {
    /// All of them.
    pub const ALL: [Self; 6] = [Self::Off, Self::Xna, Self::RealShadow, Self::Comparison, Self::Terrain, Self::Ours];

    /// Whether it can read a map of a format: a comparison sampler needs a depth texture.
    pub const fn can_read(self, format: SampleFormat) -> bool {
        format.is_depth() || !matches!(self, Self::Comparison | Self::Ours)
    }
}

impl ShadingKind {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Xna, Self::Projective, Self::Headlight, Self::Comparison, Self::Terrain, Self::Modern];
}

impl From<ShadowTest> for TestKind {
    fn from(test: ShadowTest) -> Self {
        match test {
            ShadowTest::Off => Self::Off,
            ShadowTest::Xna { .. } => Self::Xna,
            ShadowTest::RealShadow { .. } => Self::RealShadow,
            ShadowTest::Comparison { .. } => Self::Comparison,
            ShadowTest::Terrain { .. } => Self::Terrain,
            ShadowTest::Ours { .. } => Self::Ours,
        }
    }
}

impl From<Shading> for ShadingKind {
    fn from(shading: Shading) -> Self {
        match shading {
            Shading::Xna { .. } => Self::Xna,
            Shading::Projective => Self::Projective,
            Shading::Headlight { .. } => Self::Headlight,
            Shading::Comparison { .. } => Self::Comparison,
            Shading::Terrain { .. } => Self::Terrain,
            Shading::Modern { .. } => Self::Modern,
        }
    }
}
