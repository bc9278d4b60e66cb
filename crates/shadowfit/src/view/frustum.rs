//! The visible part of the world, as eight corners relative to the eye.
//!
//! Fits need only these corners of a camera. They are relative to the eye, because f32 world coordinates a
//! few hundred metres from the origin would change a fit by 1e-4 of its size.

use glam::{DMat4, DVec3, DVec4, Mat4, Vec3};

use crate::base::checks::MAX_LENGTH;
use crate::base::{DepthConvention, FitError, checks};

/// A convex view volume with four edges from a near rectangle to a parallel far one: perspective,
/// orthographic, off-axis or mirrored. For a camera with a tilted near plane, such as a mirror's, it encloses
/// the visible part.
///
/// ```text
///      0───────1        4─────────────5     each rectangle: left-top, right-top,
///      │ near  │        │     far     │     right-bottom, left-bottom of the picture
///      3───────2        │             │     (clip x = -1, y = +1 first)
///                       7─────────────6
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ViewFrustum {
    /// Position of the eye in world space, in metres. The corners are relative to it.
    pub origin: DVec3,
    /// Corners in world axes relative to [`Self::origin`], in metres: four near, then four far.
    pub corners: [Vec3; 8],
    /// View depth of the near corners, in metres along [`Self::forward`] from the origin.
    pub near: f32,
    /// View depth of the far corners, in metres along [`Self::forward`] from the origin. Equal to
    /// [`Self::near`] if the view [is empty](Self::is_empty).
    pub far: f32,
    /// Unit viewing direction in world axes, perpendicular to both rectangles.
    pub forward: Vec3,
}

/// Clip x and y of the corners, in their order.
pub(crate) const CORNERS_XY: [(f64, f64); 4] = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];

/// Share of its terms below which the w of a far corner is rounding noise of an f32 matrix. The far plane
/// then counts as infinite. It is a few times 2⁻²⁴.
const INFINITE_W_F32: f64 = 1.0 / 4_194_304.0;

/// The share for f64 matrices: a few times 2⁻⁵³.
const INFINITE_W_F64: f64 = 1.0 / 2_251_799_813_685_248.0;

/// Least relative difference of a perspective's w between its planes. A matrix with a smaller difference may
/// be an orthographic one that was inverted in f32.
const PERSPECTIVE: f64 = 1e-4;

impl ViewFrustum {
    /// Returns the frustum of an f32 matrix from clip space to **absolute** world space, with the camera's
    /// position and the matrix's depth range.
    ///
    /// A far plane beyond `max_distance` (view depth in metres), or at infinity, is moved to it. Pass
    /// `f32::MAX` to keep any finite far plane. A view that begins beyond `max_distance` [is
    /// empty](Self::is_empty): it has no shadows.
    ///
    /// # Tilted planes
    ///
    /// The near plane of a mirror, a water surface or a portal is the surface itself (E. Lengyel, "Oblique
    /// view frustum depth projection and clipping", 2005), which tilts the far plane too. View depths are
    /// then measured along the axis of the picture: perpendicular to the picture plane, or along the view
    /// rays if these are parallel. The frustum encloses the visible part of the view. Its sides enclose the
    /// part of the picture that shows anything beyond the near plane, rounded outward to eighths of the
    /// picture. Its near and far planes are perpendicular to the axis, at depths rounded outward to 2^(k/8) m
    /// (for parallel rays, to sixteenths of the depth). So they mostly stay constant while a mirror moves.
    ///
    /// A perspective matrix shows whether its depth is reversed, and a contradicting `depth` is an error. An
    /// orthographic matrix does not show the direction of its depth, and no matrix shows whether its range is
    /// 0..1 or -1..1. With the wrong convention the view looks backward, or its near plane is at half or
    /// twice the distance.
    ///
    /// # Precision
    ///
    /// An f32 matrix rounds each element by up to ε = 2⁻²⁴ of itself. At the far plane w = 1/far is then the
    /// difference of two elements near 1/near (unless depth is reversed, where it is a single element). A
    /// corner c relative to the eye moves by no more than 4 ε r (|c| + |eye|), to first order in ε r, with r
    /// = far/near at the far corners and 1 at the near ones. With reversed depth r = 1 at all of them. An
    /// extent of a fitted box moves by twice the worst of these errors. Inverting a matrix in f32 multiplies
    /// the error by its condition number. Prefer [`Self::from_camera`], or [`Self::from_eye_from_clip`],
    /// whose error does not depend on |eye|.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Self::from_world_from_clip_f64`].
    pub fn from_world_from_clip(
        world_from_clip: &Mat4,
        eye: DVec3,
        depth: DepthConvention,
        max_distance: f32,
    ) -> Result<Self, FitError> {
        let matrix = world_from_clip.as_dmat4();
        Unprojection { matrix, eye, offset: eye, depth, infinite_w: INFINITE_W_F32 }.frustum(max_distance)
    }

