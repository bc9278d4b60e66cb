//! The family of fits, one file per algorithm, and what they share.
//!
//! Every fit decides which box along the light's axes the shadow map stores: a footprint says
//! what must be inside, a rectangle lies around it, and the caster policy places the near plane.
//! [`fit`] and [`fit_scene`] take the rule from the settings.

pub mod aabb;
pub mod focused;
pub mod oriented;
pub mod sphere;
pub mod xna;

mod footprint;
mod near_plane;
mod outline;
mod volume;

use glam::{DVec2, DVec3, Vec3};

use crate::axes::LightAxes;
use crate::checks::{self, MAX_LENGTH};
use crate::settings::{FitKind, FitSettings, RectangleKind};
use crate::{FitError, FitInput, LightFit, ViewFrustum, Workspace, grid};

pub(crate) use footprint::{Content, Footprint};
pub(crate) use near_plane::{filter_reach, place as place_near};
pub(crate) use outline::{Outline, Scratch};
pub(crate) use volume::{Placing, ROUNDING, Volume};

/// Fits the light's orthographic view-projection to a camera frustum, by the rule that
/// [`FitSettings::kind`] names.
///
/// The frustum is cut at [`FitSettings::max_distance`] first (`f32::MAX` leaves it whole; infinity
/// is refused like every number that is not finite). `direction` is the light's
/// **direction of travel** in world axes (right-handed); sources that speak of the direction
/// toward the light use the opposite sign. Its length is of no account. Nothing is known of the
/// scene here: [`fit_scene`] takes boxes, [`MapFitter`](crate::MapFitter) makes several
/// maps and keeps them still.
///
/// # Errors
///
/// Every input that is NaN or infinite, [`FitError::BadDirection`], [`FitError::ZeroResolution`],
/// [`FitError::NearNotBelowFar`] when the maximum distance ends before the near plane, and
/// [`FitError::EmptyFrustum`].
pub fn fit(frustum: &ViewFrustum, direction: Vec3, settings: &FitSettings) -> Result<LightFit, FitError> {
    let input = FitInput::new(core::slice::from_ref(frustum), direction);
    if settings.kind == FitKind::XnaSample {
        // It looks at nothing but the corners, and is as cheap as the sample's own only without storage.
        return xna::of_view(&input, settings);
    }
    let mut storage = [DVec2::ZERO; Workspace::required(0, 1)];
    fit_scene(&input, settings, &mut Workspace::new(&mut storage))
}

/// Fits one map around what the views see of the scene, by the rule that [`FitSettings::kind`]
/// names. As [`fit`], with the boxes of receivers and casters.
///
/// Where no receiver's box is in view the fit is that of the view alone, and
/// [`LightFit::is_empty`] says so.
///
/// # Errors
///
/// As [`fit`]; [`FitError::NoView`] without a view; [`FitError::WorkspaceTooSmall`], see
/// [`Workspace::required`].
pub fn fit_scene(input: &FitInput, settings: &FitSettings, workspace: &mut Workspace) -> Result<LightFit, FitError> {
    let (light, distance) = prepare(input, settings)?;
    let (boxes, points) = Content::new(input, workspace)?;
    let range = Range { near: f32::MIN, far: distance };
    let mut volume = fit_slice(&boxes, &light, settings, range, Placing::Tight, points)?;
    grid::steady(&mut volume, boxes.origin, None, 1.0);
    LightFit::from_volume(input.views[0].origin, &volume, settings)
}

/// A range of view depths, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    pub(crate) near: f32,
    pub(crate) far: f32,
}

/// The light of one frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Light {
    /// Unit direction of travel.
    pub(crate) direction: DVec3,
    /// Unit direction that is up.
    pub(crate) up: DVec3,
    /// Axes of the kind of fit that it was made for.
    pub(crate) axes: LightAxes,
}

