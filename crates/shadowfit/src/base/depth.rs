//! The three depth ranges that clip spaces use.
//!
//! Every matrix that this crate reads or writes names its range with [`DepthConvention`], because
//! a fit that guesses it wrong still looks right from most cameras.

/// Depth range of a clip space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum DepthConvention {
    /// Near is 0, far is 1 (wgpu, Direct3D, Vulkan, Metal).
    #[default]
    ZeroToOne,
    /// Near is 1, far is 0: the same range reversed, for float precision.
    Reversed,
    /// Near is -1, far is 1 (OpenGL).
    NegativeOneToOne,
}

impl DepthConvention {
    /// Clip depth (after the division by w) of the near plane.
    pub const fn near(self) -> f32 {
        match self {
            Self::ZeroToOne => 0.0,
            Self::Reversed => 1.0,
            Self::NegativeOneToOne => -1.0,
        }
    }

    /// Clip depth (after the division by w) of the far plane.
    pub const fn far(self) -> f32 {
        match self {
            Self::ZeroToOne | Self::NegativeOneToOne => 1.0,
            Self::Reversed => 0.0,
        }
    }
}
