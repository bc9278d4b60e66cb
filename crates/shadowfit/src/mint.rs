//! Conversions from and to the types of the [mint](https://docs.rs/mint) crate, which most maths crates
//! support (feature `mint`).
//!
//! They use mint directly, so they do not depend on glam's own conversions, whose names differ between
//! releases. They check no values; the fits reject bad ones.
//!
//! ```
//! use shadowfit::mint::{dvec3, matrix, vec3};
//! use shadowfit::settings::FitSettings;
//! use shadowfit::{PerspectiveCamera, fit};
//!
//! // The mint types that another maths crate's `.into()` returns.
//! let (eye, forward) = (mint::Point3 { x: 0.0, y: 1.7, z: 5.0 }, mint::Vector3 { x: 0.0, y: 0.0, z: -1.0 });
//! let (up, direction) = (mint::Vector3 { x: 0.0, y: 1.0, z: 0.0 }, mint::Vector3 { x: 0.3, y: -0.8, z: 0.2 });
//!
//! let camera = PerspectiveCamera {
//!     eye: dvec3(eye),
//!     forward: vec3(forward),
//!     up: vec3(up),
//!     fov_y: 0.8,
//!     aspect: 16.0 / 9.0,
//!     near: 0.1,
//!     far: 200.0,
//! };
//! let light = fit(&camera.frustum()?, vec3(direction), &FitSettings::default())?;
//! let clip_from_world: mint::ColumnMatrix4<f32> = matrix(&light.clip_from_world);
//! # assert_eq!(clip_from_world.w.w, 1.0);
//! # Ok::<(), shadowfit::FitError>(())
//! ```

use ::mint::{ColumnMatrix4, Point3, Vector3, Vector4};
use glam::{DMat4, DVec3, Mat4, Vec3, Vec4};

use crate::base::{Aabb, DepthConvention, FitError};
use crate::culling::{OrientedBox, Sphere};
use crate::projection::WorldMatrices;
use crate::view::ViewFrustum;

/// Converts a direction or position to this crate's type, in the same unit.
pub fn vec3(v: impl Into<Vector3<f32>>) -> Vec3 {
    let v = v.into();
    Vec3::new(v.x, v.y, v.z)
}

/// Converts a world position to this crate's type, in metres.
pub fn dvec3(p: impl Into<Point3<f64>>) -> DVec3 {
    let p = p.into();
    DVec3::new(p.x, p.y, p.z)
}

/// Converts a column matrix to this crate's type. mint converts row matrices to column matrices.
pub fn mat4(m: impl Into<ColumnMatrix4<f32>>) -> Mat4 {
    let m = m.into();
    let column = |c: Vector4<f32>| Vec4::new(c.x, c.y, c.z, c.w);
    Mat4::from_cols(column(m.x), column(m.y), column(m.z), column(m.w))
}

/// Converts an f64 column matrix to this crate's type.
pub fn dmat4(m: impl Into<ColumnMatrix4<f64>>) -> DMat4 {
    let m = m.into();
    let [x, y, z, w] = [m.x, m.y, m.z, m.w].map(|c| glam::DVec4::new(c.x, c.y, c.z, c.w));
    DMat4::from_cols(x, y, z, w)
}

/// Converts a direction or offset to mint.
pub fn vector(v: Vec3) -> Vector3<f32> {
    Vector3 { x: v.x, y: v.y, z: v.z }
}

/// Converts a position relative to an origin, in metres, to mint.
pub fn point(p: Vec3) -> Point3<f32> {
    Point3 { x: p.x, y: p.y, z: p.z }
}

/// Converts a world position, in metres, to mint.
pub fn world_point(p: DVec3) -> Point3<f64> {
    Point3 { x: p.x, y: p.y, z: p.z }
}

/// Converts a matrix of a [`LightProjection`](crate::LightProjection), [`WorldMatrices`] or camera to mint.
pub fn matrix(m: &Mat4) -> ColumnMatrix4<f32> {
    let column = |c: Vec4| Vector4 { x: c.x, y: c.y, z: c.z, w: c.w };
    ColumnMatrix4 { x: column(m.x_axis), y: column(m.y_axis), z: column(m.z_axis), w: column(m.w_axis) }
}

/// Calls [`ViewFrustum::from_eye_from_clip`] with a matrix and an eye of another maths crate.
///
/// # Errors
///
/// As [`ViewFrustum::from_eye_from_clip`].
pub fn frustum_from_eye_from_clip(
    eye_from_clip: impl Into<ColumnMatrix4<f32>>,
    eye: impl Into<Point3<f64>>,
    depth: DepthConvention,
    max_distance: f32,
) -> Result<ViewFrustum, FitError> {
    ViewFrustum::from_eye_from_clip(&mat4(eye_from_clip), dvec3(eye), depth, max_distance)
}

/// Converts from the least and the greatest corner.
impl From<[Point3<f32>; 2]> for Aabb {
    fn from([min, max]: [Point3<f32>; 2]) -> Self {
        Self { min: vec3(min), max: vec3(max) }
    }
}

/// Converts to the least and the greatest corner.
impl From<Aabb> for [Point3<f32>; 2] {
    fn from(aabb: Aabb) -> Self {
        [point(aabb.min), point(aabb.max)]
    }
}

/// Converts from the centre and the radius.
impl From<(Point3<f32>, f32)> for Sphere {
    fn from((centre, radius): (Point3<f32>, f32)) -> Self {
        Self { centre: vec3(centre), radius }
    }
}

/// Converts from the centre and the half axes.
impl From<(Point3<f32>, [Vector3<f32>; 3])> for OrientedBox {
    fn from((centre, half_axes): (Point3<f32>, [Vector3<f32>; 3])) -> Self {
        Self { centre: vec3(centre), half_axes: half_axes.map(vec3) }
    }
}

/// Converts to light from world, clip from light and clip from world.
impl From<WorldMatrices> for [ColumnMatrix4<f32>; 3] {
    fn from(matrices: WorldMatrices) -> Self {
        let WorldMatrices { light_from_world, clip_from_light, clip_from_world } = matrices;
        [light_from_world, clip_from_light, clip_from_world].map(|m| matrix(&m))
    }
}
