//! A camera and the rays through the centres of its pixels.
//!
//! All values are f64 in world space, so that a visible point is as exact as its triangle. Judged pictures
//! and measured fits use the same size of a pixel on a surface, computed here.

use glam::{DVec2, DVec3};
use shadowfit::Camera;

/// A camera with a perspective or an orthographic lens. World space, right-handed, metres.
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
    /// Half of the picture's width and height, in metres, at a view depth of 1 m. If the lens [is
    /// orthographic](Self::is_orthographic), it is the same at every view depth.
    pub half_size: DVec2,
    /// Whether all rays are parallel and start beside the eye instead of at it.
    pub is_orthographic: bool,
    /// Pixels across and down the picture.
    pub size: [u32; 2],
    /// View depth of the near plane, in metres.
    pub near: f64,
    /// View depth of the far plane, in metres.
    pub far: f64,
}

impl PixelCamera {
    /// Creates the pixel camera of a picture of `size` pixels across and down. Pixels need not be square. If
    /// [`Camera::frustum`] would refuse the camera, the axes are NaN and no pixel of the picture is judged.
    pub fn new(camera: impl Into<Camera>, size: [u32; 2]) -> Self {
        let camera: Camera = camera.into();
        let forward = camera.forward.as_dvec3().normalize();
        let right = forward.cross(camera.up.as_dvec3()).normalize();
        Self {
            eye: camera.eye,
            right,
            up: right.cross(forward),
            forward,
            half_size: camera.half_size(),
            is_orthographic: camera.lens.is_orthographic(),
            size,
            near: camera.near.into(),
            far: camera.far.into(),
        }
    }

    /// Returns the number of pixels.
    pub fn pixels(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }

    /// Returns the ray through the centre of a pixel, counted from the left and from the top.
    pub fn ray(&self, x: u32, y: u32) -> PixelRay {
        let across = (2.0 * (f64::from(x) + 0.5) / f64::from(self.size[0]) - 1.0) * self.half_size.x;
        let upward = (1.0 - 2.0 * (f64::from(y) + 0.5) / f64::from(self.size[1])) * self.half_size.y;
        self.ray_beside(self.right * across + self.up * upward)
    }

    /// Returns the ray at an offset from the picture's centre, in metres; for a perspective, at a view depth
    /// of 1 m.
    fn ray_beside(&self, aside: DVec3) -> PixelRay {
        if self.is_orthographic {
            PixelRay { origin: self.eye + aside, direction: self.forward }
        } else {
            PixelRay { origin: self.eye, direction: aside + self.forward }
        }
    }

    /// Returns `ray` moved by `aside`, in metres; for a perspective, at a view depth of 1 m.
    pub(crate) fn moved(&self, ray: &PixelRay, aside: DVec3) -> PixelRay {
        let PixelRay { origin, direction } = *ray;
        if self.is_orthographic {
            PixelRay { origin: origin + aside, direction }
        } else {
            PixelRay { origin, direction: direction + aside }
        }
    }

    /// Returns the ray through the centre of a pixel, given by its index in rows from the top.
    pub fn ray_of(&self, index: usize) -> PixelRay {
        let width = self.size[0].max(1) as usize;
        self.ray((index % width) as u32, (index / width) as u32)
    }

    /// Returns how far a ray moves for one pixel to the right and one down, world axes, metres; for a
    /// perspective, at a view depth of 1 m.
    pub(crate) fn pixel_axes(&self) -> [DVec3; 2] {
        let [across, down] = [0, 1].map(|axis| 2.0 * self.half_size[axis] / f64::from(self.size[axis]));
        [self.right * across, -self.up * down]
    }

    /// Returns the view depth of a world point, in metres.
    pub fn view_depth(&self, point: DVec3) -> f64 {
        (point - self.eye).dot(self.forward)
    }

    /// Returns how far a point moves on its tangent plane for one pixel to the right and one down, world
    /// space, metres. `ray` is the pixel's ray. `normal` is the plane's normal, on either side.
    pub fn pixel_steps(&self, ray: &PixelRay, normal: DVec3, view_depth: f64) -> [DVec3; 2] {
        self.pixel_axes().map(|step| slide(step, ray.direction, normal, self.spread(view_depth)))
    }

