//! The light-space hull: what a map must hold, seen from the light.

use glam::{DVec2, DVec3};

use crate::base::checks::MIN_LENGTH;
use crate::base::hull::HullBuilder;
use crate::base::{FitError, box_corners};
use crate::content::Content;
use crate::fits::Covers;
use crate::light::LightAxes;
use crate::view::Range;

/// What a map must hold, seen from the light: an outline across the light and a depth range along
/// it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightHull<'a> {
    pub(crate) axes: LightAxes,
    /// Convex outline in the plane of the axes' x and y, anticlockwise, relative to the origin.
    pub(crate) outline: &'a [DVec2],
    /// Range along the axes' z.
    pub(crate) z: (f64, f64),
    /// Greatest distance from the origin, for the rounding of f32 coordinates.
    pub(crate) farthest: f64,
    /// Whether no receiver was found and the views' slices are used instead.
    pub(crate) is_empty: bool,
}

/// Collects a light hull.
struct Collector<'a> {
    axes: LightAxes,
    hull: HullBuilder<'a>,
    z: (f64, f64),
    farthest_squared: f64,
}

impl<'a> Collector<'a> {
    fn new(axes: LightAxes, points: &'a mut [DVec2]) -> Self {
        Self { axes, hull: HullBuilder::new(points), z: (f64::MAX, f64::MIN), farthest_squared: 0.0 }
    }

    fn push(&mut self, p: DVec3) -> Result<(), FitError> {
        let q = self.axes.project(p);
        self.z = (self.z.0.min(q.z), self.z.1.max(q.z));
        self.farthest_squared = self.farthest_squared.max(p.dot(p));
        self.hull.push(q.truncate())
    }

    /// Whether a box lies inside what has been collected so far, so that no part of it can change
    /// the hull.
    fn holds(&self, min: DVec3, max: DVec3) -> bool {
        if self.hull.is_empty() {
            return false;
        }
        let (centre, half) = self.axes.project_box(min, max);
        if centre.z - half.z < self.z.0 || centre.z + half.z > self.z.1 {
            return false;
        }
        self.hull.holds_rectangle(centre.truncate(), half.truncate())
            || box_corners(min, max).into_iter().all(|corner| self.hull.holds(self.axes.project(corner).truncate()))
    }

    fn finish(self, is_empty: bool) -> LightHull<'a> {
        let farthest = libm::sqrt(self.farthest_squared);
        LightHull { axes: self.axes, outline: self.hull.finish(), z: self.z, farthest, is_empty }
    }
}

impl<'a> LightHull<'a> {
    /// The hull of what a rule covers.
    pub(crate) fn of(
        covers: Covers,
        content: &Content,
        axes: LightAxes,
        range: Range,
        points: &'a mut [DVec2],
    ) -> Result<Self, FitError> {
        match covers {
            Covers::Receivers => Self::of_receivers(content, axes, range, points),
            Covers::Views | Covers::Sphere | Covers::Corners => Self::of_views(content, axes, range, points),
        }
    }

    /// The hull of the views' slices.
    fn of_views(content: &Content, axes: LightAxes, range: Range, points: &'a mut [DVec2]) -> Result<Self, FitError> {
        let mut collector = Collector::new(axes, points);
        content.corners(range).try_for_each(|corner| collector.push(corner))?;
        collector.finish(false).checked()
    }

    /// The hull of the receivers' boxes clipped to the views' slices; that of the slices themselves
    /// where no boxes are known or none is in view.
    pub(crate) fn of_receivers(
        content: &Content,
        axes: LightAxes,
        range: Range,
        points: &'a mut [DVec2],
    ) -> Result<Self, FitError> {
        if content.receivers.is_none() {
            return Self::of_views(content, axes, range, points);
        }
        let mut collector = Collector::new(axes, points);
        content.receivers_in(range, |_, slice, min, max| {
            if collector.holds(min, max) { Ok(()) } else { slice.clip(min, max, &mut |p| collector.push(p)) }
        })?;
        if collector.hull.is_empty() {
            let Collector { hull, .. } = collector;
            let of_views = Self::of_views(content, axes, range, hull.into_storage())?;
            return Ok(Self { is_empty: true, ..of_views });
        }
        Ok(collector.finish(false))
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
