//! The region that a map must cover: its hull as seen from the light, and the box around the hull along the
//! light's axes. The box is padded for rounding and by the margin. It is not yet on a grid, widened by a
//! border or extended to the casters.

use glam::{DVec2, DVec3};

use crate::base::checks::{MIN_LENGTH, ROUNDING, THINNEST};
use crate::base::enclosing::{HullBuilder, SYMMETRY};
use crate::base::{FitError, box_corners, checks};
use crate::content::{Bounds, Content, VisitCorners};
use crate::fits::rectangle::Rectangle;
use crate::fits::{Covers, FitRule, rectangle};
use crate::light::{BoundSource, LightAxes, Volume};
use crate::technique::settings::RectangleKind;
use crate::view::Range;

/// The region that a map must cover.
pub(crate) struct Covered<'a> {
    /// The box, without a light yet.
    pub(crate) volume: Volume,
    /// Greatest shift of a receiver or a caster across the light by rounding, in metres.
    pub(crate) rounding: f64,
    /// The part of the light's plane in which casters count.
    pub(crate) shadowed: Shadowed<'a>,
}

/// A part of the light's plane.
#[derive(Clone, Copy)]
pub(crate) enum Shadowed<'a> {
    /// A convex outline, anticlockwise in the plane of these axes.
    Outline(LightAxes, &'a [DVec2]),
    /// The whole map, so that turning the camera moves no plane.
    WholeMap,
}

impl<'a> Covered<'a> {
    /// Computes the region that a rule covers for a range of view depths.
    #[inline(always)]
    pub(crate) fn new(
        rule: &FitRule,
        content: &Content,
        axes: LightAxes,
        range: Range,
        points: &'a mut [DVec2],
    ) -> Result<Self, FitError> {
        match rule.form.covers {
            Covers::Corners => Self::corners(rule, content, axes, range),
            Covers::Sphere => Self::sphere(rule, content, axes, range),
            Covers::Views | Covers::Receivers => {
                let hull = LightHull::of(rule.form.covers, Detail::Outline, content, axes, range, points)?;
                Ok(Self::hull(rule, content, &hull, range))
            }
        }
    }

    /// Computes the box of the slices' corners, with the margin and without room for rounding.
    #[inline(always)]
    fn corners(rule: &FitRule, content: &Content, axes: LightAxes, range: Range) -> Result<Self, FitError> {
        let (mut min, mut max) = (DVec3::MAX, DVec3::MIN);
        for slice in content.slices(range) {
            for corner in slice {
                let p = axes.project(corner);
                (min, max) = (min.min(p), max.max(p));
            }
        }
        let size = max - min;
        if size.min_element() < MIN_LENGTH {
            return Err(FitError::EmptyFrustum { size: size.as_vec3() });
        }
        let margin = DVec3::splat(rule.margin);
        let volume = Volume::covering(axes, min - margin, max + margin, [BoundSource::View; 6], false);
        Ok(Self { volume, rounding: 0.0, shadowed: Shadowed::WholeMap })
    }

    /// Computes the cube around the slices' enclosing sphere.
    #[inline(always)]
    fn sphere(rule: &FitRule, content: &Content, axes: LightAxes, range: Range) -> Result<Self, FitError> {
        let sphere = content.enclosing_sphere(range)?;
        let centre = axes.project(sphere.centre);
        let longest = (2.0 * sphere.radius).max(rule.least_size.max_element());
        let rounding = ROUNDING * (1.5 * longest + checks::length(sphere.centre));
        let pad = rule.margin + rounding + 2.0 * SYMMETRY * sphere.radius;
        let extent = DVec3::splat(2.0 * (sphere.radius + pad));
        let (mut min, mut max) = (centre - extent * 0.5, centre + extent * 0.5);
        if rule.serves_all {
            (min, max) = within_receivers(min, max, content, &axes, pad);
        }
        let (low, high) = widened(min.truncate(), max.truncate(), rule.least_size);
        let (min, max) = (low.extend(min.z), high.extend(max.z));
        let volume = Volume::covering(axes, min, max, [BoundSource::Sphere; 6], false);
        Ok(Self { volume, rounding, shadowed: Shadowed::WholeMap })
    }

