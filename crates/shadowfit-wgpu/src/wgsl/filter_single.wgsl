// Does one look-up at the point itself.
fn shadowfit_compare(projected: shadowfit_Projected, turn: f32) -> f32 {
    return shadowfit_look_up(projected.texel, projected);
}
