// A depth map, compared by the sampler.

@group(1) @binding(0) var map: texture_depth_2d;
@group(1) @binding(1) var map_sampler: sampler_comparison;

fn stored_in(texel: vec2<i32>) -> f32 {
    return textureLoad(map, texel, 0);
}

// Share of the light by less-or-equal: of one texel, or of 2 x 2 with a linear sampler.
fn compared(uv: vec2<f32>, depth: f32) -> f32 {
    return textureSampleCompareLevel(map, map_sampler, uv, saturate(depth));
}
