//! Everything that decides how a sun's shadows look, as one plain type.
//!
//! [`Technique::default`] is the one to begin with; [`PRESETS`](crate::PRESETS) has others by name.

use crate::technique::settings::{
    BiasSettings, FilterKind, FitKind, FitSettings, HoldSettings, MapChoice, MapFormat, NeedSource, ReceiverSource,
    Softness, SplitScheme, Stabilise, setters,
};
use glam::UVec2;

pub mod presets;
pub mod settings;
pub mod softness;

pub use presets::{PRESETS, Preset};

/// How shadows are made: the maps and their fit, the filter and the bias that read them, their
/// format.
///
/// ```
/// use shadowfit::settings::FilterKind;
/// use shadowfit::Technique;
///
/// let technique = Technique::preset("stable-4").unwrap().with_filter(FilterKind::Pcf3x3);
/// assert_eq!((technique.count, technique.border()), (4, 2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Technique {
    /// Number of maps, 1..=8. Default: 4, as Bevy and Babylon.js have it.
    pub count: u32,
    /// The fit of all maps. Default: [`FitSettings::default`] with [`FitKind::Windows`].
    /// A fit that is read by the feature `serde` without its kind is one of [`FitKind::Focused`].
    pub fit: FitSettings,
    /// Where one map ends and the next begins. Default: [`SplitScheme::FromHistogram`], which takes
    /// boxes where no histogram is given.
    pub splits: SplitScheme,
    /// Which of the maps a point reads; windows are always read by coverage. Default:
    /// [`MapChoice::Coverage`].
    pub choice: MapChoice,
    /// Texels over which a map that is read by [`MapChoice::Coverage`] is blended into the next coarser
    /// one, inward from the filter's reach to its border, 0..=[`MAX_BLEND`](crate::settings::MAX_BLEND);
    /// 0 for none. Default: 8.
    pub blend: f32,
    /// Share of a map's range of view depths that the next map covers too, for a blend between them
    /// by [`MapChoice::ViewDepth`], 0..=1. Default: 0.
    pub overlap: f32,
    /// What keeps the maps stable. Default: [`Stabilise::Hysteresis`].
    pub stabilise: Stabilise,
    /// Details of [`Stabilise::Hysteresis`], and when held splits are given up. Default:
    /// [`HoldSettings::default`].
    pub hold: HoldSettings,
    /// Which boxes of the scene's receivers the fit is given. Default:
    /// [`ReceiverSource::Clusters`].
    pub receivers: ReceiverSource,
    /// Filter of the look-up. Default: [`FilterKind::Pcf5x5`]. [`FilterKind::Pcss`] needs maps that keep the
    /// distances of casters: not [`CasterPolicy::DepthClamp`](crate::settings::CasterPolicy::DepthClamp).
    pub filter: FilterKind,
    /// Width of the filters that are [soft](FilterKind::is_soft); the others ignore it. It also says how fine
    /// texels may be ([`Self::least_texel`]). Default: [`Softness::default`].
    pub softness: Softness,
    /// Share of the shadow distance over which shadows fade out toward its end, 0..=1: 0.1 begins at nine tenths
    /// of it. It is ignored where [`FitSettings::max_distance`] is `f32::MAX`. Default: 0, shadows end at once.
    pub fade: f32,
    /// Biases of the look-up. Default: [`BiasSettings::automatic`] for the default filter.
    pub bias: BiasSettings,
    /// What windows are placed by. Default: [`NeedSource::LastFrame`].
    pub need: NeedSource,
    /// Storage of the maps. Default: [`MapFormat::Depth32Float`].
    pub format: MapFormat,
}

impl Default for Technique {
    /// The preset `windows-4`: the best all round.
    fn default() -> Self {
        Self {
            count: 4,
            fit: FitSettings::default().with_kind(FitKind::Windows),
            splits: SplitScheme::default(),
            choice: MapChoice::default(),
            blend: 8.0,
            overlap: 0.0,
            stabilise: Stabilise::default(),
            hold: HoldSettings::default(),
            receivers: ReceiverSource::default(),
            filter: FilterKind::default(),
            softness: Softness::default(),
            fade: 0.0,
            bias: BiasSettings::default(),
            need: NeedSource::default(),
            format: MapFormat::default(),
        }
    }
}

setters!(Technique {
    with_count count: u32,
    with_fit fit: FitSettings,
    with_splits splits: SplitScheme,
    with_choice choice: MapChoice,
    with_blend blend: f32,
    with_overlap overlap: f32,
    with_stabilise stabilise: Stabilise,
    with_hold hold: HoldSettings,
    with_receivers receivers: ReceiverSource,
    with_need need: NeedSource,
    with_format format: MapFormat,
    with_softness softness: Softness,
    with_fade fade: f32,
});

impl Technique {
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
    /// ([`FitSettings::max_distance`]) and how far toward the light casters count
    /// ([`FitSettings::caster_extension`]). They suit a scene, so that another technique for the same scene keeps them.
    #[must_use]
    pub const fn with_lengths_of(mut self, other: &Self) -> Self {
        (self.fit.max_distance, self.fit.caster_extension) = (other.fit.max_distance, other.fit.caster_extension);
        self
    }

    /// Free texels at the border of each map: [`FitSettings::border`] where it is set, else what the
    /// filter and the normal offset can reach.
    pub const fn border(&self) -> f32 {
        match self.fit.border {
            Some(texels) => texels,
            // The looked-up point moves across the light by the offset at most.
            None => self.reach() + self.bias.normal_offset,
        }
    }

    /// Greatest reach of the filter per axis, in texels, in any map: of a soft filter that of one look-up and the
    /// [ceiling](Softness::ceiling) of its disc. The border and the choice by coverage go by it, so that they do not
    /// change with the texels of a map.
    pub const fn reach(&self) -> f32 {
        self.softness.reach(self.filter)
    }

    /// Least width of a texel, in metres; 0 for no limit. It is [`FitSettings::least_texel`], or more where a
    /// [soft](FilterKind::is_soft) filter would reach over more texels than its [ceiling](Softness::ceiling).
    /// Each map's fit but [`FitKind::XnaSample`] respects it.
    pub fn least_texel(&self) -> f32 {
        self.fit.least_texel.max(self.softness.least_texel(self.filter))
    }

    /// Whether more may read a map than the receivers that it is made for: those of other view depths, or of
    /// later frames.
    pub(crate) const fn shares_maps(&self) -> bool {
        let is_kept = !matches!(self.stabilise, Stabilise::Off) || self.has_windows();
        let is_shared = self.count > 1 || is_kept;
        matches!(self.map_choice(), MapChoice::Coverage) && is_shared
    }

    /// Which of the maps a point reads: [`Self::choice`], or by coverage where the maps are
    /// [windows](FitKind::Windows), which have no ranges of view depths.
    pub const fn map_choice(&self) -> MapChoice {
        if self.has_windows() { MapChoice::Coverage } else { self.choice }
    }

    /// Whether fits go by what an earlier frame showed, where that is known.
    pub const fn uses_seen(&self) -> bool {
        match self.fit.kind {
            FitKind::Windows => matches!(self.need, NeedSource::LastFrame),
            _ => matches!(self.splits, SplitScheme::FromHistogram),
        }
    }

    /// Whether the maps are windows: all of them are or none.
    pub(crate) const fn has_windows(&self) -> bool {
        matches!(self.fit.kind, FitKind::Windows)
    }
}
