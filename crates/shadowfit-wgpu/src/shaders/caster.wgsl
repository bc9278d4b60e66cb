// The engine's vertex shader calls shadowfit_caster_position for every caster.

struct shadowfit_Caster {
    clip_from_world: mat4x4<f32>,
}

@group(GROUP) @binding(0) var<uniform> shadowfit_caster: shadowfit_Caster;

// Clip position in the shadow map of a world position relative to the origin, in metres.
fn shadowfit_caster_position(position: vec3<f32>) -> vec4<f32> {
    return shadowfit_caster.clip_from_world * vec4<f32>(position, 1.0);
}
