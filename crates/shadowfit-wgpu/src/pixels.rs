//! Where the pixels of a depth buffer lie in the world.

use shadowfit::DepthConvention;
use shadowfit::glam::{DMat4, DVec4, Mat4};

/// Whether a part (left, top, width, height) is not empty and lies in a texture of a size, all in pixels.
pub(crate) fn lies_in([left, top, width, height]: [u32; 4], [columns, rows]: [u32; 2]) -> bool {
    let is_inside = |start: u32, side: u32, whole: u32| side > 0 && start <= whole && side <= whole - start;
    is_inside(left, width, columns) && is_inside(top, height, rows)
}

/// From a pixel's column and row (its centre), and its depth minus the far plane's, to homogeneous positions in the space
/// that `clip_from_world` takes; `None` for a matrix without an inverse. `size`: of the picture, in pixels. Most of the
/// view lies near depth 1 where depth is not reversed: differences from it are exact in f32, and so small that the matrix
/// needs no more.
pub(crate) fn world_from_pixel(clip_from_world: &Mat4, size: [u32; 2], convention: DepthConvention) -> Option<DMat4> {
    let [width, height] = size.map(f64::from);
    let clip_from_pixel = DMat4::from_cols(
        DVec4::X * (2.0 / width),
        DVec4::Y * (-2.0 / height),
        DVec4::Z,
        DVec4::new(1.0 / width - 1.0, 1.0 - 1.0 / height, f64::from(convention.far()), 1.0),
    );
    let clip_from_world = clip_from_world.as_dmat4();
    let world_from_pixel = clip_from_world.inverse() * clip_from_pixel;
    (clip_from_world.determinant() != 0.0 && world_from_pixel.is_finite()).then_some(world_from_pixel)
}
