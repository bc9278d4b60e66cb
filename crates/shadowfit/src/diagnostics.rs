//! Figures that rate a fit, as pure functions of the fit, for any engine.
//!
//! Sharpness is measured in *screen pixels per shadow texel along the worse axis*. Above 1, texels show as
//! jagged edges. Other figures give a map's coverage, the used share of its area, the precision of its depth,
//! and the margin of a bias against acne.

pub use crate::bias::depth_storage::{DepthStorage, depth_step, depth_step_at};

use glam::{DVec2, DVec3, Mat4, UVec2, Vec3};

use crate::base::{DepthConvention, FitError, checks};
use crate::bias::{Bias, FilterRadius, SQUARED_SINE_ROUNDING, Slope, depth_precision};
use crate::projection::LightProjection;

/// Screen pixels that one shadow texel covers on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PixelsPerTexel {
    /// Pixels per texel in the direction in which texels look longest.
    pub worse_axis: f32,
    /// Square pixels per texel.
    pub area: f32,
}

/// Returns the screen pixels per shadow texel on the surface through `point` with the given normal.
///
/// `point` (metres) and `normal` (any length) are in world axes. `clip_from_world` is the **camera's**
/// matrix, with any depth range. The point and the matrix's input are **relative to the fit's origin**.
/// `viewport` is the picture's size in pixels. Returns `None` if the point is not in front of the camera, or
/// if the surface is edge-on to the light, which makes its texels infinitely long.
///
/// # Errors
///
/// [`FitError::NotFinite`] for the point or the matrix, [`FitError::BadDirection`] for the normal.
///
/// # Derivation
///
/// Let a and b be coordinates in the surface's tangent plane. The map from surface to screen has the Jacobian
/// S = ∂(pixel)/∂(a, b), and the map from surface to shadow map has T = ∂(texel)/∂(a, b), so J =
/// ∂(pixel)/∂(texel) = S T⁻¹. J takes a circle of one texel to an ellipse of pixels. The worse axis is J's
/// greatest singular value, and the area is |det J|. For clip = M p the screen position is x/w, whose
/// derivative along a tangent t is (Mt.x - (x/w) Mt.w) / w.
pub fn pixels_per_texel(
    fit: &LightProjection,
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

/// Computes pixels per texel from the pixels and the texels per metre along the same two tangents.
pub(crate) fn pixels_of_texels([sa, sb]: [DVec2; 2], [ta, tb]: [DVec2; 2]) -> PixelsPerTexel {
    let determinant = ta.x * tb.y - tb.x * ta.y;
    let along_u = (sa * tb.y - sb * ta.y) / determinant;
    let along_v = (sb * ta.x - sa * tb.x) / determinant;
    let area = (along_u.x * along_v.y - along_v.x * along_u.y).abs();
    PixelsPerTexel { worse_axis: greatest_singular_value(along_u, along_v) as f32, area: area as f32 }
}

/// Cosine between normal and light below which a surface counts as edge-on to the light. The rounding of f32
/// axes is of this size.
pub(crate) const EDGE_ON_COSINE: f64 = 1e-6;

/// Returns two unit vectors that span the plane with the given unit normal.
pub(crate) fn tangents(normal: DVec3) -> [DVec3; 2] {
    let axis = if normal.x.abs() < 0.6 { DVec3::X } else { DVec3::Y };
    let a = normal.cross(axis);
    let a = a / checks::length(a);
    [a, normal.cross(a)]
}

/// Computes the pixels per metre along both tangents at a point. Returns `None` behind the camera.
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

/// Computes the texels per metre along a tangent.
fn texels_along(fit: &LightProjection, tangent: DVec3) -> DVec2 {
    let m = fit.uv_from_world.as_dmat4();
    let d = m.x_axis * tangent.x + m.y_axis * tangent.y + m.z_axis * tangent.z;
    DVec2::new(d.x, d.y) * fit.resolution.as_dvec2()
}

/// Computes the greatest singular value of the 2×2 matrix with these columns, in the form that does not
/// cancel: half the sum of the radii of its rotating and its mirroring part.
fn greatest_singular_value(c0: DVec2, c1: DVec2) -> f64 {
    let rotating = DVec2::new(c0.x + c1.y, c0.y - c1.x);
    let mirroring = DVec2::new(c0.x - c1.y, c0.y + c1.x);
    0.5 * (libm::sqrt(rotating.dot(rotating)) + libm::sqrt(mirroring.dot(mirroring)))
}

/// Position of a point relative to a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Coverage {
    /// Inside, with the whole footprint of the filter.
    Covered,
    /// Inside, but the footprint of the filter extends beyond the map's border.
    Border,
    /// Outside, beside the map.
    Aside,
    /// Outside, nearer to the light than the near plane. The point neither receives nor casts a shadow.
    BeforeNear,
    /// Outside, behind the far plane.
    BehindFar,
}

impl Coverage {
    /// Returns whether the map can be read for the point; see [`LightProjection::covers`].
    pub const fn is_inside(self) -> bool {
        matches!(self, Self::Covered | Self::Border)
    }
}

