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

/// What tells one fit from the others.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a property that a fit has or not")]
pub(crate) struct Form {
    pub(crate) covers: Covers,
    /// Where the map's roll about the light comes from.
    pub(crate) roll: Roll,
    /// Whether the rectangle is that of the settings; else it lies along the light's axes.
    pub(crate) may_turn: bool,
    /// Whether the settings limit the ratio of the texels' sides.
    pub(crate) limits_ratio: bool,
    /// Whether it always lies on the world's grid.
    pub(crate) is_on_grid: bool,
    /// Whether it is kept as its source has it: with the depth of the source, no caster policy, no border, no least
    /// texel, and never held.
    pub(crate) is_exact: bool,
    /// Whether the map always reaches to the shadow distance, wherever the receivers end.
    pub(crate) whole_distance: bool,
}

impl Form {
    /// The outline of the views along the light's own axes.
    pub(crate) const OF_VIEWS: Self = Self {
        covers: Covers::Views,
        roll: Roll::ShortestArc,
        may_turn: false,
        limits_ratio: true,
        is_on_grid: false,
        is_exact: false,
        whole_distance: false,
    };
}
