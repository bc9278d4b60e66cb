//! What a frame's camera sees of the lit side of the world, and everything that shadows it.
//!
//! Rays look for triangles in f32; every hit is refined to its triangle's plane in f64.

use std::ops::Range;

use glam::DVec3;

use super::Frame;
use crate::Tracer;

/// Rays across and down a frame.
pub const RAYS: [u32; 2] = [320, 180];
/// Height of the screen whose pixels are meant.
const SCREEN_HEIGHT: f64 = 1080.0;
/// Start of shadow rays above the surface, in metres.
const RAY_OFFSET: f64 = 1e-3;

/// The visible points of a frame that face the light.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VisiblePoints {
    /// Points, in rows from the top.
    pub points: Vec<VisiblePoint>,
    /// Number of visible points, those that face away from the light included.
    pub visible: u32,
    /// Unit direction toward the light, world axes.
    pub to_light: DVec3,
    /// Side of the square of pixels that a ray stands for: 6 where every ray is traced.
    pub pixels_per_ray: f64,
    /// Distances of the occluders along `to_light`, in metres: each point has a range of it.
    pub occluders: Vec<f64>,
}

/// A visible point that faces the light. World space, metres.
#[derive(Clone, Debug, PartialEq)]
pub struct VisiblePoint {
    /// Number among all visible points of the frame, those that face away included.
    pub number: u32,
    /// The point.
    pub position: DVec3,
    /// Unit geometric normal on the side of the eye.
    pub normal: DVec3,
    /// Cosine of the angle between the normal and the direction toward the light, above 0.
    pub facing: f64,
    /// Distance from the eye along the view's axis.
    pub view_depth: f64,
    /// How far the point moves on its tangent plane for a pixel to the right.
    pub pixel_right: DVec3,
    /// How far the point moves on its tangent plane for a pixel down.
    pub pixel_down: DVec3,
    /// Its occluders in [`VisiblePoints::occluders`]; empty for a lit point.
    pub occluders: Range<usize>,
}

impl VisiblePoints {
    /// Traces every `stride`th ray across and down of the frame (1 for what the measures define;
    /// more is a quick look), with the triangles of the frame's scene.
    pub fn trace(tracer: &Tracer, frame: &Frame, stride: u32) -> Self {
        let camera = RayCamera::new(frame);
        let stride = stride.max(1);
        let pixels_per_ray = SCREEN_HEIGHT / f64::from(RAYS[1]) * f64::from(stride);
        let mut visible = Self { to_light: frame.to_light(), pixels_per_ray, ..Self::default() };
        let step = stride as usize;
        for y in (0..RAYS[1]).step_by(step) {
            for x in (0..RAYS[0]).step_by(step) {
                visible.add(tracer, &camera, camera.direction(x, y));
            }
        }
        visible
    }

    /// Where the occluders of a point are, world space.
    pub fn occluders_of(&self, point: &VisiblePoint) -> impl Iterator<Item = DVec3> {
        let (origin, to_light) = (point.position, self.to_light);
        self.occluders[point.occluders.clone()].iter().map(move |distance| origin + to_light * *distance)
    }

    /// Follows one ray, and counts and keeps what it meets.
    fn add(&mut self, tracer: &Tracer, camera: &RayCamera, direction: DVec3) {
        let Some(hit) = tracer.first_hit(camera.eye.as_vec3(), direction.as_vec3()) else { return };
        let mut normal = plane_normal(tracer, hit.triangle);
        let view_depth = refine(tracer, hit.triangle, normal, camera.eye, direction, hit.distance);
        if view_depth > camera.far || view_depth < camera.near {
            return;
        }
        let number = self.visible;
        self.visible += 1;
        if normal.dot(direction) > 0.0 {
            normal = -normal;
        }
        let facing = normal.dot(self.to_light);
        if facing <= 0.0 || facing.is_nan() {
            return;
        }
        let position = camera.eye + direction * view_depth;
        // Moves on the tangent plane along which the ray through the neighbouring pixel is met.
        let slide = |across: DVec3| (across - direction * (across.dot(normal) / direction.dot(normal))) * view_depth;
        let occluders = self.add_occluders(tracer, position + normal * RAY_OFFSET);
        self.points.push(VisiblePoint {
            number,
            position,
            normal,
            facing,
            view_depth,
            pixel_right: slide(camera.right * camera.pixel),
            pixel_down: slide(-camera.up * camera.pixel),
            occluders,
        });
    }

    /// Keeps every triangle between a point and the light.
    fn add_occluders(&mut self, tracer: &Tracer, origin: DVec3) -> Range<usize> {
        let first = self.occluders.len();
        let to_light = self.to_light;
        tracer.for_each_hit(origin.as_vec3(), to_light.as_vec3(), |hit| {
            let normal = plane_normal(tracer, hit.triangle);
            let distance = refine(tracer, hit.triangle, normal, origin, to_light, hit.distance);
            if distance > 0.0 {
                self.occluders.push(distance);
            }
        });
        first..self.occluders.len()
    }
}

/// The camera of a frame as its rays need it: world space, metres.
struct RayCamera {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    /// Half of the picture's width and height at view depth 1.
    half: [f64; 2],
    /// Side of a pixel at view depth 1.
    pixel: f64,
    near: f64,
    far: f64,
}

impl RayCamera {
    fn new(frame: &Frame) -> Self {
        let view = frame.view_from_world();
        let axis = |row: usize| view.row(row).truncate();
        let tan = frame.tan_half_fov();
        Self {
            eye: view.inverse().w_axis.truncate(),
            right: axis(0),
            up: axis(1),
            forward: -axis(2),
            half: [tan * frame.aspect, tan],
            pixel: 2.0 * tan / SCREEN_HEIGHT,
            near: frame.near,
            far: frame.far,
        }
    }

    /// Direction through the middle of a part of the picture; the distance along it is view depth.
    fn direction(&self, x: u32, y: u32) -> DVec3 {
        let across = (2.0 * (f64::from(x) + 0.5) / f64::from(RAYS[0]) - 1.0) * self.half[0];
        let upward = (1.0 - 2.0 * (f64::from(y) + 0.5) / f64::from(RAYS[1])) * self.half[1];
        self.right * across + self.up * upward + self.forward
    }
}

/// Unit normal of a triangle's plane, by its winding.
fn plane_normal(tracer: &Tracer, triangle: u32) -> DVec3 {
    let [a, b, c] = tracer.corners(triangle).map(glam::Vec3::as_dvec3);
    (b - a).cross(c - a).normalize_or_zero()
}

/// Distance along a ray to a triangle's plane; the one that f32 found if that is not finite.
fn refine(tracer: &Tracer, triangle: u32, normal: DVec3, origin: DVec3, direction: DVec3, found: f32) -> f64 {
    let corner = tracer.corners(triangle)[0].as_dvec3();
    let distance = normal.dot(corner - origin) / normal.dot(direction);
    if distance.is_finite() { distance } else { f64::from(found) }
}
