// Comparison by the sampler: one texel with a nearest sampler, 2x2 weighted with a linear one.

@group(GROUP) @binding(1) var shadowfit_texture: texture_depth_2d_array;
@group(GROUP) @binding(2) var shadowfit_sampler: sampler_comparison;

fn shadowfit_compare(map: u32, uv: vec3<f32>) -> f32 {
    return textureSampleCompareLevel(
        shadowfit_texture, shadowfit_sampler, uv.xy, i32(map), saturate(uv.z));
}

// The stored depth of a texel, for views of the map.
fn shadowfit_stored(map: u32, texel: vec2<i32>) -> f32 {
    return textureLoad(shadowfit_texture, texel, i32(map), 0);
}
