//! Clusters: triangles cut into groups with tight boxes.
//!
//! A fit knows a receiver only by its box, and the box of a level in one mesh is useless. The boxes of a few
//! hundred clusters of the same mesh hold much less empty space. An animated mesh keeps its clusters, and
//! only their boxes are computed again.

mod piece;
mod split;

use alloc::vec::Vec;

use glam::{DVec3, Vec3};

use crate::base::checks::{MAX_LENGTH, length};
use crate::base::{Aabb, FitError, checks};
use crate::content::normal_cone::NormalCone;
use piece::{Corners, Outline, Triangle};

/// Boxes around small groups of triangles, for [`Boxes::boxes`](crate::Boxes::boxes). Together they hold
/// every point of every triangle. A group holds triangles of one object only.
///
/// ```
/// use shadowfit::glam::Vec3;
/// use shadowfit::Clusters;
/// use shadowfit::Boxes;
///
/// // A stair of ten steps, each step two triangles.
/// let mut steps = Vec::new();
/// for i in 0..10 {
///     let (near, far) = (Vec3::new(0.0, i as f32, i as f32), Vec3::new(2.0, i as f32, i as f32 + 1.0));
///     let (left, right) = (far.with_x(near.x), near.with_x(far.x));
///     steps.extend([[near, left, far], [near, far, right]]);
/// }
/// let clusters = Clusters::build(&[&steps], Clusters::DEFAULT_LIMIT)?;
/// let receivers = Boxes::world(clusters.boxes());
/// assert!(receivers.boxes.iter().all(|step| step.max.y == step.min.y)); // no air in the boxes
/// # Ok::<(), shadowfit::FitError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clusters {
    /// Number of triangles of each object.
    counts: Vec<u32>,
    /// The pieces of triangles in each cluster, one cluster after the other.
    pieces: Vec<Outline>,
    corners: Corners,
    /// Object of each cluster, and the end of its pieces.
    ends: Vec<(u32, usize)>,
    boxes: Vec<Aabb>,
    cones: Vec<NormalCone>,
}

impl Clusters {
    /// Number of clusters that works well for scenes in one mesh. On five measured scenes with three headings
    /// each, the longer sides of maps around this number of boxes exceeded those of maps around the triangles
    /// themselves by 10%. With a quarter of the boxes it was 13%, and with four times as many 7%.
    pub const DEFAULT_LIMIT: usize = 1024;

    /// Greatest number of clusters. Higher limits are lowered to it.
    pub const MAX_LIMIT: usize = 65_536;

    /// Cuts objects into at most `limit` clusters, or one for each object with triangles if these are more.
    ///
    /// Each object is a slice of triangles. Their positions are in metres, relative to a common origin, which
    /// is the origin of [`boxes`](Self::boxes). Winding and handedness do not matter. Clusters depend only on
    /// the triangles, not on the target.
    ///
    /// Planes cut groups of triangles in two, always the group whose box holds the most empty space. A flat,
    /// full box is not cut. A triangle that crosses the plane joins the groups on both sides with its part
    /// there, so large slanted triangles get small boxes too. If very many large triangles intersect, later
    /// ones are not cut, and boxes overlap.
    ///
    /// Takes about 0.25 µs per triangle and 20 µs per cluster: 100 ms for 1,024 clusters of an object of
    /// 300,000 triangles.
    ///
    /// Sources: Wald, Ingo: "On fast construction of SAH-based bounding volume hierarchies", 2007; Stich,
    /// Martin, Heiko Friedrich and Andreas Dietrich: "Spatial splits in bounding volume hierarchies", 2009.
    /// Unlike these, no hierarchy is kept, and the cost is empty space, not the expected number of rays.
    ///
    /// # Errors
    ///
    /// Fails for a position that is NaN, infinite or beyond 1e18 m, for a limit of zero, and for more than
    /// `u32::MAX` triangles or objects.
    pub fn build(objects: &[&[[Vec3; 3]]], limit: usize) -> Result<Self, FitError> {
        if limit == 0 {
            let max = Self::MAX_LIMIT as f64;
            return Err(FitError::OutOfRange { input: "the limit of clusters", value: 0.0, min: 1.0, max });
        }
        let count = objects.iter().map(|triangles| triangles.len()).fold(0, usize::saturating_add);
        for (input, count) in [("the number of triangles", count), ("the number of objects", objects.len())] {
            checks::within(input, count as f64, 0.0, f64::from(u32::MAX))?;
        }
        check_positions(objects)?;

        let (groups, all_corners) = split::split(objects, limit.min(Self::MAX_LIMIT));
        let counts = objects.iter().map(|triangles| triangles.len() as u32).collect();
        let mut clusters = Self { counts, ..Self::default() };
        for group in &groups {
            let corners = &mut clusters.corners;
            clusters.pieces.extend(group.pieces.iter().map(|piece| corners.adopt(piece.outline, &all_corners)));
            clusters.ends.push((group.object, clusters.pieces.len()));
        }
        clusters.measure(objects);
        Ok(clusters)
    }

