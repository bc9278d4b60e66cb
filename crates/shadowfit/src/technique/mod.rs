//! Everything that decides how a sun's shadows look, as one plain type.
//!
//! [`Technique::default`] is the one to begin with; [`PRESETS`](crate::PRESETS) has others by name.

use crate::technique::setters::setters;
use crate::technique::settings::{BiasSettings, Edges, FilterKind, MapFormat, MapSettings, Softness};
use glam::UVec2;

mod filter;
mod maps;
mod presets;
mod setters;
pub mod settings;

pub use maps::{Cascades, Maps, SingleMap, Windows};
pub use presets::{PRESETS, Preset};

/// How shadows are made: the maps and their fit, the filter and the bias that read them, their
/// format.
///
/// ```
/// use shadowfit::settings::FilterKind;
/// use shadowfit::Technique;
///
/// let technique = Technique::preset("stable-4").unwrap().with_filter(FilterKind::Pcf3x3);
/// assert_eq!((technique.maps.count(), technique.border()), (4, 2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Technique {
    /// The kind of the maps, their number, and what only that kind has. Default: [`Maps::Windows`].
    pub maps: Maps,
    /// What all maps share, whatever their kind. Default: [`MapSettings::default`].
    pub fit: MapSettings,
    /// Filter of the look-up. Default: [`FilterKind::Pcf5x5`]. Some [need](Edges::need_distances) maps that keep the
    /// distances of casters: not [`CasterPolicy::DepthClamp`](crate::settings::CasterPolicy::DepthClamp).
    pub filter: FilterKind,
    /// Width of the filters that are [soft](FilterKind::is_soft); the others ignore it. It also says how fine
    /// texels may be ([`Self::least_texel`]). Default: [`Softness::default`].
    pub softness: Softness,
    /// Share of the shadow distance over which shadows fade out toward its end, 0..=1: 0.1 begins at nine tenths
    /// of it. It is ignored where [`MapSettings::max_distance`] is `f32::MAX`. Default: 0, shadows end at once.
    pub fade: f32,
    /// Biases of the look-up. Default: [`BiasSettings::automatic`] for the default filter.
    pub bias: BiasSettings,
    /// Storage of the maps. Default: [`MapFormat::Depth32Float`].
    pub format: MapFormat,
    /// Whether edges are the filter's, or traced where the maps are not sure. Default: [`Edges::Filtered`].
    pub edges: Edges,
}

impl Default for Technique {
    /// The preset `windows-4`: the best all round.
    fn default() -> Self {
        Self {
            maps: Maps::default(),
            fit: MapSettings::default(),
            filter: FilterKind::default(),
            softness: Softness::default(),
            fade: 0.0,
            bias: BiasSettings::default(),
            format: MapFormat::default(),
            edges: Edges::default(),
        }
    }
}

setters!(Technique {
    with_fit fit: MapSettings,
    with_format format: MapFormat,
    with_softness softness: Softness,
    with_fade fade: f32,
    with_edges edges: Edges,
});

impl Technique {
    /// This technique with other maps: [`Windows`], [`Cascades`] or [`SingleMap`].
    #[must_use]
    pub fn with_maps(mut self, maps: impl Into<Maps>) -> Self {
        self.maps = maps.into();
        self
    }

    /// This technique with another number of maps; cascades that become one are [one map](SingleMap), and the
    /// other way round.
    #[must_use]
    pub fn with_count(mut self, count: u32) -> Self {
        self.maps = self.maps.with_count(count);
        self
    }

    /// This technique with another filter, and the [automatic bias](BiasSettings::automatic) that it
    /// needs.
    #[must_use]
    pub fn with_filter(self, filter: FilterKind) -> Self {
        self.with_look_up(filter, BiasSettings::automatic(filter))
    }

    /// This technique with another filter and bias.
    #[must_use]
    pub const fn with_look_up(mut self, filter: FilterKind, bias: BiasSettings) -> Self {
        (self.filter, self.bias) = (filter, bias);
        self
    }

    /// This technique with maps of another width and height, in texels.
    #[must_use]
    pub const fn with_resolution(mut self, width: u32, height: u32) -> Self {
        self.fit.resolution = UVec2::new(width, height);
        self
    }

    /// This technique with shadows that end at another view depth, in metres; `f32::MAX` is as far
    /// as the camera sees.
    #[must_use]
    pub const fn with_max_distance(mut self, metres: f32) -> Self {
        self.fit.max_distance = metres;
        self
    }

    /// This technique with the lengths of another one, in metres: how far shadows reach
    /// ([`MapSettings::max_distance`]) and how far toward the light casters count
    /// ([`MapSettings::caster_extension`]). They suit a scene, so that another technique for the same scene keeps them.
    #[must_use]
    pub const fn with_lengths_of(mut self, other: &Self) -> Self {
        (self.fit.max_distance, self.fit.caster_extension) = (other.fit.max_distance, other.fit.caster_extension);
        self
    }

    /// Free texels at the border of each map: [`MapSettings::border`] where it is set, else what the
    /// filter and the normal offset can reach.
    pub const fn border(&self) -> f32 {
        match self.fit.border {
            Some(texels) => texels,
            // The looked-up point moves across the light by the offset at most.
            None => self.filter_radius() + self.bias.normal_offset,
        }
    }

    /// Greatest reach of the filter per axis, in texels, in any map: of a soft filter that of one look-up and the
    /// [ceiling](Softness::ceiling) of its disc. The border and the choice by coverage go by it, so that they do not
    /// change with the texels of a map.
    pub const fn filter_radius(&self) -> f32 {
        self.softness.filter_radius(self.filter)
    }

    /// Least width of a texel, in metres; 0 for no limit. It is [`MapSettings::least_texel`], or more where a
    /// [soft](FilterKind::is_soft) filter would reach over more texels than its [ceiling](Softness::ceiling). Where edges
    /// are [traced](Edges::Traced), rays make the penumbra, and texels may be as fine as they like.
    /// Each map's fit but [`FitKind::XnaSample`](settings::FitKind::XnaSample) respects it.
    pub fn least_texel(&self) -> f32 {
        let soft = if self.edges.are_traced() { 0.0 } else { self.softness.least_texel(self.filter) };
        self.fit.least_texel.max(soft)
    }

    /// Whether more may read a map than the receivers that it is made for: those of other view depths, or of
    /// later frames.
    pub(crate) const fn shares_maps(&self) -> bool {
        self.maps.selection().is_by_coverage() && (self.maps.count() > 1 || self.maps.are_kept())
    }
}