    /// Returns the distance of two rays at a view depth, in metres, relative to their distance in the
    /// picture's own units.
    pub(crate) const fn spread(&self, view_depth: f64) -> f64 {
        if self.is_orthographic { 1.0 } else { view_depth }
    }
}

/// The line of sight of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelRay {
    /// Point where the view depth is 0, world space, metres.
    pub origin: DVec3,
    /// Direction whose component along the view is 1, so that the distance along it is view depth.
    pub direction: DVec3,
}

impl PixelRay {
    /// Returns the point at a view depth, in metres.
    pub fn at(&self, view_depth: f64) -> DVec3 {
        self.origin + self.direction * view_depth
    }
}

/// Returns how far a ray's intersection with a plane moves when the ray is moved there by `across` times
/// `spread`.
pub fn slide(across: DVec3, ray: DVec3, normal: DVec3, spread: f64) -> DVec3 {
    (across - ray * (across.dot(normal) / ray.dot(normal))) * spread
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use shadowfit::Lens;

    use super::*;

    fn cameras() -> [PixelCamera; 2] {
        [Lens::Perspective { fov_y: 1.0 }, Lens::Orthographic { half_height: 3.0 }].map(|lens| {
            let (eye, forward) = (DVec3::new(3.0, 2.0, 1.0), Vec3::new(0.3, -0.4, -1.0));
            let camera = Camera { eye, forward, up: Vec3::Y, lens, aspect: 1.5, near: 0.1, far: 100.0 };
            PixelCamera::new(camera, [30, 20])
        })
    }

    #[test]
    fn rays_through_the_middle_of_the_picture_enclose_the_direction_of_view() {
        for camera in cameras() {
            let mean = (camera.ray(14, 9).at(5.0) + camera.ray(15, 10).at(5.0)) * 0.5;
            assert!(mean.abs_diff_eq(camera.eye + camera.forward * 5.0, 1e-12));
            let right_handed = camera.right.cross(camera.up).abs_diff_eq(-camera.forward, 1e-12);
            assert!(right_handed && camera.up.y > 0.0);
            assert!((camera.view_depth(camera.ray(3, 17).at(7.0)) - 7.0).abs() < 1e-12);
        }
    }

    #[test]
    fn rays_of_a_camera_meet_its_clip_space_at_their_pixel() {
        for lens in [Lens::Perspective { fov_y: 1.0 }, Lens::Orthographic { half_height: 3.0 }] {
            let (eye, forward) = (DVec3::new(3.0, 2.0, 1.0), Vec3::new(0.3, -0.4, -1.0));
            let camera = Camera { eye, forward, up: Vec3::Y, lens, aspect: 1.5, near: 0.1, far: 100.0 };
            let ray = PixelCamera::new(camera, [30, 20]).ray(3, 17);
            for (view_depth, depth) in [(0.1, 0.0), (100.0, 1.0)] {
                let clip = camera.clip_from_world(shadowfit::DepthConvention::ZeroToOne)
                    * (ray.at(view_depth) - eye).as_vec3().extend(1.0);
                let found = clip.truncate() / clip.w;
                let expected = Vec3::new(3.5 / 15.0 - 1.0, 1.0 - 17.5 / 10.0, depth);
                assert!(found.abs_diff_eq(expected, 2e-6), "{lens:?}: {found}");
            }
        }
    }

    #[test]
    fn a_pixel_step_leads_to_where_the_neighbouring_ray_meets_the_plane() {
        for camera in cameras() {
            let (normal, plane_depth) = (DVec3::new(0.2, 1.0, 0.1).normalize(), -2.0);
            let met = |x, y| {
                let ray = camera.ray(x, y);
                let depth = (plane_depth - normal.dot(ray.origin)) / normal.dot(ray.direction);
                (ray.at(depth), ray, depth)
            };
            let (point, ray, depth) = met(12, 15);
            let [right, down] = camera.pixel_steps(&ray, normal, depth);
            // The step is a derivative. The neighbour differs from it by a second-order term, a fraction of a
            // pixel.
            for (step, neighbour) in [(right, met(13, 15).0), (down, met(12, 16).0)] {
                assert!((point + step - neighbour).length() < 0.1 * step.length(), "{step} {}", neighbour - point);
                assert!(step.dot(normal).abs() < 1e-12);
            }
        }
    }
}
