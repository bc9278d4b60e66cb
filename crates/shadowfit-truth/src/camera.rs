//! A pinhole camera and the rays through the centres of its pixels.
//!
//! Everything is f64 and in world space, so that a visible point is as exact as its triangle. The
//! measures of pictures and those of fits both find here how large a pixel is on a surface.

use glam::{DVec2, DVec3};
use shadowfit::PerspectiveCamera;

/// A pinhole camera. World space, right-handed, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelCamera {
    /// Position of the eye.
    pub eye: DVec3,
    /// Unit direction that appears to the right.
    pub right: DVec3,
    /// Unit direction that appears upward.
    pub up: DVec3,
    /// Unit direction of view.
    pub forward: DVec3,
    /// Tangents of half of the horizontal and of the vertical field of view.
    pub tan_half_fov: DVec2,
    /// Pixels across and down the picture.
    pub size: [u32; 2],
    /// View depth of the near plane, in metres.
    pub near: f64,
    /// View depth of the far plane, in metres.
    pub far: f64,
}

impl PixelCamera {
    /// The pixels of a camera whose picture has `size` pixels across and down; they need not be square.
    /// A camera that [`PerspectiveCamera::frustum`] refuses gives axes that are not numbers, and
    /// pictures in which no pixel is judged.
    pub fn new(camera: &PerspectiveCamera, size: [u32; 2]) -> Self {
        let forward = camera.forward.as_dvec3().normalize();
        let right = forward.cross(camera.up.as_dvec3()).normalize();
        let tangent = (f64::from(camera.fov_y) * 0.5).tan();
        Self {
            eye: camera.eye,
            right,
            up: right.cross(forward),
            forward,
            tan_half_fov: DVec2::new(tangent * f64::from(camera.aspect), tangent),
            size,
            near: camera.near.into(),
            far: camera.far.into(),
        }
    }

    /// Number of pixels.
    pub fn pixels(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }

    /// Direction through the centre of a pixel, counted from the left and from the top, world axes.
    /// Its component along the view is 1, so that the distance along it is view depth.
    pub fn ray(&self, x: u32, y: u32) -> DVec3 {
        let across = (2.0 * (f64::from(x) + 0.5) / f64::from(self.size[0]) - 1.0) * self.tan_half_fov.x;
        let upward = (1.0 - 2.0 * (f64::from(y) + 0.5) / f64::from(self.size[1])) * self.tan_half_fov.y;
        self.right * across + self.up * upward + self.forward
    }

    /// The same for a pixel by its index in the rows from the top.
    pub fn ray_of(&self, index: usize) -> DVec3 {
        let width = self.size[0].max(1) as usize;
        self.ray((index % width) as u32, (index / width) as u32)
    }

    /// How far a ray moves at view depth 1 for one pixel to the right, and for one down, world axes, metres.
    pub(crate) fn pixel_axes(&self) -> [DVec3; 2] {
        let [across, down] = [0, 1].map(|axis| 2.0 * self.tan_half_fov[axis] / f64::from(self.size[axis]));
        [self.right * across, -self.up * down]
    }

    /// View depth of a point of the world, in metres.
    pub fn view_depth(&self, point: DVec3) -> f64 {
        (point - self.eye).dot(self.forward)
    }

    /// How far a point moves on its tangent plane for one pixel to the right, and for one down, world
    /// space, metres. `ray` is that of its pixel, `normal` a normal of the plane, toward either side.
    pub fn pixel_steps(&self, ray: DVec3, normal: DVec3, view_depth: f64) -> [DVec3; 2] {
        self.pixel_axes().map(|step| slide(step, ray, normal, view_depth))
    }
}

/// How far the point where a ray meets a plane moves on it when the ray is moved by `across` at view
/// depth 1.
pub(crate) fn slide(across: DVec3, ray: DVec3, normal: DVec3, view_depth: f64) -> DVec3 {
    (across - ray * (across.dot(normal) / ray.dot(normal))) * view_depth
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn camera() -> PixelCamera {
        let camera = PerspectiveCamera {
            eye: DVec3::new(3.0, 2.0, 1.0),
            forward: Vec3::new(0.3, -0.4, -1.0),
            up: Vec3::Y,
            fov_y: 1.0,
            aspect: 1.5,
            near: 0.1,
            far: 100.0,
        };
        PixelCamera::new(&camera, [30, 20])
    }

    #[test]
    fn rays_through_the_middle_of_the_picture_enclose_the_direction_of_view() {
        let camera = camera();
        let mean = (camera.ray(14, 9) + camera.ray(15, 10)) * 0.5;
        assert!(mean.abs_diff_eq(camera.forward, 1e-12));
        let right_handed = camera.right.cross(camera.up).abs_diff_eq(-camera.forward, 1e-12);
        assert!(right_handed && camera.up.y > 0.0);
        assert!((camera.ray(3, 17).dot(camera.forward) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_pixel_step_leads_to_where_the_neighbouring_ray_meets_the_plane() {
        let camera = camera();
        let (normal, plane_depth) = (DVec3::new(0.2, 1.0, 0.1).normalize(), -2.0);
        let met = |x, y| {
            let ray = camera.ray(x, y);
            let depth = (plane_depth - normal.dot(camera.eye)) / normal.dot(ray);
            (camera.eye + ray * depth, ray, depth)
        };
        let (point, ray, depth) = met(12, 15);
        let [right, down] = camera.pixel_steps(ray, normal, depth);
        // The step is the derivative: the neighbour differs by the second order, a pixel's share.
        for (step, neighbour) in [(right, met(13, 15).0), (down, met(12, 16).0)] {
            assert!((point + step - neighbour).length() < 0.1 * step.length(), "{step} {}", neighbour - point);
            assert!(step.dot(normal).abs() < 1e-12);
        }
    }
}
