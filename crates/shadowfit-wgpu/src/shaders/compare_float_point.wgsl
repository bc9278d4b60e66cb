// The nearest texel alone.
fn shadowfit_look_up(map: u32, size: vec2<f32>, texel: vec2<f32>, projected: shadowfit_Projected) -> f32 {
    return shadowfit_lit(map, size, floor(texel), projected.depth + dot(projected.gradient, texel - projected.texel));
}
