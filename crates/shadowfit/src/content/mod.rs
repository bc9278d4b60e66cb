//! The views and boxes of one frame, in the form that fits use.
//!
//! Boxes of objects and clusters come in an order in which neighbours in the list are mostly neighbours in space. So
//! the bounds of runs of neighbours are made once a frame: what lies outside of them need not be tested for each box.
//! A tree of boxes is asked whenever something is asked of them: it looks at few of them.

#[cfg(feature = "alloc")]
pub(crate) mod clusters;
mod groups;
pub(crate) mod normal_cone;
mod standing;
#[cfg(feature = "alloc")]
pub(crate) mod tree;

use core::cell::OnceCell;

use glam::{DVec2, DVec3, Vec3};

use crate::base::enclosing::{EnclosingSphere, HullBuilder, SymmetricFrustum, minimal};
use crate::base::{Boxes, FitError, checks, moved};
use crate::content::groups::Groups;
use crate::content::normal_cone::NormalCone;
pub(crate) use crate::content::standing::BoxTree;
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
    /// Boxes that receive and cast beside those of the lists.
    pub(crate) standing: Option<&'a BoxTree>,
}

/// The views and boxes of one frame, with the view depths of each box computed once.
pub(crate) struct Content<'a> {
    pub(crate) views: &'a [ViewFrustum],
    pub(crate) origin: DVec3,
    /// The list of receivers.
    receivers: Option<Boxes<'a>>,
    /// The list of casters.
    casters: Option<Boxes<'a>>,
    standing: Option<&'a BoxTree>,
    /// Least and greatest view depth of each receiver of the list, view by view; the least is above the
    /// greatest where the box is out of view.
    depths: &'a [DVec2],
    receiver_groups: Groups<'a>,
    caster_groups: Groups<'a>,
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
        let [count, casters] = [input.receivers, input.casters].map(|boxes| boxes.map_or(0, |boxes| boxes.boxes.len()));
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
            standing: input.standing,
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
            standing: None,
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

    /// Whether it is known what receives shadows.
    pub(crate) fn knows_receivers(&self) -> bool {
        self.receivers.is_some() || self.standing.is_some()
    }

    /// Whether anything is known to cast shadows.
    pub(crate) fn has_casters(&self) -> bool {
        self.standing.is_some() || self.casters.is_some_and(|casters| !casters.boxes.is_empty())
    }

    /// The list of receivers, and that of casters; `None` of the second one where it is the same in memory.
    pub(crate) fn lists(&self) -> [Option<Boxes<'a>>; 2] {
        [self.receivers, self.casters.filter(|_| !is_same(self.receivers, self.casters))]
    }

    /// Number of receivers of the list.
    fn listed(&self) -> usize {
        self.receivers.map_or(0, |receivers| receivers.boxes.len())
    }

    /// Depths of the listed receivers in each view.
    fn depths(&self) -> impl Iterator<Item = &[DVec2]> {
        let listed = self.listed();
        (0..self.views.len()).map(move |view| self.depths.get(view * listed..(view + 1) * listed).unwrap_or_default())
    }

    /// A receiver's box: of the list by its index, and standing ones after these by their numbers.
    #[inline]
    pub(crate) fn receiver(&self, index: usize) -> Option<(DVec3, DVec3)> {
        let listed = self.listed();
        if let (Some(receivers), true) = (&self.receivers, index < listed) {
            return Some(moved(&receivers.boxes[index], receivers.origin - self.origin));
        }
        let tree = self.standing?;
        tree.get((index - listed) as u32).map(|aabb| moved(&aabb, tree.origin() - self.origin))
    }

    /// Least and greatest view depth of what the views see of the receivers, `None` when nothing.
    pub(crate) fn depth_range(&self) -> Option<(f64, f64)> {
        let mut range = OUT_OF_VIEW;
        for (view, depths) in self.views().zip(self.depths()) {
            let whole = view.slice(view.near, view.far);
            let add = |range: &mut DVec2, depths: (f64, f64), min: DVec3, max: DVec3| {
                range.y = range.y.max(depths.1.min(view.far));
                // The part of a box that is in view may begin much farther out than the box.
                if depths.0 < range.x {
                    let Ok(()) = whole.clip(min, max, &mut |p| {
                        range.x = range.x.min(view.depth.distance(p).max(view.near));
                        Ok::<(), core::convert::Infallible>(())
                    });
                }
            };
            for (i, depths) in depths.iter().enumerate().filter(|(_, depths)| depths.x <= depths.y) {
                if let Some((min, max)) = self.receiver(i) {
                    add(&mut range, (depths.x, depths.y), min, max);
                }
            }
            let is_new = |range: &DVec2, (near, far): (f64, f64), _, _| near < range.x || far.min(view.far) > range.y;
            self.each_standing_seen(
                (&view, view.near, view.far),
                &mut range,
                is_new,
                |range, depths, _, (min, max)| {
                    add(range, depths, min, max);
                },
            );
        }
        if range.x < range.y { Some((range.x, range.y)) } else { None }
    }

    /// Greatest distance of any receiver from an eye, in view or not: no turn of the camera makes
    /// a view depth exceed it. `None` when no receiver is known.
    pub(crate) fn farthest(&self) -> Option<f64> {
        let of_corner = |min: DVec3, max: DVec3| {
            let corner = min.abs().max(max.abs());
            corner.dot(corner)
        };
        let mut squared: Option<f64> = None;
        for view in self.views {
            let to_eye = self.origin - view.origin;
            let may_be_farther = |squared: &Option<f64>, min: DVec3, max: DVec3| {
                let most = of_corner(min + to_eye, max + to_eye) * (1.0 + 1e-9);
                squared.is_none_or(|squared| most >= squared)
            };
            if let Some(receivers) = &self.receivers {
                let groups = &self.receiver_groups;
                each_of_list(receivers, groups, view.origin, &mut squared, may_be_farther, |squared, min, max| {
                    *squared = Some(of_corner(min, max).max(squared.unwrap_or(0.0)));
                });
            }
            self.each_standing(&mut squared, may_be_farther, |squared, min, max| {
                *squared = Some(of_corner(min + to_eye, max + to_eye).max(squared.unwrap_or(0.0)));
            });
        }
        squared.map(libm::sqrt)
    }

    /// Bounds of all receivers across the light, in view or not, along the light's axes. `None` when no receiver is
    /// known.
    pub(crate) fn receivers_across(&self, axes: &LightAxes) -> Option<(DVec2, DVec2)> {
        *self.across.get_or_init(|| {
            let across = |min, max| {
                let (centre, half) = axes.project_box(min, max);
                ((centre - half).truncate(), (centre + half).truncate())
            };
            let is_new = |(low, high): &(DVec2, DVec2), min, max| {
                let (a, b) = across(min, max);
                !(a.cmpge(*low).all() && b.cmple(*high).all())
            };
            let widen = |(low, high): &mut (DVec2, DVec2), min, max| {
                let (a, b) = across(min, max);
                (*low, *high) = (low.min(a), high.max(b));
            };
            let mut bounds = (DVec2::MAX, DVec2::MIN);
            if let Some(receivers) = &self.receivers {
                each_of_list(receivers, &self.receiver_groups, self.origin, &mut bounds, is_new, widen);
            }
            self.each_standing(&mut bounds, is_new, widen);
            (bounds.0.x <= bounds.1.x).then_some(bounds)
        })
    }

    /// Passes on each receiver's box that may reach into a range of view depths, with the slice of
    /// the view that it may intersect, in coordinates relative to the origin, with a state; those of the list by index.
    /// Standing ones are passed on where `is_new` of them and of the boxes around them is true.
    pub(crate) fn receivers_in<S, E>(
        &self,
        range: Range,
        state: &mut S,
        is_new: impl Fn(&S, DVec3, DVec3) -> bool,
        mut visit: impl FnMut(&mut S, Option<usize>, &Slice, (DVec3, DVec3)) -> Result<(), E>,
    ) -> Result<(), E> {
        for (view, depths) in self.views().zip(self.depths()) {
            let slice = view.slice(f64::from(range.near), f64::from(range.far));
            if slice.near >= slice.far {
                continue;
            }
            for i in scattered(depths.len()) {
                let is_in = depths[i].x <= slice.far && depths[i].y >= slice.near;
                if let Some(corners) = self.receiver(i).filter(|_| is_in) {
                    visit(state, Some(i), &slice, corners)?;
                }
            }
            let mut all = (&mut *state, Ok(()));
            let goes_on = |all: &(&mut S, Result<(), E>), _, min, max| all.1.is_ok() && is_new(all.0, min, max);
            self.each_standing_seen((&view, slice.near, slice.far), &mut all, goes_on, |all, _, _, corners| {
                if all.1.is_ok() {
                    all.1 = visit(all.0, None, &slice, corners);
                }
            });
            all.1?;
        }
        Ok(())
    }

    /// Passes on each receiver's box that reaches into one of the views, with its least and greatest view
    /// depth and a state. Standing ones, about the nearest first, are passed on where `is_new` of them and of the boxes
    /// around them is true.
    pub(crate) fn each_receiver<S>(
        &self,
        view: usize,
        state: &mut S,
        is_new: impl Fn(&S, (f64, f64), DVec3, DVec3) -> bool,
        mut visit: impl FnMut(&mut S, (f64, f64), DVec3, DVec3),
    ) {
        let depths = self.depths().nth(view).unwrap_or_default();
        for (i, depths) in depths.iter().enumerate().filter(|(_, depths)| depths.x <= depths.y) {
            if let Some((min, max)) = self.receiver(i) {
                visit(state, (depths.x, depths.y), min, max);
            }
        }
        if let Some(view) = self.views().nth(view) {
            self.each_standing_seen((&view, view.near, view.far), state, is_new, |state, depths, _, (min, max)| {
                visit(state, depths, min, max);
            });
        }
    }

    /// Greatest distance from the origin of a corner of the receivers that the views see in a range of view depths, in
    /// metres, and no less than `least`.
    pub(crate) fn farthest_seen(&self, range: Range, least: f64) -> f64 {
        let squared = |min: DVec3, max: DVec3| {
            let corner = min.abs().max(max.abs());
            corner.dot(corner)
        };
        let mut most = least * least;
        let (near, far) = (f64::from(range.near), f64::from(range.far));
        for (view, depths) in self.views().zip(self.depths()) {
            let is_farther = |min, max| squared(min, max) > least * least && view.depths(min, max).is_some();
            let runs = self.receiver_groups.runs().filter(|(_, min, max)| is_farther(*min, *max));
            for i in runs.flat_map(|(run, _, _)| run) {
                let DVec2 { x: first, y: last } = depths[i];
                if first <= last.min(far)
                    && last >= near
                    && let Some((min, max)) = self.receiver(i)
                {
                    most = squared(min, max).max(most);
                }
            }
        }
        for view in self.standing.iter().flat_map(|_| self.views()) {
            let is_farther = |most: &f64, _, min, max| squared(min, max) > *most;
            let (near, far) = (view.near.max(near), view.far.min(far));
            self.each_standing_seen((&view, near, far), &mut most, is_farther, |most, _, _, (min, max)| {
                *most = squared(min, max).max(*most);
            });
        }
        libm::sqrt(most)
    }

    /// Passes on each receiver's box that reaches into any of the views, with a state: boxes are passed on where
    /// `is_new` of the bounds of their run is true.
    pub(crate) fn each_seen_receiver<S>(
        &self,
        state: &mut S,
        is_new: impl Fn(&S, DVec3, DVec3) -> bool,
        mut visit: impl FnMut(&mut S, DVec3, DVec3),
    ) {
        for (run, min, max) in self.receiver_groups.runs() {
            if !is_new(state, min, max) {
                continue;
            }
            for i in run.filter(|i| self.depths().any(|depths| depths[*i].x <= depths[*i].y)) {
                if let Some((min, max)) = self.receiver(i) {
                    visit(state, min, max);
                }
            }
        }
        for view in self.standing.iter().flat_map(|_| self.views()) {
            let is_new = |state: &S, _, min, max| is_new(state, min, max);
            self.each_standing_seen((&view, view.near, view.far), state, is_new, |state, _, _, (min, max)| {
                visit(state, min, max);
            });
        }
    }

    /// Passes on each receiver's box that reaches into a view, whether it is dark or not, with its
    /// [number](Self::receiver) and a state. Standing ones, about the nearest first, are passed on where `is_new` of
    /// their least view depth, of them and of the boxes around them is true.
    pub(crate) fn each_in_view<S>(
        &self,
        view: &View,
        state: &mut S,
        is_new: impl Fn(&S, f64, (DVec3, DVec3)) -> bool,
        mut visit: impl FnMut(&mut S, usize, (DVec3, DVec3)),
    ) {
        let listed = self.listed();
        let boxes = self.receivers.map_or(&[][..], |receivers| receivers.boxes);
        for (i, _) in boxes.iter().enumerate().filter(|(_, aabb)| !aabb.is_empty()) {
            if let Some(corners) = self.receiver(i).filter(|(min, max)| view.depths(*min, *max).is_some()) {
                visit(state, i, corners);
            }
        }
        let is_new = |state: &S, (near, _): (f64, f64), min, max| is_new(state, near, (min, max));
        self.each_standing_seen((view, view.near, view.far), state, is_new, |state, _, number, corners| {
            visit(state, listed + number as usize, corners);
        });
    }

    /// Passes on each caster's box, in view or not, with a state: those for which, and for the bounds of those around
    /// which, `is_new` is true.
    pub(crate) fn each_caster<S>(
        &self,
        state: &mut S,
        is_new: impl Fn(&S, DVec3, DVec3) -> bool,
        mut visit: impl FnMut(&mut S, DVec3, DVec3),
    ) {
        if let Some(casters) = &self.casters {
            each_of_list(casters, &self.caster_groups, self.origin, state, &is_new, &mut visit);
        }
        self.each_standing(state, is_new, visit);
    }

    /// A box around all casters, in view or not, if there are any.
    pub(crate) fn caster_bounds(&self) -> Option<(DVec3, DVec3)> {
        let listed = self.caster_groups.runs().map(|(_, min, max)| (min, max));
        let all = listed.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let mut bounds = all.unwrap_or((DVec3::MAX, DVec3::MIN));
        let is_new = |all: &(DVec3, DVec3), min: DVec3, max: DVec3| !(min.cmpge(all.0).all() && max.cmple(all.1).all());
        self.each_standing(&mut bounds, is_new, |all, min, max| *all = (all.0.min(min), all.1.max(max)));
        (bounds.0.x <= bounds.1.x).then_some(bounds)
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

/// Passes on the boxes of a list, relative to an origin, with a state, in the runs for whose bounds, which are relative to
/// that of the fit, `is_new` is true.
fn each_of_list<S>(
    list: &Boxes,
    groups: &Groups,
    origin: DVec3,
    state: &mut S,
    is_new: impl Fn(&S, DVec3, DVec3) -> bool,
    mut visit: impl FnMut(&mut S, DVec3, DVec3),
) {
    for (run, min, max) in groups.runs() {
        if !is_new(state, min, max) {
            continue;
        }
        for aabb in list.boxes[run].iter().filter(|aabb| !aabb.is_empty()) {
            let (min, max) = moved(aabb, list.origin - origin);
            visit(state, min, max);
        }
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
