//! The parts of a [`Technique`](crate::Technique).
//!
//! Every field is public, has a default, and has a row in the table of the crate `shadowfit-params`. Panels,
//! command lines and saved files are made from that table. Lengths are in metres, map sizes and biases in
//! texels. View depths are counted from the eye along the camera's forward direction.
//!
//! The defaults make the [recommended technique](crate::Preset::RECOMMENDED). If other engines have a default
//! for the same number, we use theirs. All other defaults come from the measurements in the repository's
//! `docs/BENCHMARKS.md`.

use glam::{UVec2, Vec3};

use crate::base::{DepthConvention, FitError, checks};
use crate::technique::setters::setters;

pub use super::filter::{FilterKind, SoftRadius, Softness};

/// Rule that fits a shadow map to the camera frustum or to a slice of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum FitKind {
    /// The XNA Shadow Mapping sample's `CreateLightViewProjectionMatrix` (Microsoft, 2008), reproduced
    /// exactly. It is tight across the light, has twice the necessary depth, and has no caster policy.
    XnaSample,
    /// Axis-aligned box of the camera frustum in the light's axes, tight along the light too.
    /// [`MapSettings::casters`] places the near plane.
    FrustumAabb,
    /// Smallest rectangle around the camera frustum as seen from the light, turned as set by
    /// [`Shape::rectangle`]. It is the tightest fit without knowledge of the scene.
    Oriented,
    /// Minimal enclosing sphere of the camera frustum, on a fixed world grid of whole texels. Shadow edges do
    /// not crawl when the camera moves or turns.
    Sphere,
    /// Smallest rectangle around the visible parts of the receivers' boxes, turned as set by
    /// [`Shape::rectangle`]. Without boxes it equals [`Self::Oriented`]. The default.
    #[default]
    Focused,
}

/// Rectangle that [`FitKind::Oriented`] and [`FitKind::Focused`] put around the covered points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum RectangleKind {
    /// Rectangle along the light's own axes, never turned.
    AxisAligned,
    /// Rectangle of least area. The default.
    #[default]
    MinimumArea,
    /// Rectangle with the shortest longer side, made square. It gives square texels on a square map.
    MinimumSquare,
}

/// Policy that places the near plane of a map. Casters in front of the near plane, on the light's side, are
/// lost unless depth is clamped.
///
/// The *covered region* is the region that the map must cover: a slice of the view, or the receivers in it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum CasterPolicy {
    /// At the covered region. Casters in front of it are lost, as in the XNA sample.
    None,
    /// Moved from the covered region toward the light by [`MapSettings::caster_extension`].
    Extend,
    /// At the bounding box of all casters, clipped to the volume that can cast shadows into view. Equals
    /// [`Self::Extend`] if the casters are unknown.
    SceneBounds,
    /// At the first caster that can cast a shadow into view: each caster's own box is clipped to the volume
    /// that can cast shadows into view. Equals [`Self::Extend`] if the casters are unknown. The default.
    #[default]
    PerObject,
    /// At the covered region. The pipeline's depth clamp ("pancaking") keeps the casters in front of it and
    /// flattens them onto the near plane, so culling keeps them too. Filters cannot use the distance to a
    /// clamped caster.
    DepthClamp,
}

/// Shape of a map across the light: the rule that fits it to the covered region.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Shape {
    /// Fit rule. Default: [`FitKind::Focused`].
    pub kind: FitKind,
    /// Rectangle of fits that may turn. Default: [`RectangleKind::MinimumArea`].
    pub rectangle: RectangleKind,
    /// Greatest ratio of a texel's longer side to its shorter one, 1 or more. Long texels blur shadows more
    /// along one direction. The rectangle is chosen and widened to respect this limit. [`FitKind::XnaSample`]
    /// ignores it. Default: `f32::MAX`, no limit.
    pub max_texel_ratio: f32,
}

impl Default for Shape {
    fn default() -> Self {
        Self::new(FitKind::Focused)
    }
}

impl Shape {
    /// Creates the shape of a fit rule, with defaults for the rest.
    pub const fn new(kind: FitKind) -> Self {
        Self { kind, rectangle: RectangleKind::MinimumArea, max_texel_ratio: f32::MAX }
    }
}

