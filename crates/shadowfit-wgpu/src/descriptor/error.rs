//! Errors of creating or preparing a shadow map. Each variant contains the offending value, and its index if
//! there are several.

use core::fmt;

use shadowfit::glam::Vec3;
use shadowfit::settings::{Edges, FilterKind, MAX_MAPS, MapFormat, MapSelection, Softness};
use shadowfit::{DepthConvention, FitError};

use super::limits::RESOLUTIONS;
use super::texture_error::MapTextureError;

/// The reason why a [`ShadowMap`](crate::ShadowMap) could not be created or prepared.
#[derive(Clone, Debug, PartialEq)]
pub enum ShadowMapError {
    /// Width or height is outside [`RESOLUTIONS`] or above the device's limit.
    Resolution {
        /// Requested resolution, in texels.
        resolution: [u32; 2],
        /// Maximum texture width and height of the device, in texels.
        device_limit: u32,
    },
    /// The number of maps is outside 1..=[`MAX_MAPS`].
    Maps(u32),
    /// The blend, in texels, is outside 0..=[`MapSelection::MAX_BLEND`].
    Blend(f32),
    /// The number of rays per pixel is outside 1..=[`Edges::MAX_SAMPLES`].
    Samples(u32),
    /// wgpu's clip space does not have this depth convention.
    Depth(DepthConvention),
    /// The radii of soft filters violate 0 ≤ floor ≤ ceiling, or the ceiling is outside 1 to
    /// [`Softness::MAX_RADIUS`] texels.
    Softness {
        /// [`Softness::floor`](shadowfit::settings::Softness::floor), in texels.
        floor: f32,
        /// [`Softness::ceiling`](shadowfit::settings::Softness::ceiling), in texels.
        ceiling: f32,
    },
    /// The softness, as the tangent of the sun's angular radius, is negative or not finite.
    SoftRadius(f32),
    /// The view depths of the fade, in metres, do not ascend or are not finite.
    Fade([f32; 2]),
    /// A filter that needs the distance to the caster ([`Edges::need_distances`]) is combined with depth
    /// clamp. A clamped caster has lost its distance.
    ///
    /// [`Edges::need_distances`]: shadowfit::settings::Edges::need_distances
    SoftDepthClamp(FilterKind),
    /// PCSS is combined with a depth format on OpenGL, whose shaders cannot read depth as a number.
    PcssDepthLoads(MapFormat),
    /// The device cannot draw to this format or read it.
    Format {
        /// The format.
        format: MapFormat,
        /// The missing capability of the device.
        why: String,
    },
    /// The device has not enough memory for the maps.
    OutOfMemory {
        /// Width and height of the maps, in texels.
        resolution: [u32; 2],
        /// Number of maps.
        maps: u32,
        /// Format of the maps.
        format: MapFormat,
    },
    /// The given texture cannot hold the maps.
    Texture(MapTextureError),
    /// The device refused to create a resource. Contains the device's message.
    Device(String),
    /// Names in WGSL cannot begin with this prefix.
    Prefix(String),
    /// A map that wraps around in its layer does not fill the layer, or its first texel lies outside the
    /// layer.
    TexelOffset {
        /// Index of the map.
        index: usize,
        /// Position of the map's first texel in the layer, in texels.
        texel_offset: [u32; 2],
        /// Width and height of the map, in texels.
        fit: [u32; 2],
        /// Width and height of the layer, in texels.
        map: [u32; 2],
    },
    /// A fit has more texels than a layer, or another depth convention, so that biases and comparisons would
    /// be wrong.
    Fit {
        /// Index of the fit.
        index: usize,
        /// Resolution, in texels, and depth convention of the fit.
        fit: ([u32; 2], DepthConvention),
        /// Resolution, in texels, and depth convention of the layers.
        map: ([u32; 2], DepthConvention),
    },
    /// There are more fits than layers, so that the farther ones could not be drawn.
    TooManyFits {
        /// Number of fits.
        fits: usize,
        /// Number of layers.
        layers: usize,
    },
    /// The ends of maps that are selected by view depth do not ascend, or one of them is NaN. Points would
    /// read the wrong map.
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
        /// Name and value of the bias.
        error: FitError,
    },
    /// A view is invalid.
    View(FitError),
    /// The length of the view's forward direction differs from 1 by more than 0.001. View depths would be
    /// scaled by it.
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
            Self::Resolution { resolution, device_limit } => write_resolution(f, *resolution, *device_limit),
            Self::Maps(maps) => write!(f, "{maps} shadow maps: the number must be 1 to {MAX_MAPS}"),
            Self::Blend(texels) => write!(f, "blend of {texels} texels: it must be 0 to {}", MapSelection::MAX_BLEND),
            Self::Depth(depth) => {
                write!(f, "depth convention {depth:?}: wgpu's clip space has 0..1, plain or reversed")
            }
            Self::Samples(samples) => {
                write!(f, "{samples} rays per traced pixel: the number must be 1 to {}", Edges::MAX_SAMPLES)
            }
            Self::Softness { floor, ceiling } => write_softness(f, *floor, *ceiling),
            Self::SoftRadius(tangent) => {
                write!(f, "softness of {tangent} m of penumbra per metre: it must be finite and not negative")
            }
            Self::Fade(fade) => write_fade(f, *fade),
            Self::SoftDepthClamp(filter) => write_depth_clamp(f, *filter),
            Self::PcssDepthLoads(format) => {
                write!(f, "PCSS with {format:?}: OpenGL's shaders cannot read depth textures as numbers; use R32Float")
            }
            Self::Format { format, why } => {
                write!(f, "this device cannot use {format:?} for shadow maps: {why}; use Depth32Float instead")
            }
            Self::OutOfMemory { resolution, maps, format } => write_out_of_memory(f, *resolution, *maps, *format),
            Self::Texture(error) => write!(f, "the texture for the shadow maps: {error}"),
            Self::Device(error) => write!(f, "the device cannot create the shadow map: {error}"),
            Self::Prefix(prefix) => write_prefix(f, prefix),
            Self::TexelOffset { index, texel_offset, fit, map } => {
                write_texel_offset(f, *index, *texel_offset, [*fit, *map])
            }
            Self::Fit { index, fit, map } => write_fit(f, *index, *fit, *map),
            Self::TooManyFits { fits, layers } => write_too_many(f, *fits, *layers),
            Self::Order { index, far, previous } => write_order(f, *index, *far, *previous),
            Self::Bias { index, error } => write!(f, "map {index}: {error}"),
            Self::View(error) => write!(f, "the views of the maps: {error}"),
            Self::Forward { forward, length } => {
                write!(f, "the view's forward direction {forward} has length {length}: normalise it")
            }
        }
    }
}

