//! Why a shadow map cannot be made or prepared. Every variant carries the offending value, and its index where there
//! are several.

use core::fmt;

use shadowfit::glam::Vec3;
use shadowfit::settings::{Edges, FilterKind, MAX_MAPS, MapFormat, MapSelection, Softness};
use shadowfit::{DepthConvention, FitError};

use super::limits::RESOLUTIONS;
use super::texture_error::MapTextureError;

/// Why a [`ShadowMap`](crate::ShadowMap) could not be made or prepared.
#[derive(Clone, Debug, PartialEq)]
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
    /// A blend outside 0..=[`MapSelection::MAX_BLEND`], in texels.
    Blend(f32),
    /// A number of rays for a pixel outside 1..=[`Edges::MAX_SAMPLES`].
    Samples(u32),
    /// A depth convention that wgpu's clip space does not have.
    Depth(DepthConvention),
    /// Radii of soft filters that are not 0 ≤ floor ≤ ceiling, with a ceiling of 1 to [`Softness::MAX_RADIUS`] texels.
    Softness {
        /// [`Softness::floor`](shadowfit::settings::Softness::floor), in texels.
        floor: f32,
        /// [`Softness::ceiling`](shadowfit::settings::Softness::ceiling), in texels.
        ceiling: f32,
    },
    /// A softness that is negative or NaN, as the tangent of the sun's angular radius.
    SoftRadius(f32),
    /// View depths of a fade that do not ascend or are not finite, in metres.
    Fade([f32; 2]),
    /// A filter whose edges follow from how far casters are ([`Edges::need_distances`]) with depth clamp: a clamped caster
    /// has lost its distance.
    ///
    /// [`Edges::need_distances`]: shadowfit::settings::Edges::need_distances
    SoftDepthClamp(FilterKind),
    /// PCSS with a depth format on OpenGL, whose shaders cannot read depth as a number.
    PcssDepthLoads(MapFormat),
    /// A format that this device cannot draw to or read.
    Format {
        /// The format.
        format: MapFormat,
        /// What the device lacks.
        why: String,
    },
    /// The device has not enough memory for the maps.
    OutOfMemory {
        /// Their width and height, in texels.
        resolution: [u32; 2],
        /// Number of maps.
        maps: u32,
        /// Their format.
        format: MapFormat,
    },
    /// The texture that was handed in cannot hold the maps.
    Texture(MapTextureError),
    /// The device refused to make a resource, with its own words.
    Device(String),
    /// A prefix that no name in WGSL can begin with.
    Prefix(String),
    /// A map that wraps around beyond its layer, or that does not fill it.
    TexelOffset {
        /// Index of the map.
        index: usize,
        /// Where its first texel is to be stored, in texels.
        texel_offset: [u32; 2],
        /// Its width and height, in texels.
        fit: [u32; 2],
        /// Those of the layer.
        map: [u32; 2],
    },
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
            Self::Resolution { resolution, device_limit } => write_resolution(f, *resolution, *device_limit),
            Self::Maps(maps) => write!(f, "{maps} shadow maps: between 1 and {MAX_MAPS} are possible"),
            Self::Blend(texels) => write!(f, "blend of {texels} texels: 0 to {} are possible", MapSelection::MAX_BLEND),
            Self::Depth(depth) => {
                write!(f, "depth convention {depth:?}: wgpu's clip space has 0..1, plain or reversed")
            }
            Self::Samples(samples) => {
                write!(f, "{samples} rays for each pixel that is traced: 1 to {} are possible", Edges::MAX_SAMPLES)
            }
            Self::Softness { floor, ceiling } => write_softness(f, *floor, *ceiling),
            Self::SoftRadius(tangent) => {
                write!(f, "softness of {tangent} m of penumbra per metre: it must be a number that is not negative")
            }
            Self::Fade(fade) => write_fade(f, *fade),
            Self::SoftDepthClamp(filter) => write_depth_clamp(f, *filter),
            Self::PcssDepthLoads(format) => {
                write!(f, "PCSS with {format:?}: OpenGL's shaders cannot read depth textures as numbers; take R32Float")
            }
            Self::Format { format, why } => {
                write!(f, "this device cannot use {format:?} for shadow maps: {why}; take Depth32Float, which all have")
            }
            Self::OutOfMemory { resolution, maps, format } => write_out_of_memory(f, *resolution, *maps, *format),
            Self::Texture(error) => write!(f, "the texture for the shadow maps: {error}"),
            Self::Device(error) => write!(f, "the device cannot make the shadow map: {error}"),
            Self::Prefix(prefix) => write_prefix(f, prefix),
            Self::TexelOffset { index, texel_offset, fit, map } => {
                write_texel_offset(f, *index, *texel_offset, [*fit, *map])
            }
            Self::Fit { index, fit, map } => write_fit(f, *index, *fit, *map),
            Self::TooManyFits { fits, layers } => write_too_many(f, *fits, *layers),
            Self::Order { index, far, previous } => write_order(f, *index, *far, *previous),
            Self::Bias { index, error } => write!(f, "map {index}: {error}"),
            Self::View(error) => write!(f, "what the maps are read from: {error}"),
            Self::Forward { forward, length } => {
                write!(f, "the view's forward direction {forward} has length {length}: normalise it")
            }
        }
    }
}