/// Settings that maps of all kinds share: shadow distance, border, casters and resolution. The defaults make
/// the [recommended technique](crate::Technique).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct MapSettings {
    /// View depth at which shadows end, in metres. They never extend beyond the camera's far plane. Default:
    /// `f32::MAX`, which always means the far plane.
    pub max_distance: f32,
    /// Enlargement of the light's box on all six sides, in metres. It is the XNA sample's imperfect remedy
    /// for clipped casters. Default: 0.
    pub margin: f32,
    /// Free texels between the covered region and the map's border, for the filter's footprint. Default:
    /// `None`, which means the technique's filter radius plus its normal offset ([`Technique::border`]). A
    /// fit without a technique then uses the radius of the default filter. [`FitKind::XnaSample`] ignores
    /// this setting.
    ///
    /// [`Technique::border`]: crate::Technique::border
    pub border: Option<f32>,
    /// Policy that places the near plane. [`FitKind::XnaSample`] ignores it, since the sample has none.
    /// Default: [`CasterPolicy::PerObject`].
    pub casters: CasterPolicy,
    /// Distance that [`CasterPolicy::Extend`] moves the near plane toward the light, in metres.
    /// [`CasterPolicy::SceneBounds`] and [`CasterPolicy::PerObject`] also use it if the casters are unknown.
    /// Default: 50, which is more than the height of most buildings.
    pub caster_extension: f32,
    /// Up direction in world axes, of any length. It sets the map's roll, its rotation about the light's
    /// direction. Default: +y.
    pub up: Vec3,
    /// Least texel width, in metres; 0 for no limit. A map with finer texels is enlarged around its middle. A
    /// soft filter may need a greater width ([`Technique::least_texel`](crate::Technique::least_texel)).
    /// [`FitKind::XnaSample`] ignores it. Default: 0.
    pub least_texel: f32,
    /// Width and height of the map, in texels. Default: 2048 × 2048, as in Bevy and in the cascades of
    /// three.js.
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
    /// Returns these settings with this number of [free texels](Self::border) at the map's border, for any
    /// filter and bias.
    #[must_use]
    pub const fn with_border(mut self, texels: f32) -> Self {
        self.border = Some(texels);
        self
    }
}

/// Settings of a [single map](crate::fit) that is fitted without a technique.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct FitSettings {
    /// Shape of the map across the light.
    pub shape: Shape,
    /// Settings that do not depend on the shape.
    pub map: MapSettings,
}

impl FitSettings {
    /// Returns these settings with this number of [free texels](MapSettings::border) at the map's border.
    #[must_use]
    pub const fn with_border(mut self, texels: f32) -> Self {
        self.map.border = Some(texels);
        self
    }
}

/// Greatest number of maps that share a view.
pub const MAX_MAPS: usize = 8;

/// Scheme that splits the view depths among the maps.
///
/// If the receivers' boxes are known, all schemes except the manual one split only the depths at which
/// receivers are in view, instead of the whole frustum.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum SplitScheme {
    /// Ranges of equal length, over everything in view, or between the [visible depth
    /// bounds](crate::FitInput::depth_bounds) if they are known. The next two schemes use the same interval.
    Uniform,
    /// Ranges of equal ratio of far to near depth, which suits perspective. Most maps are then
    /// close to the eye.
    Logarithmic,
    /// Blend of the two schemes above: λ, 0..=1, is the share of the logarithmic splits, and 1 - λ the share
    /// of the uniform ones (F. Zhang, H. Sun, L. Xu, L. K. Lun, "Parallel-split shadow maps for large-scale
    /// virtual environments", 2006). 0.5 is the default of three.js and Babylon.js.
    Practical(f32),
    /// View depths at which the maps end, in metres, ascending. The last map ends where shadows end.
    Manual([f32; MAX_MAPS - 1]),
    /// Splits with the least 95% quantile of pixels per texel over the visible points, which are estimated
    /// from the receivers' boxes.
    FromBoxes,
    /// Splits as in [`Self::FromBoxes`], but with the visible points of the engine's
    /// [histogram](crate::FitInput::histogram), if there is one. The default.
    #[default]
    FromHistogram,
}

/// Rule that selects the map that a point reads; [`crate::selection`] explains it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum MapSelection {
    /// The finest map that covers the point and the filter's footprint around it, at any view depth. The
    /// default, with [`Self::DEFAULT_BLEND`].
    Coverage {
        /// Width of the blend into the next coarser map, in texels, 0..=[`Self::MAX_BLEND`]; 0 for none. The
        /// blend begins one filter radius inside the map's border and goes inward.
        blend: f32,
    },
    /// The map whose range of view depths holds the point, blended into the next one where ranges overlap, as
    /// in other engines.
    ViewDepth {
        /// Share of a map's range of view depths that the next map also covers, 0..=1.
        overlap: f32,
    },
}

