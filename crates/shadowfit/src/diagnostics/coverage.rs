//! What a map covers, and how much of it is used.

use glam::{DVec2, DVec3, Vec3};

use crate::base::{DepthConvention, FitError, checks};
use crate::bias::Reach;
use crate::fits::LightFit;

/// Where a point lies in a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Coverage {
    /// Inside, with every texel that the filter reads.
    Covered,
    /// Inside, but the filter reads texels beyond the map's border.
    Border,
    /// Outside, across the light.
    Aside,
    /// Outside, nearer to the light than the near plane: it neither receives nor casts a shadow.
    BeforeNear,
    /// Outside, behind the far plane.
    BehindFar,
}

impl Coverage {
    /// Whether the map can be read for the point: [`LightFit::covers`].
    pub const fn is_inside(self) -> bool {
        matches!(self, Self::Covered | Self::Border)
    }
}

/// Where a world position, in metres, lies in a map, for a filter of the given [`Reach`]. Inside is
/// defined by [`LightFit::covers`]; a point outside across the light is [`Coverage::Aside`] at any
/// depth.
///
/// # Errors
///
/// [`FitError::NotFinite`] and [`FitError::OutOfRange`] for the point or the reach.
pub fn coverage(fit: &LightFit, reach: impl Into<Reach>, point: DVec3) -> Result<Coverage, FitError> {
    checks::point("the point", point)?;
    let reach = reach.into().checked()?;
    let at = texture_point(fit, point - fit.origin)?;
    let uv = DVec2::new(at.x, at.y);
    if fit.covers(point) {
        // A texel beyond the border has its centre half a texel out.
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

/// Share of the map's extent by which a point may lie beside it by rounding alone; below it, the
/// side with the greater excess is reported.
const ASIDE_TOLERANCE: f64 = 1e-6;

/// Share of the map's area, 0..=1, inside the convex hull of `points` as seen by the light: the
/// corners of a frustum's slice, of the receivers' boxes or of anything else that the map must
/// cover. They are in world axes **relative to the fit's origin**, in metres, in any order; depth
/// is ignored, and the part outside the map is cut off. Fewer than three points have no area.
///
/// It is an upper bound of the share that visible points use, since they may not fill their hull.
///
/// # Errors
///
/// [`FitError::NotFinite`] and [`FitError::OutOfRange`] for the points.
///
/// # Algorithm
///
/// The hull's upper chain starts at the leftmost point and goes to the point of greatest slope
/// ahead, again and again (R. A. Jarvis, "On the identification of the convex hull of a finite
/// set of points in the plane", 1973, by slopes instead of angles, so that it always moves on);
/// the lower chain likewise. Their difference, clamped to the map, is integrated edge by edge, so
/// no hull is stored: for n points and h corners n·h steps, and no limit to either.
pub fn share_of_map(fit: &LightFit, points: &[Vec3]) -> Result<f32, FitError> {
    for point in points {
        checks::point("a point of what the map is for", point.as_dvec3())?;
        texture_point(fit, point.as_dvec3())?;
    }
    // Checked above, so that no point is dropped here.
    let seen = || points.iter().filter_map(|p| texture_point(fit, p.as_dvec3()).ok()).map(|p| DVec2::new(p.x, p.y));
    let (least, greatest) = seen().fold((1.0, 0.0), |(min, max): (f64, f64), p| (min.min(p.x), max.max(p.x)));
    let width = (greatest.min(1.0) - least.max(0.0)).max(0.0);
    // The area above the lower chain is the area below the upper chain of the flipped map.
    let above = area_below_chain(|| seen().map(|p| DVec2::new(p.x, 1.0 - p.y)));
    Ok((area_below_chain(seen) + above - width).clamp(0.0, 1.0) as f32)
}

/// Area of the unit square below the upper chain of the points' hull.
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

/// Area of the unit square below an edge that goes to the right.
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

/// Rise below which an edge counts as level: the mean height is then off by less than this
/// squared, and the quotient of differences would lose more.
const LEVEL: f64 = 1e-6;

/// Texture coordinates and stored depth of a point relative to the fit's origin, in f64.
fn texture_point(fit: &LightFit, point: DVec3) -> Result<DVec3, FitError> {
    let m = fit.uv_from_world.as_dmat4();
    let at = m.x_axis * point.x + m.y_axis * point.y + m.z_axis * point.z + m.w_axis;
    for coordinate in [at.x, at.y, at.z] {
        checks::finite("a texture coordinate", coordinate)?;
    }
    Ok(at.truncate())
}