    /// Returns the frustum of an f32 matrix from clip space to world axes **relative to the eye** (the
    /// inverse of a projection times a rotation), and the eye's position.
    ///
    /// Otherwise it equals [`Self::from_world_from_clip`], with an error bound that does not depend on the
    /// distance from the world's origin.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Self::from_world_from_clip_f64`].
    pub fn from_eye_from_clip(
        eye_from_clip: &Mat4,
        eye: DVec3,
        depth: DepthConvention,
        max_distance: f32,
    ) -> Result<Self, FitError> {
        let matrix = eye_from_clip.as_dmat4();
        Unprojection { matrix, eye, offset: DVec3::ZERO, depth, infinite_w: INFINITE_W_F32 }.frustum(max_distance)
    }

    /// Computes [`Self::from_world_from_clip`] for an f64 matrix, without its loss of precision.
    ///
    /// # Errors
    ///
    /// - [`FitError::NotFinite`] and [`FitError::OutOfRange`]: the matrix, the eye or `max_distance`.
    /// - [`FitError::OtherDepth`]: a perspective with another depth convention.
    /// - [`FitError::SingularMatrix`]: w is zero or changes its sign between near and far, or corners
    ///   coincide.
    /// - [`FitError::UnusablePlane`]: a tilted near plane with the eye on its visible side, or parallel view
    ///   rays with a w that changes its sign within the picture.
    /// - [`FitError::NearNotBelowFar`]: a `max_distance` that is not positive and ends before the near plane.
    /// - [`FitError::Endless`]: an infinite far plane with a `max_distance` of `f32::MAX`.
    /// - [`FitError::EmptyFrustum`]: no volume.
    pub fn from_world_from_clip_f64(
        world_from_clip: &DMat4,
        eye: DVec3,
        depth: DepthConvention,
        max_distance: f32,
    ) -> Result<Self, FitError> {
        let matrix = *world_from_clip;
        Unprojection { matrix, eye, offset: eye, depth, infinite_w: INFINITE_W_F64 }.frustum(max_distance)
    }

    /// Returns whether the view has no part in front of the distance that it was created with. Such a view is
    /// drawn without shadows, and no map is fitted to it.
    pub const fn is_empty(&self) -> bool {
        self.near >= self.far
    }

    /// Returns the height of the frustum as a share of the picture's height, in eighths. It is less than 1 if
    /// a tilted near plane hides the top or bottom of the picture. `clip_from_world` is the picture's matrix,
    /// for positions relative to [`Self::origin`].
    pub fn height_in_picture(&self, clip_from_world: &Mat4) -> f32 {
        let clip_from_world = clip_from_world.as_dmat4();
        let [top, bottom] = [4, 7].map(|corner: usize| {
            let clip = clip_from_world * self.corners[corner].as_dvec3().extend(1.0);
            clip.y / clip.w
        });
        let eighths = libm::round((top - bottom).abs() * 4.0);
        if eighths >= 1.0 { (eighths / 8.0) as f32 } else { 1.0 }
    }

    /// Returns whether a part of the view lies in front of a view depth, in metres. A view with no part in
    /// front of the shadow distance is drawn without shadows.
    pub const fn begins_before(&self, distance: f32) -> bool {
        self.near < self.far.min(distance)
    }

    /// Returns the part between two view depths, in metres along [`Self::forward`] from the eye. Depths
    /// outside the frustum are moved to its planes, so a slice is never larger than the whole.
    ///
    /// # Errors
    ///
    /// Returns [`FitError::NotFinite`] for a depth, and [`FitError::NearNotBelowFar`] if no part of the
    /// frustum lies between the depths.
    pub fn slice(&self, near: f32, far: f32) -> Result<Self, FitError> {
        checks::finite("the slice's near distance", f64::from(near))?;
        checks::finite("the slice's far distance", f64::from(far))?;
        let whole = self.checked()?;
        let near = near.max(whole.near);
        let far = far.min(whole.far);
        if near >= far {
            return Err(FitError::NearNotBelowFar { near, far });
        }
        let mut corners = whole.corners;
        for i in 0..4 {
            let (start, end) = (whole.corners[i].as_dvec3(), whole.corners[i + 4].as_dvec3());
            corners[i] = whole.at_depth(start, end, near);
            corners[i + 4] = whole.at_depth(start, end, far);
        }
        Self { corners, near, far, ..whole }.checked()
    }

    /// Returns the point of an edge at a view depth. Exact at both ends.
    fn at_depth(&self, start: DVec3, end: DVec3, depth: f32) -> Vec3 {
        let (near, far) = (f64::from(self.near), f64::from(self.far));
        let t = (f64::from(depth) - near) / (far - near);
        (start * (1.0 - t) + end * t).as_vec3()
    }

