// A map whose depth is packed in four channels of 8 bits.

@group(1) @binding(0) var map: texture_2d<f32>;

fn stored_in(texel: vec2<i32>) -> f32 {
    let bytes = vec4<u32>(round(textureLoad(map, texel, 0) * 255.0));
    return bitcast<f32>(bytes.x | (bytes.y << 8u) | (bytes.z << 16u) | (bytes.w << 24u));
}
