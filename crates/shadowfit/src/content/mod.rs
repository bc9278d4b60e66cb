//! The views and boxes of one frame, in the form that fits use.
//!
//! Boxes of objects and clusters come in an order in which neighbours in the list are mostly neighbours in space. So
//! the bounds of runs of neighbours are made once a frame: what lies outside of them need not be tested for each box.

#[cfg(feature = "alloc")]
pub(crate) mod clusters;
pub(crate) mod normal_cone;

use core::cell::OnceCell;

use glam::{DVec2, DVec3, Vec3};

use crate::base::enclosing::{EnclosingSphere, HullBuilder, SymmetricFrustum, minimal};
use crate::base::{Aabb, Boxes, FitError, checks, moved};
use crate::content::normal_cone::NormalCone;
use crate::light::LightAxes;
use crate::view::{Range, Slice, View, ViewFrustum, slice_corners};

/// The views, the light and the boxes that content is made of, as an engine gives them.
#[derive(Clone, Copy)]
pub(crate) struct Scene<'a> {
    pub(crate) views: &'a [ViewFrustum],
    /// Direction of travel of the light.
    pub(crate) direction: Vec3,
    pub(crate) receivers: Option<Boxes<'a>>,
    pub(crate) receiver_cones: &'a [NormalCone],
    pub(crate) casters: Option<Boxes<'a>>,
}

/// The views and boxes of one frame, with the view depths of each box computed once.
pub(crate) struct Content<'a> {
    pub(crate) views: &'a [ViewFrustum],
    pub(crate) origin: DVec3,
    pub(crate) receivers: Option<Boxes<'a>>,
    pub(crate) casters: Option<Boxes<'a>>,
    /// Least and greatest view depth of each receiver, view by view; the least is above the
    /// greatest where the box is out of view.
    depths: &'a [DVec2],
    receiver_groups: Groups<'a>,
    pub(crate) caster_groups: Groups<'a>,
    symmetric: OnceCell<Option<SymmetricFrustum>>,
    across: OnceCell<Option<(DVec2, DVec2)>>,
}

/// Most views that share a stable map.
pub(crate) const MAX_SPHERE_VIEWS: usize = 8;

/// Depths of a box that is out of view.
const OUT_OF_VIEW: DVec2 = DVec2::new(f64::MAX, f64::MIN);

