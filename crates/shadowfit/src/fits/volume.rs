//! A fit's decision, before it becomes matrices.

use glam::{DVec2, DVec3};

use super::{Content, Footprint, Range, near_plane, rectangle_kind};
use crate::axes::LightAxes;
use crate::grid::{self, Grid};
use crate::light_fit::Constraint;
use crate::rectangle::{self, Rectangle};
use crate::settings::{FitSettings, RectangleKind};

/// A box along the light's axes and how it is stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Volume {
    pub(crate) axes: LightAxes,
    /// Corner of the fitted box with the least coordinates, along the light's axes and relative
    /// to the fit's origin, in metres.
    pub(crate) min: DVec3,
    /// The opposite corner; its z is the map's near plane.
    pub(crate) max: DVec3,
    /// Coordinate of the light along its z axis.
    pub(crate) light_z: f64,
    /// Distance between near and far plane, in metres.
    pub(crate) depth_range: f64,
    /// What set the planes -x, +x, -y, +y, far, near.
    pub(crate) set_by: [Constraint; 6],
    pub(crate) is_empty: bool,
    /// Where it lies on the world's grid, if it does.
    pub(crate) grid: Option<Grid>,
}

/// What a box is enlarged by on each side, as a share of the greatest distance from the origin and
/// the box's own extent together.
///
/// A shader's f32 matrix times an f32 position is off by ten times 2⁻²⁴ of the sum of its terms,
/// as [`verify`](crate::verify) counts, the matrix's elements by two and the frustum's corners by
/// two more. The terms of the position sum to no more than its distance d, the translation is no
/// more than d and half the extent e, and an offset of the texture or clip coordinates adds another
/// half: 14 d + 12 (d + e), which 28 times 2⁻²⁴ of d + e is more than.
pub(crate) const ROUNDING: f64 = 28.0 / 16_777_216.0;

/// Whether a fit lies where it is tightest or on the world's grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Placing {
    Tight,
    /// With extents and place across the light [on the grid](grid::snap); the depth range is left
    /// for [`grid::steady`].
    OnGrid,
}

/// Extents below this share of a map's longer side, or of its distance from the origin, are
/// widened to it: a flat wall seen edge-on from the light needs no width, but a matrix does.
const THINNEST: f64 = 1e-5;

impl Volume {
    /// The box around a footprint by the settings' rectangle, margins and caster policy.
    pub(crate) fn around(
        footprint: &Footprint,
        content: &Content,
        settings: &FitSettings,
        range: Range,
        placing: Placing,
    ) -> Self {
        let rectangle = match rectangle_kind(settings) {
            RectangleKind::AxisAligned => Rectangle::around(footprint.outline, DVec2::X),
            RectangleKind::MinimumArea => rectangle::min_area(footprint.outline),
            RectangleKind::MinimumSquare => square(rectangle::min_square(footprint.outline)),
        };
        Self::from_rectangle(&rectangle, footprint, content, settings, range, placing)
    }

