//! Rays against triangles, through the bounding volume hierarchy of the `obvhs` crate.

use std::fmt;
use std::time::Duration;

use glam::{DVec3, Vec3, Vec3A};
use obvhs::bvh2::{Bvh2, builder::build_bvh2_from_tris};
use obvhs::ray::{Ray, RayHit};
use obvhs::{BvhBuildParams, triangle::Triangle};

use crate::CutOuts;

/// Says whether a triangle is there at a point: its index, and the weights of its second and third
/// corner. Cut-outs answer `false`.
type AlphaTest = Box<dyn Fn(u32, [f32; 2]) -> bool + Send + Sync>;

/// Triangles that can be asked for rays.
pub struct Tracer {
    triangles: Vec<Triangle>,
    bvh: Option<Bvh2>,
    alpha_test: Option<AlphaTest>,
    cut_outs: CutOuts,
}

/// Where a ray met a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray, in lengths of its direction.
    pub distance: f32,
    /// Index of the triangle.
    pub triangle: u32,
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
    /// Builds the hierarchy. Vertices in world space, metres; triangles with non-finite vertices
    /// are never met.
    pub fn new(triangles: impl IntoIterator<Item = [Vec3; 3]>) -> Self {
        let triangles: Vec<Triangle> = triangles
            .into_iter()
            .map(|vertices| {
                let finite = vertices.iter().all(|vertex| vertex.is_finite());
                let [v0, v1, v2] = if finite { vertices.map(Vec3A::from) } else { [Vec3A::ZERO; 3] };
                Triangle { v0, v1, v2 }
            })
            .collect();
        let bvh = (!triangles.is_empty())
            .then(|| build_bvh2_from_tris(&triangles, BvhBuildParams::medium_build(), &mut Duration::default()));
        Self { triangles, bvh, alpha_test: None, cut_outs: CutOuts::default() }
    }

    /// Adds an alpha test: `is_there(triangle, weights)`, with the weights of the triangle's second
    /// and third corner at the hit.
    #[must_use]
    pub fn with_alpha_test(mut self, is_there: impl Fn(u32, [f32; 2]) -> bool + Send + Sync + 'static) -> Self {
        self.alpha_test = Some(Box::new(is_there));
        self
    }

    /// Adds triangles with holes, in place of those added before. What also has an alpha test must
    /// pass both.
    #[must_use]
    pub fn with_cut_outs(mut self, cut_outs: CutOuts) -> Self {
        self.cut_outs = cut_outs;
        self
    }

    /// The triangles with holes.
    pub fn cut_outs(&self) -> &CutOuts {
        &self.cut_outs
    }

    /// Whether there is an alpha test that only the processor can run.
    #[cfg(feature = "gpu")]
    pub(crate) fn has_alpha_test(&self) -> bool {
        self.alpha_test.is_some()
    }

    /// The hierarchy; none without triangles.
    #[cfg(feature = "gpu")]
    pub(crate) fn bvh(&self) -> Option<&Bvh2> {
        self.bvh.as_ref()
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Corners of a triangle, world space, metres; all zero for one that was not finite.
    pub fn corners(&self, triangle: u32) -> [Vec3; 3] {
        let Triangle { v0, v1, v2 } = self.triangles[triangle as usize];
        [v0, v1, v2].map(Vec3::from)
    }

    /// Unit normal of a triangle by its winding, counter-clockwise seen from the front; zero for
    /// one without area.
    pub fn normal(&self, triangle: u32) -> Vec3 {
        self.triangles[triangle as usize].compute_normal().into()
    }

    /// Unit normal of a triangle's plane by its winding, in f64; zero for one without area.
    pub(crate) fn plane_normal(&self, triangle: u32) -> DVec3 {
        let [a, b, c] = self.corners(triangle).map(Vec3::as_dvec3);
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// Distance along a ray to the plane of the triangle that was hit, in f64; the one that f32
    /// found if that is not finite.
    pub(crate) fn refine(&self, hit: Hit, normal: DVec3, origin: DVec3, direction: DVec3) -> f64 {
        let corner = self.corners(hit.triangle)[0].as_dvec3();
        let distance = normal.dot(corner - origin) / normal.dot(direction);
        if distance.is_finite() { distance } else { f64::from(hit.distance) }
    }

    /// The nearest triangle along a ray (world space, metres; any length of direction).
    pub fn first_hit(&self, origin: Vec3, direction: Vec3) -> Option<Hit> {
        let (bvh, ray) = self.ray(origin, direction)?;
        let mut hit = RayHit::none();
        bvh.ray_traverse(ray, &mut hit, |ray, slot| self.meet(ray, bvh.primitive_indices[slot]))
            .then(|| Hit { distance: hit.t, triangle: bvh.primitive_indices[hit.primitive_id as usize] })
    }

    /// Whether anything stands in the way of a ray (world space, metres).
    pub fn is_occluded(&self, origin: Vec3, direction: Vec3) -> bool {
        self.ray(origin, direction).is_some_and(|(bvh, ray)| {
            !bvh.ray_traverse_miss(ray, |ray, slot| self.meet(ray, bvh.primitive_indices[slot]))
        })
    }

    /// Every triangle along a ray (world space, metres), in no order.
    pub fn all_hits(&self, origin: Vec3, direction: Vec3) -> Vec<Hit> {
        let mut hits = Vec::new();
        self.for_each_hit(origin, direction, |hit| hits.push(hit));
        hits
    }

    /// Calls `visit` with every triangle along a ray (world space, metres), in no order.
    pub fn for_each_hit(&self, origin: Vec3, direction: Vec3, mut visit: impl FnMut(Hit)) {
        let Some((bvh, ray)) = self.ray(origin, direction) else { return };
        bvh.ray_traverse_anyhit(ray, |ray, slot| {
            let triangle = bvh.primitive_indices[slot];
            let distance = self.meet(ray, triangle);
            if distance.is_finite() {
                visit(Hit { distance, triangle });
            }
        });
    }

    fn ray(&self, origin: Vec3, direction: Vec3) -> Option<(&Bvh2, Ray)> {
        let sane = origin.is_finite() && direction.is_finite() && direction != Vec3::ZERO;
        let bvh = self.bvh.as_ref().filter(|_| sane)?;
        Some((bvh, Ray::new_inf(origin.into(), direction.into())))
    }

    /// Distance to a triangle along a ray, infinite for a miss or a cut-out.
    fn meet(&self, ray: &Ray, index: u32) -> f32 {
        let triangle = &self.triangles[index as usize];
        let distance = triangle.intersect(ray);
        let is_opaque = self.alpha_test.is_none() && self.cut_outs.is_empty();
        if is_opaque || !distance.is_finite() {
            return distance;
        }
        let weights = weights(triangle, ray, distance);
        let passes = self.alpha_test.as_ref().is_none_or(|is_there| is_there(index, weights));
        if passes && self.cut_outs.is_there(index, weights) { distance } else { f32::INFINITY }
    }
}

/// Weights of the second and third corner at a hit, by areas.
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
    fn a_cut_out_lets_the_ray_through_where_it_says_so() {
        // Only the half next to the first corner is there.
        let tracer = Tracer::new(square_at(1.0)).with_alpha_test(|_, [second, third]| second + third < 0.5);
        assert!(tracer.is_occluded(Vec3::new(-0.9, 0.0, -0.8), Vec3::Y));
        assert!(!tracer.is_occluded(Vec3::new(0.9, 0.0, 0.8), Vec3::Y));
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
    fn empty_scenes_and_mad_rays_meet_nothing() {
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
