//! The parts that a [`Technique`](crate::Technique) is made of.
//!
//! Every field is public, has a default, and a row in the table of the crate `shadowfit-params`, from which
//! panels, command lines and saved files are made. Lengths are metres, sizes of maps and biases are texels, view
//! depths are counted from the eye along the camera's forward direction.
//!
//! Defaults are those of the [recommended technique](crate::Preset::RECOMMENDED). Where other
//! engines have a default for the same number it is theirs; the rest comes from the measurements in
//! the repository's `docs/BENCHMARKS.md`.

use glam::{UVec2, Vec3};

use crate::base::{DepthConvention, FitError, checks};
use crate::technique::setters::setters;

pub use super::filter::{FilterKind, SoftRadius, Softness};

/// Which rule fits a shadow map to the camera frustum, or to its slice of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum FitKind {
    /// The XNA Shadow Mapping sample's `CreateLightViewProjectionMatrix` (Microsoft, 2008),
    /// reproduced exactly: tight across the light, twice the depth that is needed, no caster
    /// policy.
    XnaSample,
    /// Axis-aligned box of the camera frustum in the light's axes, with tight depth and the near
    /// plane placed by [`MapSettings::casters`].
    FrustumAabb,
    /// Least rectangle of the camera frustum as seen from the light, turned about it as
    /// [`Shape::rectangle`] says. The tightest fit without knowledge of the scene.
    Oriented,
    /// Minimal enclosing sphere of the camera frustum, on a grid of whole texels that is fixed to
    /// the world: shadow edges do not crawl when the camera moves or turns.
    Sphere,
    /// Least rectangle of what the camera can see of the receivers' boxes, turned as
    /// [`Shape::rectangle`] says. Without boxes it is [`Self::Oriented`]. The default.
    #[default]
    Focused,
}

/// Which rectangle [`FitKind::Oriented`] and [`FitKind::Focused`] put around what they cover.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum RectangleKind {
    /// Along the light's own axes, never turned.
    AxisAligned,
    /// Of least area. The default.
    #[default]
    MinimumArea,
    /// The one with the least longer side, made square: square texels on a square map.
    MinimumSquare,
}

/// Where the near plane stands, so that casters between the light and the receivers are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum CasterPolicy {
    /// At the covered region: casters before it are lost, as in the sample.
    None,
    /// Moved toward the light by [`MapSettings::caster_extension`].
    Extend,
    /// At the one box around all casters, clipped to the volume that can cast shadows into view;
    /// as [`Self::Extend`] where the casters are not known.
    SceneBounds,
    /// At the first caster that can cast a shadow into view: each box is clipped to that volume.
    /// As [`Self::Extend`] where the casters are not known. The default.
    #[default]
    PerObject,
    /// At the covered region, with the pipeline's depth clamp keeping casters before it
    /// ("pancaking"). Culling still uses the unclamped volume, and filters cannot use the distance
    /// to a clamped caster.
    DepthClamp,
}

/// The shape of a map across the light: the rule that fits it to what it covers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Shape {
    /// The rule of the fit. Default: [`FitKind::Focused`].
    pub kind: FitKind,
    /// Rectangle of the fits that may turn. Default: [`RectangleKind::MinimumArea`].
    pub rectangle: RectangleKind,
    /// Greatest ratio of a texel's longer side to its shorter one, 1 or more: long texels make blur
    /// depend on its direction. The rectangle is chosen, and widened, to keep within it.
    /// [`FitKind::XnaSample`] ignores it. Default: `f32::MAX`, no limit.
    pub max_texel_ratio: f32,
}

impl Default for Shape {
    fn default() -> Self {
        Self::new(FitKind::Focused)
    }
}

impl Shape {
    /// The shape of a rule, with the defaults of the rest.
    pub const fn new(kind: FitKind) -> Self {
        Self { kind, rectangle: RectangleKind::MinimumArea, max_texel_ratio: f32::MAX }
    }
}