    /// Updates boxes and cones for triangles that have moved, keeping the clusters.
    ///
    /// `objects` are the objects of [`build`](Self::build) in the same order, each with the same number of
    /// triangles, in metres relative to one origin. Parts of triangles follow any movement and deformation of
    /// their triangles. Boxes grow where neighbouring triangles move apart, so build again after an object
    /// has changed its shape completely. Takes about 0.06 µs per triangle.
    ///
    /// # Errors
    ///
    /// Returns [`FitError::CountMismatch`] for another number of objects or triangles, and the errors of
    /// `build` for positions. On an error the clusters stay unchanged.
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

    /// Returns the box of each cluster, in metres, relative to the origin of the triangles. Boxes are never
    /// empty, but often flat. The boxes of an object follow one another.
    pub fn boxes(&self) -> &[Aabb] {
        &self.boxes
    }

    /// Returns a cone around the normals of each cluster, one for each of the [`boxes`](Self::boxes).
    pub fn cones(&self) -> &[NormalCone] {
        &self.cones
    }

    /// Returns the object and the index within the object of each triangle that lies in a cluster completely
    /// or in part. Empty if there is no such cluster.
    pub fn triangles(&self, cluster: usize) -> impl ExactSizeIterator<Item = (u32, u32)> {
        let object = self.ends.get(cluster).map_or(0, |end| end.0);
        self.outlines(cluster).iter().map(move |outline| (object, outline.triangle))
    }

    fn outlines(&self, cluster: usize) -> &[Outline] {
        let start = cluster.checked_sub(1).map_or(Some(0), |before| Some(self.ends.get(before)?.1));
        match (start, self.ends.get(cluster)) {
            (Some(start), Some(&(_, end))) => &self.pieces[start..end],
            _ => &[],
        }
    }

    /// Computes the boxes and cones of all clusters.
    fn measure(&mut self, objects: &[&[Triangle]]) {
        self.boxes.clear();
        self.cones.clear();
        for (cluster, &(object, _)) in self.ends.iter().enumerate() {
            let triangles = objects[object as usize];
            let outlines = self.outlines(cluster);
            let bounds = |outline: &Outline| self.corners.bounds(*outline, &triangles[outline.triangle as usize]);
            let aabb = outlines.iter().map(bounds).fold(Aabb::EMPTY, Aabb::union);
            let cone = NormalCone::around(|| outlines.iter().map(|outline| &triangles[outline.triangle as usize]));
            self.boxes.push(aabb);
            self.cones.push(cone);
        }
    }
}

/// Returns an error if a position is not finite or too far away.
fn check_positions(objects: &[&[[Vec3; 3]]]) -> Result<(), FitError> {
    let limit = Vec3::splat(MAX_LENGTH as f32);
    let is_good = |position: &Vec3| position.abs().cmple(limit).all();
    match objects.iter().flat_map(|triangles| triangles.as_flattened()).find(|position| !is_good(position)) {
        Some(position) => checks::point("a triangle's corner", position.as_dvec3()).map(|_| ()),
        None => Ok(()),
    }
}

impl NormalCone {
    /// Returns a narrow cone around the normals of triangles, though not the narrowest.
    fn around<'a, I: Iterator<Item = &'a [Vec3; 3]>>(triangles: impl Fn() -> I) -> Self {
        let normals = || triangles().map(area_normal).filter(|normal| *normal != DVec3::ZERO);
        // Flip normals to the side of the largest triangle, then to the side of the mean.
        let largest = normals().fold(DVec3::ZERO, |most, n| if n.dot(n) > most.dot(most) { n } else { most });
        let mean = normals().fold(DVec3::ZERO, |sum, n| sum + toward(largest, n / length(n)));
        let axis = (mean / length(mean)).as_vec3();
        if mean == DVec3::ZERO || !axis.is_finite() {
            return Self::ALL;
        }
        let unit = axis.as_dvec3() / length(axis.as_dvec3());
        let cos = normals().fold(1.0_f64, |least, n| least.min(unit.dot(n).abs() / length(n)));
        Self { axis, cos_half_angle: (cos as f32 - COSINE_STEP).max(0.0) }
    }
}

/// Amount that is subtracted from a cosine in f32 so that rounding never narrows a cone: two steps just below 1.
/// It widens the cone of parallel normals to 0.03°.
const COSINE_STEP: f32 = 2.0 * f32::EPSILON;

/// Returns the normal of a triangle by the right-hand rule, with twice its area as length.
fn area_normal([a, b, c]: &[Vec3; 3]) -> DVec3 {
    let a = a.as_dvec3();
    (b.as_dvec3() - a).cross(c.as_dvec3() - a)
}

/// Returns the normal or its opposite, on the side of `reference`.
fn toward(reference: DVec3, normal: DVec3) -> DVec3 {
    if reference.dot(normal) < 0.0 { -normal } else { normal }
}
