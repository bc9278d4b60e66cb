// The nearest texel alone.
fn shadowfit_look_up(texel: vec2<f32>, projected: shadowfit_Projected) -> f32 {
    let depth = projected.depth + dot(projected.gradient, texel - projected.texel);
    return shadowfit_lit(floor(texel), projected, depth);
}