/// What all maps of a technique share, whatever their kind: how far they reach, which casters they keep, how large
/// they are. The defaults are those of the [recommended technique](crate::Technique).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct MapSettings {
    /// Shadows end at this view depth, in metres; at the camera's far plane when that is nearer.
    /// Default: `f32::MAX`, which is always the far plane.
    pub max_distance: f32,
    /// Enlarges the light's box on all six sides, in metres: the sample's own imperfect remedy for
    /// clipped casters. Default: 0.
    pub margin: f32,
    /// Free texels between the covered region and the map's border, for the filter to read.
    /// Default: `None`, which takes what the technique's filter and bias need
    /// ([`Technique::border`]); a fit without a technique takes what the default filter needs.
    /// [`FitKind::XnaSample`] ignores it.
    ///
    /// [`Technique::border`]: crate::Technique::border
    pub border: Option<f32>,
    /// What places the near plane. [`FitKind::XnaSample`] ignores it: the sample has none. Default:
    /// [`CasterPolicy::PerObject`].
    pub casters: CasterPolicy,
    /// How far [`CasterPolicy::Extend`] moves the near plane toward the light, in metres. Default:
    /// 50, which holds most buildings. It also stands in where the casters are not known.
    pub caster_extension: f32,
    /// Up direction in world axes, which sets the map's roll; its length is ignored. Default: +y.
    pub up: Vec3,
    /// Least width of a texel, in metres; 0 for no limit. A map that would have finer ones is made larger, around its
    /// middle. [`FitKind::XnaSample`] ignores it; a soft filter may ask for more
    /// ([`Technique::least_texel`](crate::Technique::least_texel)). Default: 0.
    pub least_texel: f32,
    /// Width and height of the map, in texels. Default: 2048 × 2048, as Bevy and the cascades of
    /// three.js have it.
    pub resolution: UVec2,
    /// Depth convention of the fitted clip space. Default: [`DepthConvention::ZeroToOne`].
    pub depth: DepthConvention,
}

impl Default for MapSettings {
    fn default() -> Self {
        Self {
            max_distance: f32::MAX,
            margin: 0.0,
            border: None,
            casters: CasterPolicy::PerObject,
            caster_extension: 50.0,
            up: Vec3::Y,
            least_texel: 0.0,
            resolution: UVec2::splat(2048),
            depth: DepthConvention::ZeroToOne,
        }
    }
}

impl MapSettings {
    /// These settings with this number of [free texels](Self::border) at the map's border, for any
    /// filter and bias.
    #[must_use]
    pub const fn with_border(mut self, texels: f32) -> Self {
        self.border = Some(texels);
        self
    }
}

/// How a [single map](crate::fit) is fitted without a technique.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct FitSettings {
    /// Its shape across the light.
    pub shape: Shape,
    /// All that does not depend on the shape.
    pub map: MapSettings,
}

impl FitSettings {
    /// These settings with this number of [free texels](MapSettings::border) at the map's border.
    #[must_use]
    pub const fn with_border(mut self, texels: f32) -> Self {
        self.map.border = Some(texels);
        self
    }
}

/// Most maps that share a view.
pub const MAX_MAPS: usize = 8;

/// Where one map ends and the next begins, in view depth.
///
/// Where the receivers' boxes are known, all schemes but the manual one distribute the maps over
/// the depths at which receivers are in view, instead of over the whole frustum.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum SplitScheme {
    /// Ranges of equal length, over everything in view or between the [bounds of what is
    /// visible](crate::FitInput::depth_bounds) if those are known. The next two schemes use the same
    /// interval.
    Uniform,
    /// Ranges of equal ratio of far to near depth, which suits perspective. Most maps are then
    /// close to the eye.
    Logarithmic,
    /// Between both: λ, 0..=1, is the share of the logarithmic splits, the rest is that of the
    /// uniform ones (F. Zhang, H. Sun, L. Xu, L. K. Lun, "Parallel-split shadow maps for large-scale
    /// virtual environments", 2006). 0.5 is the default of three.js and Babylon.js.
    Practical(f32),
    /// View depths in metres at which the maps end, ascending; the last map ends with the shadows.
    Manual([f32; MAX_MAPS - 1]),
    /// The splits with the least 95% quantile of pixels per texel, with visibility estimated from
    /// the receivers' boxes.
    FromBoxes,
    /// The same, with visibility from the engine's [histogram](crate::FitInput::histogram) of
    /// visible depths; without a histogram as [`Self::FromBoxes`]. The default.
    #[default]
    FromHistogram,
}

/// Which of several maps a point reads; [`crate::selection`] has the rule.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum MapSelection {
    /// The finest one that holds the point with all that the filter reads around it, whatever the
    /// point's view depth. The default, with [`Self::DEFAULT_BLEND`].
    Coverage {
        /// Texels over which a map is blended into the next coarser one, inward from the filter's reach to its border,
        /// 0..=[`Self::MAX_BLEND`]; 0 for none.
        blend: f32,
    },
    /// The one in whose range of view depths the point lies, blended into the next one where ranges
    /// overlap, as other engines do.
    ViewDepth {
        /// Share of a map's range of view depths that the next map covers too, 0..=1.
        overlap: f32,
    },
}

impl Default for MapSelection {
    fn default() -> Self {
        Self::Coverage { blend: Self::DEFAULT_BLEND }
    }
}

impl MapSelection {
    /// Texels over which maps are blended by default.
    pub const DEFAULT_BLEND: f32 = 8.0;

    /// Most texels over which maps that are read by coverage may be blended: a quarter of the side of the
    /// smallest map that tools allow, 256.
    pub const MAX_BLEND: f32 = 64.0;

