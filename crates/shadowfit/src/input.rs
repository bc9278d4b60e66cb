//! Input of a fit: the views, the light and the boxes of a frame, and working memory.

use glam::{DVec2, Vec3};

use crate::base::Boxes;
use crate::content::normal_cone::NormalCone;
use crate::content::{Scene, StaticBoxes};
use crate::demand::grid::DemandGrid;
use crate::demand::histogram::{DepthBounds, DepthHistogram};
use crate::view::ViewFrustum;

/// Input of a fit: everything that changes from frame to frame.
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
/// assert!(map.texel_size.x < 0.03); // ten times as wide from the frustum alone
/// # Ok::<(), shadowfit::FitError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitInput<'a> {
    /// Views to shadow: one, or several that share the maps (both eyes of a headset, split screen). The eye
    /// of the first view becomes the origin of the fit.
    pub views: &'a [ViewFrustum],
    /// **Direction of travel** of the light in world axes, of any length: the negative of the
    /// direction toward the light.
    pub direction: Vec3,
    /// Boxes around everything that receives shadows, for [`FitKind::Focused`](crate::settings::FitKind) and
    /// for splits that depend on the content. If it is `None`, everything in view counts as a receiver. An
    /// empty slice means that nothing receives shadows.
    pub receivers: Option<Boxes<'a>>,
    /// Cones around the surface normals of the receivers, in the order of the receivers, or an empty slice if
    /// they are unknown. [`FitKind::Focused`](crate::settings::FitKind) ignores surfaces in view that face
    /// away from the light, since they are dark without a map.
    pub receiver_cones: &'a [NormalCone],
    /// Boxes around everything that casts shadows. The near plane is placed so that no caster is lost. If it
    /// is `None`, the near plane moves toward the light by
    /// [`MapSettings::caster_extension`](crate::settings::MapSettings::caster_extension). An empty slice
    /// means that nothing casts shadows.
    pub casters: Option<Boxes<'a>>,
    /// Hierarchy of boxes that receive and cast shadows in addition to the two lists. The cost of a frame
    /// depends on the boxes nearby, not on the total number. Use it for thousands of static boxes. If it is
    /// set, a list that is `None` adds no boxes.
    #[cfg(feature = "cache")]
    pub static_boxes: Option<&'a StaticBoxes>,
    /// Visible depths of the last frame, for
    /// [`SplitScheme::FromHistogram`](crate::settings::SplitScheme::FromHistogram).
    pub histogram: Option<DepthHistogram<'a>>,
    /// Visible demand of the last frame, for [windows](crate::Windows): one grid for each picture that was
    /// drawn with the maps. Grids of another light, or with a wrong number of cells, are ignored.
    pub demand: &'a [DemandGrid<'a>],
    /// Nearest and farthest visible depth of the last frame, if known. Uniform, logarithmic and practical
    /// splits are spread between them instead of over the whole view.
    pub depth_bounds: Option<DepthBounds>,
}

impl<'a> FitInput<'a> {
    /// Creates an input with views and a light only. `direction` is the light's direction of travel in world
    /// axes.
    pub fn new(views: &'a [ViewFrustum], direction: Vec3) -> Self {
        Self {
            views,
            direction,
            receivers: None,
            receiver_cones: &[],
            casters: None,
            #[cfg(feature = "cache")]
            static_boxes: None,
            histogram: None,
            demand: &[],
            depth_bounds: None,
        }
    }

    /// Returns the part of the input that the content is computed from.
    #[inline]
    pub(crate) fn scene(&self) -> Scene<'a> {
        let Self { views, direction, receivers, receiver_cones, casters, .. } = *self;
        Scene { views, direction, receivers, receiver_cones, casters, static_boxes: self.tree() }
    }

    /// Returns whether the casters are known.
    pub(crate) fn knows_casters(&self) -> bool {
        self.casters.is_some() || self.tree().is_some()
    }

    #[cfg(feature = "cache")]
    fn tree(&self) -> Option<&'a StaticBoxes> {
        self.static_boxes
    }

    #[cfg(not(feature = "cache"))]
    #[expect(clippy::unused_self, reason = "same signature as with the tree")]
    fn tree(&self) -> Option<&'a StaticBoxes> {
        None
    }

    /// Returns a number of [`Scratch`] elements that is enough for any fit of this input. It is
    /// [`Scratch::required`] for the input's lists, plus room for the outline of static boxes and for two
    /// more views, because maps that are [held](crate::settings::Stabilise::Hysteresis) are also fitted to
    /// the predicted views of two later frames.
    pub fn scratch(&self) -> usize {
        let count = |boxes: Option<Boxes>| boxes.map_or(0, |boxes| boxes.boxes.len());
        let outline = if self.tree().is_some() { STANDING_OUTLINE } else { 0 };
        let boxes = count(self.receivers).max(count(self.casters)) + outline;
        Scratch::required(boxes, self.views.len() + VIEWS_AHEAD)
    }
}

/// Scratch memory for the outline of static boxes, counted in boxes. In every scene tried, the outline had
/// far fewer corners.
const STANDING_OUTLINE: usize = 128;

/// Views that a fit uses in addition to the views of the frame. Held maps are also fitted to two predicted
/// views.
const VIEWS_AHEAD: usize = 2;

/// Working memory of a fit, owned by the caller, so that fits need no allocator.
#[derive(Debug)]
pub struct Scratch<'a> {
    pub(crate) storage: &'a mut [DVec2],
}

/// Greatest number of corners of a box clipped to a view: 2 · 12 - 4, for a convex body with 6 + 6 faces.
const CORNERS_PER_BOX: usize = 20;

impl<'a> Scratch<'a> {
    /// Returns a number of elements that is enough for any fit with these numbers of boxes and views. `boxes`
    /// is the number of receivers or of casters, the greater of the two. Fits usually use far less, since few
    /// boxes contribute to the outline.
    pub const fn required(boxes: usize, views: usize) -> usize {
        let pairs = boxes.saturating_mul(views);
        pairs
            .saturating_mul(1 + 2 * CORNERS_PER_BOX)
            .saturating_add(boxes.saturating_mul(2))
            .saturating_add(views.saturating_add(2).saturating_mul(16))
            .saturating_add(64)
    }

    /// Creates a scratch from storage. The storage's content is ignored.
    pub fn new(storage: &'a mut [DVec2]) -> Self {
        Self { storage }
    }
}