impl core::error::Error for ShadowMapError {}

fn write_depth_clamp(f: &mut fmt::Formatter<'_>, filter: FilterKind) -> fmt::Result {
    let (what, or_else) = if filter == FilterKind::Pcss {
        ("PCSS".to_owned(), "another filter")
    } else {
        (format!("{filter:?} whose edges are traced"), "one that is not soft, or filtered edges")
    };
    write!(
        f,
        "{what} with depth clamp: casters before the near plane have lost their distance; let the fit place its near plane \
         by another caster policy, or take {or_else}"
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
        "soft filters of {floor} to {ceiling} texels: the floor must be 0 to the ceiling, and that 1 to {}",
        Softness::MAX_RADIUS
    )
}

fn write_fade(f: &mut fmt::Formatter<'_>, [near, far]: [f32; 2]) -> fmt::Result {
    write!(f, "shadows that fade from view depth {near} m to {far} m: both must be finite, the nearer first")
}

fn write_out_of_memory(
    f: &mut fmt::Formatter<'_>,
    [width, height]: [u32; 2],
    maps: u32,
    format: MapFormat,
) -> fmt::Result {
    write!(
        f,
        "the device is out of memory for {maps} maps of {width} × {height} texels in {format:?}: take fewer, smaller or \
         coarser ones"
    )
}

fn write_prefix(f: &mut fmt::Formatter<'_>, prefix: &str) -> fmt::Result {
    write!(f, "names in WGSL cannot begin with {prefix:?}: take ASCII letters, digits and underscores, a letter first")
}

fn write_texel_offset(
    f: &mut fmt::Formatter<'_>,
    index: usize,
    texel_offset: [u32; 2],
    [fit, map]: [[u32; 2]; 2],
) -> fmt::Result {
    write!(
        f,
        "map {index} of {fit:?} texels is to begin at {texel_offset:?} in a layer of {map:?}: only a map that fills its layer \
         wraps around, and it begins inside"
    )
}

type Kind = ([u32; 2], DepthConvention);

fn write_fit(f: &mut fmt::Formatter<'_>, index: usize, fit: Kind, map: Kind) -> fmt::Result {
    write!(
        f,
        "fit {index} was made for {:?} texels and depth {:?}, the shadow map has {:?} and {:?}: give both the same \
         depth, and the map no fewer texels",
        fit.0, fit.1, map.0, map.1,
    )
}

fn write_too_many(f: &mut fmt::Formatter<'_>, fits: usize, layers: usize) -> fmt::Result {
    write!(
        f,
        "fits given: {fits}, layers of the shadow map: {layers}; make the shadow map with as many maps as there are fits"
    )
}

fn write_order(f: &mut fmt::Formatter<'_>, index: usize, far: f32, previous: f32) -> fmt::Result {
    write!(
        f,
        "map {index} ends at view depth {far} m, the one in front of it at {previous} m: sort the maps by their far, \
         nearest first"
    )
}