impl Default for MapSelection {
    fn default() -> Self {
        Self::Coverage { blend: Self::DEFAULT_BLEND }
    }
}

impl MapSelection {
    /// Default width of the blend, in texels.
    pub const DEFAULT_BLEND: f32 = 8.0;

    /// Greatest width of the blend of maps that are read by coverage, in texels: a quarter of the side of the
    /// smallest map that tools allow, which has 256 texels.
    pub const MAX_BLEND: f32 = 64.0;

    /// Returns the width of the blend into the next coarser map, in texels; 0 for selection by view depth.
    pub const fn blend(self) -> f32 {
        match self {
            Self::Coverage { blend } => blend,
            Self::ViewDepth { .. } => 0.0,
        }
    }

    /// Returns whether points select maps by [`Self::Coverage`].
    pub const fn is_by_coverage(self) -> bool {
        matches!(self, Self::Coverage { .. })
    }
}

/// Method that keeps maps from changing while the camera moves.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Stabilise {
    /// No stabilisation: every frame is fitted from scratch. Texels are finest, but shadow edges crawl.
    Off,
    /// Extents across the light are rounded up to 2^(k/8) m, eighths of an octave, and the map moves by whole
    /// texels of a fixed world grid. With [`FitKind::Sphere`] edges do not move at all. Maps of other fits
    /// still change when the camera turns.
    Snap {
        /// Greatest factor by which a held depth range may exceed the necessary length, and held splits the
        /// pixels per texel of the best splits, 1..=100.
        max_oversize: f32,
    },
    /// A map is held, including its angle, and moved by whole texels. It is replaced once it no longer covers
    /// the necessary region or exceeds [`Hysteresis::max_oversize`]. A new map is made large enough for the
    /// predicted motion of the camera. The default.
    Hysteresis(Hysteresis),
}

impl Default for Stabilise {
    fn default() -> Self {
        Self::Hysteresis(Hysteresis::default())
    }
}

impl Stabilise {
    /// Returns the greatest factor by which held sizes may exceed the necessary size.
    pub const fn max_oversize(self) -> f32 {
        match self {
            // It applies only to the depth range of a sphere, which lies on the world's grid.
            Self::Off => DEFAULT_WASTE,
            Self::Snap { max_oversize } => max_oversize,
            Self::Hysteresis(hysteresis) => hysteresis.max_oversize,
        }
    }
}

/// Settings of [`Stabilise::Hysteresis`]: how long a map is held, and how much room a new one gets.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Hysteresis {
    /// Room around the region that a new map must cover, as a share of its extent, 0..=10. Default: 0.02.
    pub margin: f32,
    /// Greatest factor by which predicted camera motion may widen a new map, 1..=100. It limits the number of
    /// frames that the map looks ahead. Default: 1.4.
    pub max_growth: f32,
    /// Greatest factor by which a held map's texels may exceed the texels of a new map, 1..=100. Held splits
    /// and depth ranges follow the same rule. Default: 1.8.
    pub max_oversize: f32,
    /// Greatest number of frames to look ahead. Default: 32.
    pub look_ahead: u32,
}

impl Default for Hysteresis {
    fn default() -> Self {
        Self { margin: 0.02, max_growth: 1.4, max_oversize: DEFAULT_WASTE, look_ahead: 32 }
    }
}

/// Default factor by which held sizes may exceed the necessary size.
pub(crate) const DEFAULT_WASTE: f32 = 1.8;

/// Biases that keep a surface from shadowing itself, in texels of the map. A depth bias of one texel moves
/// the point toward the light by the width of a texel. Texels that are not square count with their longer
/// side.
///
/// [`crate::bias`] converts them to depth and metres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct BiasSettings {
    /// Depth bias that does not depend on the slope, in texels. Default: 1/32, for inexact surface normals.
    pub constant: f32,
    /// Depth bias that is multiplied by the tangent of the angle between the surface normal and the light, in
    /// texels. Default: 0.
    pub slope: f32,
    /// Offset of the looked-up point along the geometric normal, multiplied by the sine of that angle, in
    /// texels. Default: 0.
    pub normal_offset: f32,
    /// Receiver-plane bias, in texels. Each comparison of the filter uses the depth of the receiver's own
    /// plane at the texel that it reads, moved toward the light by the plane's height change over this many
    /// texels (J. Isidoro, "Shadow mapping: GPU-based tips and techniques", 2006). To prevent self-shadowing
    /// on a plane, it must be at least the filter radius of one comparison: 0.5 for a single texel, 1 for the
    /// hardware's 2×2 and all filters built from it. 0 turns the bias off. Default: 1 + 1/256; the fraction
    /// covers the hardware's rounding of positions in the map.
    pub receiver_plane: f32,
    /// Number of roundings that the biases cover, 0..=16. The rounding of f32 positions raises
    /// [`Self::constant`] if that is smaller and not negative, and is added to the other biases that are
    /// above 0. One [step](crate::diagnostics::depth_step) of the map's format is added to the constant.
    /// Default: 1.
    pub depth_steps: f32,
}

