//! The visible points of a frame on surfaces that face the light, and their occluders.
//!
//! Rays search triangles in f32. Every hit is then refined in f64 with the plane of its triangle.

use std::ops::Range;

use glam::{DVec2, DVec3};

use super::scenarios::Frame;
use shadowfit_truth::{PixelCamera, Tracer, slide};

/// Number of rays across and down a frame.
pub const RAYS: [u32; 2] = [320, 180];
/// Height of the screen whose pixels are compared with texels, in pixels.
const SCREEN_HEIGHT: f64 = 1080.0;
/// Distance of the start of shadow rays above the surface, in metres.
const RAY_OFFSET: f64 = 1e-3;

/// The visible points of a frame that face the light.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VisiblePoints {
    /// Points, in rows from the top.
    pub points: Vec<VisiblePoint>,
    /// Number of visible points, including points that face away from the light.
    pub visible: u32,
    /// Unit direction toward the light, world axes.
    pub to_light: DVec3,
    /// Side of the square of pixels that a ray represents: 6 if every ray is traced.
    pub pixels_per_ray: f64,
    /// Distances of the occluders along `to_light`, in metres. Each point has a range of this list.
    pub occluders: Vec<f64>,
}

/// A visible point that faces the light. World space, metres.
#[derive(Clone, Debug, PartialEq)]
pub struct VisiblePoint {
    /// Number among all visible points of the frame, including points that face away from the light.
    pub number: u32,
    /// Position.
    pub position: DVec3,
    /// Unit geometric normal on the side of the eye.
    pub normal: DVec3,
    /// Cosine of the angle between the normal and the direction toward the light, above 0.
    pub facing: f64,
    /// Distance from the eye along the view, in metres.
    pub view_depth: f64,
    /// Movement of the point on its tangent plane per pixel to the right.
    pub pixel_right: DVec3,
    /// Movement of the point on its tangent plane per pixel down.
    pub pixel_down: DVec3,
    /// Range of its occluders in [`VisiblePoints::occluders`]. Empty for a lit point.
    pub occluders: Range<usize>,
}

impl VisiblePoints {
    /// Traces every `stride`-th ray of a frame, across and down, through the triangles of its scene. The
    /// measures are defined for a stride of 1. Larger strides are faster and approximate.
    pub fn trace(tracer: &Tracer, frame: &Frame, stride: u32) -> Self {
        let camera = ray_camera(frame);
        let stride = stride.max(1);
        let pixels_per_ray = SCREEN_HEIGHT / f64::from(RAYS[1]) * f64::from(stride);
        let mut visible = Self { to_light: frame.to_light(), pixels_per_ray, ..Self::default() };
        let step = stride as usize;
        for y in (0..RAYS[1]).step_by(step) {
            for x in (0..RAYS[0]).step_by(step) {
                visible.add(tracer, &camera, camera.ray(x, y).direction);
            }
        }
        visible
    }

    /// Returns the positions of a point's occluders, world space, metres.
    pub fn occluders_of(&self, point: &VisiblePoint) -> impl Iterator<Item = DVec3> {
        let (origin, to_light) = (point.position, self.to_light);
        self.occluders[point.occluders.clone()].iter().map(move |distance| origin + to_light * *distance)
    }

    /// Traces one ray and adds the point that it hits.
    fn add(&mut self, tracer: &Tracer, camera: &PixelCamera, direction: DVec3) {
        let Some(hit) = tracer.first_hit(camera.eye.as_vec3(), direction.as_vec3()) else { return };
        let mut normal = tracer.plane_normal(hit.triangle);
        let view_depth = tracer.refine(hit, normal, camera.eye, direction);
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
        let pixel = 2.0 * camera.half_size.y / SCREEN_HEIGHT;
        let step = |across: DVec3| slide(across * pixel, direction, normal, view_depth);
        let occluders = self.add_occluders(tracer, position + normal * RAY_OFFSET);
        self.points.push(VisiblePoint {
            number,
            position,
            normal,
            facing,
            view_depth,
            pixel_right: step(camera.right),
            pixel_down: step(-camera.up),
            occluders,
        });
    }

    /// Adds the occluders of a point: every triangle between the point and the light.
    fn add_occluders(&mut self, tracer: &Tracer, origin: DVec3) -> Range<usize> {
        let first = self.occluders.len();
        let to_light = self.to_light;
        tracer.for_each_hit(origin.as_vec3(), to_light.as_vec3(), |hit| {
            let normal = tracer.plane_normal(hit.triangle);
            let distance = tracer.refine(hit, normal, origin, to_light);
            if distance > 0.0 {
                self.occluders.push(distance);
            }
        });
        first..self.occluders.len()
    }
}

/// Returns the camera of a frame. Distances along its rays are view depths.
fn ray_camera(frame: &Frame) -> PixelCamera {
    let view = frame.view_from_world();
    let axis = |row: usize| view.row(row).truncate();
    let tan = frame.tan_half_fov();
    PixelCamera {
        eye: view.inverse().w_axis.truncate(),
        right: axis(0),
        up: axis(1),
        forward: -axis(2),
        half_size: DVec2::new(tan * frame.aspect, tan),
        is_orthographic: false,
        size: RAYS,
        near: frame.near,
        far: frame.far,
    }
}
