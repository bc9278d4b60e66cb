//! The shader modules, put together from the pieces in `shaders/` and the shadow map's own WGSL.

use shadowfit_wgpu::{ShadowMapDescriptor, WgslOptions, caster_wgsl, receiver_wgsl, stored_wgsl};

/// Bind group of the map's matrix in the shadow pass.
pub const CASTER_GROUP: u32 = 0;

/// Bind group of the shadow map in the shaded pass.
pub const SHADOW_GROUP: u32 = 1;

const FRAME: &str = include_str!("shaders/frame.wgsl");
const MATERIAL: &str = include_str!("shaders/material.wgsl");

/// The pieces as they lie in the folder, for tests that look for files which no module uses.
pub const PIECES: [(&str, &str); 10] = [
    ("frame.wgsl", FRAME),
    ("material.wgsl", MATERIAL),
    ("sky.wgsl", include_str!("shaders/sky.wgsl")),
    ("caster.wgsl", include_str!("shaders/caster.wgsl")),
    ("caster_color.wgsl", include_str!("shaders/caster_color.wgsl")),
    ("scene.wgsl", include_str!("shaders/scene.wgsl")),
    ("probe.wgsl", include_str!("shaders/probe.wgsl")),
    ("lines.wgsl", include_str!("shaders/lines.wgsl")),
    ("inset.wgsl", include_str!("shaders/inset.wgsl")),
    ("mip.wgsl", include_str!("shaders/mip.wgsl")),
];

/// The sky.
pub fn sky() -> String {
    [FRAME, include_str!("shaders/sky.wgsl")].concat()
}

/// The shadow pass: group 0 is the shadow map's, group 1 the material's.
pub fn caster(shadow_map: &ShadowMapDescriptor) -> String {
    let color = if shadow_map.format.is_depth() { "" } else { include_str!("shaders/caster_color.wgsl") };
    let material = MATERIAL.replace("MATERIAL_GROUP", "1");
    let shadow_map = caster_wgsl(shadow_map, &WgslOptions::group(CASTER_GROUP));
    [&shadow_map, &material, include_str!("shaders/caster.wgsl"), color].concat()
}

/// The shaded pass: frame, shadow map and material are groups 0, 1 and 2.
pub fn scene(shadow_map: &ShadowMapDescriptor) -> String {
    let material = MATERIAL.replace("MATERIAL_GROUP", "2");
    [
        FRAME,
        &receiver_wgsl(shadow_map, &WgslOptions::group(SHADOW_GROUP)),
        &material,
        include_str!("shaders/scene.wgsl"),
    ]
    .concat()
}

/// The probe pass, with the groups of the shaded one; it needs the primitive index. The directive that enables it
/// must come first.
pub fn probe(shadow_map: &ShadowMapDescriptor) -> String {
    ["enable primitive_index;\n", &scene(shadow_map), include_str!("shaders/probe.wgsl")].concat()
}

/// Lines of the world.
pub fn lines() -> String {
    [FRAME, include_str!("shaders/lines.wgsl")].concat()
}

/// The shadow map's inset: frame, shadow map and inset are groups 0, 1 and 2.
pub fn inset(shadow_map: &ShadowMapDescriptor) -> String {
    let options = WgslOptions::group(SHADOW_GROUP);
    let (receiver, stored) = (receiver_wgsl(shadow_map, &options), stored_wgsl(shadow_map, &options));
    [FRAME, &receiver, &stored, include_str!("shaders/inset.wgsl")].concat()
}

/// Texture levels.
pub fn mip() -> String {
    include_str!("shaders/mip.wgsl").to_owned()
}