impl<'a> Content<'a> {
    /// Checks the boxes and computes their view depths; returns the rest of the storage, for
    /// points.
    pub(crate) fn new<'w>(
        input: Scene<'w>,
        storage: &'w mut [DVec2],
    ) -> Result<(Content<'w>, &'w mut [DVec2]), FitError>
    where
        'a: 'w,
    {
        let origin = input.views[0].origin;
        let count_of = |boxes: Option<Boxes>| boxes.map_or(0, |boxes| boxes.boxes.len());
        let (count, casters) = (count_of(input.receivers), count_of(input.casters));
        let needed = count.saturating_mul(input.views.len());
        let grouped = [Groups::required(count), Groups::required(casters)];
        let required = needed
            .saturating_add(2 * 8 * input.views.len())
            .saturating_add(HullBuilder::SLACK)
            .saturating_add(grouped[0] + grouped[1]);
        if storage.len() < required {
            return Err(FitError::ScratchTooSmall { given: storage.len(), required });
        }
        let is_same = is_same(input.receivers, input.casters);
        for boxes in input.receivers.iter().chain(input.casters.iter().filter(|_| !is_same)) {
            check(boxes)?;
        }
        let (depths, points) = storage.split_at_mut(needed);
        let (of_receivers, points) = points.split_at_mut(grouped[0]);
        let (of_casters, points) = points.split_at_mut(grouped[1]);
        let groups = |boxes: Option<Boxes<'w>>, storage: &'w mut [DVec2]| {
            boxes.map_or(Groups::default(), |boxes| Groups::new(&boxes, origin, storage))
        };
        let receiver_groups = groups(input.receivers, of_receivers);
        let caster_groups = if is_same { receiver_groups } else { groups(input.casters, of_casters) };
        if let Some(receivers) = &input.receivers {
            for (view, depths) in input.views.iter().zip(depths.chunks_mut(count.max(1))) {
                view_depths(&input, receivers, &receiver_groups, view, depths);
            }
        }
        let content = Content {
            views: input.views,
            origin,
            receivers: input.receivers,
            casters: input.casters,
            depths,
            receiver_groups,
            caster_groups,
            symmetric: OnceCell::new(),
            across: OnceCell::new(),
        };
        Ok((content, points))
    }

    /// The views of an input alone, for fits that use nothing else.
    #[inline(always)]
    pub(crate) fn of_views(input: Scene<'a>) -> Self {
        Self {
            views: input.views,
            origin: input.views[0].origin,
            receivers: None,
            casters: None,
            depths: &[],
            receiver_groups: Groups::default(),
            caster_groups: Groups::default(),
            symmetric: OnceCell::new(),
            across: OnceCell::new(),
        }
    }

    /// The minimal sphere around all views' slices, relative to the origin.
    #[inline(always)]
    pub(crate) fn enclosing_sphere(&self, range: Range) -> Result<EnclosingSphere, FitError> {
        if let ([view], Some(symmetric)) = (self.views, self.symmetric()) {
            let (near, far) = (range.near.max(view.near), range.far.min(view.far));
            if near >= far {
                return Err(FitError::NearNotBelowFar { near, far });
            }
            let per_metre = 1.0 / (f64::from(view.far) - f64::from(view.near));
            let share = |depth: f32| (f64::from(depth) - f64::from(view.near)) * per_metre;
            return Ok(symmetric.sphere(share(near), share(far)));
        }
        self.enclosing_sphere_of_any(range)
    }

    /// The same for several views, or for one that is not symmetric.
    #[inline(never)]
    fn enclosing_sphere_of_any(&self, range: Range) -> Result<EnclosingSphere, FitError> {
        let mut corners = [DVec3::ZERO; 8 * MAX_SPHERE_VIEWS];
        let mut count = 0;
        for slice in self.slices(range) {
            let Some(free) = corners.get_mut(8 * count..8 * count + 8) else {
                let (value, max) = (self.views.len() as f64, MAX_SPHERE_VIEWS as f64);
                return Err(FitError::OutOfRange {
                    input: "the number of views of a stable fit",
                    value,
                    min: 1.0,
                    max,
                });
            };
            free.copy_from_slice(&slice);
            count += 1;
        }
        if count == 0 {
            return Err(FitError::NearNotBelowFar { near: range.near, far: range.far });
        }
        Ok(minimal(&corners[..8 * count]))
    }

    /// The first view, if its spheres are those of a symmetric frustum.
    fn symmetric(&self) -> Option<&SymmetricFrustum> {
        self.symmetric.get_or_init(|| SymmetricFrustum::new(&self.views[0].corners.map(Vec3::as_dvec3))).as_ref()
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
            let (offset, to_eye) = (receivers.origin - view.origin, self.origin - view.origin);
            let of_corner = |min: DVec3, max: DVec3| {
                let corner = min.abs().max(max.abs());
                corner.dot(corner)
            };
            for (run, min, max) in self.receiver_groups.runs() {
                let most = of_corner(min + to_eye, max + to_eye) * (1.0 + 1e-9);
                if squared.is_some_and(|squared| most < squared) {
                    continue;
                }
                for aabb in receivers.boxes[run].iter().filter(|aabb| !aabb.is_empty()) {
                    let (min, max) = moved(aabb, offset);
                    squared = Some(of_corner(min, max).max(squared.unwrap_or(0.0)));
                }
            }
        }
        squared.map(libm::sqrt)
    }

    /// Bounds of all receivers across the light, in view or not, along the light's axes. `None` when no receiver is
    /// known.
    pub(crate) fn receivers_across(&self, axes: &LightAxes) -> Option<(DVec2, DVec2)> {
        *self.across.get_or_init(|| {
            let receivers = self.receivers.as_ref()?;
            let offset = receivers.origin - self.origin;
            let (mut low, mut high) = (DVec2::MAX, DVec2::MIN);
            let across = |min, max| {
                let (centre, half) = axes.project_box(min, max);
                ((centre - half).truncate(), (centre + half).truncate())
            };
            for (run, min, max) in self.receiver_groups.runs() {
                let (a, b) = across(min, max);
                if a.cmpge(low).all() && b.cmple(high).all() {
                    continue;
                }
                for aabb in receivers.boxes[run].iter().filter(|aabb| !aabb.is_empty()) {
                    let (min, max) = moved(aabb, offset);
                    let (a, b) = across(min, max);
                    (low, high) = (low.min(a), high.max(b));
                }
            }
            (low.x <= high.x).then_some((low, high))
        })
    }

    /// Passes on each receiver's box that may reach into a range of view depths, with the slice of
    /// the view that it may intersect, in coordinates relative to the origin.
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
            for i in scattered(receivers.boxes.len()) {
                let (aabb, depths) = (&receivers.boxes[i], depths[i]);
                if depths.x <= slice.far && depths.y >= slice.near {
                    let (min, max) = moved(aabb, offset);
                    visit(i, &slice, min, max)?;
                }
            }
        }
        Ok(())
    }

    /// Passes on each receiver's box that reaches into one of the views, with its least and greatest view
    /// depth.
    pub(crate) fn each_receiver(&self, view: usize, mut visit: impl FnMut((f64, f64), DVec3, DVec3)) {
        let Some(receivers) = &self.receivers else { return };
        let offset = receivers.origin - self.origin;
        let depths = self.depths.chunks(receivers.boxes.len().max(1)).nth(view).unwrap_or_default();
        for (aabb, depths) in receivers.boxes.iter().zip(depths).filter(|(_, depths)| depths.x <= depths.y) {
            let (min, max) = moved(aabb, offset);
            visit((depths.x, depths.y), min, max);
        }
    }

    /// Passes on each receiver's box that reaches into any of the views, with a state: boxes are passed on where
    /// `is_new` of the bounds of their run is true.
    pub(crate) fn each_seen_receiver<S>(
        &self,
        state: &mut S,
        is_new: impl Fn(&S, DVec3, DVec3) -> bool,
        mut visit: impl FnMut(&mut S, DVec3, DVec3),
    ) {
        let Some(receivers) = &self.receivers else { return };
        let offset = receivers.origin - self.origin;
        for (run, min, max) in self.receiver_groups.runs() {
            if !is_new(state, min, max) {
                continue;
            }
            for i in run {
                let is_seen = |depths: &[DVec2]| depths.get(i).is_some_and(|depths| depths.x <= depths.y);
                if self.depths.chunks(receivers.boxes.len()).any(is_seen) {
                    let (min, max) = moved(&receivers.boxes[i], offset);
                    visit(state, min, max);
                }
            }
        }
    }

    /// A receiver's box.
    pub(crate) fn receiver(&self, index: usize) -> Option<(DVec3, DVec3)> {
        let receivers = self.receivers.as_ref()?;
        Some(moved(receivers.boxes.get(index)?, receivers.origin - self.origin))
    }

    /// Passes on each receiver's box that reaches into a view, whether it is dark or not, with its index.
    pub(crate) fn each_in_view(&self, view: &View, mut visit: impl FnMut(usize, DVec3, DVec3)) {
        let Some(receivers) = &self.receivers else { return };
        let offset = receivers.origin - self.origin;
        for (i, aabb) in receivers.boxes.iter().enumerate().filter(|(_, aabb)| !aabb.is_empty()) {
            let (min, max) = moved(aabb, offset);
            if view.depths(min, max).is_some() {
                visit(i, min, max);
            }
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

/// Computes the least and greatest depth of each receiver in one view.
fn view_depths(input: &Scene, receivers: &Boxes, groups: &Groups, view: &ViewFrustum, depths: &mut [DVec2]) {
    let origin = input.views[0].origin;
    let (eye, offset) = (view.origin - receivers.origin, receivers.origin - origin);
    let view = View::new(view, origin);
    let to_light = -input.direction.as_dvec3();
    depths.fill(OUT_OF_VIEW);
    for (run, min, max) in groups.runs() {
        if view.depths(min, max).is_none() {
            continue;
        }
        for i in run {
            let aabb = &receivers.boxes[i];
            if aabb.is_empty() {
                continue;
            }
            let (min, max) = moved(aabb, offset);
            let Some((near, far)) = view.depths(min, max) else { continue };
            let faces_away = |cone: &NormalCone| cone.faces_away_from(aabb, eye, to_light);
            if !input.receiver_cones.get(i).is_some_and(faces_away) {
                depths[i] = DVec2::new(near, far);
            }
        }
    }
}

/// All indices below a count, with large steps between them. Neighbouring boxes tell much the same: the
/// extent of all is nearly known after a few that lie apart, and the others cannot widen it.
pub(crate) fn scattered(count: usize) -> impl Iterator<Item = usize> {
    // The golden ratio leaves no large gaps; steps that divide the count would come back too early.
    let step = (count * 5 / 8..count).find(|step| is_coprime(*step, count)).unwrap_or(1);
    let mut index = 0;
    (0..count).map(move |_| {
        let next = index + step;
        core::mem::replace(&mut index, if next >= count { next - count } else { next })
    })
}

fn is_coprime(mut a: usize, mut b: usize) -> bool {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a == 1
}

/// Whether receivers and casters are the same boxes in memory.
fn is_same(receivers: Option<Boxes>, casters: Option<Boxes>) -> bool {
    receivers.zip(casters).is_some_and(|(a, b)| a.origin == b.origin && core::ptr::eq(a.boxes, b.boxes))
}

/// Refuses boxes with a coordinate that is not a number or too large; empty ones are allowed.
fn check(boxes: &Boxes) -> Result<(), FitError> {
    checks::point("the boxes' origin", boxes.origin)?;
    let limit = checks::MAX_LENGTH as f32;
    let is_good = |v: Vec3| (v.x.abs() <= limit) & (v.y.abs() <= limit) & (v.z.abs() <= limit);
    if boxes.boxes.iter().fold(true, |all, aabb| all & is_good(aabb.min) & is_good(aabb.max)) {
        return Ok(());
    }
    for aabb in boxes.boxes {
        let is_nan = aabb.min.is_nan() || aabb.max.is_nan();
        if is_nan || !aabb.is_empty() {
            checks::point("a corner of a box", aabb.min.as_dvec3())?;
            checks::point("a corner of a box", aabb.max.as_dvec3())?;
        }
    }
    Ok(())
}

/// Boxes in a run: few enough that runs stay small, enough that their tests cost little. 8 and 32 are both
/// slower with 1,024 clusters of real scenes.
const RUN: usize = 16;

/// Elements of storage that the bounds of a run take.
const ELEMENTS: usize = 3;

/// Boxes in runs, with the bounds of each.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Groups<'a> {
    boxes: &'a [Aabb],
    bounds: &'a [DVec2],
    /// From the origin that the boxes are seen from to their own.
    offset: DVec3,
}

impl<'a> Groups<'a> {
    /// Elements of storage for the runs of a number of boxes.
    pub(crate) const fn required(boxes: usize) -> usize {
        boxes.div_ceil(RUN) * ELEMENTS
    }

    /// The runs of boxes as seen from an origin; storage is as long as [`Self::required`] or longer.
    pub(crate) fn new(boxes: &Boxes<'a>, origin: DVec3, storage: &'a mut [DVec2]) -> Self {
        for (run, bounds) in boxes.boxes.chunks(RUN).zip(storage.chunks_exact_mut(ELEMENTS)) {
            let all = run.iter().filter(|aabb| !aabb.is_empty()).fold(Aabb::EMPTY, |all, aabb| all.union(*aabb));
            let (min, max) = (all.min.as_dvec3(), all.max.as_dvec3());
            bounds.copy_from_slice(&[min.truncate(), DVec2::new(min.z, max.x), DVec2::new(max.y, max.z)]);
        }
        Self { boxes: boxes.boxes, bounds: storage, offset: boxes.origin - origin }
    }

    /// The runs: indices of their boxes, and the corners of the bounds of those that are not empty, from the
    /// origin. Runs of empty boxes are left out.
    pub(crate) fn runs(&self) -> impl Iterator<Item = (core::ops::Range<usize>, DVec3, DVec3)> + use<'a> {
        let (offset, count) = (self.offset, self.boxes.len());
        self.bounds.chunks_exact(ELEMENTS).enumerate().filter_map(move |(i, bounds)| {
            let min = DVec3::new(bounds[0].x, bounds[0].y, bounds[1].x);
            let max = DVec3::new(bounds[1].y, bounds[2].x, bounds[2].y);
            let run = RUN * i..count.min(RUN * (i + 1));
            (min.x <= max.x && !run.is_empty()).then_some((run, min + offset, max + offset))
        })
    }
}
