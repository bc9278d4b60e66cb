// Texels of a depth texture.

@group(GROUP) @binding(BINDING_1) var shadowfit_texture: texture_depth_2d_array;

// The depth at a texel of a layer, as it is stored.
fn shadowfit_load(layer: u32, texel: vec2<i32>) -> f32 {
    return textureLoad(shadowfit_texture, texel, i32(layer), 0);
}