impl BiasSettings {
    /// Greatest value of [`Self::depth_steps`].
    pub const MAX_DEPTH_STEPS: f32 = 16.0;
}

impl Default for BiasSettings {
    /// Returns [`Self::automatic`] for the default filter.
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
    /// 24-bit depth attachment, compared by the sampler, with steps of 1/16,777,215 of the map's depth range:
    /// the default of WebGL engines. In `shadowfit-wgpu` it is the format `Depth24Plus`, which some devices
    /// store as 32-bit floats.
    Depth24Unorm,
    /// 16-bit depth attachment, compared by the sampler. It needs half the memory and has steps of 1/65,535
    /// of the map's depth range.
    Depth16Unorm,
    /// One 32-bit float colour channel with a separate depth buffer, compared in the shader (the XNA sample's
    /// first choice).
    R32Float,
    /// Like [`Self::R32Float`] with a 16-bit float, of 11 significant bits: the sample's second choice.
    R16Float,
    /// A 32-bit float in the four channels of an 8-bit colour, stored without loss: the sample's third
    /// choice.
    Rgba8Packed,
    /// An 8-bit grey: 256 steps over the map's depth range, to show why that is too coarse.
    R8Grey,
}

impl MapFormat {
    /// All formats, depth attachments first.
    pub const ALL: [Self; 7] = [
        Self::Depth32Float,
        Self::Depth24Unorm,
        Self::Depth16Unorm,
        Self::R32Float,
        Self::R16Float,
        Self::Rgba8Packed,
        Self::R8Grey,
    ];

    /// Returns whether the format is a depth attachment, which samplers compare. Other formats are colours,
    /// compared in the shader.
    pub const fn is_depth(self) -> bool {
        matches!(self, Self::Depth32Float | Self::Depth24Unorm | Self::Depth16Unorm)
    }
}

/// Method that decides the pixels at shadow edges: the maps alone, or rays for exact edges.
///
/// Rays need the triangles of the casters, and a depth buffer before the picture is shaded. The feature
/// `rays` of `shadowfit-wgpu` traces them. Code that reads the maps without it gets filtered edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Edges {
    /// The filter's shadow factor everywhere. The default.
    #[default]
    Filtered,
    /// Exact edges. If all texels in the filter's footprint agree, they decide. Otherwise rays decide. With
    /// soft filters, rays go to points of the sun's disc, whose size follows from [the softness](Softness).
    /// With other filters, they go to its centre.
    Traced {
        /// Number of rays toward the light for each pixel without agreement, 1..=[`Self::MAX_SAMPLES`]. Each
        /// ray starts at a different point of the pixel and, with a soft filter, goes to a different point of
        /// the sun. With one ray edges are exact and jagged; with four they are smooth.
        samples: u32,
    },
}

impl Edges {
    /// Number of rays per pixel in the preset `exact-4`, and the value that tools set when they turn tracing
    /// on: the fewest rays with smooth edges.
    pub const USUAL_SAMPLES: u32 = 4;

    /// Greatest number of rays per pixel.
    pub const MAX_SAMPLES: u32 = 64;

    /// Returns the number of rays for each pixel without agreement; 0 for filtered edges.
    pub const fn samples(self) -> u32 {
        match self {
            Self::Filtered => 0,
            Self::Traced { samples } => samples,
        }
    }

    /// Returns whether rays are traced.
    pub const fn are_traced(self) -> bool {
        matches!(self, Self::Traced { .. })
    }

    /// Returns whether the edges depend on the distances of casters, which depth-clamped maps lose
    /// ([`CasterPolicy::DepthClamp`]). They do for [`FilterKind::Pcss`], and for any
    /// [soft](FilterKind::is_soft) filter with traced edges.
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
