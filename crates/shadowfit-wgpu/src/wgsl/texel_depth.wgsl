
// Returns the stored depth at a texel of a depth texture. OpenGL's shaders cannot do this.
fn shadowfit_load(layer: u32, texel: vec2<i32>) -> f32 {
    return textureLoad(shadowfit_texture, texel, i32(layer), 0);
}
