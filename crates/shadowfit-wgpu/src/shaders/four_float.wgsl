
// How many of the four texels around a corner of the map's texels are lit. corner: from the map's left and top, in texels.
fn shadowfit_lit_of_four(corner: vec2<f32>, projected: shadowfit_Projected) -> f32 {
    let shifted = corner + projected.wrap;
    let at = select(shifted, shifted - projected.size, shifted >= projected.size);
    let depth = projected.depth + dot(projected.gradient, corner - projected.texel);
    return shadowfit_lit(at - 1.0, projected, depth) + shadowfit_lit(at + vec2<f32>(0.0, -1.0), projected, depth)
        + shadowfit_lit(at + vec2<f32>(-1.0, 0.0), projected, depth) + shadowfit_lit(at, projected, depth);
}
