//! Everything that decides how a sun's shadows look, as one plain type.
//!
//! Start with [`Technique::default`]; [`PRESETS`](crate::PRESETS) has others by name.

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

/// All settings of a sun's shadows: the maps, their fit and format, and the filter and bias of the look-up.
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
    /// Kind and number of the maps, with the settings of that kind. Default: [`Maps::Windows`].
    pub maps: Maps,
    /// Settings that all kinds of maps share. Default: [`MapSettings::default`].
    pub fit: MapSettings,
    /// Filter of the look-up. Default: [`FilterKind::Pcf5x5`]. Some filters [need](Edges::need_distances) the
    /// distances of casters, which [`CasterPolicy::DepthClamp`](crate::settings::CasterPolicy::DepthClamp)
    /// loses.
    pub filter: FilterKind,
    /// Width of [soft](FilterKind::is_soft) filters; other filters ignore it. It also limits how fine texels
    /// may be ([`Self::least_texel`]). Default: [`Softness::default`].
    pub softness: Softness,
    /// Share of the shadow distance over which shadows fade out toward its end, 0..=1. For example, 0.1
    /// starts the fade at nine tenths of the distance. It is ignored if [`MapSettings::max_distance`] is
    /// `f32::MAX`. Default: 0, shadows end abruptly.
    pub fade: f32,
    /// Biases of the look-up. Default: [`BiasSettings::automatic`] for the default filter.
    pub bias: BiasSettings,
    /// Texture format of the maps. Default: [`MapFormat::Depth32Float`].
    pub format: MapFormat,
    /// Filtered or exact edges. Default: [`Edges::Filtered`].
    pub edges: Edges,
}

impl Default for Technique {
    /// Returns the preset `windows-4`, the best choice for general use.
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
    /// Returns this technique with other maps: [`Windows`], [`Cascades`] or [`SingleMap`].
    #[must_use]
    pub fn with_maps(mut self, maps: impl Into<Maps>) -> Self {
        self.maps = maps.into();
        self
    }

    /// Returns this technique with another number of maps. Cascades become [one map](SingleMap) if the number
    /// is 1, and one map becomes cascades if it is greater.
    #[must_use]
    pub fn with_count(mut self, count: u32) -> Self {
        self.maps = self.maps.with_count(count);
        self
    }

    /// Returns this technique with another filter and the [automatic bias](BiasSettings::automatic) that it
    /// needs.
    #[must_use]
    pub fn with_filter(self, filter: FilterKind) -> Self {
        self.with_look_up(filter, BiasSettings::automatic(filter))
    }

    /// Returns this technique with another filter and bias.
    #[must_use]
    pub const fn with_look_up(mut self, filter: FilterKind, bias: BiasSettings) -> Self {
        (self.filter, self.bias) = (filter, bias);
        self
    }

    /// Returns this technique with maps of another width and height, in texels.
    #[must_use]
    pub const fn with_resolution(mut self, width: u32, height: u32) -> Self {
        self.fit.resolution = UVec2::new(width, height);
        self
    }

    /// Returns this technique with another shadow distance, in metres of view depth. `f32::MAX` means the
    /// camera's far plane.
    #[must_use]
    pub const fn with_max_distance(mut self, metres: f32) -> Self {
        self.fit.max_distance = metres;
        self
    }

    /// Returns this technique with the lengths of another one, in metres: the shadow distance
    /// ([`MapSettings::max_distance`]) and the distance toward the light in which casters count
    /// ([`MapSettings::caster_extension`]). These lengths depend on the scene, so all techniques for one
    /// scene can share them.
    #[must_use]
    pub const fn with_lengths_of(mut self, other: &Self) -> Self {
        (self.fit.max_distance, self.fit.caster_extension) = (other.fit.max_distance, other.fit.caster_extension);
        self
    }

    /// Returns the number of free texels at the border of each map: [`MapSettings::border`], or if that is
    /// `None`, the filter radius plus the normal offset.
    pub const fn border(&self) -> f32 {
        match self.fit.border {
            Some(texels) => texels,
            // The offset moves the looked-up point across the light by at most this much.
            None => self.filter_radius() + self.bias.normal_offset,
        }
    }

    /// Returns the greatest filter radius in any map, in texels: the greatest distance along one axis from
    /// the looked-up point to the centre of a texel that the filter reads. For a soft filter it is the radius
    /// of one look-up plus the [ceiling](Softness::ceiling) of its disc. The border and the selection by
    /// coverage use it, so they do not depend on the texel size of a map.
    pub const fn filter_radius(&self) -> f32 {
        self.softness.filter_radius(self.filter)
    }

    /// Returns the least texel width, in metres; 0 for no limit. It is [`MapSettings::least_texel`], or more
    /// if a [soft](FilterKind::is_soft) filter would otherwise reach over more texels than its
    /// [ceiling](Softness::ceiling). With [exact edges](Edges::Traced), soft filters set no limit, since rays
    /// make the penumbra. The fit [`FitKind::XnaSample`](settings::FitKind::XnaSample) ignores the limit.
    pub fn least_texel(&self) -> f32 {
        let soft = if self.edges.are_traced() { 0.0 } else { self.softness.least_texel(self.filter) };
        self.fit.least_texel.max(soft)
    }

    /// Returns whether points other than a map's own receivers may read the map: points at other view depths
    /// or in later frames.
    pub(crate) const fn shares_maps(&self) -> bool {
        self.maps.selection().is_by_coverage() && (self.maps.count() > 1 || self.maps.are_kept())
    }
}
