//! The kinds of maps that a technique may have, each with the settings that only it has.

use crate::base::{FitError, checks};
use crate::technique::setters::setters;
use crate::technique::settings::{
    DEFAULT_WASTE, FitKind, Hysteresis, MAX_MAPS, MapSelection, RectangleKind, Shape, SplitScheme, Stabilise,
};

/// How the view is shared out among the maps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Maps {
    /// Rectangles that are fixed to the world, each where it helps most of what is visible. The default.
    Windows(Windows),
    /// Cascades, one behind the other.
    Cascades(Cascades),
    /// One map around everything that is shadowed.
    Single(SingleMap),
}

impl Default for Maps {
    fn default() -> Self {
        Self::Windows(Windows::default())
    }
}

/// World-locked clipmaps that are placed by demand: squares of the plane across the light (or rectangles, where the
/// light is low) on a grid that is fixed to the world, each where it helps most of what is visible. They are
/// [read by coverage](MapSelection::Coverage).
///
/// They are still: a window never turns, its texels have widths from a fixed ladder and lie on lines that are counted
/// from the world's origin, so that it moves by whole texels. They are sharp: each is put where it helps most of what an
/// [earlier frame showed](crate::FitInput::demand), or else of what rays through the boxes find. They are whole: the
/// last one holds all receivers in view, so that a late or wrong count costs sharpness and never coverage.
///
/// A lens below 3 degrees of vertical view sees a thin strip of that plane, which cascades may fit better, as they do
/// above 120 degrees. Windows need up to 2.5 times the resolution of the presets `focused-4` and `calm-4` at 1 degree,
/// and 3.7 times at 0.2 degrees. They need up to 1.7 times from 5 to 120 degrees, and 3.1 times at 170 degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Windows {
    /// Number of maps, 1..=8. Default: 4.
    pub count: u32,
    /// Texels over which a window is blended into the next coarser one, inward from the filter's reach to its border,
    /// 0..=[`MapSelection::MAX_BLEND`]; 0 for none. Default: 8.
    pub blend: f32,
    /// A window's depth range is kept until it is longer than necessary by this factor, 1..=100. Default: 1.8.
    pub max_depth_oversize: f32,
}

impl Default for Windows {
    fn default() -> Self {
        Self { count: 4, blend: MapSelection::DEFAULT_BLEND, max_depth_oversize: DEFAULT_WASTE }
    }
}

impl Windows {
    /// The shape of a map around all that is visible, which the last window has.
    pub(crate) const WHOLE: Shape = Shape { rectangle: RectangleKind::AxisAligned, ..Shape::new(FitKind::Focused) };
}

/// Cascades: each map holds a range of view depths of its own, as in other engines' cascades.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Cascades {
    /// Number of maps, 2..=8. Default: 4, as Bevy and Babylon.js have it.
    pub count: u32,
    /// Shape of each map across the light. Default: [`FitKind::Focused`].
    pub shape: Shape,
    /// Where one map ends and the next begins. Default: [`SplitScheme::FromHistogram`], which takes
    /// boxes where no histogram is given.
    pub splits: SplitScheme,
    /// Which of the maps a point reads. Default: [`MapSelection::Coverage`].
    pub selection: MapSelection,
    /// What keeps the maps stable. Default: [`Stabilise::Hysteresis`].
    pub stabilise: Stabilise,
}

impl Default for Cascades {
    fn default() -> Self {
        Self {
            count: 4,
            shape: Shape::default(),
            splits: SplitScheme::default(),
            selection: MapSelection::default(),
            stabilise: Stabilise::default(),
        }
    }
}

/// One map around everything that is shadowed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct SingleMap {
    /// Its shape across the light. Default: [`FitKind::Focused`].
    pub shape: Shape,
    /// What keeps it stable. Default: [`Stabilise::Hysteresis`].
    pub stabilise: Stabilise,
}