    /// Computes the box of the hull's rectangle and its range along the light.
    fn hull(rule: &FitRule, content: &Content, hull: &LightHull<'a>, range: Range) -> Self {
        let resolution = rule.resolution.as_dvec2();
        let texels = resolution - 2.0 * rule.border;
        let rectangle = match rule.rectangle {
            RectangleKind::AxisAligned => Rectangle::around(hull.outline, DVec2::X),
            RectangleKind::MinimumArea => match rule.max_texel_ratio {
                None => rectangle::min_area(hull.outline),
                Some(ratio) => rectangle::min_area_within(hull.outline, ratio, |size| rule.limited(size, texels)),
            },
            RectangleKind::MinimumSquare => square(rectangle::min_square(hull.outline)),
        };
        let longest = rectangle.size().max_element();
        // Rounding of the map itself, which the border widens.
        let widening = resolution / texels;
        let rounding = (rectangle.size().max(rule.least_size) * widening + hull.farthest) * ROUNDING;
        let pad = rounding + rule.margin;
        let thinnest = longest.max(hull.farthest) * THINNEST;
        let (min, max) = widened(rectangle.min - pad, rectangle.max + pad, DVec2::splat(thinnest));
        let (min, max) = widened(min, max, rule.limited((max - min).max(rule.least_size), texels));
        let z_pad = (hull.z.1 - hull.z.0 + hull.farthest) * ROUNDING + rule.margin;
        let (z_min, z_max) = (DVec2::splat(hull.z.0 - z_pad), DVec2::splat(hull.z.1 + z_pad));
        let (z_min, z_max) = widened(z_min, z_max, DVec2::splat(thinnest));
        let (min, max) = (min.extend(z_min.x), max.extend(z_max.x));
        let bounds_from = constraints(&rectangle, hull, content, range);
        Self {
            volume: Volume::covering(hull.axes.turned(rectangle.axis), min, max, bounds_from, hull.is_empty),
            rounding: rounding.max_element(),
            shadowed: Shadowed::Outline(hull.axes, hull.outline),
        }
    }
}

/// Limits a box of constant size to the extent of all receivers and moves it to them, since no point beyond
/// them is looked up. The size stays constant while the receivers' extent does.
fn within_receivers(min: DVec3, max: DVec3, content: &Content, axes: &LightAxes, pad: f64) -> (DVec3, DVec3) {
    let Some((low, high)) = content.receivers_across(axes) else { return (min, max) };
    let (low, high) = (low - pad, high + pad);
    let size = (max - min).truncate().min(high - low);
    let centre = ((min + max) * 0.5).truncate();
    let first = (centre - size * 0.5).min(high - size).max(low);
    (first.extend(min.z), (first + size).extend(max.z))
}

/// Returns the square with the rectangle's longer side, about the same middle.
fn square(r: Rectangle) -> Rectangle {
    let (centre, half) = ((r.min + r.max) * 0.5, r.size().max_element() * 0.5);
    Rectangle { axis: r.axis, min: centre - half, max: centre + half }
}

/// Widens a range about its middle to at least `least`.
fn widened(min: DVec2, max: DVec2, least: DVec2) -> (DVec2, DVec2) {
    let missing = (least - (max - min)).max(DVec2::ZERO) * 0.5;
    (min - missing, max + missing)
}

/// Greatest distance between a plane and the view's own plane at which they count as one, as a share of the
/// box's longest side.
const SAME_PLANE: f64 = 1e-5;

/// Returns the source of each plane: the view if the plane lies at the view's own extent, otherwise the
/// receivers.
fn constraints(rectangle: &Rectangle, hull: &LightHull, content: &Content, range: Range) -> [BoundSource; 6] {
    if !content.knows_receivers() || hull.is_empty {
        return [BoundSource::View; 6];
    }
    let (mut min, mut max) = (DVec3::MAX, DVec3::MIN);
    for corner in content.corners(range) {
        let p = hull.axes.project(corner);
        let q = DVec3::new(p.truncate().dot(rectangle.axis), p.truncate().dot(rectangle.axis.perp()), p.z);
        (min, max) = (min.min(q), max.max(q));
    }
    let same = (max - min).max_element() * SAME_PLANE;
    let low = rectangle.min.extend(hull.z.0) - min;
    let high = max - rectangle.max.extend(hull.z.1);
    let by = |gap: f64| if gap <= same { BoundSource::View } else { BoundSource::Receivers };
    [by(low.x), by(high.x), by(low.y), by(high.y), by(low.z), by(high.z)]
}

/// The region that a map must cover, as seen from the light: an outline across the light and a depth range
/// along it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightHull<'a> {
    pub(crate) axes: LightAxes,
    /// Convex outline in the plane of the axes' x and y, anticlockwise, relative to the origin.
    pub(crate) outline: &'a [DVec2],
    /// Range along the axes' z.
    pub(crate) z: (f64, f64),
    /// Greatest distance from the origin, for the rounding of f32 coordinates.
    pub(crate) farthest: f64,
    /// Whether no receiver was found, so that the views' slices are used instead.
    pub(crate) is_empty: bool,
}

