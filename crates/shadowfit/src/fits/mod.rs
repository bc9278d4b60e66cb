//! The family of fits, one file per algorithm, and what they share.
//!
//! Every fit decides which box along the light's axes the shadow map stores: a hull in the light's
//! space says what must be inside, a rectangle lies around it, and the caster policy places the near
//! plane. [`fit`] and [`fit_scene`] take the rule from the settings. A further fit is a file beside this one with a
//! [`Form`], and a line in [`Form::of`].

mod aabb;
pub(crate) mod covered;
mod focused;
mod form;
mod frame;
pub(crate) mod near_plane;
mod oriented;
pub(crate) mod rectangle;
mod rule;
mod sphere;
mod xna;

pub(crate) use form::{Alignment, Covers, Form};
pub(crate) use frame::{Frame, PlacedMap, PlacedMaps};
pub(crate) use rule::{Depth, FitRule, MapUse, check_least_texel};

use glam::{DVec2, Vec3};

use crate::base::{FitError, checks};
use crate::content::Content;
use crate::fits::covered::Covered;
use crate::input::{FitInput, Scratch};
use crate::light::{Light, Volume};
use crate::projection::LightProjection;
use crate::technique::settings::{FitKind, FitSettings};
use crate::view::{Range, ViewFrustum};

impl Form {
    /// The form of a kind of fit. The kind is looked at here and nowhere else.
    const fn of(kind: FitKind) -> Self {
        match kind {
            FitKind::XnaSample => xna::FORM,
            FitKind::FrustumAabb => aabb::FORM,
            FitKind::Oriented => oriented::FORM,
            FitKind::Sphere => sphere::FORM,
            FitKind::Focused => focused::FORM,
        }
    }
}

/// Fits the light's orthographic view-projection to a camera frustum, by the rule that
/// [`Shape::kind`](crate::settings::Shape::kind) names.
///
/// The frustum is cut at [`MapSettings::max_distance`](crate::settings::MapSettings::max_distance) first (`f32::MAX` leaves it whole; infinity
/// is refused like every number that is not finite). `direction` is the light's **direction of
/// travel** in world axes (right-handed); sources that speak of the direction toward the light use
/// the opposite sign. Its length is ignored. Nothing is known about the scene here: [`fit_scene`]
/// takes boxes, [`FitState`](crate::FitState) makes several maps and keeps them still.
///
/// # Errors
///
/// Every input that is NaN or infinite, [`FitError::BadDirection`], [`FitError::ZeroResolution`],
/// [`FitError::NearNotBelowFar`] for a maximum distance that is not positive and ends before the near plane, and
/// [`FitError::EmptyFrustum`].
pub fn fit(frustum: &ViewFrustum, direction: Vec3, settings: &FitSettings) -> Result<LightProjection, FitError> {
    let input = FitInput::new(core::slice::from_ref(frustum), direction);
    let (rule, light) = prepare(&input, settings, MapUse::alone(settings))?;
    if rule.form.alignment == Alignment::Exact {
        // It uses nothing but the corners, and is as cheap as the sample's own code only without
        // storage.
        return fit_whole(&Content::of_views(input.scene()), &light, &rule, settings.map.max_distance, &mut []);
    }
    let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
    let (content, points) = Content::new(input.scene(), &mut storage)?;
    fit_whole(&content, &light, &rule, settings.map.max_distance, points)
}

/// Fits one map around what the views see of the scene, by the rule that [`Shape::kind`](crate::settings::Shape::kind)
/// names. As [`fit`], with the boxes of receivers and casters.
///
/// Where no receiver's box is in view the fit is that of the view alone, and
/// [`LightProjection::is_empty`] says so. So it does where all views begin beyond the maximum distance: the map is a box
/// around the eye then, which nothing reads.
///
/// # Errors
///
/// As [`fit`]; [`FitError::NoView`] without a view; [`FitError::ScratchTooSmall`], see
/// [`Scratch::required`].
pub fn fit_scene(input: &FitInput, settings: &FitSettings, scratch: &mut Scratch) -> Result<LightProjection, FitError> {
    let (rule, light) = prepare(input, settings, MapUse::alone(settings))?;
    let (content, points) = Content::new(input.scene(), scratch.storage)?;
    fit_whole(&content, &light, &rule, settings.map.max_distance, points)
}

