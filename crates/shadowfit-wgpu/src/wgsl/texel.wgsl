
// The depth at a texel of the layer; up to a map's size beside it, where the map wraps around.
fn shadowfit_stored_texel(texel: vec2<f32>, projected: shadowfit_Projected) -> f32 {
    let ended = select(texel, texel - projected.size, texel >= projected.size);
    let stored = select(ended, ended + projected.size, texel < vec2<f32>(0.0));
    return shadowfit_load(projected.layer, vec2<i32>(stored));
}
