// A map whose depth is its first channel.

@group(1) @binding(0) var map: texture_2d<f32>;

fn stored_in(texel: vec2<i32>) -> f32 {
    return textureLoad(map, texel, 0).r;
}
