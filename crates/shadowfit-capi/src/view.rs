//! Views of cameras, from their parameters or from their matrices.

use shadowfit::glam::{DMat4, DVec3, Mat4, Vec3};
use shadowfit::{Camera, DepthConvention, Lens, ViewFrustum};

use crate::error::{Failure, ShadowfitResult as Code};
use crate::types::{
    SHADOWFIT_DEPTH_NEGATIVE_ONE_TO_ONE, SHADOWFIT_DEPTH_REVERSED, SHADOWFIT_DEPTH_ZERO_TO_ONE, ShadowfitCamera,
    ShadowfitView,
};

/// Returns the depth convention of a number.
pub(crate) fn depth(number: u32) -> Result<DepthConvention, Failure> {
    match number {
        SHADOWFIT_DEPTH_ZERO_TO_ONE => Ok(DepthConvention::ZeroToOne),
        SHADOWFIT_DEPTH_NEGATIVE_ONE_TO_ONE => Ok(DepthConvention::NegativeOneToOne),
        SHADOWFIT_DEPTH_REVERSED => Ok(DepthConvention::Reversed),
        _ => Err(Failure::new(
            Code::ShadowfitBadInput,
            format_args!("depth is {number}; give a constant SHADOWFIT_DEPTH_..."),
        )),
    }
}

/// Returns the number of a depth convention.
pub(crate) const fn depth_number(depth: DepthConvention) -> u32 {
    match depth {
        DepthConvention::ZeroToOne => SHADOWFIT_DEPTH_ZERO_TO_ONE,
        DepthConvention::NegativeOneToOne => SHADOWFIT_DEPTH_NEGATIVE_ONE_TO_ONE,
        DepthConvention::Reversed => SHADOWFIT_DEPTH_REVERSED,
    }
}

/// Returns the view of a camera.
pub(crate) fn from_camera(camera: &ShadowfitCamera) -> Result<ShadowfitView, Failure> {
    let ShadowfitCamera { depth: number, eye, forward, up, fov_y, half_height, aspect, near_plane, far_plane, .. } =
        *camera;
    let depth = depth(number)?;
    let lens = if fov_y == 0.0 && half_height > 0.0 {
        Lens::Orthographic { half_height }
    } else {
        Lens::Perspective { fov_y }
    };
    let camera = Camera {
        eye: DVec3::from_array(eye),
        forward: Vec3::from_array(forward),
        up: Vec3::from_array(up),
        lens,
        aspect,
        near: near_plane,
        far: far_plane,
    };
    Ok(written(&camera.frustum()?, camera.clip_from_world(depth), depth))
}

/// Returns the view of a matrix from world positions to clip space, and the position of its eye. Shadows end at
/// `max_distance` if the far plane is infinite.
pub(crate) fn from_matrix(
    clip_from_world: &[f64; 16],
    eye: DVec3,
    number: u32,
    max_distance: f32,
) -> Result<ShadowfitView, Failure> {
    let depth = depth(number)?;
    let clip_from_world = DMat4::from_cols_array(clip_from_world);
    let frustum = ViewFrustum::from_world_from_clip_f64(&clip_from_world.inverse(), eye, depth, max_distance)?;
    let clip_from_eye = clip_from_world * DMat4::from_translation(eye);
    Ok(written(&frustum, clip_from_eye.as_mat4(), depth))
}

/// Returns a view as plain data.
fn written(frustum: &ViewFrustum, clip_from_eye: Mat4, depth: DepthConvention) -> ShadowfitView {
    ShadowfitView {
        size: size_of::<ShadowfitView>() as u32,
        depth: depth_number(depth),
        eye: frustum.origin.to_array(),
        forward: frustum.forward.to_array(),
        near_plane: frustum.near,
        far_plane: frustum.far,
        corners: frustum.corners.map(|corner| corner.to_array()),
        clip_from_eye: clip_from_eye.to_cols_array(),
    }
}

/// Returns the frustum of a view.
pub(crate) fn frustum(view: &ShadowfitView) -> ViewFrustum {
    ViewFrustum {
        origin: DVec3::from_array(view.eye),
        corners: view.corners.map(Vec3::from_array),
        near: view.near_plane,
        far: view.far_plane,
        forward: Vec3::from_array(view.forward),
    }
}
