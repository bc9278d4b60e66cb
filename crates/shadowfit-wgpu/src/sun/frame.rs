//! What an engine tells about a frame: views, light, boxes and casters.

use shadowfit::NormalCone;
use shadowfit::cache::{CacheFrame, InView};
use shadowfit::glam::{DVec3, Vec3};
use shadowfit::{Boxes, FitError, FitInput, FittedMap, StaticBoxes, ViewFrustum};

use crate::{Casters, MapView};

/// A frame, as [`SunShadows::update`](crate::SunShadows::update) takes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunFrame<'a> {
    /// The views that show the shadows: one, or several that share the maps (both eyes of a headset, split screen).
    pub views: &'a [ViewFrustum],
    /// World position of the eye from which view depths are counted, in metres: where maps are read by view depth, and
    /// where shadows fade.
    pub eye: DVec3,
    /// Unit direction in which that eye looks, world axes.
    pub forward: Vec3,
    /// World position that all positions in the shaders are relative to, in metres. The first view's eye is most exact;
    /// zero suits engines whose shaders take world space.
    pub origin: DVec3,
    /// **Direction of travel** of the sun's light in world axes, of any length: the true one, also where [light
    /// steps](crate::SunShadows::set_light_steps) hold the maps.
    pub direction: Vec3,
    /// Boxes around everything that receives shadows; `None` if they are not known.
    pub receivers: Option<Boxes<'a>>,
    /// Cones around the normals of each receiver's surfaces, or empty, as [`FitInput::receiver_cones`].
    pub receiver_cones: &'a [NormalCone],
    /// Everything that casts shadows, but for what is in [`Self::static_boxes`].
    pub casters: Casters<'a>,
    /// What stands, receives and casts shadows beside the two lists, handed over once and told its changes: a frame then
    /// costs what changed and what is drawn, and not what there is. Static casters belong here from some thousand on;
    /// what moves in each frame belongs in the list. For another shape in the same box call
    /// [`invalidate`](crate::SunShadows::invalidate). Keep one `StaticBoxes`: another one, or none, redraws all maps.
    ///
    /// ```
    /// # use shadowfit::glam::{DVec3, Vec3};
    /// # use shadowfit::{Aabb, Boxes, StaticBoxes, PerspectiveCamera};
    /// # use shadowfit_wgpu::{Casters, SunFrame};
    /// # let camera = PerspectiveCamera {
    /// #     eye: DVec3::Y, forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 0.8, aspect: 1.6, near: 0.1, far: 200.0
    /// # };
    /// # let (views, aabb) = ([camera.frustum()?], Aabb::new(Vec3::ZERO, Vec3::ONE));
    /// let mut world = StaticBoxes::new(DVec3::ZERO);
    /// let number = world.insert(aabb)?; // once: later `set` and `remove`
    ///
    /// let moving = [aabb];
    /// let boxes = Boxes::world(&moving);
    /// let casters = Casters { moves: &[true], ..Casters::fixed(boxes) };
    /// let frame = SunFrame::new(&views, Vec3::new(0.3, -0.8, 0.2), boxes, casters);
    /// let frame = SunFrame { static_boxes: Some(&world), ..frame };
    /// # assert_eq!(frame.static_boxes.and_then(|world| world.get(number)), Some(aabb));
    /// # Ok::<(), shadowfit::FitError>(())
    /// ```
    pub static_boxes: Option<&'a StaticBoxes>,
    /// Number of the frame. Soft filters turn their pattern by it, for temporal anti-aliasing; 0 in every frame keeps
    /// the same pattern.
    pub number: u32,
}

impl<'a> SunFrame<'a> {
    /// A frame whose shaders take positions relative to the first view's eye.
    pub fn new(views: &'a [ViewFrustum], direction: Vec3, receivers: Boxes<'a>, casters: Casters<'a>) -> Self {
        let (eye, forward) = views.first().map_or((DVec3::ZERO, Vec3::NEG_Z), |view| (view.origin, view.forward));
        Self {
            views,
            eye,
            forward,
            origin: eye,
            direction,
            receivers: Some(receivers),
            receiver_cones: &[],
            casters,
            static_boxes: None,
            number: 0,
        }
    }

    /// This frame with positions in the shaders relative to another origin, in world space, in metres.
    #[must_use]
    pub const fn with_origin(mut self, origin: DVec3) -> Self {
        self.origin = origin;
        self
    }

    /// Refuses values that go to shaders and that neither the fits nor the maps check.
    pub(crate) fn check(&self) -> Result<(), FitError> {
        for (input, point) in [("the frame's eye", self.eye), ("the frame's origin", self.origin)] {
            if let Some(value) = point.to_array().into_iter().find(|value| !value.is_finite()) {
                return Err(FitError::NotFinite { input, value });
            }
        }
        Ok(())
    }

    /// The input of the fits.
    pub(crate) fn input(&self) -> FitInput<'a> {
        FitInput {
            receivers: self.receivers,
            receiver_cones: self.receiver_cones,
            casters: Some(self.casters.boxes),
            static_boxes: self.static_boxes,
            ..FitInput::new(self.views, self.direction)
        }
    }

    /// The input of the cache, with the maps to draw.
    pub(crate) fn cache_frame(&self, maps: &'a [FittedMap]) -> CacheFrame<'a> {
        CacheFrame {
            maps,
            casters: self.casters,
            static_boxes: self.static_boxes,
            direction: self.direction,
            reader: self.map_view().reader(),
            in_view: InView::Views(self.views),
        }
    }

    /// The view from which the maps are read.
    pub(crate) fn map_view(&self) -> MapView {
        let Self { origin, eye, forward, number, .. } = *self;
        MapView { origin, eye, forward, frame: number }
    }
}
