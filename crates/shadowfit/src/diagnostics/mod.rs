//! How good a fit is, as numbers that any engine can compute: pure functions of the fit.
//!
//! A map's sharpness is measured in *screen pixels per shadow texel along the worse axis*: above
//! one, texels show as jagged edges. Other figures say what the map covers, how much of it is used,
//! how finely it stores depth and how far a bias is from acne.

mod acne;
mod coverage;

use glam::{DVec2, DVec3, Mat4, UVec2, Vec3};

pub use self::acne::{AcneMargin, acne_margin};
pub use self::coverage::{Coverage, coverage, share_of_map};
use crate::base::{FitError, checks};
use crate::fits::LightFit;

pub use crate::bias::depth_storage::{DepthStorage, depth_step, depth_step_at};

/// Screen pixels that one shadow texel covers on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PixelsPerTexel {
    /// Along the worse axis: pixels per texel in the direction in which texels look longest.
    pub worse_axis: f32,
    /// By area: pixels² per texel.
    pub area: f32,
}

/// Screen pixels per shadow texel on the surface through `point` with the given normal.
///
/// `point` (metres) and `normal` (any length) are in world axes, the point and the input of
/// `clip_from_world` (the **camera's**, any depth range) **relative to the fit's origin**;
/// `viewport` is the picture's size in pixels. `None` where the point is not in front of the
/// camera, or where the surface is edge-on to the light, so that its texels are infinitely long.
///
/// # Errors
///
/// [`FitError::NotFinite`] for the point or the matrix, [`FitError::BadDirection`] for the normal.
///
/// # Derivation
///
/// Let a and b be coordinates in the surface's tangent plane. The chain surface → screen has the
/// Jacobian S = ∂(pixel)/∂(a, b), surface → map has T = ∂(texel)/∂(a, b), so
/// J = ∂(pixel)/∂(texel) = S T⁻¹. J takes a circle of one texel to an ellipse of pixels; the
/// worse axis is J's greatest singular value, the area |det J|. For clip = M p the screen
/// position is x/w, whose derivative along a tangent t is (Mt.x - (x/w) Mt.w) / w.
pub fn pixels_per_texel(
    fit: &LightFit,
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
    let tangents = tangents(normal);
    let Some(screen) = screen_jacobian(clip_from_world, viewport, point, tangents) else {
        return Ok(None);
    };
    if normal.dot(fit.direction.as_dvec3()).abs() < EDGE_ON_COSINE {
        return Ok(None);
    }
    Ok(Some(pixels_of_texels(screen, tangents.map(|tangent| texels_along(fit, tangent)))))
}

/// Pixels per texel from the pixels and the texels per metre along the same two tangents.
pub(crate) fn pixels_of_texels([sa, sb]: [DVec2; 2], [ta, tb]: [DVec2; 2]) -> PixelsPerTexel {
    let determinant = ta.x * tb.y - tb.x * ta.y;
    let along_u = (sa * tb.y - sb * ta.y) / determinant;
    let along_v = (sb * ta.x - sa * tb.x) / determinant;
    let area = (along_u.x * along_v.y - along_v.x * along_u.y).abs();
    PixelsPerTexel { worse_axis: greatest_singular_value(along_u, along_v) as f32, area: area as f32 }
}

/// Below this cosine between normal and light a surface counts as edge-on to the light: f32 axes
/// are rounded by as much.
pub(crate) const EDGE_ON_COSINE: f64 = 1e-6;

/// Two unit vectors that span the plane with the given unit normal.
pub(crate) fn tangents(normal: DVec3) -> [DVec3; 2] {
    let axis = if normal.x.abs() < 0.6 { DVec3::X } else { DVec3::Y };
    let a = normal.cross(axis);
    let a = a / checks::length(a);
    [a, normal.cross(a)]
}

/// Pixels per metre along both tangents at a point, or `None` behind the camera.
pub(crate) fn screen_jacobian(
    clip_from_world: &Mat4,
    viewport: UVec2,
    point: Vec3,
    tangents: [DVec3; 2],
) -> Option<[DVec2; 2]> {
    let m = clip_from_world.as_dmat4();
    let p = point.as_dvec3();
    let clip = m.x_axis * p.x + m.y_axis * p.y + m.z_axis * p.z + m.w_axis;
    if clip.w <= 0.0 {
        return None;
    }
    // Clip space is two units wide; the sign of y does not matter here.
    let half = viewport.as_dvec2() * 0.5;
    Some(tangents.map(|t| {
        let d = m.x_axis * t.x + m.y_axis * t.y + m.z_axis * t.z;
        let x = (d.x - clip.x / clip.w * d.w) / clip.w;
        let y = (d.y - clip.y / clip.w * d.w) / clip.w;
        DVec2::new(x, y) * half
    }))
}

/// Texels per metre along a tangent.
fn texels_along(fit: &LightFit, tangent: DVec3) -> DVec2 {
    let m = fit.uv_from_world.as_dmat4();
    let d = m.x_axis * tangent.x + m.y_axis * tangent.y + m.z_axis * tangent.z;
    DVec2::new(d.x, d.y) * fit.resolution.as_dvec2()
}

/// Greatest singular value of the 2×2 matrix with these columns, in the form that does not
/// cancel: half the sum of the radii of its rotating and its mirroring part.
fn greatest_singular_value(c0: DVec2, c1: DVec2) -> f64 {
    let rotating = DVec2::new(c0.x + c1.y, c0.y - c1.x);
    let mirroring = DVec2::new(c0.x - c1.y, c0.y + c1.x);
    0.5 * (libm::sqrt(rotating.dot(rotating)) + libm::sqrt(mirroring.dot(mirroring)))
}
