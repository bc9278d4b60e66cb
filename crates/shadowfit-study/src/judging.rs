//! How pictures are judged, and the truth that all techniques of a frame share.

use glam::DVec3;
use shadowfit::Camera;
use shadowfit_truth::{PixelCamera, Truth, TruthLight, TruthSettings};

use crate::View;

/// How pictures are judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judging {
    /// Width and height, in pixels.
    pub size: [u32; 2],
    /// Distance above the surface at which shadow rays start, in metres.
    pub ray_offset: f64,
    /// Angular radius of the sun, in radians; 0 for hard shadows.
    pub sun_radius: f64,
    /// Rays toward a sun with a radius.
    pub sun_rays: u32,
    /// Whether crawl is measured, which draws each frame once more.
    pub crawl: bool,
    /// Points of a pixel across and down by which factors are compared with the light on its whole area; 0 for none, since
    /// each takes two rays.
    pub area: u32,
    /// Whether only pixels of the scene's subject count; all do in a scene without one.
    pub subject_only: bool,
}

impl Default for Judging {
    fn default() -> Self {
        Self {
            size: [1280, 720],
            ray_offset: 1e-3,
            sun_radius: 0.0,
            sun_rays: 64,
            crawl: true,
            area: 0,
            subject_only: false,
        }
    }
}

impl Judging {
    /// How the truth of a view is traced: shadows are judged up to the camera's far plane.
    pub(crate) fn truth_settings(&self, view: &View) -> TruthSettings {
        let to_light = -view.direction.as_dvec3().normalize();
        TruthSettings {
            light: TruthLight::Sun { to_light, radius: self.sun_radius, rays: self.sun_rays },
            ray_offset: self.ray_offset,
            max_distance: f64::from(view.camera.far),
        }
    }

    /// The rays of a view's pixels, relative to the world position `origin`, in metres, that of the scene's rays.
    pub(crate) fn pixel_camera(&self, origin: DVec3, view: &View) -> PixelCamera {
        let camera = Camera { eye: view.camera.eye - origin, ..view.camera };
        PixelCamera::new(camera, self.size)
    }
}

/// The truth of a frame, for all techniques: traced as soon as the first of them has found the visible triangles.
#[derive(Debug, Default)]
pub struct SharedTruth(Option<Truth>);

impl SharedTruth {
    /// The truth, once a picture has been judged.
    pub fn get(&self) -> Option<&Truth> {
        self.0.as_ref()
    }

    /// The truth, traced on the first call.
    pub(crate) fn or_trace(&mut self, trace: impl FnOnce() -> Truth) -> &Truth {
        self.0.get_or_insert_with(trace)
    }
}
