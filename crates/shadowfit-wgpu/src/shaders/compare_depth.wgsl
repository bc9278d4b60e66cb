// Comparison by the sampler: one texel with a nearest sampler, 2x2 weighted with a linear one. It repeats the layer, so
// that it reads on across the seam of a map that is stored shifted.

@group(GROUP) @binding(BINDING_2) var shadowfit_sampler: sampler_comparison;

// One look-up at a position in the map, in texels, with the depth of the point's plane there.
fn shadowfit_look_up(texel: vec2<f32>, projected: shadowfit_Projected) -> f32 {
    // Not nearer to the border of what is in use than half a texel: the sampler would read beyond it.
    let inside = clamp(texel, vec2<f32>(0.5), projected.size - vec2<f32>(0.5));
    let depth = projected.depth + dot(projected.gradient, inside - projected.texel);
    let shifted = inside + projected.wrap;
    let stored = select(shifted, shifted - projected.size, shifted >= projected.size);
    let uv = stored / vec2<f32>(textureDimensions(shadowfit_texture));
    return textureSampleCompareLevel(shadowfit_texture, shadowfit_sampler, uv, i32(projected.layer), saturate(depth));
}
