// A disc of constant width.
fn shadowfit_compare(projected: shadowfit_Projected, turn: f32) -> f32 {
    return shadowfit_disc(projected.disc, projected, turn);
}
