// Materials, shared by the shaded and the shadow pass.

struct Material {
    base_color: vec4<f32>,
    base_uv: array<vec4<f32>, 2>,
    normal_uv: array<vec4<f32>, 2>,
    emissive: vec3<f32>,
    alpha_cutoff: f32,
    metallic: f32,
    roughness: f32,
    normal_scale: f32,
    blended: f32,
}

@group(MATERIAL_GROUP) @binding(0) var<uniform> material: Material;
@group(MATERIAL_GROUP) @binding(1) var base_texture: texture_2d<f32>;
@group(MATERIAL_GROUP) @binding(2) var base_sampler: sampler;
@group(MATERIAL_GROUP) @binding(3) var normal_texture: texture_2d<f32>;
@group(MATERIAL_GROUP) @binding(4) var normal_sampler: sampler;

fn transformed_uv(rows: array<vec4<f32>, 2>, uv: vec2<f32>) -> vec2<f32> {
    let at = vec3<f32>(uv, 1.0);
    return vec2<f32>(dot(rows[0].xyz, at), dot(rows[1].xyz, at));
}

// Returns base colour and alpha before vertex colours.
fn base_color(uv: vec2<f32>) -> vec4<f32> {
    return material.base_color * textureSample(base_texture, base_sampler, transformed_uv(material.base_uv, uv));
}

// Whether the pipeline draws parts with cut-outs. It is a constant, because shaders that may discard disable
// the early depth test.
override MASKED: bool = false;

// Returns whether a fragment is cut out. Alpha is read from the finest level only. Coarser levels would
// average cut-outs away, so that a far fence would vanish, and rays have no mip levels.
fn is_cut_out(uv: vec2<f32>, vertex_alpha: f32) -> bool {
    let texel = textureSampleLevel(base_texture, base_sampler, transformed_uv(material.base_uv, uv), 0.0);
    return MASKED && material.base_color.a * texel.a * vertex_alpha < material.alpha_cutoff;
}
