//! Intersection of rays with triangles, through the bounding volume hierarchy of the `obvhs` crate.

use std::fmt;
use std::sync::Arc;

use glam::{DVec3, Vec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::ray::{Ray, RayHit};
use obvhs::{Boundable, BvhBuildParams, triangle::Triangle};
use shadowfit_rays::build_bvh2;

use crate::cut_out::CutOuts;
use crate::memory::TracerMemory;

/// Function that returns whether a triangle, given by its index, is opaque at a point, given by the weights
/// of its second and third corner.
type AlphaTest = Arc<dyn Fn(u32, [f32; 2]) -> bool + Send + Sync>;

/// Growth in cost at which a refitted hierarchy is rebuilt. The time per ray grows about like the cost, and a
/// build costs as much time as thousands of rays.
const MAX_COST_GROWTH: f32 = 1.5;

/// Triangles, and a hierarchy to find the triangles that a ray hits. A clone copies both and shares the
/// images of cut-outs.
#[derive(Clone)]
pub struct Tracer {
    triangles: Vec<Corners>,
    bvh: Option<Bvh2>,
    /// Cost per ray when the hierarchy was built.
    built_cost: f32,
    alpha_test: Option<AlphaTest>,
    cut_outs: CutOuts,
}

/// Intersection of a ray with a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray, in lengths of its direction.
    pub distance: f32,
    /// Index of the triangle.
    pub triangle: u32,
}

/// Error: the number of moved triangles differs from the tracer's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the tracer has {wanted} triangles and got {given} moved ones: pass every triangle, in the same order")]
pub struct TriangleCountError {
    /// Number of triangles in the tracer.
    pub wanted: usize,
    /// Number of triangles that were passed.
    pub given: usize,
}

impl fmt::Debug for Tracer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Tracer")
            .field("triangles", &self.triangles.len())
            .field("alpha_test", &self.alpha_test.is_some())
            .field("cut_outs", &self.cut_outs.cut_outs().len())
            .finish_non_exhaustive()
    }
}

impl Tracer {
    /// Builds the hierarchy. Vertices are in world space, metres. Rays never hit triangles with non-finite
    /// vertices.
    pub fn new(triangles: impl IntoIterator<Item = [Vec3; 3]>) -> Self {
        let triangles: Vec<Corners> = triangles.into_iter().map(Corners::new).collect();
        let bvh = build(&triangles);
        let built_cost = bvh.as_ref().map_or(0.0, cost);
        Self { triangles, bvh, built_cost, alpha_test: None, cut_outs: CutOuts::default() }
    }

    /// Moves all triangles, passed in their order (world space, metres), for animated scenes. The hierarchy
    /// is refitted. It is rebuilt if a ray through the refitted one would cost more than 1.5 times its cost
    /// after the last build.
    ///
    /// # Errors
    ///
    /// If the number of triangles differs. The tracer is then unchanged.
    pub fn set_triangles(&mut self, moved: impl IntoIterator<Item = [Vec3; 3]>) -> Result<(), TriangleCountError> {
        let moved: Vec<Corners> = moved.into_iter().map(Corners::new).collect();
        if moved.len() != self.triangles.len() {
            return Err(TriangleCountError { wanted: self.triangles.len(), given: moved.len() });
        }
        self.triangles = moved;
        let Some(bvh) = &mut self.bvh else { return Ok(()) };
        refit(bvh, &self.triangles);
        // A NaN cost also leads to a rebuild.
        let is_good = cost(bvh) <= self.built_cost * MAX_COST_GROWTH;
        if !is_good {
            self.bvh = build(&self.triangles);
            self.built_cost = self.bvh.as_ref().map_or(0.0, cost);
        }
        Ok(())
    }

    /// Estimates the memory of a tracer with this number of triangles. The estimate is within a factor of 1.5
    /// for a thousand triangles or more, passed to [`Self::new`] by an iterator that knows its length.
    pub fn memory(triangles: usize) -> TracerMemory {
        TracerMemory::of(triangles)
    }

