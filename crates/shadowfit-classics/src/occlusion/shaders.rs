//! The shader modules of ambient occlusion, assembled from pieces.

use shadowfit_render::shaders::{FRAME, SCREEN, in_group, material};

use shadowfit_render::shaders::SRGB;

const UNIFORM: &str = include_str!("uniform.wgsl");
const BUFFERS: &str = include_str!("buffers.wgsl");
const FORMULA: &str = include_str!("formula.wgsl");

/// Returns the module of view-space positions and normals. The frame,
/// [`OcclusionUniform`](super::OcclusionUniform) and the material are groups 0, 1 and 2.
pub fn surface() -> String {
    [&part(), include_str!("surface.wgsl")].concat()
}

/// Returns the module of the picture whose ambient light is darkened: the groups of [`surface`], and
/// occlusion in group 3.
pub fn shade() -> String {
    [&part(), SRGB, include_str!("shade.wgsl")].concat()
}

/// Returns the pieces that passes over parts of the scene share.
fn part() -> String {
    [FRAME, &material(2), include_str!("part.wgsl"), &in_group(UNIFORM, 1)].concat()
}

/// Returns the module that computes ambient occlusion by either method. The uniform is group 0, the surface
/// buffers are group 1.
pub fn gather() -> String {
    let (normals, depth) = (include_str!("normals.wgsl"), include_str!("depth.wgsl"));
    [SCREEN, &in_group(UNIFORM, 0), BUFFERS, FORMULA, normals, depth].concat()
}

/// Returns the module of the blur, with the groups of [`gather`].
pub fn blur() -> String {
    [SCREEN, &in_group(UNIFORM, 0), BUFFERS, include_str!("blur.wgsl")].concat()
}

/// Returns the module that shows occlusion alone, from group 0.
pub fn view() -> String {
    [SCREEN, include_str!("view.wgsl")].concat()
}
