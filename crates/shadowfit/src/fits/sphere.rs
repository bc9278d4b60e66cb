//! The stable fit: the minimal enclosing sphere of the view, seen from the light.
//!
//! A sphere looks the same from every side, so turning the camera does not change the map's
//! extent; the map's texels lie on a grid that is fixed to the world, so moving it shifts the map
//! by whole texels. Shadow edges stand perfectly still, at the price of a map that is mostly
//! outside the view.
//!
//! For a symmetric frustum the sphere's centre lies on the axis. With half diagonals r₀ at the
//! near and r₁ at the far rectangle, L apart, and x from the near one:
//!
//! ```text
//!          ____
//!        ╱   ╱│╲         x² + r₀² = (L - x)² + r₁²
//!       │  ╱  │ │        x = (L² + r₁² - r₀²) / 2L, at most L
//!      ┌│╱    │r₁        r = √((L - x)² + r₁²)
//!    r₀├┼──●──┤ │
//!       ╲  x  │╱
//! ```
//!
//! Any other view, and several together, get the sphere by incremental construction from at most
//! four points of support, as E. Welzl has it ("Smallest enclosing disks (balls and ellipsoids)",
//! 1991). The stable map with a bounding sphere and whole texels is M. Valient's ("Stable
//! rendering of cascaded shadow maps", `ShaderX6`, 2008); here the extent is rounded up to eighths
//! of an octave instead of a world unit, and the grid is kept in f64.

use glam::{DVec2, DVec3, Vec3};

use super::{Content, Light, Range, Volume, fit_as, near_plane};
use crate::grid;
use crate::light_fit::Constraint;
use crate::settings::{FitKind, FitSettings};
use crate::{FitError, LightFit, ViewFrustum, checks};

/// Fits the frustum's enclosing sphere; see the [module](self). `direction` is the light's
/// direction of travel in world axes.
///
/// # Errors
///
/// As [`fits::fit`](super::fit).
pub fn fit(frustum: &ViewFrustum, direction: Vec3, settings: &FitSettings) -> Result<LightFit, FitError> {
    fit_as(FitKind::Sphere, frustum, direction, settings)
}

/// A sphere, in metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sphere {
    /// Its centre, in world axes relative to the first view's eye.
    pub centre: DVec3,
    /// Its radius.
    pub radius: f64,
}

/// The minimal sphere around a frustum's corners; exact to 1e-9 of its radius for what the
/// corners, in f32, say.
///
/// # Errors
///
/// As [`ViewFrustum::slice`] for frusta that no fit can use.
pub fn enclosing_sphere(frustum: &ViewFrustum) -> Result<Sphere, FitError> {
    let corners = frustum.checked()?.corners.map(Vec3::as_dvec3);
    Ok(Round::new(&corners).map_or_else(|| minimal(&corners), |round| round.sphere(0.0, 1.0)))
}

#[inline(always)]
pub(crate) fn volume(
    content: &Content,
    light: &Light,
    settings: &FitSettings,
    range: Range,
) -> Result<Volume, FitError> {
    let sphere = around(content, range)?;
    let axes = light.axes;
    let centre = axes.project(sphere.centre);
    let rounding = grid::ROUNDING * (3.0 * sphere.radius + checks::length(sphere.centre));
    let pad = f64::from(settings.margin) + rounding + 2.0 * SYMMETRY * sphere.radius;
    let extent = DVec3::splat(2.0 * (sphere.radius + pad));
    let (min, max) = (centre - extent * 0.5, centre + extent * 0.5);
    let (grid, min, max) = grid::snapped(&axes, min, max, content.origin, settings);
    // The whole map is swept toward the light, so that turning the camera moves no plane.
    let outline = [(min.x, min.y), (max.x, min.y), (max.x, max.y), (min.x, max.y)].map(|(x, y)| DVec2::new(x, y));
    let texel = (max - min).truncate() / settings.resolution.as_dvec2();
    let reach = near_plane::filter_reach(texel, settings, rounding);
    let near = near_plane::place(max.z, &axes, &outline, content, settings, reach);
    let sphere = Constraint::Sphere;
    Ok(Volume {
        axes,
        min,
        max: max.with_z(near.z),
        light_z: near.z,
        depth_range: near.z - min.z,
        set_by: [sphere, sphere, sphere, sphere, sphere, near.set_by.unwrap_or(sphere)],
        is_empty: false,
        grid: Some(grid),
    })
}

/// The minimal sphere around all views' slices.
#[inline(always)]
pub(crate) fn around(content: &Content, range: Range) -> Result<Sphere, FitError> {
    if let ([view], Some(round)) = (content.views, content.round()) {
        let (near, far) = (range.near.max(view.near), range.far.min(view.far));
        if near >= far {
            return Err(FitError::NearNotBelowFar { near, far });
        }
        let per_metre = 1.0 / (f64::from(view.far) - f64::from(view.near));
        let share = |depth: f32| (f64::from(depth) - f64::from(view.near)) * per_metre;
        return Ok(round.sphere(share(near), share(far)));
    }
    around_any(content, range)
}

