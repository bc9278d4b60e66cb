//! Content of a frame: plain data.

use glam::{DVec3, Vec3};
use shadowfit::{Camera, FittedMap};
use shadowfit_wgpu::Culling;

use crate::uniform::Atmosphere;
use crate::{Inset, JudgedPicture, Line, Marks, Overlay, Quad};

/// Content of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Eye and lens of the picture.
    pub camera: Camera,
    /// Unit direction of travel of the light.
    pub direction: Vec3,
    /// The shadow maps with their biases, sorted by `far`. Empty if there is nothing to fit.
    pub maps: &'a [FittedMap],
    /// Whether the maps are used as they were last drawn. If so, nothing is drawn into them, [`Self::maps`]
    /// and [`Self::culling`] are ignored, and positions are relative to this frame's camera. For a picture
    /// after the probe of the same frame, and for further pictures of the same maps.
    pub maps_stay: bool,
    /// Whether maps are skipped if they would be drawn exactly as last time. Pictures and statistics are the
    /// same, and times are not updated. Measurements of drawing maps leave this off.
    pub maps_may_stay: bool,
    /// Eye (world space, metres) and unit forward direction for the view depths in selection by view depth.
    /// `None` for the camera's.
    pub reader: Option<(DVec3, Vec3)>,
    /// Casters that are drawn into the maps.
    pub culling: Culling,
    /// Whether shadows are drawn.
    pub shadows: bool,
    /// Colours of sun and sky.
    pub atmosphere: &'a Atmosphere,
    /// Overlay of the surfaces.
    pub overlay: Overlay,
    /// A picture that was judged against rays, for overlays and marks that show the result.
    pub judged: Option<JudgedPicture<'a>>,
    /// Marks of the judged picture's wrong pixels, on any overlay.
    pub marks: Option<Marks>,
    /// Lines drawn over the scene.
    pub lines: &'a [Line],
    /// Shadow maps shown in the picture.
    pub insets: &'a [Inset],
    /// Coloured quadrilaterals over picture and insets, drawn in this order.
    pub quads: &'a [Quad],
    /// Left, top, width and height of the part of the picture that is drawn, in pixels; `None` for all of it.
    /// The rest of the picture and of its depth buffer is unchanged. In probes it is like the sky.
    pub scissor: Option<[u32; 4]>,
    /// Shadow factors, 0 to 1, that replace the factors of maps and exact edges in opaque pixels: an `R32Float`
    /// texture of the picture's size. Pixels with a negative factor keep the factor of the maps.
    pub factors: Option<&'a wgpu::TextureView>,
    /// Smallest distance above the surface at which the rays of exact edges start, in metres. Default: a
    /// millimetre.
    pub ray_offset: f32,
}

/// Smallest distance above the surface at which the rays of exact edges start, in metres, for scenes of some
/// metres.
const RAY_OFFSET: f32 = 1e-3;

impl<'a> Frame<'a> {
    /// Returns a plain picture with shadows, for a light that travels along `direction` (unit, world axes).
    pub fn new(camera: impl Into<Camera>, direction: Vec3, maps: &'a [FittedMap], atmosphere: &'a Atmosphere) -> Self {
        Self {
            camera: camera.into(),
            direction,
            maps,
            maps_stay: false,
            maps_may_stay: false,
            reader: None,
            culling: Culling::default(),
            shadows: true,
            atmosphere,
            overlay: Overlay::default(),
            judged: None,
            marks: None,
            lines: &[],
            insets: &[],
            quads: &[],
            scissor: None,
            factors: None,
            ray_offset: RAY_OFFSET,
        }
    }

    /// Returns the frame with another camera. Points still select their maps by this frame's camera.
    #[must_use]
    pub fn seen_through(self, camera: impl Into<Camera>) -> Self {
        Self { camera: camera.into(), reader: Some(self.reader()), ..self }
    }

    /// Returns the eye and the unit forward direction for view depths.
    pub(crate) fn reader(&self) -> (DVec3, Vec3) {
        self.reader.unwrap_or((self.camera.eye, self.camera.forward.normalize()))
    }
}