impl SingleMap {
    /// The map as the only slice of the view.
    pub(crate) fn slice(&self) -> Cascades {
        let Self { shape, stabilise } = *self;
        let selection = MapSelection::Coverage { blend: 0.0 };
        Cascades { count: 1, shape, splits: SplitScheme::Logarithmic, selection, stabilise }
    }
}

setters!(Windows {
    with_count count: u32,
    with_blend blend: f32,
    with_max_depth_oversize max_depth_oversize: f32,
});

setters!(Cascades {
    with_count count: u32,
    with_shape shape: Shape,
    with_splits splits: SplitScheme,
    with_selection selection: MapSelection,
    with_stabilise stabilise: Stabilise,
});

setters!(SingleMap {
    with_shape shape: Shape,
    with_stabilise stabilise: Stabilise,
});

impl From<Windows> for Maps {
    fn from(windows: Windows) -> Self {
        Self::Windows(windows)
    }
}

impl From<Cascades> for Maps {
    fn from(cascades: Cascades) -> Self {
        Self::Cascades(cascades)
    }
}

impl From<SingleMap> for Maps {
    fn from(one: SingleMap) -> Self {
        Self::Single(one)
    }
}

impl Maps {
    /// Their number.
    pub const fn count(&self) -> u32 {
        match self {
            Self::Windows(windows) => windows.count,
            Self::Cascades(cascades) => cascades.count,
            Self::Single(_) => 1,
        }
    }

    /// As many maps of the same kind; cascades that become one are [one map](Self::Single) of their shape, and the
    /// other way round.
    #[must_use]
    pub fn with_count(self, count: u32) -> Self {
        match self {
            Self::Windows(windows) => windows.with_count(count).into(),
            Self::Cascades(_) | Self::Single(_) if count == 1 => self.as_single().into(),
            Self::Cascades(cascades) => cascades.with_count(count).into(),
            Self::Single(_) => self.as_cascades().with_count(count).into(),
        }
    }

    /// As many maps of the view, of a shape across the light: [cascades](Self::Cascades), or [one map](Self::Single).
    #[must_use]
    pub fn with_shape(self, shape: Shape) -> Self {
        if self.count() == 1 {
            self.as_single().with_shape(shape).into()
        } else {
            self.as_cascades().with_shape(shape).into()
        }
    }

    /// As many maps of the view, fitted by another rule.
    #[must_use]
    pub fn with_kind(self, kind: FitKind) -> Self {
        self.with_shape(self.shape().unwrap_or_default().with_kind(kind))
    }

    /// As many maps of the view, kept as told: [cascades](Self::Cascades), or [one map](Self::Single).
    #[must_use]
    pub fn with_stabilise(self, stabilise: Stabilise) -> Self {
        if self.count() == 1 {
            self.as_single().with_stabilise(stabilise).into()
        } else {
            self.as_cascades().with_stabilise(stabilise).into()
        }
    }

    /// These cascades, or the nearest to maps of another kind: as many (of one map: 2), with what both kinds have.
    pub fn as_cascades(&self) -> Cascades {
        match *self {
            Self::Windows(Windows { count, blend, max_depth_oversize: max_oversize }) => Cascades {
                count: count.max(2),
                selection: MapSelection::Coverage { blend },
                stabilise: Stabilise::Hysteresis(Hysteresis { max_oversize, ..Hysteresis::default() }),
                ..Cascades::default()
            },
            Self::Cascades(cascades) => cascades,
            Self::Single(SingleMap { shape, stabilise }) => {
                Cascades { count: 2, shape, stabilise, ..Cascades::default() }
            }
        }
    }

