//! Input of a fit: the views, the light and the boxes of a frame, and memory to work in.

use glam::{DVec2, Vec3};

use crate::base::Boxes;
use crate::content::normal_cone::NormalCone;
use crate::content::{Scene, StaticBoxes};
use crate::demand::grid::DemandGrid;
use crate::demand::histogram::{DepthBounds, DepthHistogram};
use crate::view::ViewFrustum;

/// Everything that changes from frame to frame.
///
/// ```
/// use shadowfit::glam::{DVec3, Vec3};
/// use shadowfit::settings::FitSettings;
/// use shadowfit::{Aabb, Boxes, FitInput, PerspectiveCamera, Scratch};
///
/// let camera = PerspectiveCamera {
///     eye: DVec3::new(0.0, 1.7, 5.0),
///     forward: Vec3::NEG_Z,
///     up: Vec3::Y,
///     fov_y: 0.8,
///     aspect: 16.0 / 9.0,
///     near: 0.1,
///     far: 200.0,
/// };
/// let view = [camera.frustum()?];
/// let objects = [
///     Aabb::new(Vec3::new(-20.0, -0.1, -40.0), Vec3::new(20.0, 0.0, 10.0)), // ground
///     Aabb::new(Vec3::new(-2.0, 0.0, -12.0), Vec3::new(2.0, 6.0, -8.0)),    // house
/// ];
/// let boxes = Boxes::world(&objects);
/// let input = FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&view, Vec3::new(0.3, -0.8, 0.2)) };
/// let settings = FitSettings::default().with_max_distance(40.0);
/// let mut storage = [Default::default(); Scratch::required(2, 1)];
/// let map = shadowfit::fit_scene(&input, &settings, &mut Scratch::new(&mut storage))?;
/// assert!(map.texel_size.x < 0.03); // the frustum alone gives ten times that
/// # Ok::<(), shadowfit::FitError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitInput<'a> {
    /// The views to be shadowed: one, or several that share the maps (both eyes of a headset, split
    /// screen). The first one's eye becomes the origin of the fit.
    pub views: &'a [ViewFrustum],
    /// **Direction of travel** of the light in world axes, of any length: the negative of the
    /// direction toward the light.
    pub direction: Vec3,
    /// Boxes around everything that receives shadows, for [`FitKind::Focused`](crate::settings::FitKind)
    /// and for splits that depend on the content. `None` when they are not known: everything in view
    /// counts as a receiver then. An empty slice means that nothing receives.
    pub receivers: Option<Boxes<'a>>,
    /// Cones around the normals of each receiver's surfaces, or an empty slice when they are not
    /// known: surfaces that the camera sees and that face away from the light are dark without a
    /// map, so [`FitKind::Focused`](crate::settings::FitKind) ignores them.
    pub receiver_cones: &'a [NormalCone],
    /// Boxes around everything that casts shadows. They place the near plane: no caster in them is lost.
    /// `None` when they are not known: the near plane is then moved toward the light by
    /// [`MapSettings::caster_extension`](crate::settings::MapSettings::caster_extension). An empty slice means
    /// that nothing casts.
    pub casters: Option<Boxes<'a>>,
    /// A hierarchy of boxes that receive and cast shadows beside the two lists. The cost of a frame depends on the boxes
    /// nearby, not on the total. Use it for thousands of static boxes. With it a list that is `None` adds nothing.
    #[cfg(feature = "alloc")]
    pub static_boxes: Option<&'a StaticBoxes>,
    /// The depths that the last frame showed, for
    /// [`SplitScheme::FromHistogram`](crate::settings::SplitScheme::FromHistogram).
    pub histogram: Option<DepthHistogram<'a>>,
    /// What the last frame showed and how fine a texel it asked for, one grid for each picture that was
    /// drawn with the maps, for [windows](crate::Windows). Grids of
    /// another light, or of another size, are ignored.
    pub demand: &'a [DemandGrid<'a>],
    /// Nearest and farthest depth that the last frame showed, if known: uniform, logarithmic and
    /// practical splits are spread between them instead of over all that is in view.
    pub depth_bounds: Option<DepthBounds>,
}

impl<'a> FitInput<'a> {
    /// Views and light alone, `direction` being the light's direction of travel in world axes.
    pub fn new(views: &'a [ViewFrustum], direction: Vec3) -> Self {
        Self {
            views,
            direction,
            receivers: None,
            receiver_cones: &[],
            casters: None,
            #[cfg(feature = "alloc")]
            static_boxes: None,
            histogram: None,
            demand: &[],
            depth_bounds: None,
        }
    }

    /// What content is made of.
    #[inline]
    pub(crate) fn scene(&self) -> Scene<'a> {
        let Self { views, direction, receivers, receiver_cones, casters, .. } = *self;
        Scene { views, direction, receivers, receiver_cones, casters, static_boxes: self.tree() }
    }

    /// Whether it is known what casts shadows.
    pub(crate) fn knows_casters(&self) -> bool {
        self.casters.is_some() || self.tree().is_some()
    }

    #[cfg(feature = "alloc")]
    fn tree(&self) -> Option<&'a StaticBoxes> {
        self.static_boxes
    }

    #[cfg(not(feature = "alloc"))]
    #[expect(clippy::unused_self, reason = "as with an allocator")]
    fn tree(&self) -> Option<&'a StaticBoxes> {
        None
    }

    /// Number of elements of [`Scratch`] that is enough for any fit of this input: that of
    /// [`Scratch::required`] for its lists, and room for the outline of static boxes. Maps that are
    /// [held](crate::settings::Stabilise::Hysteresis) look at the views of two frames ahead, for which two more views
    /// count.
    pub fn scratch(&self) -> usize {
        let count = |boxes: Option<Boxes>| boxes.map_or(0, |boxes| boxes.boxes.len());
        let outline = if self.tree().is_some() { STANDING_OUTLINE } else { 0 };
        let boxes = count(self.receivers).max(count(self.casters)) + outline;
        Scratch::required(boxes, self.views.len() + VIEWS_AHEAD)
    }
}

/// Boxes that make up the outline of static ones: far more than it has corners in any scene that was tried.
const STANDING_OUTLINE: usize = 128;

/// Views that a fit works with beside those of the frame: held maps are fitted to the views of two frames ahead as well.
const VIEWS_AHEAD: usize = 2;

/// Storage that fits work in, owned by the caller, so that nothing allocates.
#[derive(Debug)]
pub struct Scratch<'a> {
    pub(crate) storage: &'a mut [DVec2],
}

/// Greatest number of corners of a box clipped to a view: a convex body with six and six faces has
/// no more than 2 · 12 - 4.
const CORNERS_PER_BOX: usize = 20;

impl<'a> Scratch<'a> {
    /// Number of elements that is enough for any fit of a number of boxes (receivers or casters, whichever are
    /// more) in a number of views. Usually far less is used, since few boxes contribute to the outline.
    pub const fn required(boxes: usize, views: usize) -> usize {
        let pairs = boxes.saturating_mul(views);
        pairs
            .saturating_mul(1 + 2 * CORNERS_PER_BOX)
            .saturating_add(boxes.saturating_mul(2))
            .saturating_add(views.saturating_add(2).saturating_mul(16))
            .saturating_add(64)
    }

    /// A scratch over storage, whose content is ignored.
    pub fn new(storage: &'a mut [DVec2]) -> Self {
        Self { storage }
    }
}
