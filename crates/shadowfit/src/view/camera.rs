//! A perspective camera from plain parameters.
//!
//! It is the most exact input for a fit: the frustum's corners are computed from the lens, relative to the
//! eye, without inverting an f32 matrix.

use glam::{DVec3, Mat4, Vec3, Vec4};

use super::frustum::{CORNERS_XY, ViewFrustum, check_corners, check_extent};
use crate::base::checks::{MAX_LENGTH, MIN_LENGTH};
use crate::base::{DepthConvention, FitError, checks};

/// A symmetric perspective camera in a right-handed world. Its view space looks along -z.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PerspectiveCamera {
    /// Position of the eye in world space, in metres.
    pub eye: DVec3,
    /// Viewing direction in world space, of any length that is not extreme. It is normalised.
    pub forward: Vec3,
    /// Up direction of the picture in world space. It need not be perpendicular to `forward`.
    pub up: Vec3,
    /// Vertical field of view, in radians, between 0 and π.
    pub fov_y: f32,
    /// Width of the picture divided by its height.
    pub aspect: f32,
    /// View depth of the near plane, in metres.
    pub near: f32,
    /// View depth of the far plane, in metres.
    pub far: f32,
}

/// The camera's unit axes in world space, right-handed with `right × up = -forward`.
struct CameraAxes {
    right: DVec3,
    up: DVec3,
    forward: DVec3,
}

impl PerspectiveCamera {
    /// Returns the rotation from world axes to view space (right-handed, x right, y up, looking along -z).
    ///
    /// The input is a position **relative to the eye**, in metres: subtract [`Self::eye`] in f64 first.
    /// Returns a matrix of NaN if [`Self::frustum`] rejects the camera.
    pub fn view_from_world(&self) -> Mat4 {
        let nan = DVec3::NAN;
        let axes = self.axes().unwrap_or(CameraAxes { right: nan, up: nan, forward: nan });
        let (x, y, z) = (axes.right.as_vec3(), axes.up.as_vec3(), -axes.forward.as_vec3());
        Mat4::from_cols(
            Vec4::new(x.x, y.x, z.x, 0.0),
            Vec4::new(x.y, y.y, z.y, 0.0),
            Vec4::new(x.z, y.z, z.z, 0.0),
            Vec4::W,
        )
    }

    /// Returns the projection from view space (right-handed, looking along -z, metres) to clip space with x
    /// right, y up and the given depth range.
    ///
    /// Returns a meaningless matrix if [`Self::frustum`] rejects the camera. Does not panic.
    pub fn clip_from_view(&self, depth: DepthConvention) -> Mat4 {
        let (near, far) = (f64::from(self.near), f64::from(self.far));
        let tangent = self.tangent_y();
        let (scale, offset) = match depth {
            DepthConvention::ZeroToOne => (far / (near - far), near * far / (near - far)),
            DepthConvention::Reversed => (near / (far - near), near * far / (far - near)),
            DepthConvention::NegativeOneToOne => ((far + near) / (near - far), 2.0 * near * far / (near - far)),
        };
        Mat4::from_cols(
            Vec4::new((1.0 / (tangent * f64::from(self.aspect))) as f32, 0.0, 0.0, 0.0),
            Vec4::new(0.0, (1.0 / tangent) as f32, 0.0, 0.0),
            Vec4::new(0.0, 0.0, scale as f32, -1.0),
            Vec4::new(0.0, 0.0, offset as f32, 0.0),
        )
    }

    /// Returns the projection of world positions **relative to the eye**, in metres, to clip space with the
    /// given depth range: [`Self::clip_from_view`] × [`Self::view_from_world`].
    pub fn clip_from_world(&self, depth: DepthConvention) -> Mat4 {
        let clip = self.clip_from_view(depth).as_dmat4();
        clip.mul_mat4(&self.view_from_world().as_dmat4()).as_mat4()
    }

    /// Returns the camera's view frustum, for a fit.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`ViewFrustum::from_camera`].
    #[inline(always)]
    pub fn frustum(&self) -> Result<ViewFrustum, FitError> {
        ViewFrustum::from_camera(self)
    }

    /// Returns the tangent of half the vertical field of view.
    fn tangent_y(&self) -> f64 {
        libm::tan(f64::from(self.fov_y) * 0.5)
    }

    #[inline(always)]
    fn axes(&self) -> Result<CameraAxes, FitError> {
        let forward = checks::unit("the camera's forward direction", self.forward)?;
        let up = checks::unit("the camera's up direction", self.up)?;
        let right = forward.cross(up);
        let length = checks::length(right);
        if length < PARALLEL_SINE {
            return Err(FitError::ParallelUp { forward: self.forward, up: self.up });
        }
        let right = right / length;
        Ok(CameraAxes { right, up: right.cross(forward), forward })
    }
}

impl ViewFrustum {
    /// Returns the frustum of a perspective camera. It is exact to f32 rounding of each corner (6e-8 of its
    /// distance from the eye) at any position of the eye.
    ///
    /// # Errors
    ///
    /// Fails for each parameter that is NaN, infinite, zero, or too small or large for f32 arithmetic.
    /// Returns [`FitError::OutOfRange`] for a field of view outside 0..π, [`FitError::ParallelUp`] for an
    /// undefined roll, and [`FitError::NearNotBelowFar`].
    #[inline(always)]
    pub fn from_camera(camera: &PerspectiveCamera) -> Result<Self, FitError> {
        // Computed first, because a function call spills all earlier results to memory.
        let tangent = camera.tangent_y();
        checks::point("the camera's eye", camera.eye)?;
        let axes = camera.axes()?;
        let fov_y = f64::from(camera.fov_y);
        checks::within("the camera's fov_y", fov_y, MIN_LENGTH, core::f64::consts::PI)?;
        let aspect = f64::from(camera.aspect);
        checks::within("the camera's aspect", aspect, MIN_LENGTH, MAX_LENGTH)?;
        let near = f64::from(camera.near);
        checks::within("the camera's near distance", near, MIN_LENGTH, MAX_LENGTH)?;
        let far = f64::from(camera.far);
        checks::within("the camera's far distance", far, MIN_LENGTH, MAX_LENGTH)?;
        let (right, up) = (axes.right * tangent * aspect, axes.up * tangent);
        let mut corners = [Vec3::ZERO; 8];
        for (i, (x, y)) in CORNERS_XY.into_iter().enumerate() {
            let ray = axes.forward + right * x + up * y;
            corners[i] = (ray * near).as_vec3();
            corners[i + 4] = (ray * far).as_vec3();
        }
        check_corners(&corners)?;
        check_extent(&corners, camera.near, camera.far)?;
        Ok(Self { origin: camera.eye, corners, near: camera.near, far: camera.far, forward: axes.forward.as_vec3() })
    }
}

/// Sine of the angle below which two directions count as parallel. f32 rounds a unit vector by up to 1e-7, so
/// with smaller angles the roll would be noise.
const PARALLEL_SINE: f64 = 1e-6;
