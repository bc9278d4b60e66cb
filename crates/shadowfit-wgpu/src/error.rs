//! Why a shadow map cannot be made or prepared. Every variant carries the offending value, and its index where there
//! are several.

use core::fmt;

use shadowfit::glam::Vec3;
use shadowfit::settings::MAX_BLEND;
use shadowfit::{DepthConvention, FitError};

use crate::{MAX_MAPS, RESOLUTIONS};

/// Why a [`ShadowMap`](crate::ShadowMap) could not be made or prepared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShadowMapError {
    /// Width or height outside [`RESOLUTIONS`] or above the device's limit, which is given.
    Resolution {
        /// The resolution asked for, in texels.
        resolution: [u32; 2],
        /// The device's greatest texture width and height, in texels.
        device_limit: u32,
    },
    /// Number of maps outside 1..=[`MAX_MAPS`].
    Maps(u32),
    /// A blend outside 0..=[`MAX_BLEND`], in texels.
    Blend(f32),
    /// A depth convention that wgpu's clip space does not have.
    Depth(DepthConvention),
    /// Depth clamp on a device without [`wgpu::Features::DEPTH_CLIP_CONTROL`].
    DepthClamp,
    /// A fit has more texels than a layer, or another depth convention: biases and comparisons
    /// would be wrong.
    Fit {
        /// Index of the fit.
        index: usize,
        /// Its resolution, in texels, and depth convention.
        fit: ([u32; 2], DepthConvention),
        /// Those of the layers.
        map: ([u32; 2], DepthConvention),
    },
    /// More fits than layers: the farther ones could not be drawn.
    TooManyFits {
        /// Number of fits.
        fits: usize,
        /// Number of layers.
        layers: usize,
    },
    /// The ends of maps that are read by view depth do not ascend, or one of them is NaN: points would read the wrong
    /// map.
    Order {
        /// Index of the first map that ends before the one in front of it.
        index: usize,
        /// View depth at which it ends, in metres.
        far: f32,
        /// View depth at which the map in front of it ends, in metres; `f32::MIN` for the first one.
        previous: f32,
    },
    /// A bias is NaN or infinite.
    Bias {
        /// Index of the map.
        index: usize,
        /// Which of its biases, and the value.
        error: FitError,
    },
    /// A view makes no sense.
    View(FitError),
    /// The view's forward direction is not of unit length, to a thousandth: view depths would be scaled by it.
    Forward {
        /// The direction.
        forward: Vec3,
        /// Its length.
        length: f32,
    },
}

impl fmt::Display for ShadowMapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Resolution { resolution: [width, height], device_limit } => write!(
                f,
                "shadow map of {width} × {height} texels: each side must be {} to {} texels, and this device allows \
                 at most {device_limit}",
                RESOLUTIONS.start(),
                RESOLUTIONS.end(),
            ),
            Self::Maps(maps) => write!(f, "{maps} shadow maps: between 1 and {MAX_MAPS} are possible"),
            Self::Blend(texels) => write!(f, "blend of {texels} texels: 0 to {MAX_BLEND} are possible"),
            Self::Depth(depth) => {
                write!(f, "depth convention {depth:?}: wgpu's clip space has 0..1, plain or reversed")
            }
            Self::DepthClamp => write!(
                f,
                "depth clamp: this device has no DEPTH_CLIP_CONTROL; let the fit place its near plane by another caster \
                 policy"
            ),
            Self::Fit { index, fit, map } => write!(
                f,
                "fit {index} was made for {:?} texels and depth {:?}, the shadow map has {:?} and {:?}: give both the \
                 same depth, and the map no fewer texels",
                fit.0, fit.1, map.0, map.1,
            ),
            Self::TooManyFits { fits, layers } => write!(
                f,
                "fits given: {fits}, layers of the shadow map: {layers}; make the shadow map with as many maps as there \
                 are fits"
            ),
            Self::Order { index, far, previous } => write!(
                f,
                "map {index} ends at view depth {far} m, the one in front of it at {previous} m: sort the maps by their \
                 far, nearest first"
            ),
            Self::Bias { index, error } => write!(f, "map {index}: {error}"),
            Self::View(error) => write!(f, "what the maps are read from: {error}"),
            Self::Forward { forward, length } => {
                write!(f, "the view's forward direction {forward} has length {length}: normalise it")
            }
        }
    }
}

impl core::error::Error for ShadowMapError {}
