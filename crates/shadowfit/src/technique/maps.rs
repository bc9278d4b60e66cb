//! The kinds of maps that a technique may have, with the settings of each kind.

use crate::base::{FitError, checks};
use crate::technique::setters::setters;
use crate::technique::settings::{
    DEFAULT_WASTE, FitKind, Hysteresis, MAX_MAPS, MapSelection, RectangleKind, Shape, SplitScheme, Stabilise,
};

/// Kind of the maps: how they share the view.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Maps {
    /// Rectangles on a fixed world grid, each placed where it improves the most visible pixels. The default.
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

/// World-locked clipmaps that are placed by visible demand. A window is a square in the plane across the
/// light, or a rectangle if the light is low. It lies on a fixed world grid and is placed where it improves
/// the most visible pixels. Points [read windows by coverage](MapSelection::Coverage).
///
/// - Windows are still. A window never turns and moves by whole texels. Its texels are 2^(k/8) metres wide,
///   and their borders lie on lines that are counted from the world's origin.
/// - Windows are sharp. They are placed by the [visible demand](crate::FitInput::demand) of an earlier frame.
///   Without it, rays through the boxes estimate the demand.
/// - Windows leave no gaps. The last one contains all receivers in view, so a late or wrong demand costs
///   sharpness, never coverage.
///
/// Cascades may fit better if the vertical field of view is below 3 degrees, where the camera sees a thin
/// strip of that plane, or above 120 degrees. To be as sharp as the presets `focused-4` and `calm-4`, windows
/// need at most 1.7 times the resolution of those presets at 5 to 120 degrees, 2.5 times at 1 degree, 3.7
/// times at 0.2 degrees, and 3.1 times at 170 degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Windows {
    /// Number of maps, 1..=8. Default: 4.
    pub count: u32,
    /// Width of the blend into the next coarser window, in texels, 0..=[`MapSelection::MAX_BLEND`]; 0 for
    /// none. The blend begins one filter radius inside the window's border and goes inward. Default: 8.
    pub blend: f32,
    /// Greatest factor by which a held depth range may exceed the necessary length, 1..=100. Default: 1.8.
    pub max_depth_oversize: f32,
}

impl Default for Windows {
    fn default() -> Self {
        Self { count: 4, blend: MapSelection::DEFAULT_BLEND, max_depth_oversize: DEFAULT_WASTE }
    }
}

impl Windows {
    /// Shape of the last window, a map around everything visible.
    pub(crate) const WHOLE: Shape = Shape { rectangle: RectangleKind::AxisAligned, ..Shape::new(FitKind::Focused) };
}

/// Cascades: each map has a separate range of view depths, as in other engines.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Cascades {
    /// Number of maps, 2..=8. Default: 4, as in Bevy and Babylon.js.
    pub count: u32,
    /// Shape of each map across the light. Default: [`FitKind::Focused`].
    pub shape: Shape,
    /// Scheme that splits the view depths among the maps. Default: [`SplitScheme::FromHistogram`], which uses
    /// boxes if there is no histogram.
    pub splits: SplitScheme,
    /// Rule that selects the map that a point reads. Default: [`MapSelection::Coverage`].
    pub selection: MapSelection,
    /// Method that keeps the maps stable. Default: [`Stabilise::Hysteresis`].
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
    /// Shape of the map across the light. Default: [`FitKind::Focused`].
    pub shape: Shape,
    /// Method that keeps the map stable. Default: [`Stabilise::Hysteresis`].
    pub stabilise: Stabilise,
}

impl SingleMap {
    /// Returns the map as the only slice of the view.
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
    /// Returns the number of maps.
    pub const fn count(&self) -> u32 {
        match self {
            Self::Windows(windows) => windows.count,
            Self::Cascades(cascades) => cascades.count,
            Self::Single(_) => 1,
        }
    }