    /// The box around a footprint across the light by a given rectangle.
    pub(crate) fn from_rectangle(
        rectangle: &Rectangle,
        footprint: &Footprint,
        content: &Content,
        settings: &FitSettings,
        range: Range,
        placing: Placing,
    ) -> Self {
        let axes = footprint.axes.turned(rectangle.axis);
        let longest = rectangle.size().max_element();
        // That of the map, which the kernel's texels widen.
        let resolution = settings.resolution.as_dvec2();
        let widening = resolution / (resolution - 2.0 * f64::from(settings.border_texels()));
        let rounding = (rectangle.size() * widening + footprint.reach) * ROUNDING;
        let pad = rounding + f64::from(settings.margin);
        let thinnest = longest.max(footprint.reach) * THINNEST;
        let (min, max) = widened(rectangle.min - pad, rectangle.max + pad, thinnest);
        let z_pad = (footprint.z.1 - footprint.z.0 + footprint.reach) * ROUNDING + f64::from(settings.margin);
        let (z_min, z_max) =
            widened(DVec2::splat(footprint.z.0 - z_pad), DVec2::splat(footprint.z.1 + z_pad), thinnest);
        let mut volume = Self {
            axes,
            min: min.extend(z_min.x),
            max: max.extend(z_max.x),
            light_z: 0.0,
            depth_range: 0.0,
            set_by: constraints(rectangle, footprint, content, range),
            is_empty: footprint.is_empty,
            grid: None,
        };
        match placing {
            Placing::Tight => (volume.min, volume.max) = with_kernel(volume.min, volume.max, settings),
            Placing::OnGrid => _ = grid::snap(&mut volume, content.origin, settings),
        }
        let texel = (volume.max - volume.min).truncate() / settings.resolution.as_dvec2();
        let reach = near_plane::filter_reach(texel, settings, rounding.max_element());
        let near = near_plane::place(volume.max.z, &footprint.axes, footprint.outline, content, settings, reach);
        (volume.max.z, volume.set_by[5]) = (near.z, near.set_by.unwrap_or(volume.set_by[5]));
        // The rounding of the depth range, which casters may make far longer than what is covered.
        let depth = (volume.max.z - volume.min.z) * ROUNDING;
        (volume.min.z, volume.max.z) = (volume.min.z - depth, volume.max.z + depth);
        volume.light_at_near_plane();
        volume
    }

    /// Puts the light in the near plane, with the depth range from there to the far plane.
    pub(crate) fn light_at_near_plane(&mut self) {
        self.light_z = self.max.z;
        self.depth_range = self.max.z - self.min.z;
    }
}

/// The square with the rectangle's longer side, about the same middle.
fn square(r: Rectangle) -> Rectangle {
    let (centre, half) = ((r.min + r.max) * 0.5, r.size().max_element() * 0.5);
    Rectangle { axis: r.axis, min: centre - half, max: centre + half }
}

/// The same range, at least as long as `thinnest`.
fn widened(min: DVec2, max: DVec2, thinnest: f64) -> (DVec2, DVec2) {
    let missing = (DVec2::splat(thinnest) - (max - min)).max(DVec2::ZERO) * 0.5;
    (min - missing, max + missing)
}

/// Leaves the kernel margin free on all sides.
fn with_kernel(min: DVec3, max: DVec3, settings: &FitSettings) -> (DVec3, DVec3) {
    let resolution = settings.resolution.as_dvec2();
    let kernel = DVec2::splat(f64::from(settings.border_texels()));
    let margin = (max - min).truncate() / (resolution - kernel * 2.0) * kernel;
    (min - margin.extend(0.0), max + margin.extend(0.0))
}

/// Share of a box's longest side within which its planes count as the view's own.
const SAME_PLANE: f64 = 1e-5;

/// What set each plane: the view where it lies at the view's own extent, else the receivers.
fn constraints(rectangle: &Rectangle, footprint: &Footprint, content: &Content, range: Range) -> [Constraint; 6] {
    if content.receivers.is_none() || footprint.is_empty {
        return [Constraint::View; 6];
    }
    let (mut min, mut max) = (DVec3::MAX, DVec3::MIN);
    for corner in content.corners(range) {
        let p = footprint.axes.project(corner);
        let q = DVec3::new(p.truncate().dot(rectangle.axis), p.truncate().dot(rectangle.axis.perp()), p.z);
        (min, max) = (min.min(q), max.max(q));
    }
    let slack = (max - min).max_element() * SAME_PLANE;
    let low = rectangle.min.extend(footprint.z.0) - min;
    let high = max - rectangle.max.extend(footprint.z.1);
    let by = |gap: f64| if gap <= slack { Constraint::View } else { Constraint::Receivers };
    [by(low.x), by(high.x), by(low.y), by(high.y), by(low.z), by(high.z)]
}
