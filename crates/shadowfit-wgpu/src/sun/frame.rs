//! Input of a frame: views, light, boxes and casters.

use shadowfit::NormalCone;
use shadowfit::cache::{CacheFrame, InView};
use shadowfit::glam::{DVec3, Vec3};
use shadowfit::{Boxes, FitError, FitInput, FittedMap, StaticBoxes, ViewFrustum};

use crate::{Casters, MapView};

/// Input of a frame, for [`SunShadows::update`](crate::SunShadows::update).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunFrame<'a> {
    /// Views that show the shadows: one, or several that share the maps (both eyes of a headset, split
    /// screen).
    pub views: &'a [ViewFrustum],
    /// World position of the eye for view depths, in metres. It is used for the selection by view depth and
    /// for the fade.
    pub eye: DVec3,
    /// Unit viewing direction of this eye, in world axes.
    pub forward: Vec3,
    /// World position that all positions in the shaders are relative to, in metres. The first view's eye is
    /// most precise. Use zero if the shaders take world space.
    pub origin: DVec3,
    /// **Direction of travel** of the sunlight in world axes, of any length. Pass the true direction, even if
    /// [light steps](crate::SunShadows::set_light_steps) hold the maps.
    pub direction: Vec3,
    /// Boxes around all receivers; `None` if they are not known.
    pub receivers: Option<Boxes<'a>>,
    /// Cones around the surface normals of each receiver, or empty; see [`FitInput::receiver_cones`].
    pub receiver_cones: &'a [NormalCone],
    /// All casters except for [`Self::static_boxes`].
    pub casters: Casters<'a>,
    /// A hierarchy of static boxes, whose objects receive and cast shadows in addition to the two lists. The
    /// per-frame cost depends on the boxes that changed or are drawn, not on their total number. Use it from
    /// some thousand static casters on. Objects that move in every frame belong in the list. If an object
    /// changes its shape but not its box, call [`invalidate`](crate::SunShadows::invalidate). Keep one
    /// `StaticBoxes`: replacing or removing it redraws all maps.
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
    /// let number = world.insert(aabb)?; // once; later call `set` and `remove`
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
    /// Number of the frame. Soft filters rotate their pattern by it, for temporal anti-aliasing. With 0 in
    /// every frame the pattern does not change.
    pub number: u32,
}

impl<'a> SunFrame<'a> {
    /// Returns a frame whose shaders take positions relative to the first view's eye.
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

    /// Returns this frame with another origin of the positions in the shaders, in world space, in metres.
    #[must_use]
    pub const fn with_origin(mut self, origin: DVec3) -> Self {
        self.origin = origin;
        self
    }

    /// Refuses values that go to shaders and are checked neither by the fits nor by the maps.
    pub(crate) fn check(&self) -> Result<(), FitError> {
        for (input, point) in [("the frame's eye", self.eye), ("the frame's origin", self.origin)] {
            if let Some(value) = point.to_array().into_iter().find(|value| !value.is_finite()) {
                return Err(FitError::NotFinite { input, value });
            }
        }
        Ok(())
    }

    /// Returns the input of the fits.
    pub(crate) fn input(&self) -> FitInput<'a> {
        FitInput {
            receivers: self.receivers,
            receiver_cones: self.receiver_cones,
            casters: Some(self.casters.boxes),
            static_boxes: self.static_boxes,
            ..FitInput::new(self.views, self.direction)
        }
    }

    /// Returns the input of the cache, with the maps to draw.
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

    /// Returns the view of the look-ups.
    pub(crate) fn map_view(&self) -> MapView {
        let Self { origin, eye, forward, number, .. } = *self;
        MapView { origin, eye, forward, frame: number }
    }
}
