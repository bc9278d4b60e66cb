// The nearest texel alone.
fn shadowfit_compare(map: u32, uv: vec3<f32>) -> f32 {
    let size = vec2<f32>(textureDimensions(shadowfit_texture));
    return shadowfit_lit(map, vec2<i32>(floor(uv.xy * size)), uv.z);
}
