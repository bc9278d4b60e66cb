//! How good a spot light's map is, as numbers: the sun's [`crate::diagnostics`] for a perspective.
//!
//! Texels grow with the distance from the light and shrink on the screen with that from the camera, so a lamp near the
//! camera is coarse far away and one far away is coarse close up; and a perspective depth is far coarser far from the
//! light than near it.

use glam::{DVec2, DVec3, Mat4, UVec2, Vec2, Vec3};

use super::SpotFit;
use super::bias::{SpotBias, on_hardware};
use super::matrix::COVER_TOLERANCE;
use super::plane::Plane;
use crate::base::{FitError, checks};
use crate::bias::Reach;
use crate::bias::depth_storage::{DepthStorage, depth_step_at};
use crate::diagnostics::{
    AcneMargin, Coverage, EDGE_ON_COSINE, PixelsPerTexel, pixels_of_texels, screen_jacobian, tangents,
};

/// Screen pixels per shadow texel on the surface through `point` with the given normal.
///
/// `point` (metres) and `normal` (any length) are in world axes, the point and the input of `clip_from_world` (the
/// **camera's**, any depth range) **relative to the fit's origin**; `viewport` is the picture's size in pixels. `None`
/// where the point is not in front of the camera and of the light, or where the surface is edge-on to the light, so
/// that its texels are infinitely long.
///
/// The derivation is that of [`crate::diagnostics::pixels_per_texel`], with a perspective on both sides: the map too is
/// a screen, that of the light.
///
/// # Errors
///
/// [`FitError::NotFinite`] and [`FitError::OutOfRange`] for the point or the matrix, [`FitError::BadDirection`] for the
/// normal.
pub fn pixels_per_texel(
    fit: &SpotFit,
    clip_from_world: &Mat4,
    viewport: UVec2,
    point: Vec3,
    normal: Vec3,
) -> Result<Option<PixelsPerTexel>, FitError> {
    checks::point("the point", point.as_dvec3())?;
    for element in clip_from_world.to_cols_array() {
        checks::finite("an element of clip_from_world", f64::from(element))?;
    }
    let normal = checks::unit("the surface normal", normal)?;
    let to_light = fit.position - fit.origin - point.as_dvec3();
    if normal.dot(to_light).abs() < EDGE_ON_COSINE * checks::length(to_light) {
        return Ok(None);
    }
    let tangents = tangents(normal);
    let screen = screen_jacobian(clip_from_world, viewport, point, tangents);
    let texels = screen_jacobian(&fit.clip_from_world, fit.resolution, point, tangents);
    Ok(screen.zip(texels).map(|(screen, texels)| pixels_of_texels(screen, texels)))
}

/// Size of a texel across the light's axis at a world position (f64, metres), along u and v, in metres; `None` for a
/// point that is not before the light. On a slanted surface a texel is longer.
///
/// # Errors
///
/// [`FitError::NotFinite`] and [`FitError::OutOfRange`] for the point.
pub fn texel_size(fit: &SpotFit, point: DVec3) -> Result<Option<Vec2>, FitError> {
    let distance = -fit.project(checks::point("the point", point)?).z;
    if distance <= 0.0 {
        return Ok(None);
    }
    let size = fit.texel_size.as_dvec2() * distance;
    let rounded = |side| checks::rounded("the texel's size", side);
    Ok(Some(Vec2::new(rounded(size.x)?, rounded(size.y)?)))
}

/// How much nearer to the light a point at a distance along its axis (metres, within the planes) has to be for its
/// stored depth to change by one step of the format, in metres: d x / (1 + x) with x = step · d / B and
/// B = near · far / (far - near), the stored depth being A - B / d.
///
/// For equal steps and plain depth it grows with the square of the distance. Floats make it worse for plain depth,
/// since they have their coarsest steps where the stored depth is near 1, which is nearly everywhere, and make it
/// almost proportional to the distance for reversed depth.
///
/// # Errors
///
/// [`FitError::NotFinite`], and [`FitError::OutOfRange`] beyond the planes.
pub fn depth_step(fit: &SpotFit, storage: impl Into<DepthStorage>, distance: f32) -> Result<f32, FitError> {
    let (near, far) = (f64::from(fit.near), f64::from(fit.far));
    let distance = checks::within("the distance along the light's axis", f64::from(distance), near, far)?;
    let stored = fit.depth_at(distance).clamp(0.0, 1.0);
    let step = f64::from(depth_step_at(storage, 1.0, stored as f32)?);
    let share = step * distance / fit.depth_scale();
    checks::rounded("the depth step", distance * share / (1.0 + share))
}

