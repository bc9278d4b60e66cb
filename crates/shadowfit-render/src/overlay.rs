//! Overlays that surfaces show instead of their plain shading.

use shadowfit_params::tool::ViewMode;

/// Overlay of the surfaces. Each except [`Overlay::None`] has its own shaders, created when it is first
/// shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Overlay {
    /// Only shading.
    #[default]
    None,
    /// The map that each point reads, in the colours [`MAP_TINTS`](shadowfit_params::figures::MAP_TINTS). If
    /// a point reads two, both are mixed by their weights. Points that no map covers keep their colour.
    MapTint,
    /// Screen pixels per texel along the worse axis
    /// ([`pixels_per_texel`](shadowfit::diagnostics::pixels_per_texel)) of the map with the greater weight in
    /// a point's shadow, as [`pixels_per_texel_color`](shadowfit_params::figures::pixels_per_texel_color),
    /// darker in the shade. Points that no map covers are hatched in grey.
    PixelsPerTexel,
    /// The texels of the map with the greater weight in a point's shadow, as a checkerboard with lines in the
    /// map's tint. Texels below six pixels are joined to blocks of 4, 16, 64 and so on texels per side.
    /// Points that no map covers keep their colour.
    TexelGrid,
    /// The shadows that rays found ([`Frame::judged`](crate::Frame::judged)). Pixels that face the light but
    /// were not judged have the maps' shadows and are hatched.
    Truth,
    /// The picture in dim grey, and wrong pixels of [`Frame::judged`](crate::Frame::judged) in the [colours
    /// of their classes](shadowfit_params::figures::ERROR_COLORS).
    Error,
    /// The picture in grey. Pixels whose texels were not in agreement, so that rays were traced, and facing
    /// pixels that were left to the filter have the [`EDGE_COLORS`](shadowfit_params::figures::EDGE_COLORS).
    Traced,
    /// The casters that the maps hold. An instance has the tint of the first map that holds it, or is dark
    /// and hatched if no map does. Blended surfaces, which cast no shadow, are grey.
    Casters,
}

impl Overlay {
    /// All overlays with their own shaders.
    pub const ALL: [Self; 7] =
        [Self::MapTint, Self::PixelsPerTexel, Self::TexelGrid, Self::Truth, Self::Error, Self::Traced, Self::Casters];

    /// Returns the overlay of a view mode.
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

    /// Returns the WGSL that colours a visible point, in its function `overlaid`.
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

    /// Returns whether the sky behind it is grey, because blue would conflict with the overlay's colours.
    pub const fn has_gray_sky(self) -> bool {
        matches!(self, Self::PixelsPerTexel | Self::Error | Self::Traced | Self::Casters)
    }

    /// Returns whether it shows a judged picture.
    pub const fn is_judged(self) -> bool {
        matches!(self, Self::Truth | Self::Error)
    }
}