impl Light {
    #[inline(always)]
    fn new(direction: DVec3, up: DVec3, kind: FitKind) -> Self {
        let axes = match kind {
            FitKind::XnaSample => LightAxes::look_at(direction, up),
            _ => LightAxes::shortest_arc(direction, up),
        };
        Self { direction, up, axes }
    }

    /// The same light for another kind of fit.
    pub(crate) fn of_kind(&self, kind: FitKind) -> Self {
        Self::new(self.direction, self.up, kind)
    }
}

/// One map around a range of view depths. The sphere's is always on the grid, the XNA sample's never.
#[inline(always)]
pub(crate) fn fit_slice(
    content: &Content,
    light: &Light,
    settings: &FitSettings,
    range: Range,
    placing: Placing,
    points: &mut [DVec2],
) -> Result<Volume, FitError> {
    // Errors are handed on arm by arm, so that the volume, which is large, is written once.
    Ok(match settings.kind {
        FitKind::XnaSample => xna::volume(content, light, settings, range)?,
        FitKind::FrustumAabb => aabb::volume(content, light, settings, range, placing, points)?,
        FitKind::Oriented => oriented::volume(content, light, settings, range, placing, points)?,
        FitKind::Sphere => sphere::volume(content, light, settings, range)?,
        FitKind::Focused => focused::volume(content, light, settings, range, placing, points)?,
    })
}

/// Fits a single frustum by one kind, whatever the settings name.
pub(crate) fn fit_as(
    kind: FitKind,
    frustum: &ViewFrustum,
    direction: Vec3,
    settings: &FitSettings,
) -> Result<LightFit, FitError> {
    fit(frustum, direction, &FitSettings { kind, ..*settings })
}

/// Checks what all fits take; gives the light and the view depth at which shadows end.
#[inline(always)]
pub(crate) fn prepare(input: &FitInput, settings: &FitSettings) -> Result<(Light, f32), FitError> {
    let (direction, up) = checked(input, settings)?;
    Ok((Light::new(direction, up, settings.kind), settings.max_distance))
}

/// Checks what all fits take; gives the unit directions of the light's travel and of up.
#[inline(always)]
fn checked(input: &FitInput, settings: &FitSettings) -> Result<(DVec3, DVec3), FitError> {
    if input.views.is_empty() {
        return Err(FitError::NoView);
    }
    for view in input.views {
        view.check()?;
    }
    check(settings)?;
    let direction = checks::unit("the light's direction", input.direction)?;
    let up = checks::unit("the up direction", settings.up)?;
    let near = input.views.iter().map(|view| view.near).fold(f32::MAX, f32::min);
    if near >= settings.max_distance {
        return Err(FitError::NearNotBelowFar { near, far: settings.max_distance });
    }
    Ok((direction, up))
}

/// Checks the numbers of a fit's settings.
pub(crate) fn check(settings: &FitSettings) -> Result<(), FitError> {
    checks::within("the fit's margin", f64::from(settings.margin), 0.0, MAX_LENGTH)?;
    let extension = f64::from(settings.caster_extension);
    checks::within("the fit's caster extension", extension, 0.0, MAX_LENGTH)?;
    if settings.resolution.x == 0 || settings.resolution.y == 0 {
        return Err(FitError::ZeroResolution { resolution: settings.resolution });
    }
    let widest = f64::from(settings.resolution.min_element()) * 0.25;
    checks::within("the fit's border", f64::from(settings.border_texels()), 0.0, widest)?;
    checks::finite("the maximum shadow distance", f64::from(settings.max_distance))?;
    Ok(())
}

/// The rectangle kind that a fit's settings stand for.
pub(crate) fn rectangle_kind(settings: &FitSettings) -> RectangleKind {
    match settings.kind {
        FitKind::Oriented | FitKind::Focused => settings.rectangle,
        FitKind::XnaSample | FitKind::FrustumAabb | FitKind::Sphere => RectangleKind::AxisAligned,
    }
}
