//! What surfaces show instead of their plain shading.

use shadowfit_params::tool::ViewMode;

/// What the surfaces show. Each but [`Overlay::None`] has shaders of its own, which are made when it is first shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Overlay {
    /// Their shading alone.
    #[default]
    None,
    /// The map that each point reads, in the colours [`MAP_TINTS`](shadowfit_params::figures::MAP_TINTS); where it reads two,
    /// both mixed by their weights. What no map covers keeps its own colour.
    MapTint,
    /// Screen pixels per texel along the worse axis
    /// ([`pixels_per_texel`](shadowfit::diagnostics::pixels_per_texel)) of the map that weighs more in a point's shadow, as
    /// [`pixels_per_texel_color`](shadowfit_params::figures::pixels_per_texel_color), darker where there is less light. What no
    /// map covers is hatched in grey.
    PixelsPerTexel,
    /// The texels of the map that weighs more in a point's shadow, as a checkerboard with lines in the map's tint; where
    /// they are less than six pixels wide, blocks of 4, 16, 64 and so on texels a side. What no map covers keeps its own
    /// colour.
    TexelGrid,
    /// The shadows that rays found ([`Frame::judged`](crate::Frame::judged)). What was not judged, though it faces the
    /// light, has the maps' shadows and is hatched.
    Truth,
    /// The picture in dim grey, and wrong pixels of [`Frame::judged`](crate::Frame::judged) in the
    /// [colours of their classes](shadowfit_params::figures::ERROR_COLORS).
    Error,
    /// The picture in grey. Pixels of which the maps were not sure, and whose rays were traced, and what faces the light and
    /// was left to the filter, have the [`EDGE_COLORS`](shadowfit_params::figures::EDGE_COLORS).
    Traced,
    /// Which casters the maps hold: an instance has the tint of the first map that holds it, or is dark and hatched if it
    /// is in none. Blended surfaces, which cast nothing, are grey.
    Casters,
}

impl Overlay {
    /// All that have shaders of their own.
    pub const ALL: [Self; 7] =
        [Self::MapTint, Self::PixelsPerTexel, Self::TexelGrid, Self::Truth, Self::Error, Self::Traced, Self::Casters];

    /// What the surfaces show in a view of the camera.
    pub const fn of(view: ViewMode) -> Self {
        match view {
            ViewMode::Truth => Self::Truth,
            ViewMode::Error => Self::Error,
            ViewMode::PixelsPerTexel => Self::PixelsPerTexel,
            ViewMode::Maps => Self::MapTint,
            ViewMode::TexelGrid => Self::TexelGrid,
            ViewMode::Traced => Self::Traced,
            _ => Self::None,
        }
    }

    /// The WGSL that colours a visible point, by its function `overlaid`.
    pub(crate) const fn wgsl(self) -> &'static str {
        match self {
            Self::None => "",
            Self::MapTint => include_str!("shaders/map_tint.wgsl"),
            Self::PixelsPerTexel => include_str!("shaders/pixels_per_texel.wgsl"),
            Self::TexelGrid => include_str!("shaders/texel_grid.wgsl"),
            Self::Truth => include_str!("shaders/truth.wgsl"),
            Self::Error => include_str!("shaders/error.wgsl"),
            Self::Traced => include_str!("shaders/traced.wgsl"),
            Self::Casters => include_str!("shaders/casters.wgsl"),
        }
    }

    /// Whether the sky is grey behind it, since its colours have a meaning that a blue sky has not.
    pub const fn has_gray_sky(self) -> bool {
        matches!(self, Self::PixelsPerTexel | Self::Error | Self::Traced | Self::Casters)
    }

    /// Whether it shows a judged picture.
    pub const fn is_judged(self) -> bool {
        matches!(self, Self::Truth | Self::Error)
    }
}