    /// Adds an alpha test. `is_opaque(triangle, weights)` returns whether a triangle, given by its index,
    /// stops a ray. The weights belong to its second and third corner at the hit.
    #[must_use]
    pub fn with_alpha_test(mut self, is_opaque: impl Fn(u32, [f32; 2]) -> bool + Send + Sync + 'static) -> Self {
        self.alpha_test = Some(Arc::new(is_opaque));
        self
    }

    /// Sets the triangles with holes and replaces earlier ones. If there is also an alpha test, both must
    /// find the triangle opaque.
    #[must_use]
    pub fn with_cut_outs(mut self, cut_outs: CutOuts) -> Self {
        self.cut_outs = cut_outs;
        self
    }

    /// Returns the triangles with holes.
    pub fn cut_outs(&self) -> &CutOuts {
        &self.cut_outs
    }

    /// Returns whether there is an alpha test that only the CPU can run.
    #[cfg(feature = "gpu")]
    pub(crate) fn has_alpha_test(&self) -> bool {
        self.alpha_test.is_some()
    }

    /// Returns the hierarchy; `None` without triangles.
    #[cfg(feature = "gpu")]
    pub(crate) fn bvh(&self) -> Option<&Bvh2> {
        self.bvh.as_ref()
    }

    /// Returns the number of triangles.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Returns whether there are no triangles.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Returns the corners of a triangle, world space, metres. All are zero if one was not finite.
    pub fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.triangles[triangle as usize].0
    }

    /// Returns the unit normal of a triangle by its winding, counter-clockwise seen from the front. Zero for
    /// a triangle without area.
    pub fn normal(&self, triangle: u32) -> Vec3 {
        self.triangles[triangle as usize].triangle().compute_normal().into()
    }

    /// Returns the unit normal of a triangle's plane by its winding, in f64. Zero for a triangle without
    /// area.
    pub fn plane_normal(&self, triangle: u32) -> DVec3 {
        let [a, b, c] = self.corners(triangle).map(Vec3::as_dvec3);
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// Computes the distance along a ray to the plane of the hit triangle, in f64. If it is not finite,
    /// returns the f32 distance of the hit.
    pub fn refine(&self, hit: Hit, normal: DVec3, origin: DVec3, direction: DVec3) -> f64 {
        let corner = self.corners(hit.triangle)[0].as_dvec3();
        let distance = normal.dot(corner - origin) / normal.dot(direction);
        if distance.is_finite() { distance } else { f64::from(hit.distance) }
    }

    /// Returns the nearest triangle along a ray (world space, metres; direction of any length).
    pub fn first_hit(&self, origin: Vec3, direction: Vec3) -> Option<Hit> {
        self.first_hit_within(origin, direction, f32::INFINITY)
    }

    /// Returns the nearest triangle along a ray (world space, metres), if it is nearer than `distance`, in
    /// lengths of the ray's direction.
    pub fn first_hit_within(&self, origin: Vec3, direction: Vec3, distance: f32) -> Option<Hit> {
        let (bvh, ray) = self.ray(origin, direction, distance)?;
        let mut hit = RayHit::none();
        bvh.ray_traverse(ray, &mut hit, |ray, slot| self.meet(ray, bvh.primitive_indices[slot]))
            .then(|| Hit { distance: hit.t, triangle: bvh.primitive_indices[hit.primitive_id as usize] })
    }

    /// Returns whether a ray (world space, metres) hits any triangle.
    pub fn is_occluded(&self, origin: Vec3, direction: Vec3) -> bool {
        self.is_occluded_within(origin, direction, f32::INFINITY)
    }

    /// Returns whether a ray (world space, metres) hits any triangle nearer than `distance`, in lengths of
    /// the ray's direction. For lights with a position.
    pub fn is_occluded_within(&self, origin: Vec3, direction: Vec3, distance: f32) -> bool {
        self.ray(origin, direction, distance).is_some_and(|(bvh, ray)| {
            !bvh.ray_traverse_miss(ray, |ray, slot| self.meet(ray, bvh.primitive_indices[slot]))
        })
    }

    /// Returns every triangle along a ray (world space, metres), in no particular order.
    pub fn all_hits(&self, origin: Vec3, direction: Vec3) -> Vec<Hit> {
        let mut hits = Vec::new();
        self.for_each_hit(origin, direction, |hit| hits.push(hit));
        hits
    }

    /// Calls `visit` with every triangle along a ray (world space, metres), in no particular order.
    pub fn for_each_hit(&self, origin: Vec3, direction: Vec3, visit: impl FnMut(Hit)) {
        self.for_each_hit_within(origin, direction, f32::INFINITY, visit);
    }

    /// Calls `visit` with every triangle along a ray (world space, metres) that is nearer than `distance`, in
    /// lengths of the ray's direction. In no particular order.
    pub fn for_each_hit_within(&self, origin: Vec3, direction: Vec3, distance: f32, mut visit: impl FnMut(Hit)) {
        let Some((bvh, ray)) = self.ray(origin, direction, distance) else { return };
        bvh.ray_traverse_anyhit(ray, |ray, slot| {
            let triangle = bvh.primitive_indices[slot];
            let met = self.meet(ray, triangle);
            if met.is_finite() && met < distance {
                visit(Hit { distance: met, triangle });
            }
        });
    }

    fn ray(&self, origin: Vec3, direction: Vec3, distance: f32) -> Option<(&Bvh2, Ray)> {
        let is_finite = origin.is_finite() && direction.is_finite() && direction != Vec3::ZERO;
        let bvh = self.bvh.as_ref().filter(|_| is_finite)?;
        Some((bvh, Ray::new(origin.into(), direction.into(), 0.0, distance)))
    }

    /// Returns the distance to a triangle along a ray, infinite for a miss or a hole of a cut-out.
    fn meet(&self, ray: &Ray, index: u32) -> f32 {
        let triangle = &self.triangles[index as usize].triangle();
        let distance = triangle.intersect(ray);
        let is_opaque = self.alpha_test.is_none() && self.cut_outs.is_empty();
        if is_opaque || !distance.is_finite() {
            return distance;
        }
        let weights = weights(triangle, ray, distance);
        let passes = self.alpha_test.as_ref().is_none_or(|is_opaque| is_opaque(index, weights));
        if passes && self.cut_outs.is_opaque(index, weights) { distance } else { f32::INFINITY }
    }
}

