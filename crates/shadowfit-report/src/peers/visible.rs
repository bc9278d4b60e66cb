//! The points that a frame's camera sees on surfaces that face the light, and their occluders.
//!
//! Rays look for triangles in f32; every hit is refined to its triangle's plane in f64.

use std::ops::Range;

use glam::{DVec2, DVec3};

use super::scenarios::Frame;
use shadowfit_truth::{PixelCamera, Tracer, slide};

/// Number of rays across and down a frame.
pub const RAYS: [u32; 2] = [320, 180];
/// Height, in pixels, of the screen whose pixels are compared with texels.
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
    /// Side, in pixels, of the square that a ray stands for: 6 where every ray is traced.
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
    /// Distance from the eye along the view, in metres.
    pub view_depth: f64,
    /// How far the point moves on its tangent plane for a pixel to the right.
    pub pixel_right: DVec3,
    /// How far the point moves on its tangent plane for a pixel down.
    pub pixel_down: DVec3,
    /// Its occluders in [`VisiblePoints::occluders`]; empty for a lit point.
    pub occluders: Range<usize>,
}

impl VisiblePoints {
    /// Traces every `stride`-th ray across and down of a frame through the triangles of its scene. The
    /// measures are defined for a stride of 1; with more they are faster and approximate.
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

    /// Positions of a point's occluders, world space, metres.
    pub fn occluders_of(&self, point: &VisiblePoint) -> impl Iterator<Item = DVec3> {
        let (origin, to_light) = (point.position, self.to_light);
        self.occluders[point.occluders.clone()].iter().map(move |distance| origin + to_light * *distance)
    }

    /// Traces one ray, and counts and keeps the point that it meets.
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

    /// Keeps every triangle between a point and the light.
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

/// The camera of a frame and its rays; the distance along one is view depth.
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
