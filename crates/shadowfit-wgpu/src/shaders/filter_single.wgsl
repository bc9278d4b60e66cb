// One look-up at the point itself.
fn shadowfit_compare(map: u32, size: vec2<f32>, projected: shadowfit_Projected) -> f32 {
    return shadowfit_look_up(map, size, projected.texel, projected);
}