    /// Returns the frustum if a fit can use it.
    pub(crate) fn checked(self) -> Result<Self, FitError> {
        self.check().map(|()| self)
    }

    /// Checks that a fit can use the frustum, since its fields are public.
    pub(crate) fn check(&self) -> Result<(), FitError> {
        checks::point("the frustum's origin", self.origin)?;
        check_corners(&self.corners)?;
        checks::unit("the frustum's forward direction", self.forward)?;
        let (near, far) = (self.near, self.far);
        checks::within("the frustum's near distance", f64::from(near), -MAX_LENGTH, MAX_LENGTH)?;
        checks::within("the frustum's far distance", f64::from(far), -MAX_LENGTH, MAX_LENGTH)?;
        // This is a view that begins beyond the end of the shadows.
        #[expect(clippy::float_cmp, reason = "an empty view has one depth")]
        let is_empty = near == far;
        if is_empty { Ok(()) } else { check_extent(&self.corners, near, far) }
    }
}

/// Returns an error for corners that are not finite or too far away.
#[inline(always)]
pub(crate) fn check_corners(corners: &[Vec3; 8]) -> Result<(), FitError> {
    // The common case takes one pass. Only an error needs another pass to find the corner.
    let limit = MAX_LENGTH as f32;
    let is_good = |c: &Vec3| (c.x.abs() <= limit) & (c.y.abs() <= limit) & (c.z.abs() <= limit);
    if corners.iter().fold(true, |all, corner| all & is_good(corner)) { Ok(()) } else { name_bad(*corners) }
}

/// Returns the error for the bad corner.
#[cold]
#[inline(never)]
fn name_bad(corners: [Vec3; 8]) -> Result<(), FitError> {
    corners.into_iter().try_for_each(|corner| checks::point("a corner of the frustum", corner.as_dvec3()).map(|_| ()))
}

/// Returns an error for a frustum without extent between near and far or between its sides.
#[inline]
pub(crate) fn check_extent(corners: &[Vec3; 8], near: f32, far: f32) -> Result<(), FitError> {
    if near >= far {
        return Err(FitError::NearNotBelowFar { near, far });
    }
    if volume(corners) > 0.0 { Ok(()) } else { Err(empty(*corners)) }
}

/// Returns the error for corners without a volume.
#[cold]
#[inline(never)]
fn empty(corners: [Vec3; 8]) -> FitError {
    let min = corners.into_iter().fold(Vec3::MAX, Vec3::min);
    let max = corners.into_iter().fold(Vec3::MIN, Vec3::max);
    FitError::EmptyFrustum { size: max - min }
}

/// Returns the volume of the box spanned by the far rectangle and the near-to-far axis, in m³. The far
/// rectangle of a view is never smaller than the near one. Zero if the frustum is flat.
#[inline]
fn volume(corners: &[Vec3; 8]) -> f64 {
    let c = |i: usize| corners[i].as_dvec3();
    let across = (c(5) - c(4)).cross(c(7) - c(4));
    let axis = (c(4) + c(6)) - (c(0) + c(2));
    across.dot(axis).abs()
}

/// The transform of clip corners into world positions relative to the eye.
pub(super) struct Unprojection {
    pub(super) matrix: DMat4,
    pub(super) eye: DVec3,
    /// Amount to subtract from the matrix's output: the eye, or zero if the output is relative to the eye
    /// already.
    offset: DVec3,
    pub(super) depth: DepthConvention,
    pub(super) infinite_w: f64,
}

impl Unprojection {
    fn frustum(&self, max_distance: f32) -> Result<ViewFrustum, FitError> {
        checks::point("the camera's eye", self.eye)?;
        checks::finite("the maximum shadow distance", f64::from(max_distance))?;
        for element in self.matrix.to_cols_array() {
            checks::finite("an element of world_from_clip", element)?;
        }
        if self.is_oblique() {
            return self.enclosing(max_distance);
        }
        self.check_depth()?;
        let forward = self.forward()?;
        let limit = f64::from(max_distance);
        let mut corners = [Vec3::ZERO; 8];
        let (mut near_sum, mut far_sum, mut is_empty) = (0.0, 0.0, false);
        for i in 0..4 {
            let edge = self.edge(i)?;
            let near = edge.near.dot(forward);
            is_empty |= near >= limit;
            let far = match edge.far {
                Some(far) if far.dot(forward) <= limit => far,
                None if max_distance == f32::MAX => return Err(FitError::Endless),
                _ => edge.near + edge.toward * ((limit - near).max(0.0) / edge.toward.dot(forward)),
            };
            corners[i] = edge.near.as_vec3();
            corners[i + 4] = far.as_vec3();
            near_sum += near;
            far_sum += far.dot(forward);
        }
        let near = (near_sum * 0.25) as f32;
        if is_empty {
            checks::may_begin_beyond(near, max_distance)?;
        }
        let far = if is_empty { near } else { (far_sum * 0.25) as f32 };
        ViewFrustum { origin: self.eye, corners, near, far, forward: forward.as_vec3() }.checked()
    }

