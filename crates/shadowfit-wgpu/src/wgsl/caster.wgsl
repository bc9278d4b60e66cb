// The engine's vertex shader calls shadowfit_caster_position for every caster.

struct shadowfit_Caster {
    clip_from_world: mat4x4<f32>,
    // 1 if the fragment shader clamps depth because the device cannot.
    clamps_in_fragment: u32,
    padding_0: u32,
    padding_1: u32,
    padding_2: u32,
}

@group(GROUP) @binding(BINDING_0) var<uniform> shadowfit_caster: shadowfit_Caster;

// Returns the clip position in the shadow map of a world position relative to the origin, in metres. If the
// fragment shader clamps depth, z lies half-way between the planes, so that no caster is clipped there.
fn shadowfit_caster_position(position: vec3<f32>) -> vec4<f32> {
    let clip = shadowfit_caster.clip_from_world * vec4<f32>(position, 1.0);
    return vec4<f32>(clip.xy, select(clip.z, 0.5, shadowfit_caster.clamps_in_fragment == 1u), clip.w);
}

// Returns the depth of a world position, which may lie outside 0..1. It is linear over a triangle, for a
// varying. Do not clamp it before interpolation: that would bend a triangle that crosses the near plane.
fn shadowfit_caster_depth(position: vec3<f32>) -> f32 {
    return (shadowfit_caster.clip_from_world * vec4<f32>(position, 1.0)).z;
}

// Returns the depth that a clamping fragment shader writes, from the interpolated one.
fn shadowfit_clamped_depth(depth: f32) -> f32 {
    return saturate(depth);
}