/// Classifies a world position, in metres, by its place in a map, for a filter of the given [`FilterRadius`].
/// A point is inside if [`LightProjection::covers`] returns true. A point beside the map is
/// [`Coverage::Aside`] at any depth.
///
/// # Errors
///
/// [`FitError::NotFinite`] and [`FitError::OutOfRange`] for the point or the filter radius.
pub fn coverage(fit: &LightProjection, reach: impl Into<FilterRadius>, point: DVec3) -> Result<Coverage, FitError> {
    checks::point("the point", point)?;
    let reach = reach.into().checked()?;
    let at = texture_point(fit, point - fit.origin)?;
    let uv = DVec2::new(at.x, at.y);
    if fit.covers(point) {
        // The centre of the first texel beyond the border lies half a texel outside.
        let free = uv.min(1.0 - uv) * fit.resolution.as_dvec2() + 0.5;
        let read = reach.disc.as_dvec2() + f64::from(reach.taps);
        return Ok(if free.cmpge(read).all() { Coverage::Covered } else { Coverage::Border });
    }
    let depth = if fit.depth == DepthConvention::Reversed { 1.0 - at.z } else { at.z };
    let outside = (uv - 0.5).abs() - 0.5;
    let aside = outside.x.max(outside.y);
    let along = (depth - 0.5).abs() - 0.5;
    Ok(if aside > ASIDE_TOLERANCE || aside >= along {
        Coverage::Aside
    } else if depth < 0.5 {
        Coverage::BeforeNear
    } else {
        Coverage::BehindFar
    })
}

/// Tolerance for rounding at the map's sides, as a share of the map's extent. Within it, the side with the
/// greater excess is reported.
const ASIDE_TOLERANCE: f64 = 1e-6;

/// Returns the share of the map's area, 0..=1, inside the convex hull of `points` as seen from the light.
/// Pass the corners of a frustum slice, of the receivers' boxes, or any other points that the map must cover.
/// They are in world axes **relative to the fit's origin**, in metres, in any order. Depth is ignored, and
/// the part of the hull outside the map is cut off. Fewer than three points have no area.
///
/// The result is an upper bound of the share that visible points use, since they may not fill their hull.
///
/// # Errors
///
/// [`FitError::NotFinite`] and [`FitError::OutOfRange`] for the points.
///
/// # Algorithm
///
/// The hull's upper chain starts at the leftmost point and repeatedly goes to the point of greatest slope
/// ahead (R. A. Jarvis, "On the identification of the convex hull of a finite set of points in the plane",
/// 1973). It compares slopes instead of angles, so it always advances. The lower chain works likewise. The
/// difference of the two chains, clamped to the map, is integrated edge by edge, so no hull is stored. For n
/// points and h corners it takes n·h steps, without a limit on either.
pub fn share_of_map(fit: &LightProjection, points: &[Vec3]) -> Result<f32, FitError> {
    for point in points {
        checks::point("a point that the map must cover", point.as_dvec3())?;
        texture_point(fit, point.as_dvec3())?;
    }
    // All points were checked above, so none is dropped here.
    let seen = || points.iter().filter_map(|p| texture_point(fit, p.as_dvec3()).ok()).map(|p| DVec2::new(p.x, p.y));
    let (least, greatest) = seen().fold((1.0, 0.0), |(min, max): (f64, f64), p| (min.min(p.x), max.max(p.x)));
    let width = (greatest.min(1.0) - least.max(0.0)).max(0.0);
    // The area above the lower chain is the area below the upper chain of the flipped map.
    let above = area_below_chain(|| seen().map(|p| DVec2::new(p.x, 1.0 - p.y)));
    Ok((area_below_chain(seen) + above - width).clamp(0.0, 1.0) as f32)
}

/// Computes the area of the unit square below the upper chain of the points' hull.
fn area_below_chain<I: Iterator<Item = DVec2>>(points: impl Fn() -> I) -> f64 {
    let leftmost = |a: DVec2, b: DVec2| if b.x < a.x || (b.x == a.x && b.y > a.y) { b } else { a };
    let Some(mut from) = points().reduce(leftmost) else { return 0.0 };
    let mut area = 0.0;
    let steeper = |from: DVec2| {
        move |a: DVec2, b: DVec2| {
            let turn = (a - from).perp_dot(b - from);
            if turn > 0.0 || (turn == 0.0 && b.x > a.x) { b } else { a }
        }
    };
    while let Some(to) = points().filter(|p| p.x > from.x).reduce(steeper(from)) {
        area += area_below_edge(from, to);
        from = to;
    }
    area
}

