//! WGSL with the engine's own prefixes: two suns in one shader.

use naga::valid::Capabilities;
use shadowfit::settings::{FilterKind, MapFormat};
use shadowfit_testing::wgsl::assert_valid;
use shadowfit_wgpu::exact_edges::exact_factor_wgsl;
use shadowfit_wgpu::{ShadowMapDescriptor, ShadowMapError, WgslOptions, caster_wgsl, culling_wgsl, receiver_wgsl};

fn named(group: u32, prefix: &str) -> WgslOptions<'_> {
    WgslOptions::group(group).with_prefix(prefix).expect("a prefix")
}

#[test]
fn two_suns_of_different_kinds_fit_into_one_shader_and_into_one_bind_group() {
    let sun = ShadowMapDescriptor { filter: FilterKind::Pcss, ..ShadowMapDescriptor::default() };
    let moon = ShadowMapDescriptor {
        filter: FilterKind::Pcf3x3,
        format: MapFormat::Rgba8Packed,
        first_binding: 3,
        ..ShadowMapDescriptor::default()
    };
    let suns = [(&sun, "sun"), (&moon, "moon")];
    let receivers = suns.map(|(map, prefix)| receiver_wgsl(map, &named(1, prefix))).concat();
    let shaded = "
@fragment fn fs(@builtin(position) pixel: vec4<f32>) -> @location(0) vec4<f32> {
    let at = pixel.xyz;
    return vec4<f32>(sun_factor_at(at, at, pixel.xy), moon_factor(at, at), sun_view_depth(at), 1.0);
}";
    assert_valid("shaded", &(receivers.clone() + shaded), Capabilities::empty());
    let module = assert_valid("receivers", &receivers, Capabilities::empty());
    let bindings = module.global_variables.iter().filter_map(|(_, global)| global.binding);
    let mut bindings: Vec<(u32, u32)> = bindings.map(|binding| (binding.group, binding.binding)).collect();
    bindings.sort_unstable();
    assert_eq!(bindings, [(1, 0), (1, 1), (1, 2), (1, 3), (1, 4)]);
    let casters = suns.map(|(map, prefix)| caster_wgsl(map, &named(0, prefix))).concat();
    assert_valid("casters", &casters, Capabilities::empty());
    let culling = [culling_wgsl(&named(0, "sun")), culling_wgsl(&named(1, "moon"))].concat();
    assert_valid("culling", &culling, Capabilities::empty());
    for text in [receivers, culling] {
        assert!(!text.to_lowercase().contains("shadowfit_"), "a name has kept its prefix");
    }
}

#[test]
fn exact_factors_is_read_by_a_prefix_and_at_a_binding_of_the_engine_s() {
    let map = ShadowMapDescriptor { first_binding: 4, ..ShadowMapDescriptor::default() };
    let text = receiver_wgsl(&map, &named(1, "sun")) + &exact_factor_wgsl(&named(2, "sun"), 7);
    assert!(!text.to_lowercase().contains("shadowfit_"), "a name has kept its prefix");
    let shaded = "
@fragment fn fs(@builtin(position) pixel: vec4<f32>) -> @location(0) vec4<f32> {
    return vec4<f32>(sun_exact_factor(pixel.xyz, pixel.xyz, pixel.xy));
}";
    assert_valid("shaded", &(text.clone() + shaded), Capabilities::empty());
    let module = assert_valid("exact factors", &text, Capabilities::empty());
    let bindings = module.global_variables.iter().filter_map(|(_, global)| global.binding);
    let mut bindings: Vec<(u32, u32)> = bindings.map(|binding| (binding.group, binding.binding)).collect();
    bindings.sort_unstable();
    assert_eq!(bindings, [(1, 4), (1, 5), (1, 6), (2, 7)]);
}

#[test]
fn a_prefix_that_no_name_can_begin_with_is_refused() {
    for prefix in ["", "_", "__sun", "_sun", "2nd", "my sun", "sun-", "Sönne", "sun::"] {
        let refused = WgslOptions::group(0).with_prefix(prefix).map(|_| ());
        assert_eq!(refused, Err(ShadowMapError::Prefix(prefix.to_owned())), "{prefix:?}");
        let text = refused.expect_err("refused").to_string();
        assert!(text.contains(&format!("{prefix:?}")) && text.contains("letter first"), "{text}");
    }
    for prefix in ["s", "Sun", "sun_2", "SUN"] {
        let map = ShadowMapDescriptor::default();
        assert_valid(prefix, &receiver_wgsl(&map, &named(2, prefix)), Capabilities::empty());
    }
}
