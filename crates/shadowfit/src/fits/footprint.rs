//! What a map must hold, as seen from the light: an outline in its plane and a range along it.

use core::cell::OnceCell;

use glam::{DVec2, DVec3, Vec3};

use crate::axes::LightAxes;
use crate::checks::MIN_LENGTH;
use crate::fits::Range;
use crate::fits::sphere::Round;
use crate::hull::HullBuilder;
use crate::view::{Slice, View, box_corners, moved, slice_corners};
use crate::{Boxes, FitError, FitInput, NormalCone, ViewFrustum, Workspace, checks};

/// The views and boxes of one frame, with the view depths of each box worked out once.
pub(crate) struct Content<'a> {
    pub(crate) views: &'a [ViewFrustum],
    pub(crate) origin: DVec3,
    pub(crate) receivers: Option<Boxes<'a>>,
    pub(crate) casters: Option<Boxes<'a>>,
    /// Least and greatest view depth of each receiver, view by view; the least is above the
    /// greatest where the box is out of view.
    depths: &'a [DVec2],
    round: OnceCell<Option<Round>>,
}

/// Depths of a box that is out of view.
const OUT_OF_VIEW: DVec2 = DVec2::new(f64::MAX, f64::MIN);

impl<'a> Content<'a> {
    /// Checks the boxes and takes their depths; gives the rest of the workspace for points.
    pub(crate) fn new<'w>(
        input: &FitInput<'w>,
        workspace: &'w mut Workspace,
    ) -> Result<(Content<'w>, &'w mut [DVec2]), FitError>
    where
        'a: 'w,
    {
        let origin = input.views[0].origin;
        let count = input.receivers.map_or(0, |receivers| receivers.boxes.len());
        let needed = count.saturating_mul(input.views.len());
        let required = needed.saturating_add(2 * 8 * input.views.len()).saturating_add(HullBuilder::SLACK);
        if workspace.storage.len() < required {
            return Err(FitError::WorkspaceTooSmall { given: workspace.storage.len(), required });
        }
        for boxes in input.receivers.iter().chain(&input.casters) {
            check(boxes)?;
        }
        let (depths, points) = workspace.storage.split_at_mut(needed);
        if let Some(receivers) = &input.receivers {
            let offset = receivers.origin - origin;
            for (view, depths) in input.views.iter().zip(depths.chunks_mut(count.max(1))) {
                let eye = view.origin;
                let view = View::new(view, origin);
                let eye = eye - receivers.origin;
                for (i, (aabb, depths)) in receivers.boxes.iter().zip(depths).enumerate() {
                    let (min, max) = moved(aabb, offset);
                    let to_light = -input.direction.as_dvec3();
                    let faces_away = |cone: &NormalCone| cone.faces_away_from(aabb, eye, to_light);
                    let is_dark = input.receiver_cones.get(i).is_some_and(faces_away);
                    let seen = if aabb.is_empty() || is_dark { None } else { view.depths(min, max) };
                    *depths = seen.map_or(OUT_OF_VIEW, |(near, far)| DVec2::new(near, far));
                }
            }
        }
        let content = Content {
            views: input.views,
            origin,
            receivers: input.receivers,
            casters: input.casters,
            depths,
            round: OnceCell::new(),
        };
        Ok((content, points))
    }

    /// The first view, if its spheres are those of a symmetric frustum.
    pub(crate) fn round(&self) -> Option<&Round> {
        self.round.get_or_init(|| Round::new(&self.views[0].corners.map(Vec3::as_dvec3))).as_ref()
    }

    /// The views as fits use them.
    pub(crate) fn views(&self) -> impl Iterator<Item = View> {
        self.views.iter().map(|view| View::new(view, self.origin))
    }

    /// Least and greatest view depth of what the views see of the receivers, `None` when nothing.
    pub(crate) fn depth_range(&self) -> Option<(f64, f64)> {
        let receivers = self.receivers.as_ref()?;
        let offset = receivers.origin - self.origin;
        let mut range = OUT_OF_VIEW;
        for (view, depths) in self.views().zip(self.depths.chunks(receivers.boxes.len().max(1))) {
            let whole = view.slice(view.near, view.far);
            for (aabb, depths) in receivers.boxes.iter().zip(depths).filter(|(_, depths)| depths.x <= depths.y) {
                range.y = range.y.max(depths.y.min(view.far));
                // The part of a box that is in view may begin much farther out than the box.
                if depths.x < range.x {
                    let (min, max) = moved(aabb, offset);
                    let Ok(()) = whole.clip(min, max, &mut |p| {
                        range.x = range.x.min(view.depth.distance(p).max(view.near));
                        Ok::<(), core::convert::Infallible>(())
                    });
                }
            }
        }
        if range.x < range.y { Some((range.x, range.y)) } else { None }
    }

    /// Greatest distance of any receiver from an eye, in view or not: no turn of the camera makes
    /// a view depth exceed it. `None` when no receiver is known.
    pub(crate) fn farthest(&self) -> Option<f64> {
        let receivers = self.receivers.as_ref()?;
        let mut squared = None;
        for view in self.views {
            let offset = receivers.origin - view.origin;
            for aabb in receivers.boxes.iter().filter(|aabb| !aabb.is_empty()) {
                let (min, max) = moved(aabb, offset);
                let corner = min.abs().max(max.abs());
                squared = Some(corner.dot(corner).max(squared.unwrap_or(0.0)));
            }
        }
        squared.map(libm::sqrt)
    }

    /// Gives each receiver's box that may reach into a range of view depths, with the slice of
    /// the view that it may meet, in coordinates relative to the origin.
    pub(crate) fn receivers_in<E>(
        &self,
        range: Range,
        mut visit: impl FnMut(usize, &Slice, DVec3, DVec3) -> Result<(), E>,
    ) -> Result<(), E> {
        let Some(receivers) = &self.receivers else { return Ok(()) };
        let offset = receivers.origin - self.origin;
        let count = receivers.boxes.len().max(1);
        for (view, depths) in self.views().zip(self.depths.chunks(count)) {
            let slice = view.slice(f64::from(range.near), f64::from(range.far));
            if slice.near >= slice.far {
                continue;
            }
            for (i, (aabb, depths)) in receivers.boxes.iter().zip(depths).enumerate() {
                if depths.x <= slice.far && depths.y >= slice.near {
                    let (min, max) = moved(aabb, offset);
                    visit(i, &slice, min, max)?;
                }
            }
        }
        Ok(())
    }

    /// Gives each receiver's box that reaches into one of the views.
    pub(crate) fn each_receiver(&self, view: usize, mut visit: impl FnMut(DVec3, DVec3)) {
        let Some(receivers) = &self.receivers else { return };
        let offset = receivers.origin - self.origin;
        let depths = self.depths.chunks(receivers.boxes.len().max(1)).nth(view).unwrap_or_default();
        for (aabb, _) in receivers.boxes.iter().zip(depths).filter(|(_, depths)| depths.x <= depths.y) {
            let (min, max) = moved(aabb, offset);
            visit(min, max);
        }
    }

    /// Corners of the views' slices.
    pub(crate) fn corners(&self, range: Range) -> impl Iterator<Item = DVec3> {
        self.slices(range).flatten()
    }

    /// Corners of each view's slice that is not empty.
    pub(crate) fn slices(&self, range: Range) -> impl Iterator<Item = [DVec3; 8]> {
        self.views.iter().filter_map(move |view| slice_corners(view, self.origin, range.near, range.far))
    }
}

