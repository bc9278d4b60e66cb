//! The fits, one file per algorithm, and their shared code.
//!
//! Every fit computes the box along the light's axes that the shadow map stores. A hull in light space
//! encloses the covered points, a rectangle encloses the hull, and the caster policy places the near plane.
//! [`fit`] and [`fit_scene`] take the rule from the settings. To add a fit, add a file beside this one with a
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
    /// Returns the form of a kind of fit. No other code depends on the kind.
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

/// Fits the light's orthographic view-projection to a camera frustum, by the rule in
/// [`Shape::kind`](crate::settings::Shape::kind).
///
/// The frustum is first cut at [`MapSettings::max_distance`](crate::settings::MapSettings::max_distance).
/// `f32::MAX` leaves it whole; infinity is refused like every number that is not finite. `direction` is the
/// light's **direction of travel** in world axes (right-handed), of any length. If you have the direction
/// toward the light, negate it. This function does not know the scene. [`fit_scene`] takes boxes, and
/// [`FitState`](crate::FitState) makes several maps and keeps them stable.
///
/// # Errors
///
/// An error for every input that is NaN or infinite, [`FitError::BadDirection`],
/// [`FitError::ZeroResolution`], [`FitError::NearNotBelowFar`] for a maximum distance that is not positive
/// and ends before the near plane, and [`FitError::EmptyFrustum`].
pub fn fit(frustum: &ViewFrustum, direction: Vec3, settings: &FitSettings) -> Result<LightProjection, FitError> {
    let input = FitInput::new(core::slice::from_ref(frustum), direction);
    let (rule, light) = prepare(&input, settings, MapUse::alone(settings))?;
    if rule.form.alignment == Alignment::Exact {
        // This fit uses only the corners. Without storage it is as cheap as the sample's own code.
        return fit_whole(&Content::of_views(input.scene()), &light, &rule, settings.map.max_distance, &mut []);
    }
    let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
    let (content, points) = Content::new(input.scene(), &mut storage)?;
    fit_whole(&content, &light, &rule, settings.map.max_distance, points)
}

/// Fits one map around the visible parts of the scene, by the rule in
/// [`Shape::kind`](crate::settings::Shape::kind). It works like [`fit`], with the boxes of receivers and
/// casters.
///
/// If no receiver's box is in view, the map is fitted to the view alone, and [`LightProjection::is_empty`] is
/// true. It is also true if all views begin beyond the maximum distance. In this case the map is a box around
/// the eye that no point reads.
///
/// # Errors
///
/// As [`fit`]. Also [`FitError::NoView`] without a view, and [`FitError::ScratchTooSmall`]; see
/// [`Scratch::required`].
pub fn fit_scene(input: &FitInput, settings: &FitSettings, scratch: &mut Scratch) -> Result<LightProjection, FitError> {
    let (rule, light) = prepare(input, settings, MapUse::alone(settings))?;
    let (content, points) = Content::new(input.scene(), scratch.storage)?;
    fit_whole(&content, &light, &rule, settings.map.max_distance, points)
}

/// Fits one map around everything that receives shadows.
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

/// Returns the view depth at which the first view begins, in metres.
fn nearest(views: &[ViewFrustum]) -> f32 {
    views.iter().map(|view| view.near).fold(f32::MAX, f32::min)
}

/// Returns whether a part of any view lies before the shadow distance, in metres of view depth.
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

/// Alignment of a fit: as tight as possible, or on the world's grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Snapping {
    Tight,
    /// Extents and position across the light are [on the grid](FitRule::snap). [`Volume::stabilise_depth`]
    /// sets the depth range later.
    OnGrid,
}

/// Fits one map around a range of view depths, from the input to the box that becomes its
/// [matrices](LightProjection::from_volume). The sphere fit is always on the grid, the XNA sample's fit
/// never.
#[inline(always)]
pub(crate) fn fit_map(
    content: &Content,
    light: &Light,
    rule: &FitRule,
    range: Range,
    snapping: Snapping,
    points: &mut [DVec2],
) -> Result<Volume, FitError> {
    // 1. The light's axes. All steps below measure along them.
    let axes = light.axes(rule.form.roll);
    // 2. The covered region: its hull in light space, the rectangle around that, and the depth of both,
    //    padded for rounding and by the margin.
    let Covered { mut volume, rounding, shadowed } = Covered::new(rule, content, axes, range, points)?;
    // 3. The map around it, with the border that the filter reads, on the grid or as tight as possible.
    match (rule.form.alignment, snapping) {
        (Alignment::Exact, _) => {}
        (Alignment::Free, Snapping::Tight) => rule.add_border(&mut volume),
        (Alignment::Free, Snapping::OnGrid) | (Alignment::OnGrid, _) => drop(rule.snap(&mut volume, content.origin)),
    }
    // 4. The near plane, moved toward the light so that casters are kept, and the light in it.
    near_plane::place(&mut volume, rule, shadowed, rounding, content);
    Ok(volume)
}
