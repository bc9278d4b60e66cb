// Comparison by the sampler: one texel with a nearest sampler, 2x2 weighted texels with a linear one. The
// sampler repeats the layer, so that it reads across the seam of a map that wraps around.

@group(GROUP) @binding(BINDING_2) var shadowfit_sampler: sampler_comparison;

// Returns the size of a texel in look-up coordinates: its share of the layer.
fn shadowfit_unit() -> vec2<f32> {
    return vec2<f32>(1.0) / vec2<f32>(textureDimensions(shadowfit_texture));
}

// Does one look-up at layer coordinates, which may lie outside 0..1 because the layer repeats.
fn shadowfit_look_up_at(at: vec2<f32>, depth: f32, projected: shadowfit_Projected) -> f32 {
    return textureSampleCompareLevel(shadowfit_texture, shadowfit_sampler, at, i32(projected.layer), saturate(depth));
}
