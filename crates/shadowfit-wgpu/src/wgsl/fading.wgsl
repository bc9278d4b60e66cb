
// Fades from one set of maps to another. Functions that depend on the set exist twice.

struct shadowfit_Fading {
    now: shadowfit_Receiver,
    // Maps of the previous light direction while they fade out; otherwise none.
    before: shadowfit_Receiver,
    // Share of `now` in the factor.
    share: f32,
    // Layer of the first map of `now`.
    first_layer: u32,
    padding_0: u32,
    padding_1: u32,
}

// Returns the share of the light that reaches a point according to the maps. turn: rotation of the discs, in
// radians.
fn shadowfit_turned(position: vec3<f32>, normal: vec3<f32>, turn: f32) -> f32 {
    let now = shadowfit_turned_now(position, normal, turn);
    if shadowfit_fading.before.map_count == 0u {
        return now;
    }
    return mix(shadowfit_turned_before(position, normal, turn), now, shadowfit_fading.share);
}

// Returns the index of the present map with the greatest weight in the factor; -1 outside all maps.
fn shadowfit_map_index(position: vec3<f32>) -> i32 {
    let layer = shadowfit_map_index_now(position);
    return select(layer - i32(shadowfit_fading.first_layer), -1, layer < 0);
}