    /// Returns maps of the same kind with another count. Cascades become [one map](Self::Single) of their
    /// shape if the count is 1, and one map becomes cascades if it is greater.
    #[must_use]
    pub fn with_count(self, count: u32) -> Self {
        match self {
            Self::Windows(windows) => windows.with_count(count).into(),
            Self::Cascades(_) | Self::Single(_) if count == 1 => self.as_single().into(),
            Self::Cascades(cascades) => cascades.with_count(count).into(),
            Self::Single(_) => self.as_cascades().with_count(count).into(),
        }
    }

    /// Returns the same number of maps with another shape. Windows become [cascades](Self::Cascades), or [one
    /// map](Self::Single) if there is only one, since their own shape follows from the light.
    #[must_use]
    pub fn with_shape(self, shape: Shape) -> Self {
        if self.count() == 1 {
            self.as_single().with_shape(shape).into()
        } else {
            self.as_cascades().with_shape(shape).into()
        }
    }

    /// Returns the same number of maps fitted by another rule. Windows become [cascades](Self::Cascades), or
    /// [one map](Self::Single) if there is only one.
    #[must_use]
    pub fn with_kind(self, kind: FitKind) -> Self {
        self.with_shape(self.shape().unwrap_or_default().with_kind(kind))
    }

    /// Returns the same number of maps with another method of stabilisation. Windows become
    /// [cascades](Self::Cascades), or [one map](Self::Single) if there is only one.
    #[must_use]
    pub fn with_stabilise(self, stabilise: Stabilise) -> Self {
        if self.count() == 1 {
            self.as_single().with_stabilise(stabilise).into()
        } else {
            self.as_cascades().with_stabilise(stabilise).into()
        }
    }

    /// Returns the maps as cascades. Maps of another kind keep their number (one map becomes 2) and the
    /// settings that cascades also have.
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

    /// Returns the maps as windows. Maps of another kind keep their number and the settings that windows also
    /// have.
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

    /// Returns a single map in place of these maps. Maps of another kind keep the settings that a single map
    /// also has.
    pub fn as_single(&self) -> SingleMap {
        if let Self::Single(one) = *self {
            return one;
        }
        let Cascades { shape, stabilise, .. } = self.as_cascades();
        SingleMap { shape, stabilise }
    }

    /// Returns the shape of each map, or `None` for windows, whose shape follows from the light.
    pub const fn shape(&self) -> Option<Shape> {
        match self {
            Self::Windows(_) => None,
            Self::Cascades(cascades) => Some(cascades.shape),
            Self::Single(one) => Some(one.shape),
        }
    }

    /// Returns the rule that selects the map that a point reads.
    pub const fn selection(&self) -> MapSelection {
        match self {
            Self::Windows(windows) => MapSelection::Coverage { blend: windows.blend },
            Self::Cascades(cascades) => cascades.selection,
            Self::Single(_) => MapSelection::Coverage { blend: 0.0 },
        }
    }

    /// Returns whether fits use the visible demand of an earlier frame, if it is known.
    pub const fn uses_visible_demand(&self) -> bool {
        match self {
            Self::Windows(_) => true,
            Self::Cascades(cascades) => matches!(cascades.splits, SplitScheme::FromHistogram),
            Self::Single(_) => false,
        }
    }

    /// Returns whether any part of a map is kept for later frames.
    pub(crate) const fn are_kept(&self) -> bool {
        match self {
            Self::Windows(_) => true,
            Self::Cascades(Cascades { stabilise, .. }) | Self::Single(SingleMap { stabilise, .. }) => {
                !matches!(stabilise, Stabilise::Off)
            }
        }
    }

    /// Returns whether each map is fitted by the XNA sample's rule, which has no caster policy.
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

/// Refuses stabilisation settings that are out of range.
fn check_kept(stabilise: Stabilise) -> Result<(), FitError> {
    if let Stabilise::Hysteresis(hysteresis) = stabilise {
        checks::within("the hysteresis's margin", f64::from(hysteresis.margin), 0.0, 10.0)?;
        checks::within("the hysteresis's greatest growth", f64::from(hysteresis.max_growth), 1.0, 100.0)?;
    }
    checks::within("the maps' greatest oversize", f64::from(stabilise.max_oversize()), 1.0, 100.0)?;
    Ok(())
}
