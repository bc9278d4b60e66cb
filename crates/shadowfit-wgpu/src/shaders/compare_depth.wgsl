// Comparison by the sampler: one texel with a nearest sampler, 2x2 weighted with a linear one.

@group(GROUP) @binding(1) var shadowfit_texture: texture_depth_2d_array;
@group(GROUP) @binding(2) var shadowfit_sampler: sampler_comparison;

// One look-up at a position in a map of the given size, in texels, with the depth of the point's plane there.
fn shadowfit_look_up(map: u32, size: vec2<f32>, texel: vec2<f32>, projected: shadowfit_Projected) -> f32 {
    // Not nearer to the border of what is in use than half a texel: the sampler would read beyond it.
    let inside = clamp(texel, vec2<f32>(0.5), size - vec2<f32>(0.5));
    let depth = projected.depth + dot(projected.gradient, inside - projected.texel);
    let uv = inside / vec2<f32>(textureDimensions(shadowfit_texture));
    return textureSampleCompareLevel(shadowfit_texture, shadowfit_sampler, uv, i32(map), saturate(depth));
}

// The stored depth of a texel, for views of the map.
fn shadowfit_stored(map: u32, texel: vec2<i32>) -> f32 {
    return textureLoad(shadowfit_texture, texel, i32(map), 0);
}
