
// The depth at a texel of a layer of a depth texture, as it is stored. OpenGL's shaders cannot do this.
fn shadowfit_load(layer: u32, texel: vec2<i32>) -> f32 {
    return textureLoad(shadowfit_texture, texel, i32(layer), 0);
}
