// The nearest texel alone.
fn shadowfit_look_up(map: u32, size: vec2<f32>, texel: vec2<f32>, place: shadowfit_Place) -> f32 {
    return shadowfit_lit(map, size, floor(texel), place.depth + dot(place.gradient, texel - place.texel));
}
