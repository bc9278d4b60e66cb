//! Tests camera positions: whether a camera fits there, and how much its picture shows.
//!
//! Rays reject most positions quickly. For the remaining ones the distance to every triangle is computed, so
//! that thin walls and wires between the rays are not missed.

use glam::Vec3;
use rayon::prelude::*;
use shadowfit::Camera;
use shadowfit_truth::Tracer;

/// Number of ray directions, 13° apart: enough to tell whether a position is inside a solid.
const DIRECTIONS: usize = 256;
/// Angle between successive points of an even spiral on a sphere, in radians (the golden angle).
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;
/// Least share of back-face hits at a position that counts as inside a solid.
const INSIDE: f32 = 0.5;
/// Rays across and down a view.
const VIEW_RAYS: [usize; 2] = [12, 8];

/// Tests positions in a scene. World space, metres.
pub(super) struct Probe<'a> {
    pub(super) tracer: &'a Tracer,
    /// Minimum distance of a camera from every triangle.
    pub(super) clearance: f32,
    directions: Vec<Vec3>,
}

/// The content of a camera's view, sampled with a coarse grid of rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seen {
    /// Share of the rays that hit geometry.
    pub(super) share: f32,
    /// Median distance of the hits, in metres; 0 if no ray hits.
    pub(super) distance: f32,
}

impl<'a> Probe<'a> {
    pub(super) fn new(tracer: &'a Tracer, clearance: f32) -> Self {
        Self { tracer, clearance, directions: (0..DIRECTIONS).map(direction).collect() }
    }

    /// Returns whether the rays allow a camera here: outside solids, and no hit within the clearance.
    pub(super) fn is_open(&self, eye: Vec3) -> bool {
        let (mut met, mut from_behind) = (0, 0);
        for &direction in &self.directions {
            let Some(hit) = self.tracer.first_hit(eye, direction) else { continue };
            if hit.distance < self.clearance {
                return false;
            }
            met += 1;
            from_behind += usize::from(self.tracer.normal(hit.triangle).dot(direction) > 0.0);
        }
        from_behind as f32 <= INSIDE * met as f32
    }

    /// Returns whether no triangle at all is within the clearance.
    pub(super) fn is_clear(&self, eye: Vec3) -> bool {
        (0..self.tracer.len() as u32).into_par_iter().all(|triangle| {
            let corners = self.tracer.corners(triangle);
            is_a_point(&corners) || is_beyond(eye, &corners, self.clearance)
        })
    }

    /// Returns whether a camera can fly straight between two positions, with the clearance on all sides.
    pub(super) fn is_way(&self, from: Vec3, to: Vec3) -> bool {
        let way = to - from;
        let side = way.cross(Vec3::Y).normalize_or_zero() * self.clearance;
        let offsets = [Vec3::ZERO, side, -side, Vec3::Y * self.clearance, Vec3::NEG_Y * self.clearance];
        way != Vec3::ZERO
            && offsets
                .iter()
                .all(|offset| self.tracer.first_hit(from + offset, way).is_none_or(|hit| hit.distance > 1.0))
    }

    /// Returns the height of the camera over the surface below it, in metres; infinite if there is none.
    pub(super) fn height(&self, eye: Vec3) -> f32 {
        self.tracer.first_hit(eye, Vec3::NEG_Y).map_or(f32::INFINITY, |hit| hit.distance)
    }

    pub(super) fn look(&self, camera: impl Into<Camera>) -> Seen {
        let camera: Camera = camera.into();
        let forward = camera.forward.normalize();
        let right = forward.cross(camera.up).normalize();
        let half = camera.half_size().as_vec2();
        let up = right.cross(forward) * half.y;
        let right = right * half.x;
        let place = |index: usize, count: usize| (index as f32 + 0.5) / count as f32 * 2.0 - 1.0;
        let rays = (0..VIEW_RAYS[0] * VIEW_RAYS[1]).map(|ray| {
            forward + right * place(ray % VIEW_RAYS[0], VIEW_RAYS[0]) + up * place(ray / VIEW_RAYS[0], VIEW_RAYS[1])
        });
        let eye = camera.eye.as_vec3();
        let met = |ray: Vec3| self.tracer.first_hit(eye, ray).map(|hit| hit.distance * ray.length());
        let mut distances: Vec<f32> = rays.filter_map(met).collect();
        distances.sort_by(f32::total_cmp);
        let share = distances.len() as f32 / (VIEW_RAYS[0] * VIEW_RAYS[1]) as f32;
        Seen { share, distance: distances.get(distances.len() / 2).copied().unwrap_or(0.0) }
    }
}

/// Returns a unit direction of an even spiral on the sphere.
fn direction(index: usize) -> Vec3 {
    let height = 1.0 - (2.0 * index as f64 + 1.0) / DIRECTIONS as f64;
    let radius = (1.0 - height * height).sqrt();
    let (sin, cos) = (GOLDEN_ANGLE * index as f64).sin_cos();
    Vec3::new((radius * cos) as f32, height as f32, (radius * sin) as f32)
}

/// Returns whether a triangle is a single point. The tracer stores triangles that are not finite as such.
pub(super) fn is_a_point(corners: &[Vec3; 3]) -> bool {
    corners[0] == corners[1] && corners[1] == corners[2]
}

