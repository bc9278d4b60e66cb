
// How many of the four texels around a corner of the map's texels are lit. corner: from the map's left and top, in texels.
fn shadowfit_lit_of_four(corner: vec2<f32>, projected: shadowfit_Projected) -> f32 {
    let shifted = corner + projected.wrap;
    let at = select(shifted, shifted - projected.size, shifted >= projected.size) * projected.unit;
    let depth = saturate(projected.depth + dot(projected.gradient, corner - projected.texel));
    let four = textureGatherCompare(shadowfit_texture, shadowfit_sampler, at, i32(projected.layer), depth);
    return four.x + four.y + four.z + four.w;
}
