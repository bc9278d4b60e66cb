//! Brute-force rays against every triangle in `f64`, and random rays and triangles.

use shadowfit_rays::Sides;
use shadowfit_rays::glam::{Affine3A, DVec3, Quat, Vec3};

use super::device::Ray;

/// A triangle in the world with its blocking sides. Its front follows the winding of its mesh.
pub(crate) struct Blocker {
    pub(crate) corners: [DVec3; 3],
    /// Normal of the front, of any length.
    pub(crate) normal: DVec3,
    pub(crate) sides: Sides,
}

/// Share of a triangle, and distance in metres, within which `f32` and `f64` may disagree: a thousand
/// roundings of the coordinates in these tests.
const MARGIN: f64 = 1e-3;
/// Sine of the angle between a ray and a triangle below which that margin is too small.
const GRAZING: f64 = 1e-2;

impl Blocker {
    /// Returns the triangles of an instance. A negative determinant keeps the front sides of the mesh.
    pub(crate) fn all(triangles: &[[Vec3; 3]], world_from_mesh: &Affine3A, sides: Sides) -> Vec<Self> {
        let transform = world_from_mesh.as_daffine3();
        let blocker = |triangle: &[Vec3; 3]| {
            let corners = triangle.map(|corner| transform.transform_point3(corner.as_dvec3()));
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            Self { corners, normal: normal * transform.matrix3.determinant().signum(), sides }
        };
        triangles.iter().map(blocker).collect()
    }

    /// Returns whether it blocks a ray, or `None` within rounding of an edge.
    fn blocks(&self, [origin, direction]: Ray) -> Option<bool> {
        let [a, b, c] = self.corners;
        let (origin, direction) = (origin.as_dvec3(), direction.as_dvec3());
        let normal = (b - a).cross(c - a);
        let area = normal.length_squared();
        if area == 0.0 {
            return Some(false);
        }
        let is_grazing = (normal.dot(direction) / area.sqrt()).abs() < GRAZING;
        let distance = normal.dot(a - origin) / normal.dot(direction);
        let point = origin + direction * distance - a;
        let [second, third] = [point.cross(c - a), (b - a).cross(point)].map(|weighed| weighed.dot(normal) / area);
        let least = second.min(third).min(1.0 - second - third).min(distance);
        let faces = self.normal.dot(direction) > 0.0;
        let is_side = self.sides == Sides::Both || faces == (self.sides == Sides::Front);
        if is_grazing {
            return if self.is_far(origin, direction) { Some(false) } else { None };
        }
        if least.abs() < MARGIN { None } else { Some(least > 0.0 && is_side) }
    }
}

impl Blocker {
    /// Returns whether a ray misses the ball around the triangle.
    fn is_far(&self, origin: DVec3, direction: DVec3) -> bool {
        let centre = self.corners.iter().sum::<DVec3>() / 3.0;
        let radius = self.corners.map(|corner| corner.distance(centre)).into_iter().fold(MARGIN, f64::max);
        let to_centre = centre - origin;
        let along = to_centre.dot(direction);
        along < -radius || (to_centre - direction * along).length() > radius * (1.0 + MARGIN)
    }
}

/// Returns whether a ray is blocked, or `None` if rounding decides.
pub(crate) fn is_blocked(blockers: &[Blocker], ray: Ray) -> Option<bool> {
    let mut answer = Some(false);
    for blocker in blockers {
        match blocker.blocks(ray) {
            Some(true) => return Some(true),
            Some(false) => (),
            None => answer = None,
        }
    }
    answer
}

/// Compares results with brute force, except for rays within rounding of an edge. Requires many blocked and
/// many free rays.
pub(crate) fn assert_answers(blockers: &[Blocker], rays: &[Ray], answers: &[bool]) {
    let mut counts = [0; 2];
    for (ray, answer) in rays.iter().zip(answers) {
        if let Some(wanted) = is_blocked(blockers, *ray) {
            assert_eq!(*answer, wanted, "{ray:?}");
            counts[usize::from(wanted)] += 1;
        }
    }
    assert!(counts.iter().all(|count| count * 20 > rays.len()), "{counts:?} of {} rays are too few", rays.len());
}

/// Pseudo-random numbers, the same in each run.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// Returns a number in 0..1.
    pub(crate) fn share(&mut self) -> f32 {
        // D. Knuth's MMIX generator.
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1 << 24) as f32
    }

    /// Returns a point in a cube around zero.
    pub(crate) fn in_cube(&mut self, half: f32) -> Vec3 {
        Vec3::from([0; 3].map(|_| (self.share() * 2.0 - 1.0) * half))
    }

    /// Returns a unit direction.
    pub(crate) fn direction(&mut self) -> Vec3 {
        self.in_cube(1.0).try_normalize().unwrap_or(Vec3::Y)
    }

    pub(crate) fn triangles(&mut self, count: usize, half: f32) -> Vec<[Vec3; 3]> {
        let mut triangle = || {
            let centre = self.in_cube(half);
            [0; 3].map(|_| centre + self.in_cube(half * 0.7))
        };
        (0..count).map(|_| triangle()).collect()
    }

    pub(crate) fn rays(&mut self, count: usize, half: f32) -> Vec<Ray> {
        (0..count).map(|_| [self.in_cube(half), self.direction()]).collect()
    }

    /// Returns a rotation and stretch, half of the time mirrored, with a translation into a cube.
    pub(crate) fn transform(&mut self, half: f32) -> Affine3A {
        let mut scale = Vec3::from([0; 3].map(|_| 0.4 + self.share()));
        if self.share() < 0.5 {
            scale.y = -scale.y;
        }
        let turn = Quat::from_axis_angle(self.direction(), self.share() * 6.0);
        Affine3A::from_scale_rotation_translation(scale, turn, self.in_cube(half))
    }
}
