//! What a frame shows: plain data.

use glam::{DVec3, Vec3};
use shadowfit::{Camera, FittedMap};
use shadowfit_wgpu::Culling;

use crate::uniform::Atmosphere;
use crate::{Inset, JudgedPicture, Line, Marks, Overlay, Quad};

/// What a frame shows.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Eye and lens that the picture is seen through.
    pub camera: Camera,
    /// Unit direction of travel of the light.
    pub direction: Vec3,
    /// The shadow maps with their biases, in order of their `far`; empty where there is nothing to fit.
    pub maps: &'a [FittedMap],
    /// Whether the maps are used as they were drawn last: nothing is drawn into them, [`Self::maps`] and
    /// [`Self::culling`] are ignored, and positions are looked up from this frame's camera. For the probe of a frame and its
    /// picture in turn, and for further pictures of the same maps.
    pub maps_stay: bool,
    /// Whether maps that would be drawn as they were last are not drawn again: pictures and statistics are the same, and
    /// times are left as they were. Measurements of what it takes to draw maps leave this off.
    pub maps_may_stay: bool,
    /// Eye (world space, metres) and unit forward direction that view depths are counted from, by which points select
    /// among maps that are read by view depth. `None` for the camera's.
    pub reader: Option<(DVec3, Vec3)>,
    /// Which casters are drawn into the maps.
    pub culling: Culling,
    /// Whether shadows are drawn.
    pub shadows: bool,
    /// Colours of sun and sky.
    pub atmosphere: &'a Atmosphere,
    /// What the surfaces show.
    pub overlay: Overlay,
    /// A picture that was judged against rays, for overlays and marks that show how the shadows were judged.
    pub judged: Option<JudgedPicture<'a>>,
    /// Marks of its wrong pixels, whatever the surfaces show.
    pub marks: Option<Marks>,
    /// Lines drawn over the scene.
    pub lines: &'a [Line],
    /// Shadow maps shown in the picture.
    pub insets: &'a [Inset],
    /// Coloured quadrilaterals over picture and insets, each drawn over those before it.
    pub quads: &'a [Quad],
    /// Left, top, width and height of the part of the picture that is drawn, in pixels; all of it where `None`. The rest
    /// of the picture and of its depth buffer stays as it was; in probes it is as the sky.
    pub scissor: Option<[u32; 4]>,
    /// Least distance above the surface at which the rays of exact edges start, in metres. Default: a millimetre.
    pub ray_offset: f32,
}

/// Least distance above the surface at which the rays of exact edges start, in metres, for scenes of some metres.
const RAY_OFFSET: f32 = 1e-3;

impl<'a> Frame<'a> {
    /// A plain picture with shadows, for a light that travels along `direction` (unit, world axes).
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
            ray_offset: RAY_OFFSET,
        }
    }

    /// The same frame seen through another camera, while points still choose their maps from this one's.
    #[must_use]
    pub fn seen_through(self, camera: impl Into<Camera>) -> Self {
        Self { camera: camera.into(), reader: Some(self.reader()), ..self }
    }

    /// Eye and unit forward direction that view depths are counted from.
    pub(crate) fn reader(&self) -> (DVec3, Vec3) {
        self.reader.unwrap_or((self.camera.eye, self.camera.forward.normalize()))
    }
}
