//! The WGSL of casters and receivers, put together from the pieces in `shaders/`. Every name starts
//! with `shadowfit_`, so that the text can be pasted into any shader.

use shadowfit::settings::{FilterKind, MapFormat};
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
/// | `shadowfit_map_index(position) -> i32` | the index of the map that `shadowfit_factor` reads there, for tints that show it; -1 outside every map |
/// | `shadowfit_view_depth(position) -> f32` | the view depth, in metres, that chooses among the maps: the distance from [`MapView::eye`](crate::MapView::eye) along [`MapView::forward`](crate::MapView::forward) |
///
/// `position` is in world space, metres, relative to the origin of [`crate::ShadowMap::prepare`];
/// `normal` is the unit geometric normal on the side that is seen. A point reads the first map that
/// ends beyond its view depth and covers it. Reads bindings 0, 1 and, for depth formats, 2 of
/// `group`; no derivatives.
pub fn receiver_wgsl(descriptor: &ShadowMapDescriptor, group: u32) -> String {
    let look_up = match (descriptor.format, descriptor.filter) {
        (MapFormat::Depth32Float, _) => include_str!("shaders/compare_depth.wgsl").to_owned(),
        (MapFormat::R32Float, FilterKind::Point) => {
            [include_str!("shaders/compare_float.wgsl"), include_str!("shaders/compare_float_point.wgsl")].concat()
        }
        (MapFormat::R32Float, _) => {
            [include_str!("shaders/compare_float.wgsl"), include_str!("shaders/compare_float_2x2.wgsl")].concat()
        }
    };
    let filter = match descriptor.filter {
        FilterKind::Point | FilterKind::Hardware2x2 => include_str!("shaders/filter_single.wgsl"),
        FilterKind::Pcf3x3 => include_str!("shaders/filter_tent_3x3.wgsl"),
        FilterKind::Pcf5x5 => include_str!("shaders/filter_tent_5x5.wgsl"),
    };
    let closer = if descriptor.depth == DepthConvention::Reversed { ">=" } else { "<=" };
    [include_str!("shaders/receiver.wgsl"), &look_up, filter, &choice(descriptor.maps)]
        .concat()
        .replace("GROUP", &group.to_string())
        .replace("MAX_MAPS", &MAX_MAPS.to_string())
        .replace("COMPARE", closer)
}

/// The search for a point's map: one branch per map, since software rasterisers take twenty times as long for a loop
/// over an array of uniforms.
fn choice(maps: u32) -> String {
    let branches = |found: &dyn Fn(u32) -> String| -> String {
        let branch = |map: u32| {
            format!(
                "    if view_depth < shadowfit_receiver.maps[{map}].far
        && shadowfit_covers({map}u, shadowfit_receiver.maps[{map}], position) {{
        return {};
    }}
",
                found(map)
            )
        };
        (0..maps.min(MAX_MAPS as u32)).map(branch).collect()
    };
    let compare = |map: u32| {
        format!(
            "shadowfit_compare({map}u, shadowfit_receiver.maps[{map}].size,
            shadowfit_project(shadowfit_receiver.maps[{map}], position, normal))"
        )
    };
    format!(
        "
// Share of the light that reaches a point: 1 lit, 0 in shadow, 1 outside every map.
fn shadowfit_factor(position: vec3<f32>, normal: vec3<f32>) -> f32 {{
    let view_depth = shadowfit_view_depth(position);
{}    return 1.0;
}}

// Index of the map that shadowfit_factor reads at a point: -1 outside every map.
fn shadowfit_map_index(position: vec3<f32>) -> i32 {{
    let view_depth = shadowfit_view_depth(position);
{}    return -1;
}}
",
        branches(&compare),
        branches(&|map| map.to_string()),
    )
}
