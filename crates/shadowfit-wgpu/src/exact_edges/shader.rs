//! WGSL of the edge passes, and of the shader that reads their result.

use shadowfit::DepthConvention;
use shadowfit::settings::FilterKind;
use shadowfit_rays::{RayWgslOptions, rays_wgsl};

use super::noise;
use super::uniform::{MAX_POINTS, MAX_UNKNOWN};
use super::verdict::Verdict;
use super::view::NormalEncoding;
use crate::wgsl::loads_wgsl;
use crate::{ShadowMapDescriptor, WgslOptions, receiver_wgsl};

/// Threads per tracing workgroup, which is also the maximum number of rays per pixel.
pub(super) const TRACE_THREADS: u32 = 64;
/// Maximum number of workgroups along an axis in WebGPU.
const MAX_GROUPS: u32 = 65_535;
/// Bind groups of the look-up and of the rays.
const RECEIVER_GROUP: u32 = 0;
const RAYS_GROUP: u32 = 2;

/// Texels on each side of a point that must agree, along each axis. A caster or gap that covers none of their
/// centres is missed. Measured on the shared scenes: 1 in all maps gives 0.013% wrong pixels and traces 1.7%
/// of the pixels, 2 gives 0.0024% and 4.9%, and 3 gives 0.0024% and 7.9%.
const FOOTPRINT: f32 = 2.0;
/// Texels that must agree in the coarsest map, where most casters thinner than a texel are read. In four
/// generated towns, 2 gives 0.0077% wrong pixels and traces 11.0% of the pixels, and 3 gives 0.0038% and
/// 12.8%.
const COARSEST_FOOTPRINT: f32 = 3.0;

/// Width of a block of a pyramid's finest level, in texels.
pub(super) const BLOCK: u32 = 4;

const LIST: &str = include_str!("list.wgsl");

/// Properties of a view that change the WGSL of the passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shape {
    /// Samples of the depth texture per pixel.
    pub(super) samples: u32,
    /// Encoding of the texture of normals, if there is one.
    pub(super) normals: Option<NormalEncoding>,
}

/// Returns the WGSL of the passes that classify pixels, count workgroups, apply the budget, find triangles,
/// trace rays, and compute the depth bounds of maps for suns with a radius. It does not contain an engine's
/// alpha test. The entry points are `classify`, `count_groups`, `select_pixels`, `find_surfaces`, `trace`,
/// `gather_blocks` and `join_blocks`. `samples` is the number of samples of the depth texture per pixel.
pub fn edges_wgsl(descriptor: &ShadowMapDescriptor, samples: u32, normals: Option<NormalEncoding>) -> [String; 7] {
    let shape = Shape { samples, normals };
    let [blocks, levels] = pyramid(descriptor);
    let [surfaces, trace] = [surfaces, trace].map(|wgsl| wgsl(descriptor, shape, None));
    [classify(descriptor, shape), arguments(descriptor), select(), surfaces, trace, blocks, levels]
}

/// Returns WGSL that reads the result of an [`EdgePass`](super::EdgePass). Put it after the WGSL of
/// [`receiver_wgsl`]. `shadowfit_exact_factor(position, normal, pixel) -> f32` returns the share of the light
/// that reaches a point of the depth buffer: the exact factor, or the filter's factor where edges were not
/// traced. Its arguments are the same as for `shadowfit_factor_at`. `shadowfit_is_traced(pixel) -> bool` and
/// `shadowfit_is_filtered(pixel) -> bool` return how the factor was found. The functions read one texture at
/// `binding` of the group: 0 for [`EdgePass::group`](super::EdgePass::group), any other number for a bind
/// group of the engine with [`EdgePass::factors`](super::EdgePass::factors).
pub fn exact_factor_wgsl(options: &WgslOptions<'_>, binding: u32) -> String {
    options.fill(include_str!("exact_factor.wgsl"), binding)
}

pub(super) fn classify(descriptor: &ShadowMapDescriptor, shape: Shape) -> String {
    let four =
        if descriptor.format.is_depth() { include_str!("four_depth.wgsl") } else { include_str!("four_float.wgsl") };
    let is_reversed = descriptor.depth == DepthConvention::Reversed;
    let (toward_light, closer) = if is_reversed { (1.0, ">=") } else { (-1.0, "<=") };
    let nearest = if is_reversed { 1.0 } else { 0.0 };
    let (is_soft, by_coverage) = (descriptor.filter.is_soft(), descriptor.selection.is_by_coverage());
    let constants = format!(
        "const FOOTPRINT: f32 = {FOOTPRINT:?};\nconst COARSEST_FOOTPRINT: f32 = {COARSEST_FOOTPRINT:?};\nconst TOWARD_LIGHT: f32 = {toward_light:?};\nconst NEAREST: f32 = \
         {nearest:?};\nconst IS_SOFT: bool = {is_soft};\nconst IS_BY_COVERAGE: bool = {by_coverage};\nconst BLOCK: i32 = \
         {BLOCK};\n"
    );
    let list = LIST.replace("LIST_COUNT", "atomic<u32>");
    let pass = [include_str!("classify.wgsl"), include_str!("soft.wgsl")].concat();
    let pass = pass.replace("COMPARE", closer).replace("MAX_UNKNOWN", &MAX_UNKNOWN.to_string());
    [&look_up(descriptor), four, &shared(shape), &list, &constants, &Verdict::wgsl(), &pass].concat()
}

