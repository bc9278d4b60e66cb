
// Compares only the nearest texel.
fn shadowfit_look_up_at(at: vec2<f32>, depth: f32, projected: shadowfit_Projected) -> f32 {
    return shadowfit_lit(floor(at), projected, depth);
}