    /// Texels over which a map is blended into the next coarser one by coverage; 0 by view depth.
    pub const fn blend(self) -> f32 {
        match self {
            Self::Coverage { blend } => blend,
            Self::ViewDepth { .. } => 0.0,
        }
    }

    /// Whether points read by [`Self::Coverage`].
    pub const fn is_by_coverage(self) -> bool {
        matches!(self, Self::Coverage { .. })
    }
}

/// Whether and how maps are kept from changing while the camera moves.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Stabilise {
    /// Every frame is fitted anew: the finest texels, and shadow edges that crawl.
    Off,
    /// Extents are rounded up to eighths of an octave and the map moves by whole texels of a grid
    /// that is fixed to the world. With [`FitKind::Sphere`] edges do not move at all; other fits
    /// still change when the camera turns.
    Snap {
        /// Splits and depth ranges are kept until they are larger than necessary by this factor, 1..=100.
        max_oversize: f32,
    },
    /// A map is kept, its angle included, and moved by whole texels as long as it covers what it
    /// must and wastes no more than [`Hysteresis::max_oversize`]. A new map is made large enough for the
    /// predicted motion. The default.
    Hysteresis(Hysteresis),
}

impl Default for Stabilise {
    fn default() -> Self {
        Self::Hysteresis(Hysteresis::default())
    }
}

impl Stabilise {
    /// How many times larger than necessary something that is kept may become.
    pub const fn max_oversize(self) -> f32 {
        match self {
            // Nothing but the depth range of a sphere, which lies on the world's grid.
            Self::Off => DEFAULT_WASTE,
            Self::Snap { max_oversize } => max_oversize,
            Self::Hysteresis(hysteresis) => hysteresis.max_oversize,
        }
    }
}

/// When [`Stabilise::Hysteresis`] keeps a map and how much room a new one gets.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Hysteresis {
    /// Room left around what a new map must cover, as a share of its extent, 0..=10. Default: 0.02.
    pub margin: f32,
    /// A new map also covers what the camera will see if it goes on moving as it did, for as many
    /// frames as make the map wider by at most this factor, 1..=100. Default: 1.4.
    pub max_growth: f32,
    /// A map is made anew when its texels are larger than necessary by this factor, 1..=100; held
    /// splits are chosen anew by the same rule. Default: 1.8.
    pub max_oversize: f32,
    /// Greatest number of frames to look ahead. Default: 32.
    pub look_ahead: u32,
}

impl Default for Hysteresis {
    fn default() -> Self {
        Self { margin: 0.02, max_growth: 1.4, max_oversize: DEFAULT_WASTE, look_ahead: 32 }
    }
}

/// How many times larger than necessary something that is kept may become, by default.
pub(crate) const DEFAULT_WASTE: f32 = 1.8;

/// Biases that keep a surface from shadowing itself, in texels of the map.
///
/// They are converted to depth and metres in one place, [`crate::bias`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct BiasSettings {
    /// Depth bias that does not depend on the slope, in texel sizes along the light. Default: 1/32, for inexact
    /// surface normals.
    pub constant: f32,
    /// Depth bias times the tangent of the angle between the surface normal and the light, in
    /// texel sizes. Default: 0.
    pub slope: f32,
    /// Offset of the sampled point along the geometric normal times the sine of that angle, in
    /// texel sizes. Default: 0.
    pub normal_offset: f32,
    /// Receiver-plane bias: each comparison of the filter is made with the depth of the receiver's
    /// own plane where it reads, moved toward the light by the plane's height change over this many
    /// texels (J. Isidoro, "Shadow mapping: GPU-based tips and techniques", 2006). The reach of one
    /// comparison clears a plane: 0.5 for a single texel, 1 for the hardware's 2×2 and all filters
    /// built from it. 0 turns it off. Default: 1 + 1/256; the fraction covers the hardware's
    /// rounding of positions in the map.
    pub receiver_plane: f32,
    /// Bias in roundings, 0..=16. One covers a [step](crate::diagnostics::depth_step) of the map's format, and the
    /// rounding of f32 positions: [`Self::constant`] is raised to it, and the other biases, unless they are 0, grow by
    /// it. Default: 1.
    pub depth_steps: f32,
}

impl BiasSettings {
    /// Greatest [`Self::depth_steps`].
    pub const MAX_DEPTH_STEPS: f32 = 16.0;
}

impl Default for BiasSettings {
    /// [`Self::automatic`] for the default filter.
    fn default() -> Self {
        Self::automatic(FilterKind::default())
    }
}

