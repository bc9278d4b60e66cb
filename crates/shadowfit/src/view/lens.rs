//! A camera with a perspective or an orthographic lens, for code that accepts both.

use glam::{DVec2, DVec3, Mat4, Vec3, Vec4};

use super::camera::PerspectiveCamera;
use super::frustum::{CORNERS_XY, ViewFrustum, check_corners, check_extent};
use crate::base::checks::{MAX_LENGTH, MIN_LENGTH};
use crate::base::{DepthConvention, FitError, checks};

/// A symmetric camera in a right-handed world. Its view space looks along -z.
///
/// ```
/// use shadowfit::glam::{DVec3, Vec3};
/// use shadowfit::{Camera, Lens};
///
/// let lens = Lens::Orthographic { half_height: 4.0 };
/// let (eye, forward, up) = (DVec3::new(0.0, 20.0, 0.0), Vec3::NEG_Y, Vec3::NEG_Z);
/// let camera = Camera { eye, forward, up, lens, aspect: 1.5, near: 1.0, far: 30.0 };
/// let frustum = camera.frustum().unwrap();
/// assert_eq!(frustum.corners[1], Vec3::new(6.0, -1.0, -4.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Camera {
    /// Position of the eye in world space, in metres.
    pub eye: DVec3,
    /// Viewing direction in world space, of any length that is not extreme.
    pub forward: Vec3,
    /// Up direction of the picture in world space. It need not be perpendicular to `forward`.
    pub up: Vec3,
    /// Lens.
    pub lens: Lens,
    /// Width of the picture divided by its height.
    pub aspect: f32,
    /// View depth of the near plane, in metres. The near plane of an orthographic view may lie at the eye or
    /// behind it.
    pub near: f32,
    /// View depth of the far plane, in metres.
    pub far: f32,
}

/// Lens of a [`Camera`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Lens {
    /// All view rays meet at the eye.
    Perspective {
        /// Vertical field of view, in radians, between 0 and π.
        fov_y: f32,
    },
    /// All view rays are parallel.
    Orthographic {
        /// Half of the height of the picture, in metres.
        half_height: f32,
    },
}

impl Lens {
    /// Returns whether all view rays are parallel.
    pub const fn is_orthographic(&self) -> bool {
        matches!(self, Self::Orthographic { .. })
    }
}

impl Camera {
    /// Returns half of the picture's width and height, in metres: at a view depth of 1 m for a perspective
    /// lens, at any view depth for an orthographic one.
    pub fn half_size(&self) -> DVec2 {
        let half_height = match self.lens {
            Lens::Perspective { fov_y } => libm::tan(f64::from(fov_y) * 0.5),
            Lens::Orthographic { half_height } => f64::from(half_height),
        };
        DVec2::new(half_height * f64::from(self.aspect), half_height)
    }

    /// Returns the rotation from world axes to view space, as [`PerspectiveCamera::view_from_world`].
    pub fn view_from_world(&self) -> Mat4 {
        self.with_angle(1.0).view_from_world()
    }

    /// Returns the projection from view space (right-handed, looking along -z, metres) to clip space with x
    /// right, y up and the given depth range.
    ///
    /// Returns a meaningless matrix if [`Self::frustum`] rejects the camera. Does not panic.
    pub fn clip_from_view(&self, depth: DepthConvention) -> Mat4 {
        if let Lens::Perspective { fov_y } = self.lens {
            return self.with_angle(fov_y).clip_from_view(depth);
        }
        let (near, far, half) = (f64::from(self.near), f64::from(self.far), self.half_size());
        let (scale, offset) = match depth {
            DepthConvention::ZeroToOne => (1.0 / (near - far), near / (near - far)),
            DepthConvention::Reversed => (1.0 / (far - near), far / (far - near)),
            DepthConvention::NegativeOneToOne => (2.0 / (near - far), (far + near) / (near - far)),
        };
        Mat4::from_cols(
            Vec4::new((1.0 / half.x) as f32, 0.0, 0.0, 0.0),
            Vec4::new(0.0, (1.0 / half.y) as f32, 0.0, 0.0),
            Vec4::new(0.0, 0.0, scale as f32, 0.0),
            Vec4::new(0.0, 0.0, offset as f32, 1.0),
        )
    }

    /// Returns the projection of world positions **relative to the eye**, in metres, to clip space with the
    /// given depth range:
    /// [`Self::clip_from_view`] × [`Self::view_from_world`].
    pub fn clip_from_world(&self, depth: DepthConvention) -> Mat4 {
        let clip = self.clip_from_view(depth).as_dmat4();
        clip.mul_mat4(&self.view_from_world().as_dmat4()).as_mat4()
    }

    /// Returns the camera's view frustum, for a fit.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`ViewFrustum::from_camera`], for the half height instead of the field of view.
    pub fn frustum(&self) -> Result<ViewFrustum, FitError> {
        let half_height = match self.lens {
            Lens::Perspective { fov_y } => return self.with_angle(fov_y).frustum(),
            Lens::Orthographic { half_height } => f64::from(half_height),
        };
        // Checks the eye, the directions and the aspect.
        let axes = PerspectiveCamera { near: 1.0, far: 2.0, ..self.with_angle(1.0) };
        axes.frustum()?;
        checks::within("the camera's near distance", f64::from(self.near), -MAX_LENGTH, MAX_LENGTH)?;
        checks::within("the camera's far distance", f64::from(self.far), -MAX_LENGTH, MAX_LENGTH)?;
        checks::within("the camera's half height", half_height, MIN_LENGTH, MAX_LENGTH)?;
        let [right, up, back] = {
            let rows = axes.view_from_world().transpose();
            [rows.x_axis, rows.y_axis, rows.z_axis].map(|axis| axis.truncate().as_dvec3())
        };
        let half = self.half_size();
        let mut corners = [Vec3::ZERO; 8];
        for (i, (x, y)) in CORNERS_XY.into_iter().enumerate() {
            let across = right * (x * half.x) + up * (y * half.y);
            corners[i] = (across - back * f64::from(self.near)).as_vec3();
            corners[i + 4] = (across - back * f64::from(self.far)).as_vec3();
        }
        check_corners(&corners)?;
        check_extent(&corners, self.near, self.far)?;
        Ok(ViewFrustum { origin: self.eye, corners, near: self.near, far: self.far, forward: (-back).as_vec3() })
    }

    /// Returns the camera with a perspective lens.
    const fn with_angle(&self, fov_y: f32) -> PerspectiveCamera {
        let Self { eye, forward, up, lens: _, aspect, near, far } = *self;
        PerspectiveCamera { eye, forward, up, fov_y, aspect, near, far }
    }
}

impl From<PerspectiveCamera> for Camera {
    fn from(camera: PerspectiveCamera) -> Self {
        let PerspectiveCamera { eye, forward, up, fov_y, aspect, near, far } = camera;
        Self { eye, forward, up, lens: Lens::Perspective { fov_y }, aspect, near, far }
    }
}

impl From<&PerspectiveCamera> for Camera {
    fn from(camera: &PerspectiveCamera) -> Self {
        (*camera).into()
    }
}

impl From<&Self> for Camera {
    fn from(camera: &Self) -> Self {
        *camera
    }
}
