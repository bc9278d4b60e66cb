//! Camera that a depth buffer was drawn with, and the uniform for it.

use bytemuck::{Pod, Zeroable};
use shadowfit::demand::PIXELS;
use shadowfit::demand::{DEPTHS, VisibleDemandSpace};
use shadowfit::glam::{DVec3, Mat4, Vec3};
use shadowfit::settings::MapSettings;
use shadowfit::{DepthConvention, PerspectiveCamera, ViewFrustum};

use super::error::DemandPassError;
use crate::pixels::{DepthBufferError, world_from_pixel};

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

/// Uniform of the pass: `Demand` in WGSL, where the fields are explained.
#[allow(missing_docs)]
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct DemandUniform {
    pub world_from_pixel: [[f32; 4]; 4],
    pub view: [f32; 4],
    pub direction: [f32; 3],
    pub far_depth: f32,
    pub x: [f32; 3],
    pub cell: f32,
    pub y: [f32; 3],
    pub shape: f32,
    pub corner: [u32; 2],
    pub size: [u32; 2],
    pub step: u32,
    pub pixels: f32,
    pub exponent: i32,
    pub near: f32,
    pub far: f32,
    pub bins_per_octave: f32,
    pub pixel_width: [f32; 2],
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
        let VisibleDemandSpace { demand: space, near, far } = *space;
        let [left, top, width, height] = self.rectangle;
        // The histogram has no bins for negative or zero depths, which orthographic views may have.
        let octaves = (f64::from(far) / f64::from(near)).log2();
        let (first, bins_per_octave) = if near > 0.0 { (near, DEPTHS as f64 / octaves) } else { (f32::MAX, 0.0) };
        Ok(DemandUniform {
            world_from_pixel: self.world_from_pixel()?.to_cols_array_2d(),
            view: self.view_depth(),
            direction: space.direction.to_array(),
            far_depth: self.depth.far(),
            x: space.x.to_array(),
            cell: space.cell,
            y: space.y.to_array(),
            shape: 1.0 / space.y.length(),
            corner: [left, top],
            size: [width, height],
            step: self.step(),
            pixels: height as f32 / PIXELS * self.frustum.height_in_picture(&self.clip_from_world),
            exponent: ((space.texel.to_bits() >> 23) & 0xff).cast_signed(),
            near: first,
            far,
            bins_per_octave: bins_per_octave as f32,
            pixel_width: self.pixel_width(),
        })
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

    /// Returns the matrix from a pixel's column and row, and its depth minus the far plane's, to positions
    /// relative to the eye.
    fn world_from_pixel(&self) -> Result<Mat4, DepthBufferError> {
        let [_, _, width, height] = self.rectangle;
        let matrix = world_from_pixel(&self.clip_from_world, [width, height], self.depth);
        matrix.map(|matrix| matrix.as_mat4()).filter(Mat4::is_finite).ok_or(DepthBufferError::SingularMatrix)
    }

    /// Returns the plane whose distance from a position relative to the eye is its view depth, in metres.
    fn view_depth(&self) -> [f32; 4] {
        // The centre of the near rectangle is the most precise point.
        let middle = (self.frustum.corners[0] + self.frustum.corners[2]) * 0.5;
        let forward = self.frustum.forward;
        forward.extend(self.frustum.near - forward.dot(middle)).to_array()
    }

    /// Returns the width of a pixel on a surface that faces the eye, in metres: at view depth 0, and its
    /// growth per metre of view depth. The pixel has the size that it would have if the frustum were
    /// [`PIXELS`] high.
    fn pixel_width(&self) -> [f32; 2] {
        let [near, far] = [self.frustum.near, self.frustum.far];
        let height = |top: usize, bottom: usize| {
            (self.frustum.corners[top].as_dvec3() - self.frustum.corners[bottom].as_dvec3()).length()
        };
        let (at_near, at_far) = (height(0, 3), height(4, 7));
        let growth = (at_far - at_near) / (f64::from(far) - f64::from(near));
        [at_near - growth * f64::from(near), growth].map(|width| (width / f64::from(PIXELS)) as f32)
    }
}
