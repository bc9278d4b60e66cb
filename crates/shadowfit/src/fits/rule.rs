//! A fit as data: the covered region, the rectangle, the axes and the depth.
//!
//! A rule is the settings with all values resolved that depend on the kind of fit, by its [`Form`].

use glam::{DVec2, DVec3, UVec2};

use super::form::{Alignment, Form};
use crate::base::checks::{MAX_LENGTH, ROUNDING, floor};
use crate::base::{DepthConvention, FitError, checks};
use crate::light::Volume;
use crate::light::grid::{Grid, anchor, quantised};
use crate::technique::settings::{CasterPolicy, FilterKind, FitSettings, MapSettings, RectangleKind};

/// Rule that places the near plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Depth {
    /// The XNA sample's own depth: the light is at the far side of the box, and the range is twice its depth.
    Doubled,
    /// At the covered region.
    AtCovered,
    /// Before the covered region by this distance, in metres.
    Extended(f64),
    /// At the box around all casters, clipped to the volume that can cast shadows into view.
    AtCasterBounds,
    /// At the first caster that can cast a shadow into view.
    AtCasters,
}

/// Fit rule of one map: [`FitSettings`] with all values resolved that depend on the kind of fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FitRule {
    pub(crate) form: Form,
    pub(crate) rectangle: RectangleKind,
    pub(crate) depth: Depth,
    /// Free texels between the covered region and the map's border.
    pub(crate) border: f64,
    /// Enlargement of the box on all sides, in metres.
    pub(crate) margin: f64,
    /// Greatest ratio of a texel's sides, if there is a limit.
    pub(crate) max_texel_ratio: Option<f64>,
    /// Least width of a texel along either side, in metres; 0 for no limit.
    pub(crate) least_texel: f64,
    /// Least extents of the covered region, in metres: the extents of the texels between the borders.
    pub(crate) least_size: DVec2,
    /// Width and height of the map, in texels.
    pub(crate) resolution: UVec2,
    /// Depth convention of the fitted clip space.
    pub(crate) convention: DepthConvention,
    /// Whether any point inside the map may read it. Otherwise only points in its slice of the view do.
    pub(crate) serves_all: bool,
}

/// The properties of a map's look-up that its fit depends on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MapUse {
    /// Free texels at the map's border, for the filter.
    pub(crate) border: f32,
    /// Whether points outside the map's slice of the view may read it.
    pub(crate) is_shared: bool,
}

impl MapUse {
    /// Returns the use of a single map without a technique. The border comes from the settings, or from the
    /// radius of the default filter.
    pub(crate) const fn alone(settings: &FitSettings) -> Self {
        let border = match settings.map.border {
            Some(texels) => texels,
            None => FilterKind::Pcf5x5.filter_radius(),
        };
        Self { border, is_shared: false }
    }
}

impl FitRule {
    /// Resolves settings for a use of the map.
    ///
    /// # Errors
    ///
    /// [`FitError::NotFinite`] and [`FitError::OutOfRange`] for a number of the settings, and
    /// [`FitError::ZeroResolution`].
    #[inline(always)]
    pub(crate) fn new(
        FitSettings { shape, map: settings }: &FitSettings,
        MapUse { border, is_shared }: MapUse,
        casters_are_known: bool,
    ) -> Result<Self, FitError> {
        let ratio = f64::from(shape.max_texel_ratio);
        checks::within("the fit's greatest texel ratio", ratio, 1.0, f64::from(f32::MAX))?;
        check(settings, border)?;
        let form = Form::of(shape.kind);
        let is_exact = form.alignment == Alignment::Exact;
        let depth = if is_exact { Depth::Doubled } else { near_plane(settings, casters_are_known) };
        let rectangle = if form.may_turn { shape.rectangle } else { RectangleKind::AxisAligned };
        let least_texel = if is_exact { 0.0 } else { f64::from(settings.least_texel) };
        Ok(Self {
            form,
            rectangle,
            depth,
            border: f64::from(border),
            margin: f64::from(settings.margin),
            max_texel_ratio: Some(shape.max_texel_ratio).filter(|ratio| *ratio < f32::MAX).map(f64::from),
            least_texel,
            least_size: (settings.resolution.as_dvec2() - 2.0 * f64::from(border)) * least_texel,
            resolution: settings.resolution,
            convention: settings.depth,
            serves_all: is_shared && !is_exact,
        })
    }