/// The same for views that are several or not symmetric.
#[inline(never)]
fn around_any(content: &Content, range: Range) -> Result<Sphere, FitError> {
    let mut corners = [DVec3::ZERO; 8 * MAX_VIEWS];
    let mut count = 0;
    for slice in content.slices(range) {
        let Some(place) = corners.get_mut(8 * count..8 * count + 8) else {
            let (value, max) = (content.views.len() as f64, MAX_VIEWS as f64);
            return Err(FitError::OutOfRange { input: "the number of views of a stable fit", value, min: 1.0, max });
        };
        place.copy_from_slice(&slice);
        count += 1;
    }
    if count == 0 {
        return Err(FitError::NearNotBelowFar { near: range.near, far: range.far });
    }
    Ok(minimal(&corners[..8 * count]))
}

/// Most views that share a stable map.
pub const MAX_VIEWS: usize = 8;

/// Share of a half diagonal by which the four may differ for the centre to lie on the axis: a few
/// roundings of f32 corners.
const SYMMETRY: f64 = 1e-6;

/// A frustum whose rectangles are round about one axis, upright to it, so that the spheres of its
/// slices follow from their depths.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Round {
    /// Middle of the near rectangle.
    near: DVec3,
    /// From there to the middle of the far one.
    axis: DVec3,
    length: f64,
    /// Half diagonals of the near and the far rectangle.
    radii: (f64, f64),
}

impl Round {
    /// `None` for frusta that are not symmetric.
    #[inline(always)]
    pub(crate) fn new(corners: &[DVec3; 8]) -> Option<Self> {
        let centre = |c: &[DVec3]| (c[0] + c[1] + c[2] + c[3]) * 0.25;
        let (near, far) = (centre(&corners[..4]), centre(&corners[4..]));
        let axis = far - near;
        let length = checks::length(axis);
        let squared = |c: DVec3, middle: DVec3| (c - middle).dot(c - middle);
        let (r0, r1) = (libm::sqrt(squared(corners[0], near)), libm::sqrt(squared(corners[4], far)));
        let is_round = corners[4..].iter().all(|corner| {
            let from_axis = *corner - far;
            (from_axis.dot(from_axis) - r1 * r1).abs() <= 2.0 * SYMMETRY * r1 * r1
                && from_axis.dot(axis).abs() <= SYMMETRY * length * r1
        });
        if is_round && length > 0.0 { Some(Self { near, axis, length, radii: (r0, r1) }) } else { None }
    }

    /// The sphere of the part between two shares of the axis.
    fn sphere(&self, from: f64, to: f64) -> Sphere {
        let radius = |t: f64| self.radii.0 * (1.0 - t) + self.radii.1 * t;
        // Which end is the wider one does not matter to the formula.
        let (r0, r1, length) = (radius(from), radius(to), self.length * (to - from));
        let x = ((length * length + r1 * r1 - r0 * r0) / (2.0 * length)).min(length);
        let radius = libm::sqrt((length - x) * (length - x) + r1 * r1);
        Sphere { centre: self.near + self.axis * (from + x / self.length), radius }
    }
}

/// Share of a squared radius by which a point may lie outside and still count as inside.
const INSIDE: f64 = 1e-12;

/// Least sphere around points: any sphere that leaves a point out is made anew with that point on
/// its surface, up to four of which fix it.
fn minimal(points: &[DVec3]) -> Sphere {
    let mut support = [DVec3::ZERO; 4];
    grow(points, &mut support, 0)
}

fn grow(points: &[DVec3], support: &mut [DVec3; 4], fixed: usize) -> Sphere {
    let mut sphere = through(&support[..fixed]);
    if fixed == 4 {
        return sphere;
    }
    for (i, p) in points.iter().enumerate() {
        let d = *p - sphere.centre;
        if sphere.radius < 0.0 || d.dot(d) > sphere.radius * sphere.radius * (1.0 + INSIDE) {
            support[fixed] = *p;
            sphere = grow(&points[..i], support, fixed + 1);
        }
    }
    sphere
}

/// The least sphere with up to four points on its surface; of negative radius for none.
fn through(points: &[DVec3]) -> Sphere {
    let Some(first) = points.first() else { return Sphere { centre: DVec3::ZERO, radius: -1.0 } };
    // The centre is first + Σ λᵢ eᵢ with 2 eᵢ·(Σ λⱼ eⱼ) = eᵢ·eᵢ, solved by Gram-Schmidt: each new
    // point moves the centre along the part of its edge that is across the earlier ones.
    let mut centre = *first;
    let mut across = [DVec3::ZERO; 3];
    for (k, p) in points[1..].iter().enumerate() {
        let edge = *p - *first;
        let mut u = edge;
        for v in &across[..k] {
            let vv = v.dot(*v);
            if vv > 0.0 {
                u -= *v * (u.dot(*v) / vv);
            }
        }
        across[k] = u;
        let uu = u.dot(u);
        if uu > INSIDE * edge.dot(edge) {
            let (to_point, to_first) = (*p - centre, *first - centre);
            centre += u * ((to_point.dot(to_point) - to_first.dot(to_first)) / (2.0 * u.dot(edge)));
        }
    }
    Sphere { centre, radius: checks::length(*first - centre) }
}
