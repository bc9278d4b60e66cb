
// Returns the depth at a texel of a present map, by the map's index.
fn shadowfit_stored(map: i32, texel: vec2<i32>) -> f32 {
    return shadowfit_stored_now(map + i32(shadowfit_fading.first_layer), texel);
}
