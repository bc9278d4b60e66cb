// Comparison by hand, for colour formats that no comparison sampler reads.

@group(GROUP) @binding(1) var shadowfit_texture: texture_2d_array<f32>;

// The stored depth of a texel, clamped to the layer's edge.
fn shadowfit_stored(map: u32, texel: vec2<i32>) -> f32 {
    let last = vec2<i32>(textureDimensions(shadowfit_texture)) - vec2<i32>(1);
    return textureLoad(shadowfit_texture, clamp(texel, vec2<i32>(0), last), i32(map), 0).x;
}

// Whether light passes one texel of a map of the given size.
fn shadowfit_lit(map: u32, size: vec2<f32>, texel: vec2<f32>, depth: f32) -> f32 {
    let inside = clamp(texel, vec2<f32>(0.0), size - vec2<f32>(1.0));
    return select(0.0, 1.0, saturate(depth) COMPARE shadowfit_stored(map, vec2<i32>(inside)));
}
