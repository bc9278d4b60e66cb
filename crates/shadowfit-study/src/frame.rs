//! The frame of a view, and a haze that fits the distance of view.

use shadowfit::FittedMap;
use shadowfit_params::tool::CameraSettings;
use shadowfit_render::{Atmosphere, Frame};

use crate::View;

/// Returns sun and sky with a haze for the size of the visible scene, so that it does not hide a chair but is
/// visible in a town. At `sight` metres, it is as dense as the default haze at the default camera's far
/// plane.
pub fn atmosphere(sight: f32) -> Atmosphere {
    let atmosphere = Atmosphere::default();
    let usual = CameraSettings::default().far;
    Atmosphere { haze_per_metre: atmosphere.haze_per_metre * usual / sight.max(1e-3), ..atmosphere }
}

impl View {
    /// Returns a plain frame of the view with the shadows of these maps. If these maps were drawn last, they
    /// are not drawn again.
    pub fn frame<'a>(&self, maps: &'a [FittedMap], atmosphere: &'a Atmosphere) -> Frame<'a> {
        Frame { maps_may_stay: true, ..Frame::new(self.camera, self.direction, maps, atmosphere) }
    }

    /// Returns sun and sky with a haze for the camera's far plane.
    pub(crate) fn atmosphere(&self) -> Atmosphere {
        atmosphere(self.camera.far)
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};
    use shadowfit::PerspectiveCamera;

    use super::*;

    fn camera(far: f32) -> PerspectiveCamera {
        PerspectiveCamera {
            eye: DVec3::ZERO,
            forward: Vec3::NEG_Z,
            up: Vec3::Y,
            fov_y: 0.8,
            aspect: 1.0,
            near: 0.1,
            far,
        }
    }

    #[test]
    fn haze_thins_with_the_distance_that_it_suits() {
        let view = View { camera: camera(10.0).into(), direction: Vec3::NEG_Y, is_first: true };
        let own = view.atmosphere().haze_per_metre;
        let near = |value: f32, expected: f32| (value - expected).abs() <= 1e-6 * expected;
        assert!(near(atmosphere(20.0).haze_per_metre, own / 2.0));
        assert!(near(atmosphere(40.0).haze_per_metre, own / 4.0));
        let default = Atmosphere::default().haze_per_metre;
        assert!(near(atmosphere(CameraSettings::default().far).haze_per_metre, default));
    }

    #[test]
    fn a_frame_seen_from_outside_keeps_the_eye_that_chooses_the_maps() {
        let view = View { camera: camera(10.0).into(), direction: Vec3::NEG_Y, is_first: true };
        let outside = PerspectiveCamera { eye: DVec3::new(5.0, 6.0, 7.0), ..camera(100.0) };
        let atmosphere = view.atmosphere();
        let inside = view.frame(&[], &atmosphere);
        let drawn = inside.seen_through(outside);
        assert_eq!((drawn.camera.eye, drawn.reader), (outside.eye, Some((DVec3::ZERO, Vec3::NEG_Z))));
        assert_eq!(inside.reader, None);
    }
}
