// Texels of a colour texture whose four bytes are the bits of the depth, the lowest first.

@group(GROUP) @binding(BINDING_1) var shadowfit_texture: texture_2d_array<f32>;

// The depth at a texel of a layer, as it is stored. Rounding makes the bytes whole again, whatever a GPU rounds when it
// divides them by 255.
fn shadowfit_load(layer: u32, texel: vec2<i32>) -> f32 {
    let bytes = vec4<u32>(round(textureLoad(shadowfit_texture, texel, i32(layer), 0) * 255.0));
    return bitcast<f32>(bytes.x | (bytes.y << 8u) | (bytes.z << 16u) | (bytes.w << 24u));
}
