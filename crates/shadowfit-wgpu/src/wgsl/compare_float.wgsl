// Comparison by hand, for colour formats that no comparison sampler reads.

// What a texel is in the coordinates of look-ups: one.
fn shadowfit_unit() -> vec2<f32> {
    return vec2<f32>(1.0);
}

// Whether light passes one texel of the layer; up to a map's size beside it, where the map wraps around.
fn shadowfit_lit(texel: vec2<f32>, projected: shadowfit_Projected, depth: f32) -> f32 {
    return select(0.0, 1.0, saturate(depth) COMPARE shadowfit_stored_texel(texel, projected));
}
