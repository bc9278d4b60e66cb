//! Camera that a depth buffer was drawn with, and the uniform for it.

use shadowfit::demand::{DepthPicture, VisibleDemandSpace};
use shadowfit::glam::{DVec3, Mat4, Vec3};
use shadowfit::settings::MapSettings;
pub use shadowfit::uniform::DemandUniform;
use shadowfit::{DepthConvention, PerspectiveCamera, ViewFrustum};

use super::error::DemandPassError;
use crate::pixels::DepthBufferError;

/// Greatest number of rows at which every pixel is counted. In a larger picture only every second, third, ...
/// pixel is counted, across and down, so that the pass takes the same time at any resolution. In the
/// courtyard at 1080 rows, every fourth pixel is counted. That moves at most 1.1% of the points to another
/// cell (15% with a limit of 36 rows), in a tenth of the time on a software adapter.
const MAX_ROWS: u32 = 270;

/// Camera of a depth buffer, and the light that its points are counted for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DemandView {
    /// Frustum of the camera.
    pub frustum: ViewFrustum,
    /// Matrix that the depth buffer was drawn with, from world positions relative to [`ViewFrustum::origin`],
    /// in metres, to clip space. It can be perspective or orthographic, with a finite or infinite far plane.
    pub clip_from_world: Mat4,
    /// Depth convention of the depth buffer: 0..1, plain or reversed. Pixels at the far plane's depth have no
    /// surface.
    pub depth: DepthConvention,
    /// **Direction of travel** of the light in world axes, of any length.
    pub direction: Vec3,
    /// Up direction of the world, [`MapSettings::up`].
    pub up: Vec3,
    /// Shadow distance, in metres of view depth, [`MapSettings::max_distance`]. Points beyond are not
    /// counted.
    pub max_distance: f32,
    /// Part of the depth texture that the view fills, in pixels: left, top, width, height.
    pub rectangle: [u32; 4],
}

impl DemandView {
    /// Returns the view of a perspective camera, drawn with [`PerspectiveCamera::clip_from_world`], that
    /// fills a texture of `size` pixels. `direction` is the light's direction of travel in world axes.
    ///
    /// # Errors
    ///
    /// [`DemandPassError::Fit`] as [`PerspectiveCamera::frustum`].
    pub fn from_camera(
        camera: &PerspectiveCamera,
        depth: DepthConvention,
        direction: Vec3,
        settings: &MapSettings,
        size: [u32; 2],
    ) -> Result<Self, DemandPassError> {
        Ok(Self {
            frustum: camera.frustum()?,
            clip_from_world: camera.clip_from_world(depth),
            depth,
            direction,
            up: settings.up,
            max_distance: settings.max_distance,
            rectangle: [0, 0, size[0], size[1]],
        })
    }

    /// Returns the distance between counted pixels, across and down, in pixels.
    pub(super) fn step(&self) -> u32 {
        self.rectangle[3].div_ceil(MAX_ROWS).max(1)
    }

    /// Returns the cells and bins that the counts belong to.
    pub(super) fn space(&self) -> Result<VisibleDemandSpace, DemandPassError> {
        Ok(VisibleDemandSpace::new(&self.frustum, self.direction, self.up, self.max_distance)?)
    }

    /// Returns the uniform of the shader.
    pub(super) fn uniform(&self, space: &VisibleDemandSpace) -> Result<DemandUniform, DemandPassError> {
        if self.depth == DepthConvention::NegativeOneToOne {
            return Err(DepthBufferError::Depth(self.depth).into());
        }
        self.check_depth()?;
        let [left, top, width, height] = self.rectangle;
        let Self { frustum: view, clip_from_world, depth, .. } = self;
        let picture = DepthPicture { size: [width, height], clip_from_world: *clip_from_world, depth: *depth, view };
        // The only error: the matrix has no inverse.
        let uniform = DemandUniform::new(&picture, space, self.step(), [left, top]);
        Ok(uniform.map_err(|_| DepthBufferError::SingularMatrix)?)
    }

    /// Refuses a matrix whose depth runs in the opposite direction of the convention.
    fn check_depth(&self) -> Result<(), DepthBufferError> {
        let clip_from_world = self.clip_from_world.as_dmat4();
        let depth_of = |corners: &[Vec3]| {
            let middle = corners.iter().map(|corner| corner.as_dvec3()).sum::<DVec3>() * 0.25;
            let clip = clip_from_world * middle.extend(1.0);
            clip.z / clip.w
        };
        let (near, far) = (depth_of(&self.frustum.corners[..4]), depth_of(&self.frustum.corners[4..]));
        // NaN is refused as a singular matrix.
        let is_other = if self.depth == DepthConvention::Reversed { near < far } else { near > far };
        if is_other { Err(DepthBufferError::OtherDepth(self.depth)) } else { Ok(()) }
    }
}
