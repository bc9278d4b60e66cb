//! The WGSL of casters and receivers, put together from the pieces in `shaders/`. Every name starts
//! with `shadowfit_`, so that the text can be pasted into any shader.

use shadowfit::bias::reach;
use shadowfit::settings::{FilterKind, MapChoice, MapFormat};
use shadowfit::{CasterVolume, DepthConvention};

use crate::{MAX_MAPS, ShadowMapDescriptor};

/// WGSL for vertex shaders of the shadow pass: `shadowfit_caster_position(position) -> vec4<f32>`,
/// where `position` is in world space, metres, relative to the origin of
/// [`crate::ShadowMap::prepare`].
///
/// It reads binding 0 of `group`, which may be any: [`crate::ShadowMap::render`] and
/// [`crate::ShadowMap::begin_pass`] bind the map's [`caster_group`](crate::ShadowMap::caster_group)
/// where they are told to.
pub fn caster_wgsl(group: u32) -> String {
    include_str!("shaders/caster.wgsl").replace("GROUP", &group.to_string())
}

/// WGSL for shaders that cull casters: `shadowfit_cull_box(min, max) -> u32`, whose bit i says whether the box may cast
/// a shadow into map i, and `shadowfit_touches_box`, `_sphere` and `_oriented_box` for one map. They are the twins of
/// [`shadowfit::culling::cull`] and of the tests of [`shadowfit::CasterVolume`].
///
/// Reads a [`crate::CullingUniform`] at binding 0 of `group`.
pub fn culling_wgsl(group: u32) -> String {
    include_str!("shaders/culling.wgsl")
        .replace("GROUP", &group.to_string())
        .replace("MAX_MAPS", &MAX_MAPS.to_string())
        .replace("MAX_PLANES", &CasterVolume::MAX_PLANES.to_string())
}

/// WGSL for fragment shaders that receive shadows:
///
/// | function | gives |
/// |---|---|
/// | `shadowfit_factor(position, normal) -> f32` | the filtered share of the light that reaches a point: 1 lit, 0 in shadow, 1 outside every map |
/// | `shadowfit_map_index(position) -> i32` | the index of the map that weighs more in `shadowfit_factor` there, for tints that show it; -1 outside every map |
/// | `shadowfit_view_depth(position) -> f32` | the view depth, in metres, that chooses among maps that are read by view depth: the distance from [`MapView::eye`](crate::MapView::eye) along [`MapView::forward`](crate::MapView::forward) |
///
/// `position` is in world space, metres, relative to the origin of [`crate::ShadowMap::prepare`];
/// `normal` is the unit geometric normal on the side that is seen. Which map a point reads is
/// [`ShadowMapDescriptor::choice`], by the rule of [`shadowfit::choice`]. Reads bindings 0, 1 and, for depth formats, 2 of
/// `group`; no derivatives.
pub fn receiver_wgsl(descriptor: &ShadowMapDescriptor, group: u32) -> String {
    let look_up = match (descriptor.format, descriptor.filter) {
        (MapFormat::Depth32Float | MapFormat::Depth16Unorm, _) => include_str!("shaders/compare_depth.wgsl").to_owned(),
        (_, FilterKind::Point) => {
            [include_str!("shaders/compare_float.wgsl"), include_str!("shaders/compare_float_point.wgsl")].concat()
        }
        (_, _) => [include_str!("shaders/compare_float.wgsl"), include_str!("shaders/compare_float_2x2.wgsl")].concat(),
    };
    let filter = match descriptor.filter {
        FilterKind::Point | FilterKind::Hardware2x2 => include_str!("shaders/filter_single.wgsl"),
        FilterKind::Pcf3x3 => include_str!("shaders/filter_tent_3x3.wgsl"),
        _ => include_str!("shaders/filter_tent_5x5.wgsl"),
    };
    let closer = if descriptor.depth == DepthConvention::Reversed { ">=" } else { "<=" };
    [include_str!("shaders/receiver.wgsl"), &look_up, filter, &choice(descriptor)]
        .concat()
        .replace("GROUP", &group.to_string())
        .replace("MAX_MAPS", &MAX_MAPS.to_string())
        .replace("COMPARE", closer)
}

/// The search for a point's maps, and a map by its place in the order: one branch per map, since software rasterisers
/// take twenty times as long for a loop over an array of uniforms.
fn choice(descriptor: &ShadowMapDescriptor) -> String {
    let maps = descriptor.maps.clamp(1, MAX_MAPS as u32);
    let map = |entry: u32| format!("shadowfit_receiver.maps[{entry}]");
    let try_map = |entry: u32| {
        let map = map(entry);
        format!(
            "    if shadowfit_is_open(choice, {entry}, view_depth, {map}.far, {map}.blend_near) {{
        let free = shadowfit_free({entry}u, {map}, position);
        choice = shadowfit_try(choice, {entry}, view_depth, {map}.far, {map}.blend_near, free);
    }}
"
        )
    };
    let entry = |entry: u32| format!("    if entry == {entry} {{\n        return {};\n    }}\n", map(entry));
    let rule = match descriptor.choice {
        MapChoice::Coverage => include_str!("shaders/choice_coverage.wgsl"),
        MapChoice::ViewDepth => include_str!("shaders/choice_view_depth.wgsl"),
    };
    let (reach, blend) = (reach(descriptor.filter), descriptor.blend);
    format!(
        "
const SHADOWFIT_REACH: f32 = {reach:?};
const SHADOWFIT_BLEND: f32 = {blend:?};

{rule}
// The maps that a point reads.
fn shadowfit_choose(position: vec3<f32>) -> shadowfit_Choice {{
    let view_depth = shadowfit_view_depth(position);
    var choice = shadowfit_Choice(-1, -1, 1.0, -1, 0.0);
{}    choice.first = select(choice.first, choice.clamped, choice.first < 0);
    return choice;
}}

// The map at a place in the order.
fn shadowfit_entry(entry: i32) -> shadowfit_Map {{
{}    return {};
}}
{}",
        (0..maps).map(try_map).collect::<String>(),
        (1..maps).map(entry).collect::<String>(),
        map(0),
        include_str!("shaders/factor.wgsl"),
    )
}