/// Where a world position, in metres, lies in the light's map, for a filter of the given [`Reach`]. Inside is defined
/// by [`SpotFit::covers`]. A point nearer along the axis than the near plane, and every point behind the light, is
/// [`Coverage::BeforeNear`]; one beside the frustum is [`Coverage::Aside`] at any other distance.
///
/// # Errors
///
/// [`FitError::NotFinite`] and [`FitError::OutOfRange`] for the point or the reach.
pub fn coverage(fit: &SpotFit, reach: impl Into<Reach>, point: DVec3) -> Result<Coverage, FitError> {
    let p = fit.project(checks::point("the point", point)?);
    let reach = reach.into().checked()?;
    let window = DVec2::from_array(fit.tangents()) * -p.z;
    checks::finite("the point's place in the map", window.x + window.y)?;
    if fit.covers(point) {
        // A texel beyond the border has its centre half a texel out.
        let free = (window - p.truncate().abs()) / (fit.texel_size.as_dvec2() * -p.z) + 0.5;
        let read = reach.disc.as_dvec2() + f64::from(reach.taps);
        return Ok(if free.cmpge(read).all() { Coverage::Covered } else { Coverage::Border });
    }
    let is_beside = p.truncate().abs().cmpgt(window * (1.0 + 2.0 * COVER_TOLERANCE)).any();
    Ok(if -p.z < f64::from(fit.near) {
        Coverage::BeforeNear
    } else if is_beside {
        Coverage::Aside
    } else {
        Coverage::BehindFar
    })
}

/// Predicted margin of a bias against acne at a world position (f64, metres) on a surface with the given **geometric**
/// normal (world axes, any length, either side): the bias given there less what its plane needs for a filter of the
/// given reach [on hardware](on_hardware) and a map of the given storage. `None` where the map does not cover the
/// point.
///
/// With the lift h, the lifted point's distance d and the depth bias β, all as [`SpotBias`] gives them and less its
/// [precision](SpotBias::precision), the margin is h + β c d / B - d s, in metres along the normal, with c, B and s of
/// [`spot::bias`](super::bias); in texels it is divided by the longer side of one at the point. At 0 or more a plane
/// cannot shadow itself; below, part of its points do.
///
/// # Errors
///
/// [`FitError::NotFinite`], [`FitError::OutOfRange`] for the point or the reach, and [`FitError::BadDirection`] for the
/// normal.
pub fn acne_margin(
    fit: &SpotFit,
    bias: &SpotBias,
    reach: impl Into<Reach>,
    storage: impl Into<DepthStorage>,
    point: DVec3,
    normal: Vec3,
) -> Result<Option<AcneMargin>, FitError> {
    let reach = reach.into().checked()?;
    let bias = bias.checked()?;
    checks::unit("the surface normal", normal)?;
    if !coverage(fit, reach, point)?.is_inside() {
        return Ok(None);
    }
    let given = bias.on_plane(fit, point, normal)?;
    let plane = Plane::of(fit, point, normal)?;
    let precision = SpotBias::precision(storage, fit);
    let offset = f64::from(given.offset);
    let distance = plane.lifted(offset);
    let depth =
        f64::from(given.depth) - f64::from(precision.constant_depth) - f64::from(precision.distance_depth) / distance;
    let lift = offset - f64::from(precision.constant_offset);
    let metres =
        lift + depth * plane.height * distance / fit.depth_scale() - distance * plane.rise(on_hardware(fit, reach)?);
    let texel = f64::from(fit.texel_size.x.max(fit.texel_size.y)) * plane.distance;
    let rounded = |margin| checks::rounded("the acne margin", margin);
    Ok(Some(AcneMargin { metres: rounded(metres)?, texels: rounded(metres / texel)? }))
}
