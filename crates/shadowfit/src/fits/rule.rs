//! A fit as data: what each kind covers, by which rectangle, along which axes and how deep.
//!
//! Settings with everything resolved that depends on the kind, by its [`Form`].

use glam::{DVec2, UVec2};

use super::form::Form;
use crate::base::checks::MAX_LENGTH;
use crate::base::{DepthConvention, FitError, checks};
use crate::technique::settings::{CasterPolicy, FilterKind, FitSettings, MapSettings, RectangleKind};

/// What places the near plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Depth {
    /// The XNA sample's own depth: the light at the far side of the box, and twice its depth.
    Doubled,
    /// At the covered region.
    AtCovered,
    /// This far before the covered region, in metres.
    Extended(f64),
    /// At the box around all casters, as far as it can cast shadows into view.
    AtCasterBounds,
    /// At the first caster that can cast a shadow into view.
    AtCasters,
}

/// How one map is fitted: [`FitSettings`] with everything resolved that depends on the kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FitRule {
    pub(crate) form: Form,
    pub(crate) rectangle: RectangleKind,
    pub(crate) depth: Depth,
    /// Free texels between the covered region and the map's border.
    pub(crate) border: f64,
    /// What the box is enlarged by on all sides, in metres.
    pub(crate) margin: f64,
    /// Greatest ratio of a texel's sides, if there is a limit.
    pub(crate) max_texel_ratio: Option<f64>,
    /// Least width of a texel along either side, in metres; 0 for no limit.
    pub(crate) least_texel: f64,
    /// Least extents of what is covered, in metres: those of the texels between the borders.
    pub(crate) least_size: DVec2,
    /// Width and height of the map, in texels.
    pub(crate) resolution: UVec2,
    /// Depth convention of the fitted clip space.
    pub(crate) convention: DepthConvention,
    /// Whether all that lies inside the map may read it, and not its slice of the view alone.
    pub(crate) serves_all: bool,
}

impl FitRule {
    /// The rule of settings, with the free texels at the border.
    ///
    /// # Errors
    ///
    /// [`FitError::NotFinite`] and [`FitError::OutOfRange`] for a number of the settings, and
    /// [`FitError::ZeroResolution`].
    #[inline(always)]
    pub(crate) fn new(
        FitSettings { shape, map: settings }: &FitSettings,
        border: f32,
        casters_are_known: bool,
    ) -> Result<Self, FitError> {
        let ratio = f64::from(shape.max_texel_ratio);
        checks::within("the fit's greatest texel ratio", ratio, 1.0, f64::from(f32::MAX))?;
        check(settings, border)?;
        let form = Form::of(shape.kind);
        let depth = if form.is_exact { Depth::Doubled } else { near_plane(settings, casters_are_known) };
        let rectangle = if form.may_turn { shape.rectangle } else { RectangleKind::AxisAligned };
        let least_texel = if form.is_exact { 0.0 } else { f64::from(settings.least_texel) };
        Ok(Self {
            form,
            rectangle,
            depth,
            border: f64::from(border),
            margin: f64::from(settings.margin),
            max_texel_ratio: Some(shape.max_texel_ratio)
                .filter(|ratio| *ratio < f32::MAX && form.limits_ratio)
                .map(f64::from),
            least_texel,
            least_size: (settings.resolution.as_dvec2() - 2.0 * f64::from(border)) * least_texel,
            resolution: settings.resolution,
            convention: settings.depth,
            serves_all: false,
        })
    }

    /// Extents across the light, in metres, enlarged so that the texels keep within the limit of their ratio;
    /// `texels` is their number along each axis.
    pub(crate) fn limited(&self, size: DVec2, texels: DVec2) -> DVec2 {
        let Some(ratio) = self.max_texel_ratio else { return size };
        size.max(texels * ((size / texels).max_element() / ratio))
    }

    /// Texels that are left for the content of a map on the grid.
    pub(crate) fn usable(&self) -> DVec2 {
        // One texel is lost to the shift onto the grid.
        self.resolution.as_dvec2() - (2.0 * self.border + 1.0)
    }

    /// Whether a map of this rule can be kept from frame to frame: not the sample's.
    pub(crate) const fn can_be_held(&self) -> bool {
        !self.form.is_exact
    }

    /// This rule without a border, its near plane at the covered region. What it covers is no smaller than with one.
    pub(crate) const fn without_room(self) -> Self {
        Self { border: 0.0, depth: Depth::AtCovered, ..self }
    }
}

/// Free texels of settings without a technique: where none are set, the reach of the default filter.
pub(crate) const fn default_border(settings: &FitSettings) -> f32 {
    match settings.map.border {
        Some(texels) => texels,
        None => FilterKind::Pcf5x5.reach(),
    }
}

/// The rule of the near plane for the settings' caster policy.
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
