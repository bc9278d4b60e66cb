// Comparison in the shader, for colour formats that comparison samplers cannot read.

// Returns the size of a texel in look-up coordinates: one.
fn shadowfit_unit() -> vec2<f32> {
    return vec2<f32>(1.0);
}

// Returns whether light passes one texel of the layer. The texel may lie up to a map's size outside, where
// the map wraps around.
fn shadowfit_lit(texel: vec2<f32>, projected: shadowfit_Projected, depth: f32) -> f32 {
    return select(0.0, 1.0, saturate(depth) COMPARE shadowfit_stored_texel(texel, projected));
}