/// Returns whether a triangle is at least a distance away.
fn is_beyond(point: Vec3, corners: &[Vec3; 3], distance: f32) -> bool {
    let [a, b, c] = *corners;
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    // The box test is cheaper and decides nearly every triangle.
    point.distance_squared(point.clamp(low, high)) >= distance * distance
        || point.distance_squared(nearest(point, corners)) >= distance * distance
}

/// Returns the nearest point of a triangle, on its face or on one of its edges.
fn nearest(point: Vec3, corners: &[Vec3; 3]) -> Vec3 {
    let [a, b, c] = *corners;
    let normal = (b - a).cross(c - a);
    let inside = |from: Vec3, to: Vec3| (to - from).cross(point - from).dot(normal) >= 0.0;
    if normal != Vec3::ZERO && inside(a, b) && inside(b, c) && inside(c, a) {
        return point - normal * ((point - a).dot(normal) / normal.length_squared());
    }
    let edges = [(a, b), (b, c), (c, a)].map(|(from, to)| {
        let edge = to - from;
        let share = (point - from).dot(edge) / edge.length_squared();
        // The share of an edge without length is NaN.
        from + edge * if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) }
    });
    edges.into_iter().min_by(|x, y| point.distance_squared(*x).total_cmp(&point.distance_squared(*y))).unwrap_or(a)
}

#[cfg(test)]
mod tests {
    use shadowfit::PerspectiveCamera;

    use super::*;
    use crate::path::scenes::{cuboid, room};

    #[test]
    fn the_nearest_point_of_a_triangle_is_on_its_face_an_edge_or_a_corner() {
        let corners = [Vec3::ZERO, Vec3::X * 2.0, Vec3::Y * 2.0];
        let cases = [
            (Vec3::new(0.5, 0.5, 3.0), Vec3::new(0.5, 0.5, 0.0)),
            (Vec3::new(1.0, -1.0, 3.0), Vec3::X),
            (Vec3::new(2.0, 2.0, -1.0), Vec3::new(1.0, 1.0, 0.0)),
            (Vec3::new(-1.0, -1.0, 1.0), Vec3::ZERO),
            (Vec3::new(5.0, -1.0, 0.0), Vec3::X * 2.0),
        ];
        for (point, wanted) in cases {
            assert!(nearest(point, &corners).abs_diff_eq(wanted, 1e-6), "{point}");
        }
        assert_eq!(nearest(Vec3::ONE, &[Vec3::ZERO, Vec3::ZERO, Vec3::X]), Vec3::X);
    }

    #[test]
    fn inside_a_solid_is_not_open_and_inside_a_room_is() {
        let solid = Tracer::new(cuboid(Vec3::splat(-1.0), Vec3::ONE));
        let probe = Probe::new(&solid, 0.01);
        assert!(!probe.is_open(Vec3::ZERO) && probe.is_open(Vec3::splat(1.2)));
        let room = Tracer::new(room());
        let probe = Probe::new(&room, 0.01);
        assert!(probe.is_open(Vec3::new(0.0, 1.7, 0.0)) && !probe.is_open(Vec3::new(3.5, 1.0, 0.0)));
    }

    #[test]
    fn a_wire_between_the_rays_is_found_all_the_same() {
        let wire = [Vec3::new(0.031, 0.0, 0.0), Vec3::new(0.031, 1e-6, 0.0), Vec3::new(0.031, 0.0, 1e-6)];
        let tracer = Tracer::new([wire]);
        let probe = Probe::new(&tracer, 0.05);
        assert!(probe.is_open(Vec3::ZERO) && !probe.is_clear(Vec3::ZERO));
        assert!(Probe::new(&tracer, 0.03).is_clear(Vec3::ZERO));
        assert!(Probe::new(&Tracer::new([[Vec3::NAN; 3]]), 1.0).is_clear(Vec3::ZERO));
    }

    #[test]
    fn ways_end_at_walls_and_need_room_at_their_sides() {
        let tracer = Tracer::new(cuboid(Vec3::new(-0.1, -1.0, 0.0), Vec3::new(0.1, 1.0, 5.0)));
        let probe = Probe::new(&tracer, 0.2);
        let way = |z: f32| probe.is_way(Vec3::new(-3.0, 0.0, z), Vec3::new(3.0, 0.0, z));
        assert!(!way(1.0) && !way(-0.1) && way(-0.3));
    }

    #[test]
    fn a_view_of_half_a_floor_meets_it_with_half_of_its_rays() {
        let floor = cuboid(Vec3::new(-1e6, -1.0, -1e6), Vec3::new(1e6, 0.0, 1e6));
        let tracer = Tracer::new(floor);
        let camera = PerspectiveCamera {
            eye: glam::DVec3::Y,
            forward: Vec3::NEG_Z,
            up: Vec3::Y,
            fov_y: 1.0,
            aspect: 1.5,
            near: 0.1,
            far: 10.0,
        };
        let seen = Probe::new(&tracer, 0.1).look(camera);
        assert!(seen.share == 0.5 && seen.distance > 1.0, "{seen:?}");
    }
}