/// Corners of a triangle, a quarter smaller than the aligned ones that rays are tested against.
#[derive(Clone, Copy, Debug)]
struct Corners([Vec3; 3]);

impl Corners {
    /// Stores the corners, or zeros if one of them is not finite.
    fn new(corners: [Vec3; 3]) -> Self {
        let finite = corners.iter().all(|corner| corner.is_finite());
        Self(if finite { corners } else { [Vec3::ZERO; 3] })
    }

    fn triangle(&self) -> Triangle {
        let [v0, v1, v2] = self.0.map(Vec3A::from);
        Triangle { v0, v1, v2 }
    }
}

impl Boundable for Corners {
    fn aabb(&self) -> Aabb {
        self.triangle().aabb()
    }
}

fn build(triangles: &[Corners]) -> Option<Bvh2> {
    let params = BvhBuildParams::medium_build();
    let mut bvh = (!triangles.is_empty()).then(|| build_bvh2(triangles, params))?;
    // Drops the lists that only the builder needs, and unused capacity.
    bvh.parents = Vec::new();
    bvh.primitives_to_nodes = Vec::new();
    bvh.nodes.shrink_to_fit();
    Some(bvh)
}

/// Fits the boxes to triangles that have moved.
fn refit(bvh: &mut Bvh2, triangles: &[Corners]) {
    for node in bvh.nodes.iter_mut().filter(|node| node.is_leaf()) {
        let slots = node.first_index as usize..(node.first_index + node.prim_count) as usize;
        let boxes = bvh.primitive_indices[slots].iter().map(|index| triangles[*index as usize].aabb());
        node.set_aabb(boxes.fold(Aabb::empty(), |all, one| all.union(&one)));
    }
    bvh.refit_all();
}

