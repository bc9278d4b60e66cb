//! Settings for judging pictures, and the truth that all techniques of a frame share.

use glam::DVec3;
use shadowfit::Camera;
use shadowfit_truth::{FlipReference, PixelCamera, Truth, TruthLight, TruthSettings};

use crate::View;

/// Settings for judging pictures.
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
    /// Points per pixel, across and down, at which factors are compared with the light on the pixel's area.
    /// Each point takes two rays. 0 skips the comparison.
    pub area: u32,
    /// Whether the shaded picture is compared with the same picture with true shadows
    /// ([ꟻLIP](shadowfit_truth::FlipReference)), which draws each frame once more.
    pub flip: bool,
    /// Whether only pixels of the scene's subject count. All pixels count in a scene without a subject.
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
            flip: false,
            subject_only: false,
        }
    }
}

impl Judging {
    /// Returns the settings for tracing the truth of a view. Shadows are judged up to the camera's far plane.
    pub(crate) fn truth_settings(&self, view: &View) -> TruthSettings {
        let to_light = -view.direction.as_dvec3().normalize();
        TruthSettings {
            light: TruthLight::Sun { to_light, radius: self.sun_radius, rays: self.sun_rays },
            ray_offset: self.ray_offset,
            max_distance: f64::from(view.camera.far),
        }
    }

    /// Returns the pixel camera of a view, relative to `origin`, the world position of the scene's rays, in
    /// metres.
    pub(crate) fn pixel_camera(&self, origin: DVec3, view: &View) -> PixelCamera {
        let camera = Camera { eye: view.camera.eye - origin, ..view.camera };
        PixelCamera::new(camera, self.size)
    }
}

/// The truth of a frame, for all techniques. It is traced once the first technique has found the visible
/// triangles.
#[derive(Debug, Default)]
pub struct SharedTruth {
    truth: Option<Truth>,
    /// The shaded picture with true shadows.
    pub(crate) picture: Option<FlipReference>,
}

impl SharedTruth {
    /// Returns the truth, once a picture has been judged.
    pub fn get(&self) -> Option<&Truth> {
        self.truth.as_ref()
    }

    /// Returns the truth. Traces it on the first call.
    pub(crate) fn or_trace(&mut self, trace: impl FnOnce() -> Truth) -> &Truth {
        self.truth.get_or_insert_with(trace)
    }
}

/// A shaded picture of a view, and the same picture with true shadows.
#[derive(Clone, Debug, PartialEq)]
pub struct PicturePair {
    /// sRGB pixels, four bytes each, rows from the top.
    pub(crate) mapped: Vec<u8>,
    /// The same with true shadows.
    pub(crate) truth: Vec<u8>,
    /// Width and height, in pixels.
    pub(crate) size: [u32; 2],
}

impl PicturePair {
    /// Returns the mean [ꟻLIP](FlipReference) error of the picture, 0 (as with true shadows) to 1.
    pub fn flip(&self) -> f64 {
        FlipReference::new(&self.truth, self.size).mean_error(&self.mapped)
    }
}
