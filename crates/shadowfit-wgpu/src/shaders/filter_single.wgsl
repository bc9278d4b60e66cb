// One look-up at the point itself.
fn shadowfit_compare(map: u32, size: vec2<f32>, place: shadowfit_Place) -> f32 {
    return shadowfit_look_up(map, size, place.texel, place);
}