    /// These windows, or the nearest to maps of another kind: as many, with what both kinds have.
    pub fn as_windows(&self) -> Windows {
        let windows = |count, blend, max_depth_oversize| Windows { count, blend, max_depth_oversize };
        match *self {
            Self::Windows(windows) => windows,
            Self::Cascades(Cascades { count, selection, stabilise, .. }) => {
                let blend = if selection.is_by_coverage() { selection.blend() } else { MapSelection::DEFAULT_BLEND };
                windows(count, blend, stabilise.max_oversize())
            }
            Self::Single(SingleMap { stabilise, .. }) => {
                windows(1, MapSelection::DEFAULT_BLEND, stabilise.max_oversize())
            }
        }
    }

    /// This map, or the nearest to maps of another kind: one around them all, with what both kinds have.
    pub fn as_single(&self) -> SingleMap {
        if let Self::Single(one) = *self {
            return one;
        }
        let Cascades { shape, stabilise, .. } = self.as_cascades();
        SingleMap { shape, stabilise }
    }

    /// The shape of each map; `None` of windows, whose shape follows from the light.
    pub const fn shape(&self) -> Option<Shape> {
        match self {
            Self::Windows(_) => None,
            Self::Cascades(cascades) => Some(cascades.shape),
            Self::Single(one) => Some(one.shape),
        }
    }

    /// Which of the maps a point reads.
    pub const fn selection(&self) -> MapSelection {
        match self {
            Self::Windows(windows) => MapSelection::Coverage { blend: windows.blend },
            Self::Cascades(cascades) => cascades.selection,
            Self::Single(_) => MapSelection::Coverage { blend: 0.0 },
        }
    }

    /// Whether fits go by what an earlier frame showed, where that is known.
    pub const fn uses_visible_demand(&self) -> bool {
        match self {
            Self::Windows(_) => true,
            Self::Cascades(cascades) => matches!(cascades.splits, SplitScheme::FromHistogram),
            Self::Single(_) => false,
        }
    }

    /// Whether anything of a map is kept for later frames.
    pub(crate) const fn are_kept(&self) -> bool {
        match self {
            Self::Windows(_) => true,
            Self::Cascades(Cascades { stabilise, .. }) | Self::Single(SingleMap { stabilise, .. }) => {
                !matches!(stabilise, Stabilise::Off)
            }
        }
    }

    /// Whether the fit of each is the XNA sample's, which has no caster policy.
    pub const fn are_exact(&self) -> bool {
        matches!(self.shape(), Some(Shape { kind: FitKind::XnaSample, .. }))
    }

    /// Refuses numbers that are out of range.
    pub(crate) fn check(&self) -> Result<(), FitError> {
        let least = if matches!(self, Self::Cascades(_)) { 2.0 } else { 1.0 };
        checks::within("the number of maps", f64::from(self.count()), least, MAX_MAPS as f64)?;
        match self.selection() {
            MapSelection::Coverage { blend } => {
                checks::within("the maps' blend", f64::from(blend), 0.0, f64::from(MapSelection::MAX_BLEND))?;
            }
            MapSelection::ViewDepth { overlap } => {
                checks::within("the maps' overlap", f64::from(overlap), 0.0, 1.0)?;
            }
        }
        match self {
            Self::Windows(windows) => {
                checks::within("the windows' depth oversize", f64::from(windows.max_depth_oversize), 1.0, 100.0)?;
            }
            Self::Cascades(Cascades { stabilise, .. }) | Self::Single(SingleMap { stabilise, .. }) => {
                check_kept(*stabilise)?;
            }
        }
        Ok(())
    }
}

/// Refuses numbers of what keeps maps stable that are out of range.
fn check_kept(stabilise: Stabilise) -> Result<(), FitError> {
    if let Stabilise::Hysteresis(hysteresis) = stabilise {
        checks::within("the hysteresis's margin", f64::from(hysteresis.margin), 0.0, 10.0)?;
        checks::within("the hysteresis's greatest growth", f64::from(hysteresis.max_growth), 1.0, 100.0)?;
    }
    checks::within("the maps' greatest oversize", f64::from(stabilise.max_oversize()), 1.0, 100.0)?;
    Ok(())
}
