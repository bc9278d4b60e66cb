//! The shader modules of ambient occlusion, put together from pieces.

use shadowfit_render::shaders::{FRAME, SCREEN, in_group, material};

use shadowfit_render::shaders::SRGB;

const UNIFORM: &str = include_str!("uniform.wgsl");
const BUFFERS: &str = include_str!("buffers.wgsl");
const FORMULA: &str = include_str!("formula.wgsl");

/// View-space positions and normals: the frame, [`OcclusionUniform`](super::OcclusionUniform) and the material are groups
/// 0, 1 and 2.
pub fn surface() -> String {
    [&part(), include_str!("surface.wgsl")].concat()
}

/// The picture whose ambient light occlusion darkens: those groups, and occlusion in group 3.
pub fn shade() -> String {
    [&part(), SRGB, include_str!("shade.wgsl")].concat()
}

/// What passes over parts of the scene share.
fn part() -> String {
    [FRAME, &material(2), include_str!("part.wgsl"), &in_group(UNIFORM, 1)].concat()
}

/// Ambient occlusion in screen space by either method: the uniform is group 0, what was drawn of surfaces group 1.
pub fn gather() -> String {
    let (normals, depth) = (include_str!("normals.wgsl"), include_str!("depth.wgsl"));
    [SCREEN, &in_group(UNIFORM, 0), BUFFERS, FORMULA, normals, depth].concat()
}

/// The blur of occlusion, with the groups of what finds it.
pub fn blur() -> String {
    [SCREEN, &in_group(UNIFORM, 0), BUFFERS, include_str!("blur.wgsl")].concat()
}

/// Occlusion alone, in group 0.
pub fn view() -> String {
    [SCREEN, include_str!("view.wgsl")].concat()
}
