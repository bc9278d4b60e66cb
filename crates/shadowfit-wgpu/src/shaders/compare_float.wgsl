// Comparison by hand, for colour formats that no comparison sampler reads.

// Whether light passes one texel of the map.
fn shadowfit_lit(texel: vec2<f32>, projected: shadowfit_Projected, depth: f32) -> f32 {
    return select(0.0, 1.0, saturate(depth) COMPARE shadowfit_texel(texel, projected));
}