    /// Enlarges extents across the light, in metres, so that the texels keep within the limit of their ratio.
    /// `texels` is their number along each axis.
    pub(crate) fn limited(&self, size: DVec2, texels: DVec2) -> DVec2 {
        let Some(ratio) = self.max_texel_ratio else { return size };
        size.max(texels * ((size / texels).max_element() / ratio))
    }

    /// Returns the texels that the content of a map on the grid may use.
    pub(crate) fn usable(&self) -> DVec2 {
        // One texel is lost to the shift onto the grid.
        self.resolution.as_dvec2() - (2.0 * self.border + 1.0)
    }

    /// Leaves the border's texels free on all sides of a map.
    #[inline(always)]
    pub(crate) fn add_border(&self, volume: &mut Volume) {
        let border = DVec2::splat(self.border);
        let free = (volume.max - volume.min).truncate() / (self.resolution.as_dvec2() - border * 2.0) * border;
        (volume.min, volume.max) = (volume.min - free.extend(0.0), volume.max + free.extend(0.0));
    }

    /// Rounds the extents of a map across the light up and moves it to the world's grid. It still holds its content,
    /// with the border's texels around it.
    #[inline(always)]
    pub(crate) fn snap(&self, volume: &mut Volume, origin: DVec3) -> Grid {
        let anchor = anchor(&volume.axes, origin);
        let resolution = self.resolution.as_dvec2();
        let usable = self.usable();
        // A map that is larger than its content is rounded by its own extent.
        let size = (volume.max - volume.min).truncate();
        let pad = ROUNDING * (size * resolution / usable).max_element();
        let size = size + 2.0 * pad;
        let width = quantised(size.x);
        let mut size = DVec2::new(width, if size.y == size.x { width } else { quantised(size.y) });
        if self.max_texel_ratio.is_some() {
            let limited = self.limited(size, usable);
            let stepped = size.max(DVec2::new(quantised(limited.x), quantised(limited.y)));
            // The step above the limit may exceed the limit along the other axis. The limit itself follows
            // from a step too.
            size = if self.limited(stepped, usable) == stepped { stepped } else { limited };
        }
        let texel = size / usable;
        let line = (volume.min.truncate() - pad + anchor.truncate()) / texel - self.border;
        let first = DVec2::new(floor(line.x), floor(line.y));
        let grid = Grid { first, texel, z: (volume.min.z + anchor.z, volume.max.z + anchor.z) };
        let (min, max) = grid.across(anchor, resolution);
        (volume.min, volume.max) = (min.extend(volume.min.z), max.extend(volume.max.z));
        volume.grid = Some(grid);
        grid
    }

    /// Returns this rule without a border, and with its near plane at the covered region. It covers no less
    /// than with a border.
    pub(crate) const fn without_room(self) -> Self {
        Self { border: 0.0, depth: Depth::AtCovered, ..self }
    }
}

/// Returns the near plane rule of the settings' caster policy.
#[inline]
fn near_plane(settings: &MapSettings, casters_are_known: bool) -> Depth {
    match settings.casters {
        CasterPolicy::None | CasterPolicy::DepthClamp => Depth::AtCovered,
        CasterPolicy::SceneBounds if casters_are_known => Depth::AtCasterBounds,
        CasterPolicy::PerObject if casters_are_known => Depth::AtCasters,
        CasterPolicy::Extend | CasterPolicy::SceneBounds | CasterPolicy::PerObject => {
            Depth::Extended(f64::from(settings.caster_extension))
        }
    }
}

/// Checks the least texel of a fit's settings.
pub(crate) fn check_least_texel(settings: &MapSettings) -> Result<(), FitError> {
    checks::within("the fit's least texel", f64::from(settings.least_texel), 0.0, MAX_LENGTH)?;
    Ok(())
}

/// Checks the numbers of a fit's settings.
#[inline]
fn check(settings: &MapSettings, border: f32) -> Result<(), FitError> {
    checks::within("the fit's margin", f64::from(settings.margin), 0.0, MAX_LENGTH)?;
    let extension = f64::from(settings.caster_extension);
    checks::within("the fit's caster extension", extension, 0.0, MAX_LENGTH)?;
    if settings.resolution.x == 0 || settings.resolution.y == 0 {
        return Err(FitError::ZeroResolution { resolution: settings.resolution });
    }
    let widest = f64::from(settings.resolution.min_element()) * 0.25;
    checks::within("the fit's border", f64::from(border), 0.0, widest)?;
    check_least_texel(settings)?;
    checks::finite("the maximum shadow distance", f64::from(settings.max_distance))?;
    Ok(())
}