/// Computes the area of the unit square below an edge that goes to the right.
fn area_below_edge(from: DVec2, to: DVec2) -> f64 {
    let (left, right) = (from.x.max(0.0), to.x.min(1.0));
    if left >= right {
        return 0.0;
    }
    let height = |x: f64| from.y + (to.y - from.y) * ((x - from.x) / (to.x - from.x));
    let (a, b) = (height(left), height(right));
    // Integral of clamp(y, 0, 1) from y = 0.
    let integral = |y: f64| if y < 1.0 { 0.5 * y.max(0.0) * y.max(0.0) } else { y - 0.5 };
    let mean =
        if (b - a).abs() < LEVEL { (0.5 * (a + b)).clamp(0.0, 1.0) } else { (integral(b) - integral(a)) / (b - a) };
    mean * (right - left)
}

/// Rise below which an edge counts as level. The error of the mean height is then below the square of this
/// number; the quotient of differences would lose more.
const LEVEL: f64 = 1e-6;

/// Computes the texture coordinates and stored depth of a point relative to the fit's origin, in f64.
fn texture_point(fit: &LightProjection, point: DVec3) -> Result<DVec3, FitError> {
    let m = fit.uv_from_world.as_dmat4();
    let at = m.x_axis * point.x + m.y_axis * point.y + m.z_axis * point.z + m.w_axis;
    for coordinate in [at.x, at.y, at.z] {
        checks::finite("a texture coordinate", coordinate)?;
    }
    Ok(at.truncate())
}

/// Constant bias of a map and the rounding that it must cover, in metres along the light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DepthRounding {
    /// [Step](depth_step) of the map's format over its depth range.
    pub step: f32,
    /// Required bias, [`depth_precision`]: the step, plus the shift that f32 arithmetic causes between a
    /// receiver and the surface that the map stores.
    pub needed: f32,
    /// [`Bias::constant_depth`].
    pub bias: f32,
}

impl DepthRounding {
    /// Returns whether the bias covers the rounding. If not, surfaces that face the light shadow themselves
    /// in bands.
    pub fn is_covered(&self) -> bool {
        // The bias itself is rounded, too.
        self.bias >= self.needed * (1.0 - 1e-5)
    }
}

/// Compares the constant bias of a map with the rounding of its depths. Both grow with the map's depth range and with the
/// distance of the receivers' vertices; the [automatic bias](crate::settings::BiasSettings::automatic) always covers the
/// rounding.
pub fn depth_rounding(fit: &LightProjection, bias: &Bias, storage: impl Into<DepthStorage>) -> DepthRounding {
    let storage = storage.into();
    DepthRounding {
        step: depth_step(storage, fit.depth_range),
        needed: depth_precision(fit, storage) * fit.depth_range,
        bias: bias.constant_depth * fit.depth_range,
    }
}

/// Bias minus the bias that a plane needs. If it is negative, the plane shadows itself in stripes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct AcneMargin {
    /// Margin in metres along the normal: the distance that the point could sink into its surface without
    /// acne.
    pub metres: f32,
    /// Margin in texels, by the longer side of a texel, as biases are set.
    pub texels: f32,
}

/// Predicts the margin of a bias against acne at a world position (f64, metres) on a surface with the given
/// **geometric** normal (world axes, any length, either side). The margin is the bias that is applied there,
/// minus the bias that its plane needs for a filter of the given radius [on
/// hardware](FilterRadius::on_hardware) and a map of the given storage. Returns `None` if the map does not
/// cover the point.
///
/// With the normal offset h, the depth bias d of [`Bias::on_plane`] and the depth range R, the margin is `h +
/// (d - precision) · R · cos θ - E · (tx·|n·x| + ty·|n·y|)`. At 0 or more, a plane cannot shadow itself.
/// Below 0, some of its points do. Curved surfaces need more than their tangent plane.
///
/// # Errors
///
/// [`FitError::NotFinite`], [`FitError::OutOfRange`] for the point or the filter radius, and
/// [`FitError::BadDirection`] for the normal.
pub fn acne_margin(
    fit: &LightProjection,
    bias: &Bias,
    reach: impl Into<FilterRadius>,
    storage: impl Into<DepthStorage>,
    point: DVec3,
    normal: Vec3,
) -> Result<Option<AcneMargin>, FitError> {
    let reach = reach.into().checked()?;
    let given = bias.on_plane(fit, normal)?;
    let plane = Slope::of(fit, normal)?;
    if !coverage(fit, reach, point)?.is_inside() {
        return Ok(None);
    }
    // A shader computes the sine from an f32 cosine. It may be smaller than the sine of `on_plane`.
    let squared_sine = 1.0 - plane.cosine * plane.cosine;
    let sine = libm::sqrt((squared_sine - SQUARED_SINE_ROUNDING).max(0.0));
    let offset = f64::from(given.offset).min(f64::from(bias.normal_offset) * sine);
    let depth = f64::from(given.depth) - f64::from(depth_precision(fit, storage));
    let along_normal = depth * f64::from(fit.depth_range) * plane.cosine;
    let metres = offset + along_normal - reach.on_hardware(fit).rise(plane.u, plane.v);
    let texel = f64::from(fit.texel_size.x.max(fit.texel_size.y));
    let rounded = |margin| checks::rounded("the acne margin", margin);
    Ok(Some(AcneMargin { metres: rounded(metres)?, texels: rounded(metres / texel)? }))
}