/// Returns the WGSL of the passes that compute a map's depth bounds, with the entry points `gather_blocks`
/// and `join_blocks`.
pub(super) fn pyramid(descriptor: &ShadowMapDescriptor) -> [String; 2] {
    let is_reversed = descriptor.depth == DepthConvention::Reversed;
    let closer = if is_reversed { ">=" } else { "<=" };
    let constants = format!("const BLOCK: i32 = {BLOCK};\n");
    let blocks = include_str!("blocks.wgsl").replace("COMPARE", closer);
    let levels = include_str!("levels.wgsl").replace("IS_REVERSED", &is_reversed.to_string());
    let loads = loads_wgsl(descriptor, &WgslOptions::group(RECEIVER_GROUP));
    [[loads, constants, blocks].concat(), levels]
}

pub(super) fn arguments(descriptor: &ShadowMapDescriptor) -> String {
    let pixels = TRACE_THREADS / descriptor.edges.samples().max(1);
    let constants = format!(
        "const MAX_GROUPS: u32 = {MAX_GROUPS}u;\nconst PIXELS: u32 = {pixels}u;\nconst TRACE_THREADS: u32 = {TRACE_THREADS}u;\n"
    );
    let list = LIST.replace("LIST_COUNT", "u32");
    [&constants, &list, include_str!("arguments.wgsl")].concat()
}

pub(super) fn select() -> String {
    let constants =
        format!("const NOISE_SIDE: u32 = {}u;\nconst TRACE_THREADS: u32 = {TRACE_THREADS}u;\n", noise::SIDE);
    let list = LIST.replace("LIST_COUNT", "u32");
    [&constants, &list, include_str!("select.wgsl")].concat()
}

/// Returns the WGSL of the pass that finds triangles. `counts` is the engine's alpha test of ray hits.
pub(super) fn surfaces(descriptor: &ShadowMapDescriptor, shape: Shape, counts: Option<&str>) -> String {
    let constants = format!("const TRACE_THREADS: u32 = {TRACE_THREADS}u;\n");
    let pass = include_str!("surfaces.wgsl");
    [&starts(descriptor, shape, counts), &constants, pass].concat()
}

/// Returns the WGSL of the list and of the starts of rays. `descriptor` is the descriptor of the look-up.
fn starts(descriptor: &ShadowMapDescriptor, shape: Shape, counts: Option<&str>) -> String {
    let rays = rays_wgsl(&RayWgslOptions { counts, ..RayWgslOptions::group(RAYS_GROUP) });
    let list = LIST.replace("LIST_COUNT", "u32");
    [&look_up(descriptor), &rays, &shared(shape), &list, include_str!("start.wgsl")].concat()
}

/// Returns the WGSL of the pass that traces. `counts` is the engine's alpha test of ray hits.
pub(super) fn trace(descriptor: &ShadowMapDescriptor, shape: Shape, counts: Option<&str>) -> String {
    let is_soft = descriptor.filter.is_soft();
    let points = descriptor.edges.samples().max(1);
    let threads = format!(
        "const TRACE_THREADS: u32 = {TRACE_THREADS}u;\nconst POINTS: u32 = {points}u;\nconst PIXELS: u32 = {}u;\n",
        TRACE_THREADS / points
    );
    // With any soft filter, rays to a sun with a radius are compared with casters at their distance.
    let filter = if is_soft { FilterKind::Pcss } else { descriptor.filter };
    let starts = starts(&ShadowMapDescriptor { filter, ..*descriptor }, shape, counts);
    let estimate = if is_soft { include_str!("estimate_sun.wgsl") } else { include_str!("estimate_area.wgsl") };
    let pass = include_str!("trace.wgsl");
    [&starts, &threads, estimate, pass].concat()
}

/// Returns the WGSL of the look-up, for positions relative to the eye. While two sets of maps are blended no
/// edges are traced, so that the first set in the uniform is enough.
fn look_up(descriptor: &ShadowMapDescriptor) -> String {
    let one_set = ShadowMapDescriptor { cross_fades: false, ..*descriptor };
    receiver_wgsl(&one_set, &WgslOptions::group(RECEIVER_GROUP))
}

fn shared(Shape { samples, normals }: Shape) -> String {
    let (texture, index) =
        if samples > 1 { ("texture_depth_multisampled_2d", "at") } else { ("texture_depth_2d", "0") };
    let normals = match normals {
        None => "NO_NORMALS",
        Some(NormalEncoding::Signed) => "SIGNED_NORMALS",
        Some(NormalEncoding::Unsigned) => "2u",
    };
    let constants = format!(
        "\nalias DepthTexture = {texture};\nconst SAMPLES: u32 = {samples}u;\nconst NORMALS: u32 = {normals};\n\n"
    );
    let text = include_str!("edges.wgsl")
        .replace("MAX_POINTS", &MAX_POINTS.to_string())
        .replace("MAX_UNKNOWN", &MAX_UNKNOWN.to_string())
        .replace("DEPTH_INDEX", index);
    constants + &text
}