impl core::error::Error for ShadowMapError {}

fn write_depth_clamp(f: &mut fmt::Formatter<'_>, filter: FilterKind) -> fmt::Result {
    let (what, or_else) = if filter == FilterKind::Pcss {
        ("PCSS".to_owned(), "or another filter")
    } else {
        (format!("{filter:?} whose edges are traced"), "a filter that is not soft, or filtered edges")
    };
    write!(
        f,
        "{what} with depth clamp: casters in front of the near plane lose their distance; choose another caster \
         policy, {or_else}"
    )
}

fn write_resolution(f: &mut fmt::Formatter<'_>, [width, height]: [u32; 2], device_limit: u32) -> fmt::Result {
    let (least, greatest) = (RESOLUTIONS.start(), RESOLUTIONS.end());
    write!(
        f,
        "shadow map of {width} × {height} texels: each side must be {least} to {greatest} texels, and this device allows \
         at most {device_limit}"
    )
}

fn write_softness(f: &mut fmt::Formatter<'_>, floor: f32, ceiling: f32) -> fmt::Result {
    write!(
        f,
        "soft filters of {floor} to {ceiling} texels: the floor must be 0 to the ceiling, and the ceiling 1 to {}",
        Softness::MAX_RADIUS
    )
}

fn write_fade(f: &mut fmt::Formatter<'_>, [near, far]: [f32; 2]) -> fmt::Result {
    write!(f, "shadows that fade from view depth {near} m to {far} m: both must be finite, the nearer one first")
}

fn write_out_of_memory(
    f: &mut fmt::Formatter<'_>,
    [width, height]: [u32; 2],
    maps: u32,
    format: MapFormat,
) -> fmt::Result {
    write!(
        f,
        "the device is out of memory for {maps} maps of {width} × {height} texels in {format:?}: use fewer or \
         smaller maps, or a format with fewer bits"
    )
}

fn write_prefix(f: &mut fmt::Formatter<'_>, prefix: &str) -> fmt::Result {
    write!(f, "names in WGSL cannot begin with {prefix:?}: use ASCII letters, digits and underscores, a letter first")
}

fn write_texel_offset(
    f: &mut fmt::Formatter<'_>,
    index: usize,
    texel_offset: [u32; 2],
    [fit, map]: [[u32; 2]; 2],
) -> fmt::Result {
    write!(
        f,
        "map {index} of {fit:?} texels cannot begin at {texel_offset:?} in a layer of {map:?}: a map that wraps around \
         must fill its layer, and begin inside it"
    )
}

type Kind = ([u32; 2], DepthConvention);

fn write_fit(f: &mut fmt::Formatter<'_>, index: usize, fit: Kind, map: Kind) -> fmt::Result {
    write!(
        f,
        "fit {index} was made for {:?} texels and depth {:?}, the shadow map has {:?} and {:?}: use the same \
         depth for both, and at least as many texels for the map",
        fit.0, fit.1, map.0, map.1,
    )
}

fn write_too_many(f: &mut fmt::Formatter<'_>, fits: usize, layers: usize) -> fmt::Result {
    write!(f, "fits given: {fits}, layers of the shadow map: {layers}; create the shadow map with one map per fit")
}

fn write_order(f: &mut fmt::Formatter<'_>, index: usize, far: f32, previous: f32) -> fmt::Result {
    write!(
        f,
        "map {index} ends at view depth {far} m, the one in front of it at {previous} m: sort the maps by their ends, \
         nearest first"
    )
}