/// Requested detail of a hull.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Detail {
    /// The complete outline.
    Outline,
    /// Only the bounds of the outline along the axes, which are found much faster. The outline may lack
    /// corners.
    Bounds,
}

/// Collector of a light hull.
struct Collector<'a> {
    axes: LightAxes,
    detail: Detail,
    hull: HullBuilder<'a>,
    z: (f64, f64),
    farthest_squared: f64,
    /// Error of the first corner without room. Later corners are left out.
    pushed: Result<(), FitError>,
}

impl<'a> Collector<'a> {
    fn new(axes: LightAxes, detail: Detail, points: &'a mut [DVec2]) -> Self {
        let hull = HullBuilder::new(points);
        Self { axes, detail, hull, z: (f64::MAX, f64::MIN), farthest_squared: 0.0, pushed: Ok(()) }
    }

    /// Returns whether a box lies inside the hull so far, so that no part of it can change the hull.
    fn holds(&self, min: DVec3, max: DVec3) -> bool {
        if self.hull.is_empty() {
            return false;
        }
        let (centre, half) = self.axes.project_box(min, max);
        if centre.z - half.z < self.z.0 || centre.z + half.z > self.z.1 {
            return false;
        }
        let far = min.abs().max(max.abs());
        if self.detail == Detail::Bounds
            && far.dot(far) <= self.farthest_squared
            && self.hull.reaches_around(centre.truncate(), half.truncate())
        {
            return true;
        }
        self.hull.holds_rectangle(centre.truncate(), half.truncate())
            || box_corners(min, max).into_iter().all(|corner| self.hull.holds(self.axes.project(corner).truncate()))
    }

    fn finish(self, is_empty: bool) -> Result<LightHull<'a>, FitError> {
        self.pushed?;
        let farthest = libm::sqrt(self.farthest_squared);
        Ok(LightHull { axes: self.axes, outline: self.hull.finish(), z: self.z, farthest, is_empty })
    }
}

impl VisitCorners for Collector<'_> {
    fn wants(&self, bounds: &Bounds) -> bool {
        self.pushed.is_ok() && !self.holds(bounds.min, bounds.max)
    }

    fn take(&mut self, corner: DVec3) {
        if self.pushed.is_ok() {
            let q = self.axes.project(corner);
            self.z = (self.z.0.min(q.z), self.z.1.max(q.z));
            self.farthest_squared = self.farthest_squared.max(corner.dot(corner));
            self.pushed = self.hull.push(q.truncate());
        }
    }
}

impl<'a> LightHull<'a> {
    /// Computes the hull of the region that a rule covers.
    pub(crate) fn of(
        covers: Covers,
        detail: Detail,
        content: &Content,
        axes: LightAxes,
        range: Range,
        points: &'a mut [DVec2],
    ) -> Result<Self, FitError> {
        match covers {
            Covers::Receivers => Self::of_receivers(detail, content, axes, range, points),
            Covers::Views | Covers::Sphere | Covers::Corners => Self::of_views(content, axes, range, points),
        }
    }

    /// Computes the hull of the views' slices.
    fn of_views(content: &Content, axes: LightAxes, range: Range, points: &'a mut [DVec2]) -> Result<Self, FitError> {
        let mut collector = Collector::new(axes, Detail::Outline, points);
        content.corners(range).for_each(|corner| collector.take(corner));
        collector.finish(false)?.checked()
    }

    /// Computes the hull of the receivers' boxes, clipped to the views' slices. If no boxes are known or none
    /// is in view, it is the hull of the slices themselves.
    pub(crate) fn of_receivers(
        detail: Detail,
        content: &Content,
        axes: LightAxes,
        range: Range,
        points: &'a mut [DVec2],
    ) -> Result<Self, FitError> {
        if !content.knows_receivers() {
            return Self::of_views(content, axes, range, points);
        }
        let mut collector = Collector::new(axes, detail, points);
        content.visit_corners(range, &mut collector);
        if collector.hull.is_empty() {
            let Collector { hull, pushed, .. } = collector;
            pushed?;
            let of_views = Self::of_views(content, axes, range, hull.into_storage())?;
            return Ok(Self { is_empty: true, ..of_views });
        }
        collector.finish(false)
    }

    /// Refuses a hull of views without extent.
    fn checked(self) -> Result<Self, FitError> {
        let (mut min, mut max) = (DVec2::MAX, DVec2::MIN);
        for p in self.outline {
            (min, max) = (min.min(*p), max.max(*p));
        }
        let size = max - min;
        if size.min_element() < MIN_LENGTH || self.z.1 - self.z.0 < MIN_LENGTH {
            let size = size.extend(self.z.1 - self.z.0);
            return Err(FitError::EmptyFrustum { size: size.as_vec3() });
        }
        Ok(self)
    }
}
