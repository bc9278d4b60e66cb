//! The properties in which fits differ, as data that each fit has in its own file.

use crate::light::Roll;

/// Region that a map must cover.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Covers {
    /// The box of the views' corners, without room for rounding or the filter.
    Corners,
    /// The outline of the views' slices, as seen from the light.
    Views,
    /// The outline of the receivers' boxes, clipped to the slices.
    Receivers,
    /// The sphere around the views' slices.
    Sphere,
}

/// Position of a map relative to the world's texel grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Alignment {
    /// Exactly as in the fit's source: with the source's depth, and without caster policy, border, least texel or grid.
    /// Such a map is never held.
    Exact,
    /// As the technique requests: tight or on the grid.
    Free,
    /// Always on the grid.
    OnGrid,
}

/// The properties in which fits differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Form {
    pub(crate) covers: Covers,
    /// Source of the map's roll about the light.
    pub(crate) roll: Roll,
    /// Whether the settings choose the rectangle. Otherwise it lies along the light's axes.
    pub(crate) may_turn: bool,
    pub(crate) alignment: Alignment,
    /// Whether the map always reaches to the shadow distance, even if the receivers end before it.
    pub(crate) whole_distance: bool,
}

impl Form {
    /// Form of the views' outline along the light's own axes.
    pub(crate) const OF_VIEWS: Self = Self {
        covers: Covers::Views,
        roll: Roll::ShortestArc,
        may_turn: false,
        alignment: Alignment::Free,
        whole_distance: false,
    };
}
