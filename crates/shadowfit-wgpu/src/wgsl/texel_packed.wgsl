
// Returns the stored depth at a texel of a colour texture: its bits in four bytes, the lowest first. `round`
// restores whole bytes, however a GPU rounds the division by 255.
fn shadowfit_load(layer: u32, texel: vec2<i32>) -> f32 {
    let bytes = vec4<u32>(round(textureLoad(shadowfit_texture, texel, i32(layer), 0) * 255.0));
    return bitcast<f32>(bytes.x | (bytes.y << 8u) | (bytes.z << 16u) | (bytes.w << 24u));
}