/// Texture format that stores the depths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum MapFormat {
    /// 32-bit float depth attachment, compared by the sampler. The default.
    #[default]
    Depth32Float,
    /// 16-bit depth attachment, compared by the sampler: half the memory, and steps of 1/65,535 of the
    /// map's depth range.
    Depth16Unorm,
    /// One 32-bit float colour channel with a depth buffer of its own, compared by hand (the XNA
    /// sample's form).
    R32Float,
    /// The same with a 16-bit float, of 11 significant bits: the sample's second choice.
    R16Float,
    /// The bits of a 32-bit float in the four channels of an 8-bit colour: the sample's third choice. It
    /// comes back bit for bit.
    Rgba8Packed,
    /// Depth as one 8-bit grey: 256 steps over the map's depth range, to show why that is too coarse.
    R8Grey,
}

impl MapFormat {
    /// All formats, depth attachments first.
    pub const ALL: [Self; 6] =
        [Self::Depth32Float, Self::Depth16Unorm, Self::R32Float, Self::R16Float, Self::Rgba8Packed, Self::R8Grey];

    /// Whether it is a depth attachment, which samplers compare; others are colours, compared by hand.
    pub const fn is_depth(self) -> bool {
        matches!(self, Self::Depth32Float | Self::Depth16Unorm)
    }
}

/// How the edges of shadows come out: by the maps alone, or exact, by rays where the maps are not sure.
///
/// Rays need the triangles of what casts, and a depth buffer before the picture is shaded: of `shadowfit-wgpu` the
/// feature `rays`. Whoever reads the maps without that gets filtered edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Edges {
    /// The filter's factor everywhere. The default.
    #[default]
    Filtered,
    /// Where all texels that the filter reads agree, they decide; elsewhere rays do. Soft filters trace the disc of the
    /// sun by [their softness](Softness), others its centre.
    Traced {
        /// Rays toward the light for each pixel that is not sure, 1..=[`Self::MAX_SAMPLES`]: from as many points of the
        /// pixel, and toward as many of a sun that is not a point. With one ray edges are exact and jagged, with four
        /// they are smooth.
        samples: u32,
    },
}

impl Edges {
    /// Rays for a pixel of the preset `exact-4`, and where a tool turns tracing on: the fewest with smooth edges.
    pub const USUAL_SAMPLES: u32 = 4;

    /// Most rays for a pixel.
    pub const MAX_SAMPLES: u32 = 64;

    /// Rays for each pixel that is not sure; 0 where edges are filtered.
    pub const fn samples(self) -> u32 {
        match self {
            Self::Filtered => 0,
            Self::Traced { samples } => samples,
        }
    }

    /// Whether rays are traced.
    pub const fn are_traced(self) -> bool {
        matches!(self, Self::Traced { .. })
    }

    /// Whether the edges of a filter follow from how far casters are, which maps lose that are clamped
    /// ([`CasterPolicy::DepthClamp`]): those of [`FilterKind::Pcss`], and those of any [soft](FilterKind::is_soft) filter
    /// where they are traced.
    pub const fn need_distances(self, filter: FilterKind) -> bool {
        matches!(filter, FilterKind::Pcss) || (filter.is_soft() && self.are_traced())
    }

    /// Refuses a number of rays that is out of range.
    pub(crate) fn checked(self) -> Result<Self, FitError> {
        if let Self::Traced { samples } = self {
            checks::within("the rays of a pixel", f64::from(samples), 1.0, f64::from(Self::MAX_SAMPLES))?;
        }
        Ok(self)
    }
}

setters!(Shape {
    with_kind kind: FitKind,
    with_rectangle rectangle: RectangleKind,
    with_max_texel_ratio max_texel_ratio: f32,
});

setters!(MapSettings {
    with_max_distance max_distance: f32,
    with_margin margin: f32,
    with_casters casters: CasterPolicy,
    with_up up: Vec3,
    with_caster_extension caster_extension: f32,
    with_least_texel least_texel: f32,
    with_resolution resolution: UVec2,
    with_depth depth: DepthConvention,
});

setters!(FitSettings {
    with_shape shape: Shape,
    with_map map: MapSettings,
});

setters!(FitSettings.shape {
    with_kind kind: FitKind,
    with_rectangle rectangle: RectangleKind,
    with_max_texel_ratio max_texel_ratio: f32,
});

setters!(FitSettings.map {
    with_max_distance max_distance: f32,
    with_margin margin: f32,
    with_casters casters: CasterPolicy,
    with_up up: Vec3,
    with_caster_extension caster_extension: f32,
    with_least_texel least_texel: f32,
    with_resolution resolution: UVec2,
    with_depth depth: DepthConvention,
});

setters!(Hysteresis {
    with_margin margin: f32,
    with_max_growth max_growth: f32,
    with_max_oversize max_oversize: f32,
    with_look_ahead look_ahead: u32,
});

setters!(BiasSettings {
    with_constant constant: f32,
    with_slope slope: f32,
    with_normal_offset normal_offset: f32,
    with_receiver_plane receiver_plane: f32,
    with_depth_steps depth_steps: f32,
});