    /// Returns an error for a perspective whose depth direction contradicts its convention.
    ///
    /// A perspective's w is the reciprocal of the view depth, up to a factor, so it falls from the near plane
    /// to the far one: toward 1 with plain depth, for 0..1 and -1..1, and toward 0 with reversed depth. An
    /// orthographic matrix has one w everywhere.
    fn check_depth(&self) -> Result<(), FitError> {
        let w = |z: f64| self.homogeneous(0.0, 0.0, z, 1.0).1;
        let (at_zero, at_one) = (w(0.0), w(1.0));
        let (least, most) = (at_zero.abs().min(at_one.abs()), at_zero.abs().max(at_one.abs()));
        // If w changes its sign, one of them must be the rounding of an infinite far plane.
        let is_perspective = most - least > PERSPECTIVE * most;
        let is_seen = at_zero * at_one >= 0.0 || least <= PERSPECTIVE * most;
        let is_reversed = at_one.abs() > at_zero.abs();
        if is_perspective && is_seen && is_reversed != (self.depth == DepthConvention::Reversed) {
            return Err(FitError::OtherDepth { named: self.depth, is_reversed });
        }
        Ok(())
    }

    /// Returns the homogeneous world position of a homogeneous clip position, in world axes relative to the
    /// eye.
    pub(super) fn homogeneous(&self, x: f64, y: f64, z: f64, w: f64) -> (DVec3, f64) {
        let p: DVec4 = self.matrix.mul_vec4(DVec4::new(x, y, z, w));
        (p.truncate() - self.offset * p.w, p.w)
    }

    /// Returns the unit normal of the near plane, pointing away from the eye.
    ///
    /// It is computed from the matrix's columns. The near corners lie so close together that, far from the
    /// origin, their differences are mostly rounding.
    fn forward(&self) -> Result<DVec3, FitError> {
        let (centre, w) = self.homogeneous(0.0, 0.0, f64::from(self.depth.near()), 1.0);
        let across = |x: f64, y: f64| {
            let (column, column_w) = self.homogeneous(x, y, 0.0, 0.0);
            column * w - centre * column_w
        };
        let normal = across(1.0, 0.0).cross(across(0.0, 1.0));
        let length = checks::length(normal);
        let toward = self.edge(0)?.toward + self.edge(2)?.toward;
        let along = normal.dot(toward);
        if !(length > 0.0 && length.is_finite()) || along == 0.0 {
            return Err(FitError::SingularMatrix { corner: 0, w });
        }
        Ok(normal / if along < 0.0 { -length } else { length })
    }

    /// Returns the view ray through one corner of the picture.
    fn edge(&self, i: usize) -> Result<Edge, FitError> {
        let (x, y) = CORNERS_XY[i];
        let near_z = f64::from(self.depth.near());
        let far_z = f64::from(self.depth.far());
        let (mut near, mut near_w) = self.homogeneous(x, y, near_z, 1.0);
        let (mut far, mut far_w) = self.homogeneous(x, y, far_z, 1.0);
        if near_w < 0.0 {
            (near, near_w, far, far_w) = (-near, -near_w, -far, -far_w);
        }
        let row = self.matrix.row(3);
        let terms = (row.x * x).abs() + (row.y * y).abs() + (row.z * far_z).abs() + row.w.abs();
        let infinite = far_w.abs() <= self.infinite_w * terms;
        if near_w == 0.0 || (far_w < 0.0 && !infinite) {
            let (corner, w) = if near_w == 0.0 { (i, near_w) } else { (i + 4, far_w) };
            return Err(FitError::SingularMatrix { corner, w });
        }
        // Derivative of the clip line p(s) = (near + s (far - near)) / (its w), up to a positive factor. It
        // stays finite if the far point is infinite.
        let toward = far * near_w - near * far_w;
        let length = checks::length(toward);
        if !(length > 0.0 && length.is_finite()) {
            return Err(FitError::SingularMatrix { corner: i + 4, w: far_w });
        }
        let far = if infinite { None } else { Some(far / far_w) };
        Ok(Edge { near: near / near_w, far, toward: toward / length })
    }
}

/// One of the four edges from the near plane to the far one, relative to the eye.
struct Edge {
    near: DVec3,
    /// `None` if the far plane is at infinity.
    far: Option<DVec3>,
    /// Unit direction from near to far.
    toward: DVec3,
}
