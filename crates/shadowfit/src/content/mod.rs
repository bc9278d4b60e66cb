//! The views and boxes of one frame, in the form that fits use.
//!
//! Neighbours in a list of objects or clusters are mostly neighbours in space, so the bounds of runs of
//! neighbours are computed once per frame. Runs that cannot change a result are skipped. [Visitors](Visit)
//! receive the boxes of the lists and of the tree.

mod boxes;
#[cfg(feature = "cache")]
pub(crate) mod clusters;
mod extents;
mod groups;
pub(crate) mod normal_cone;
mod static_boxes;
#[cfg(feature = "cache")]
pub(crate) mod tree;
mod views;
mod visit;

use core::cell::OnceCell;

use glam::{DVec2, DVec3, Vec3};

use crate::base::enclosing::{HullBuilder, SymmetricFrustum};
use crate::base::{Boxes, FitError, moved};
use crate::view::ViewFrustum;
pub(crate) use boxes::Bounds;
use boxes::{check, compute_depths, is_same};
use groups::Groups;
use normal_cone::NormalCone;
pub(crate) use static_boxes::StaticBoxes;
pub(crate) use views::{MAX_SPHERE_VIEWS, ViewPart};
pub(crate) use visit::{Found, Query, Visit, VisitCorners};

/// The views, the light and the boxes of a frame, as an engine passes them.
#[derive(Clone, Copy)]
pub(crate) struct Scene<'a> {
    pub(crate) views: &'a [ViewFrustum],
    /// Travel direction of the light.
    pub(crate) direction: Vec3,
    pub(crate) receivers: Option<Boxes<'a>>,
    pub(crate) receiver_cones: &'a [NormalCone],
    pub(crate) casters: Option<Boxes<'a>>,
    /// Boxes that receive and cast shadows in addition to the lists.
    pub(crate) static_boxes: Option<&'a StaticBoxes>,
}

/// The views and boxes of one frame, with the view depths of each box computed once.
pub(crate) struct Content<'a> {
    pub(crate) views: &'a [ViewFrustum],
    pub(crate) origin: DVec3,
    /// The list of receivers.
    receivers: Option<Boxes<'a>>,
    /// The list of casters.
    casters: Option<Boxes<'a>>,
    static_boxes: Option<&'a StaticBoxes>,
    /// Least and greatest view depth of each listed receiver, view by view. For a box out of view the least
    /// is above the greatest.
    depths: &'a [DVec2],
    receiver_groups: Groups<'a>,
    caster_groups: Groups<'a>,
    symmetric: OnceCell<Option<SymmetricFrustum>>,
    across: OnceCell<Option<(DVec2, DVec2)>>,
}

impl<'a> Content<'a> {
    /// Checks the boxes and computes their view depths. Returns the rest of the storage, for points.
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
        let points = (2 * 8 * input.views.len()).saturating_add(HullBuilder::SLACK);
        let required = needed.saturating_add(points).saturating_add(grouped[0] + grouped[1]);
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
        compute_depths(&input, &receiver_groups, depths);
        let content = Content {
            receivers: input.receivers,
            casters: input.casters,
            static_boxes: input.static_boxes,
            depths,
            receiver_groups,
            caster_groups,
            ..Content::of_views(input)
        };
        Ok((content, points))
    }

    /// Returns the views of an input without its boxes, for fits that use only the views.
    #[inline(always)]
    pub(crate) fn of_views(input: Scene<'a>) -> Self {
        Self {
            views: input.views,
            origin: input.views[0].origin,
            receivers: None,
            casters: None,
            static_boxes: None,
            depths: &[],
            receiver_groups: Groups::default(),
            caster_groups: Groups::default(),
            symmetric: OnceCell::new(),
            across: OnceCell::new(),
        }
    }

    /// Returns whether the receivers are known.
    pub(crate) fn knows_receivers(&self) -> bool {
        self.receivers.is_some() || self.static_boxes.is_some()
    }

    /// Returns whether there are known casters.
    pub(crate) fn has_casters(&self) -> bool {
        self.static_boxes.is_some() || self.casters.is_some_and(|casters| !casters.boxes.is_empty())
    }

    /// Returns the lists of receivers and casters. The second is `None` if both are the same list in memory.
    pub(crate) fn lists(&self) -> [Option<Boxes<'a>>; 2] {
        [self.receivers, self.casters.filter(|_| !is_same(self.receivers, self.casters))]
    }

    /// Returns the number of listed receivers.
    fn listed(&self) -> usize {
        self.receivers.map_or(0, |receivers| receivers.boxes.len())
    }

    /// Returns the depths of the listed receivers in a view.
    #[inline]
    fn depths_in(&self, view: usize) -> &[DVec2] {
        let listed = self.listed();
        self.depths.get(view * listed..(view + 1) * listed).unwrap_or_default()
    }

    /// Returns a receiver's box by its [index](Found::index).
    #[inline]
    pub(crate) fn receiver(&self, index: usize) -> Option<(DVec3, DVec3)> {
        let listed = self.listed();
        if index < listed {
            return Some(self.receiver_groups.corners(index));
        }
        let tree = self.static_boxes?;
        tree.get((index - listed) as u32).map(|aabb| moved(&aabb, tree.origin() - self.origin))
    }
}