/// Returns the cost of a ray through the hierarchy by the surface area heuristic: the expected number of
/// boxes and triangles that it is tested against.
fn cost(bvh: &Bvh2) -> f32 {
    let area = |node: &obvhs::bvh2::node::Bvh2Node| f64::from(node.aabb().half_area());
    let sum: f64 = bvh.nodes.iter().map(|node| area(node) * f64::from(node.prim_count.max(1))).sum();
    let whole = area(&bvh.nodes[0]);
    // If the whole has no area, all hierarchies cost the same.
    if whole == 0.0 { 0.0 } else { (sum / whole) as f32 }
}

/// Returns the weights of the second and third corner at a hit, by areas.
fn weights(triangle: &Triangle, ray: &Ray, distance: f32) -> [f32; 2] {
    let point = ray.origin + ray.direction * distance;
    let [edge1, edge2, to_point] = [triangle.v1, triangle.v2, point].map(|v| v - triangle.v0);
    let normal = edge1.cross(edge2);
    let area = normal.length_squared();
    [to_point.cross(edge2).dot(normal) / area, edge1.cross(to_point).dot(normal) / area]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square_at(height: f32) -> [[Vec3; 3]; 2] {
        let corner = |x, z| Vec3::new(x, height, z);
        [
            [corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0)],
            [corner(-1.0, -1.0), corner(1.0, 1.0), corner(1.0, -1.0)],
        ]
    }

    #[test]
    fn the_nearest_of_two_squares_is_met_first_and_both_are_met_in_all() {
        let tracer = Tracer::new([square_at(1.0), square_at(3.0)].concat());
        let origin = Vec3::new(0.3, 0.0, 0.1);
        let hit = tracer.first_hit(origin, Vec3::Y).expect("a hit");
        assert_eq!((hit.distance, hit.triangle), (1.0, 1));
        assert!(tracer.is_occluded(origin, Vec3::Y) && !tracer.is_occluded(origin, Vec3::NEG_Y));
        let mut distances: Vec<f32> = tracer.all_hits(origin, Vec3::Y).iter().map(|hit| hit.distance).collect();
        distances.sort_by(f32::total_cmp);
        assert_eq!(distances, [1.0, 3.0]);
    }

    #[test]
    fn a_ray_of_some_length_meets_what_is_nearer_and_nothing_beyond() {
        let tracer = Tracer::new([square_at(1.0), square_at(3.0)].concat());
        let origin = Vec3::new(0.3, 0.0, 0.1);
        // The direction is 2 m long, so the squares are 0.5 and 1.5 lengths away.
        for (distance, wanted) in [(0.4, 0), (0.6, 1), (1.4, 1), (1.6, 2)] {
            let mut met = 0;
            tracer.for_each_hit_within(origin, Vec3::Y * 2.0, distance, |_| met += 1);
            assert_eq!(met, wanted, "within {distance}");
            assert_eq!(tracer.is_occluded_within(origin, Vec3::Y * 2.0, distance), wanted > 0);
            let first = tracer.first_hit_within(origin, Vec3::Y * 2.0, distance);
            assert_eq!(first.map(|hit| hit.distance), (wanted > 0).then_some(0.5));
        }
        assert!(!tracer.is_occluded_within(origin, Vec3::Y, f32::NAN));
    }

    #[test]
    fn an_alpha_test_lets_the_ray_through_where_it_is_not_opaque() {
        // Only the half next to the first corner is opaque.
        let tracer = Tracer::new(square_at(1.0)).with_alpha_test(|_, [second, third]| second + third < 0.5);
        assert!(tracer.is_occluded(Vec3::new(-0.9, 0.0, -0.8), Vec3::Y));
        assert!(!tracer.is_occluded(Vec3::new(0.9, 0.0, 0.8), Vec3::Y));
    }

    /// Returns small triangles in a row, a metre apart, ordered by `position`.
    fn row(position: impl Fn(u32) -> u32) -> Vec<[Vec3; 3]> {
        let at = |index: u32| Vec3::X * position(index) as f32;
        (0..500).map(|index| [Vec3::ZERO, Vec3::X * 0.5, Vec3::Y * 0.5].map(|corner| at(index) + corner)).collect()
    }

    fn boxes_hold_their_triangles(tracer: &Tracer) -> bool {
        let bvh = tracer.bvh.as_ref().expect("triangles");
        bvh.validate(&tracer.triangles, false, true);
        let met = |index: u32| {
            let [a, b, c] = tracer.corners(index);
            let middle = (a + b + c) / 3.0;
            tracer.first_hit(middle + Vec3::Z, Vec3::NEG_Z).is_some_and(|hit| hit.triangle == index)
        };
        (0..tracer.len() as u32).all(met)
    }

    #[test]
    fn moved_triangles_are_met_where_they_are() {
        let mut tracer = Tracer::new(row(|index| index));
        let slow_before = tracer.built_cost;
        tracer
            .set_triangles(row(|index| index).into_iter().map(|t| t.map(|v| v + Vec3::Y * v.x * 0.1)))
            .expect("the same number");
        assert!(boxes_hold_their_triangles(&tracer));
        assert_eq!(tracer.built_cost, slow_before, "a small motion is refitted");
        // After shuffling, neighbours in the hierarchy lie far apart, and it is rebuilt.
        tracer.set_triangles(row(|index| index * 211 % 500)).expect("the same number");
        let cost_now = cost(tracer.bvh.as_ref().expect("triangles"));
        assert!(boxes_hold_their_triangles(&tracer) && cost_now < slow_before * MAX_COST_GROWTH, "{cost_now}");
        // First not finite, then finite again.
        tracer.set_triangles(vec![[Vec3::NAN; 3]; 500]).expect("the same number");
        assert!(!tracer.is_occluded(Vec3::new(0.1, 0.1, 1.0), Vec3::NEG_Z));
        tracer.set_triangles(row(|index| index)).expect("the same number");
        assert!(boxes_hold_their_triangles(&tracer));
    }

    #[test]
    fn more_or_fewer_triangles_are_refused_and_nothing_moves() {
        let mut tracer = Tracer::new(square_at(1.0));
        let refused = tracer.set_triangles([square_at(2.0), square_at(3.0)].concat());
        assert_eq!(refused, Err(TriangleCountError { wanted: 2, given: 4 }));
        assert_eq!(tracer.first_hit(Vec3::new(0.3, 0.0, 0.1), Vec3::Y).map(|hit| hit.distance), Some(1.0));
        assert_eq!(Tracer::new([]).set_triangles([]), Ok(()));
    }

    #[test]
    fn weights_give_the_hit_point_back() {
        let triangle =
            Triangle { v0: Vec3A::new(1.0, 2.0, 0.0), v1: Vec3A::new(4.0, 2.0, 1.0), v2: Vec3A::new(1.0, 2.5, 5.0) };
        let wanted = triangle.v0 * 0.2 + triangle.v1 * 0.5 + triangle.v2 * 0.3;
        let ray = Ray::new_inf(Vec3A::new(1.5, 9.0, 2.0), wanted - Vec3A::new(1.5, 9.0, 2.0));
        let [second, third] = weights(&triangle, &ray, triangle.intersect(&ray));
        assert!((second - 0.5).abs() < 1e-5 && (third - 0.3).abs() < 1e-5, "{second} {third}");
    }

    #[test]
    fn empty_scenes_and_rays_that_are_not_finite_meet_nothing() {
        let empty = Tracer::new([]);
        assert!(empty.is_empty() && empty.first_hit(Vec3::ZERO, Vec3::Y).is_none());
        let square = Tracer::new(square_at(1.0));
        for bad in [Vec3::NAN, Vec3::INFINITY, Vec3::ZERO] {
            assert!(!square.is_occluded(Vec3::ZERO, bad));
        }
        assert!(!square.is_occluded(Vec3::NAN, Vec3::Y));
        assert!(!Tracer::new([[Vec3::NAN; 3]]).is_occluded(Vec3::NEG_Y, Vec3::Y));
    }
}
