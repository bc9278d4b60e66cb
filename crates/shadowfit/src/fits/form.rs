//! What tells one fit from the others, as data that each fit has in its own file.

use crate::light::Roll;

/// What a map must hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Covers {
    /// The box of the views' corners alone, without room for rounding or the filter.
    Corners,
    /// The outline of the views' slices, as the light sees them.
    Views,
    /// That of the receivers' boxes clipped to the slices.
    Receivers,
    /// The sphere around the views' slices.
    Sphere,
}

/// How a map may lie relative to the world's texel grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Alignment {
    /// Exactly as in the fit's source: with the source's depth, and without caster policy, border, least texel or grid.
    /// Such a map is never held.
    Exact,
    /// As the technique asks: tight or on the grid.
    Free,
    /// Always on the grid.
    OnGrid,
}

/// What tells one fit from the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Form {
    pub(crate) covers: Covers,
    /// Where the map's roll about the light comes from.
    pub(crate) roll: Roll,
    /// Whether the rectangle is that of the settings; else it lies along the light's axes.
    pub(crate) may_turn: bool,
    pub(crate) alignment: Alignment,
    /// Whether the map always reaches to the shadow distance, wherever the receivers end.
    pub(crate) whole_distance: bool,
}

impl Form {
    /// The outline of the views along the light's own axes.
    pub(crate) const OF_VIEWS: Self = Self {
        covers: Covers::Views,
        roll: Roll::ShortestArc,
        may_turn: false,
        alignment: Alignment::Free,
        whole_distance: false,
    };
}
