
// Two sets of maps, of which one is faded into the other: what depends on the set stands twice.

struct shadowfit_Fading {
    now: shadowfit_Receiver,
    // The maps of the light's direction before, while they are faded out; none otherwise.
    before: shadowfit_Receiver,
    // Share of the former in the factor.
    share: f32,
    // Layer of the first of these maps.
    first_layer: u32,
    padding_0: u32,
    padding_1: u32,
}

// Share of the light that reaches a point through the maps, with the look-ups over discs turned by an angle in radians.
fn shadowfit_turned(position: vec3<f32>, normal: vec3<f32>, turn: f32) -> f32 {
    let now = shadowfit_turned_now(position, normal, turn);
    if shadowfit_fading.before.map_count == 0u {
        return now;
    }
    return mix(shadowfit_turned_before(position, normal, turn), now, shadowfit_fading.share);
}

// Index of the map that weighs more in the factor of the present maps: -1 outside all of them.
fn shadowfit_map_index(position: vec3<f32>) -> i32 {
    let layer = shadowfit_map_index_now(position);
    return select(layer - i32(shadowfit_fading.first_layer), -1, layer < 0);
}
