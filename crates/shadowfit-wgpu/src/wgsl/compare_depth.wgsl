// Comparison by the sampler: one texel with a nearest sampler, 2x2 weighted with a linear one. It repeats the layer, so
// that it reads on across the seam of a map that is stored shifted.

@group(GROUP) @binding(BINDING_2) var shadowfit_sampler: sampler_comparison;

// What a texel is in the coordinates of look-ups: a share of the layer.
fn shadowfit_unit() -> vec2<f32> {
    return vec2<f32>(1.0) / vec2<f32>(textureDimensions(shadowfit_texture));
}

// One look-up at coordinates of the layer, of which a map's first repetition may begin before it.
fn shadowfit_look_up_at(at: vec2<f32>, depth: f32, projected: shadowfit_Projected) -> f32 {
    return textureSampleCompareLevel(shadowfit_texture, shadowfit_sampler, at, i32(projected.layer), saturate(depth));
}