/// One map around everything that receives shadows.
#[inline(always)]
fn fit_whole(
    content: &Content,
    light: &Light,
    rule: &FitRule,
    distance: f32,
    points: &mut [DVec2],
) -> Result<LightProjection, FitError> {
    if !is_shadowed(content.views, distance) {
        let volume = Volume::nowhere(light.axes(rule.form.roll));
        return LightProjection::from_volume(content.origin, &volume, rule.resolution, rule.convention);
    }
    let range = Range { near: f32::MIN, far: distance };
    let mut volume = fit_map(content, light, rule, range, Snapping::Tight, points)?;
    volume.stabilise_depth(content.origin, None, 1.0);
    volume.vertex_distance = content.farthest_seen(range, 0.0);
    LightProjection::from_volume(content.origin, &volume, rule.resolution, rule.convention)
}

/// View depth at which the first view begins, in metres.
fn nearest(views: &[ViewFrustum]) -> f32 {
    views.iter().map(|view| view.near).fold(f32::MAX, f32::min)
}

/// Whether a part of any view lies before the distance at which shadows end, in metres of view depth.
pub(crate) fn is_shadowed(views: &[ViewFrustum], distance: f32) -> bool {
    views.iter().any(|view| view.begins_before(distance))
}

/// Checks the inputs that all fits share. Returns the rule of the settings for a use of the map, and the light.
#[inline(always)]
pub(crate) fn prepare(input: &FitInput, settings: &FitSettings, map: MapUse) -> Result<(FitRule, Light), FitError> {
    if input.views.is_empty() {
        return Err(FitError::NoView);
    }
    for view in input.views {
        view.check()?;
    }
    let rule = FitRule::new(settings, map, input.knows_casters())?;
    let direction = checks::unit("the light's direction", input.direction)?;
    let up = checks::unit("the up direction", settings.map.up)?;
    let (near, distance) = (nearest(input.views), settings.map.max_distance);
    if near >= distance {
        checks::may_begin_beyond(near, distance)?;
    }
    Ok((rule, Light::new(direction, up, rule.form.roll)))
}

/// Whether a fit is as tight as possible or lies on the world's grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Snapping {
    Tight,
    /// With extents and position across the light [on the grid](FitRule::snap); the depth range is left
    /// for [`Volume::stabilise_depth`].
    OnGrid,
}

/// One map around a range of view depths, from the input to the box that becomes its
/// [matrices](LightProjection::from_volume). The sphere fit is always on the grid, the XNA sample's never.
#[inline(always)]
pub(crate) fn fit_map(
    content: &Content,
    light: &Light,
    rule: &FitRule,
    range: Range,
    snapping: Snapping,
    points: &mut [DVec2],
) -> Result<Volume, FitError> {
    // 1. The light's axes, along which everything is measured from here on.
    let axes = light.axes(rule.form.roll);
    // 2. What must be inside: its hull in the light's space, the rectangle around that, and the depth
    //    of both, padded for rounding and by the margin.
    let Covered { mut volume, rounding, shadowed } = Covered::new(rule, content, axes, range, points)?;
    // 3. The map around it, with the border that the filter reads: on the grid or as tight as can be.
    match (rule.form.alignment, snapping) {
        (Alignment::Exact, _) => {}
        (Alignment::Free, Snapping::Tight) => rule.add_border(&mut volume),
        (Alignment::Free, Snapping::OnGrid) | (Alignment::OnGrid, _) => drop(rule.snap(&mut volume, content.origin)),
    }
    // 4. The near plane, moved toward the light so that casters are kept, and the light in it.
    near_plane::place(&mut volume, rule, shadowed, rounding, content);
    Ok(volume)
}