/// Refuses boxes with a coordinate that is not a number or too large; empty ones are allowed.
fn check(boxes: &Boxes) -> Result<(), FitError> {
    checks::point("the boxes' origin", boxes.origin)?;
    for aabb in boxes.boxes {
        let is_nan = aabb.min.is_nan() || aabb.max.is_nan();
        if is_nan || !aabb.is_empty() {
            checks::point("a corner of a box", aabb.min.as_dvec3())?;
            checks::point("a corner of a box", aabb.max.as_dvec3())?;
        }
    }
    Ok(())
}

/// Least and greatest coordinates along the light's axes, and the outline across them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Footprint<'a> {
    pub(crate) axes: LightAxes,
    /// Convex outline in the plane of the axes' x and y, anticlockwise, relative to the origin.
    pub(crate) outline: &'a [DVec2],
    /// Range along the axes' z.
    pub(crate) z: (f64, f64),
    /// Greatest distance from the origin, for the rounding of f32 coordinates.
    pub(crate) reach: f64,
    /// Whether nothing was found and the views' slices stand in.
    pub(crate) is_empty: bool,
}

/// Collects a footprint.
struct Collector<'a> {
    axes: LightAxes,
    hull: HullBuilder<'a>,
    z: (f64, f64),
    reach_squared: f64,
}

impl<'a> Collector<'a> {
    fn new(axes: LightAxes, points: &'a mut [DVec2]) -> Self {
        Self { axes, hull: HullBuilder::new(points), z: (f64::MAX, f64::MIN), reach_squared: 0.0 }
    }

    fn push(&mut self, p: DVec3) -> Result<(), FitError> {
        let q = self.axes.project(p);
        self.z = (self.z.0.min(q.z), self.z.1.max(q.z));
        self.reach_squared = self.reach_squared.max(p.dot(p));
        self.hull.push(q.truncate())
    }

    /// Whether a box lies inside of what has been collected so far, so that no part of it can
    /// change the footprint.
    fn holds(&self, min: DVec3, max: DVec3) -> bool {
        !self.hull.is_empty()
            && box_corners(min, max).into_iter().all(|corner| {
                let q = self.axes.project(corner);
                q.z >= self.z.0 && q.z <= self.z.1 && self.hull.holds(q.truncate())
            })
    }

    fn finish(self, is_empty: bool) -> Footprint<'a> {
        let reach = libm::sqrt(self.reach_squared);
        Footprint { axes: self.axes, outline: self.hull.finish(), z: self.z, reach, is_empty }
    }
}

impl<'a> Footprint<'a> {
    /// Of the views' slices.
    pub(crate) fn of_views(
        content: &Content,
        axes: LightAxes,
        range: Range,
        points: &'a mut [DVec2],
    ) -> Result<Self, FitError> {
        let mut collector = Collector::new(axes, points);
        content.corners(range).try_for_each(|corner| collector.push(corner))?;
        collector.finish(false).checked()
    }

    /// Of the receivers' boxes clipped to the views' slices; of the slices themselves where no
    /// boxes are known or none is in view.
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
            let footprint = Self::of_views(content, axes, range, hull.into_storage())?;
            return Ok(Self { is_empty: true, ..footprint });
        }
        Ok(collector.finish(false))
    }

    /// Refuses a footprint of views without extent.
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
