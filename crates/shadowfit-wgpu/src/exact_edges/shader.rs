//! The WGSL of the edge passes, and of what reads their result.

use shadowfit::DepthConvention;
use shadowfit::settings::FilterKind;
use shadowfit_rays::{RayWgslOptions, rays_wgsl};

use super::noise;
use super::uniform::{MAX_POINTS, MAX_UNKNOWN};
use super::verdict::Verdict;
use super::view::NormalEncoding;
use crate::wgsl::loads_wgsl;
use crate::{ShadowMapDescriptor, WgslOptions, receiver_wgsl};

/// Threads of a workgroup that traces, as many as a pixel may have rays.
pub(super) const TRACE_THREADS: u32 = 64;
/// Workgroups that WebGPU has along an axis.
const MAX_GROUPS: u32 = 65_535;
/// Bind groups of the look-up and of the rays.
const RECEIVER_GROUP: u32 = 0;
const RAYS_GROUP: u32 = 2;

/// Texels on each side of a point that have to agree, along each axis. What holds none of their centres, neither a caster
/// nor a gap, is missed: with 1 in all maps there are 0.013% wrong pixels on the shared scenes and 1.7% take rays, with 2
/// 0.0024% and 4.9%, with 3 0.0024% and 7.9%.
const FOOTPRINT: f32 = 2.0;
/// The same in the coarsest map, where most casters that are thinner than a texel are read: in four generated towns there
/// are 0.0077% wrong pixels with 2, and 0.0038% with 3, and 11.0% and 12.8% take rays.
const COARSEST_FOOTPRINT: f32 = 3.0;

/// Texels along a side of a block of the finest level of a pyramid.
pub(super) const BLOCK: u32 = 4;

const LIST: &str = include_str!("list.wgsl");

/// What the WGSL of the passes depends on, beside the maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shape {
    /// Samples of the depth texture per pixel.
    pub(super) samples: u32,
    /// How the texture of normals has them, if there is one.
    pub(super) normals: Option<NormalEncoding>,
}

/// Returns the WGSL of the passes that classify pixels, count workgroups, leave pixels out, look for triangles, trace rays, and
/// bound the depths of maps for suns with a radius, without an engine's own test of hits. Their entry points are `classify`,
/// `count_groups`, `select_pixels`, `find_surfaces`, `trace`, `gather_blocks` and `join_blocks`. `samples`: those of the depth texture per pixel.
pub fn edges_wgsl(descriptor: &ShadowMapDescriptor, samples: u32, normals: Option<NormalEncoding>) -> [String; 7] {
    let shape = Shape { samples, normals };
    let [blocks, levels] = pyramid(descriptor);
    let [surfaces, trace] = [surfaces, trace].map(|wgsl| wgsl(descriptor, shape, None));
    [classify(descriptor, shape), arguments(descriptor), select(), surfaces, trace, blocks, levels]
}

/// WGSL that reads what an [`EdgePass`](super::EdgePass) found, after that of [`receiver_wgsl`]:
/// `shadowfit_exact_factor(position, normal, pixel) -> f32` is the share of the light that reaches a point that the depth
/// buffer shows: the exact factor, and the filter's where it was not. The arguments are those of `shadowfit_factor_at`.
/// `shadowfit_is_traced(pixel) -> bool` and `shadowfit_is_filtered(pixel) -> bool` say how it was found. They read one
/// texture at a binding of the group: 0 for [`EdgePass::group`](super::EdgePass::group), any other one for a
/// bind group of the engine's own with [`EdgePass::factors`](super::EdgePass::factors).
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

/// The WGSL of the passes that bound a map's depths: entry points `gather_blocks` and `join_blocks`.
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

/// `counts`: an engine's own test of hits.
pub(super) fn surfaces(descriptor: &ShadowMapDescriptor, shape: Shape, counts: Option<&str>) -> String {
    let constants = format!("const TRACE_THREADS: u32 = {TRACE_THREADS}u;\n");
    let pass = include_str!("surfaces.wgsl");
    [&starts(descriptor, shape, counts), &constants, pass].concat()
}

/// The list, and where rays start. `descriptor`: that of the look-up.
fn starts(descriptor: &ShadowMapDescriptor, shape: Shape, counts: Option<&str>) -> String {
    let rays = rays_wgsl(&RayWgslOptions { counts, ..RayWgslOptions::group(RAYS_GROUP) });
    let list = LIST.replace("LIST_COUNT", "u32");
    [&look_up(descriptor), &rays, &shared(shape), &list, include_str!("start.wgsl")].concat()
}

/// `counts`: an engine's own test of hits.
pub(super) fn trace(descriptor: &ShadowMapDescriptor, shape: Shape, counts: Option<&str>) -> String {
    let is_soft = descriptor.filter.is_soft();
    let points = descriptor.edges.samples().max(1);
    let threads = format!(
        "const TRACE_THREADS: u32 = {TRACE_THREADS}u;\nconst POINTS: u32 = {points}u;\nconst PIXELS: u32 = {}u;\n",
        TRACE_THREADS / points
    );
    // Whatever the filter, rays to a sun with a radius are compared with casters at their distance.
    let filter = if is_soft { FilterKind::Pcss } else { descriptor.filter };
    let starts = starts(&ShadowMapDescriptor { filter, ..*descriptor }, shape, counts);
    let estimate = if is_soft { include_str!("estimate_sun.wgsl") } else { include_str!("estimate_area.wgsl") };
    let pass = include_str!("trace.wgsl");
    [&starts, &threads, estimate, pass].concat()
}

/// The look-up into the maps, for positions relative to the eye. No edges are traced while two sets of maps are mixed:
/// the present one stands first in the uniform of both.
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
