//! Clusters: triangles cut into boxes that hug their surface.
//!
//! A fit knows no more of a receiver than its box, and a level that is one mesh has a box that
//! tells it nothing. Cut once into some hundred clusters, the same mesh leaves most of the empty
//! air outside; animated, it keeps its clusters and only their boxes are made anew.

mod cone;
mod split;

use alloc::vec::Vec;

use glam::Vec3;

use crate::checks::{self, MAX_LENGTH};
use crate::{Aabb, FitError, NormalCone};
use split::Reference;

/// Boxes around small groups of triangles, for [`Boxes::boxes`](crate::Boxes::boxes): together
/// they hold every point of every triangle. No group holds triangles of two objects.
///
/// ```
/// use shadowfit::glam::{DVec3, Vec3};
/// use shadowfit::{Boxes, Clusters};
///
/// // A stair of ten steps, each step two triangles.
/// let mut steps = Vec::new();
/// for i in 0..10 {
///     let (near, far) = (Vec3::new(0.0, i as f32, i as f32), Vec3::new(2.0, i as f32, i as f32 + 1.0));
///     let (left, right) = (far.with_x(near.x), near.with_x(far.x));
///     steps.extend([[near, left, far], [near, far, right]]);
/// }
/// let clusters = Clusters::build(&[&steps], Clusters::DEFAULT_LIMIT)?;
/// let receivers = Boxes { origin: DVec3::ZERO, boxes: clusters.boxes() };
/// assert!(receivers.boxes.iter().all(|step| step.max.y == step.min.y)); // no air in the boxes
/// # Ok::<(), shadowfit::FitError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clusters {
    /// Number of triangles of each object.
    counts: Vec<u32>,
    /// Object and index of each triangle, cluster by cluster.
    triangles: Vec<(u32, u32)>,
    /// Where the triangles of each cluster end.
    ends: Vec<usize>,
    boxes: Vec<Aabb>,
    cones: Vec<NormalCone>,
}

impl Clusters {
    /// Number of clusters that serves scenes of one mesh well. Of the fits measured on five scenes
    /// of 26 to 312 thousand triangles, a quarter of it needed maps 44% longer, four times as many
    /// only made them 2% shorter.
    pub const DEFAULT_LIMIT: usize = 1024;

    /// Cuts objects into `limit` clusters or fewer, or into one for each object that has triangles
    /// if those are more.
    ///
    /// Each object is a slice of triangles; the three positions of each are in metres, relative to
    /// an origin that all share, which is the origin of [`boxes`](Self::boxes). Winding and
    /// handedness are of no account. The same triangles give the same clusters on every target.
    /// Takes time as n log k for n triangles and k clusters: about 0.2 µs a triangle for 1,024.
    ///
    /// # Errors
    ///
    /// A position that is NaN, infinite or beyond 1e18 m; a limit of zero; more than `u32::MAX`
    /// triangles or objects.
    pub fn build(objects: &[&[[Vec3; 3]]], limit: usize) -> Result<Self, FitError> {
        if limit == 0 {
            return Err(FitError::OutOfRange {
                input: "the limit of clusters",
                value: 0.0,
                min: 1.0,
                max: usize::MAX as f64,
            });
        }
        let count = objects.iter().map(|triangles| triangles.len()).fold(0, usize::saturating_add);
        for (input, count) in [("the number of triangles", count), ("the number of objects", objects.len())] {
            checks::within(input, count as f64, 0.0, u32::MAX as f64)?;
        }
        check_positions(objects)?;

        let mut references = Vec::with_capacity(count);
        for (object, triangles) in (0..).zip(objects) {
            references.extend((0..).zip(*triangles).map(|(index, triangle)| Reference::new(object, index, triangle)));
        }
        let ends = split::split(&mut references, limit);
        let mut clusters = Self {
            counts: objects.iter().map(|triangles| triangles.len() as u32).collect(),
            triangles: references.iter().map(|reference| (reference.object, reference.triangle)).collect(),
            boxes: Vec::with_capacity(ends.len()),
            cones: Vec::with_capacity(ends.len()),
            ends,
        };
        clusters.measure(objects);
        Ok(clusters)
    }

    /// Makes boxes and cones anew for triangles that have moved, keeping the clusters.
    ///
    /// `objects` are those of [`build`](Self::build) in the same order, each with as many triangles
    /// as then; metres, relative to one origin. Boxes grow where neighbours part, so build again
    /// when an object has changed beyond recognition. Takes about 0.05 µs a triangle.
    ///
    /// # Errors
    ///
    /// [`FitError::CountMismatch`] for another number of objects or triangles, and positions as for
    /// `build`. The clusters are then left as they were.
    pub fn refit(&mut self, objects: &[&[[Vec3; 3]]]) -> Result<(), FitError> {
        let mismatch = |input, given, expected| Err(FitError::CountMismatch { input, given, expected });
        if objects.len() != self.counts.len() {
            return mismatch("the number of objects", objects.len(), self.counts.len());
        }
        for (triangles, &count) in objects.iter().zip(&self.counts) {
            if triangles.len() != count as usize {
                return mismatch("the number of triangles of an object", triangles.len(), count as usize);
            }
        }
        check_positions(objects)?;
        self.measure(objects);
        Ok(())
    }

    /// The box of each cluster, in metres, relative to the origin of the triangles. None is empty;
    /// flat ones are common. Those of an object follow one another.
    pub fn boxes(&self) -> &[Aabb] {
        &self.boxes
    }

    /// Where the surfaces of each cluster face, one cone for each of the [`boxes`](Self::boxes).
    pub fn cones(&self) -> &[NormalCone] {
        &self.cones
    }

    /// Object and index within the object of each triangle of a cluster; none if there is no such
    /// cluster.
    pub fn triangles(&self, cluster: usize) -> impl ExactSizeIterator<Item = (u32, u32)> {
        self.members(cluster).iter().copied()
    }

    fn members(&self, cluster: usize) -> &[(u32, u32)] {
        let start = cluster.checked_sub(1).map_or(Some(0), |before| self.ends.get(before).copied());
        match (start, self.ends.get(cluster)) {
            (Some(start), Some(&end)) => &self.triangles[start..end],
            _ => &[],
        }
    }

    /// Makes the boxes and cones of all clusters.
    fn measure(&mut self, objects: &[&[[Vec3; 3]]]) {
        self.boxes.clear();
        self.cones.clear();
        for cluster in 0..self.ends.len() {
            let corners =
                || self.members(cluster).iter().map(|&(object, triangle)| &objects[object as usize][triangle as usize]);
            let aabb = corners().flatten().copied().fold(Aabb::EMPTY, Aabb::with_point);
            let cone = NormalCone::around(corners);
            self.boxes.push(aabb);
            self.cones.push(cone);
        }
    }
}

/// Refuses positions that are not finite or too far out.
fn check_positions(objects: &[&[[Vec3; 3]]]) -> Result<(), FitError> {
    let limit = Vec3::splat(MAX_LENGTH as f32);
    let is_good = |position: &Vec3| position.abs().cmple(limit).all();
    match objects.iter().flat_map(|triangles| triangles.as_flattened()).find(|position| !is_good(position)) {
        Some(position) => checks::point("a triangle's corner", position.as_dvec3()).map(|_| ()),
        None => Ok(()),
    }
}
