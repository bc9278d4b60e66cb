
// The depth at a texel of a layer of a colour texture, as it is stored: its bits in four bytes, the lowest first. Rounding
// makes the bytes whole again, whatever a GPU rounds when it divides them by 255.
fn shadowfit_load(layer: u32, texel: vec2<i32>) -> f32 {
    let bytes = vec4<u32>(round(textureLoad(shadowfit_texture, texel, i32(layer), 0) * 255.0));
    return bitcast<f32>(bytes.x | (bytes.y << 8u) | (bytes.z << 16u) | (bytes.w << 24u));
}
