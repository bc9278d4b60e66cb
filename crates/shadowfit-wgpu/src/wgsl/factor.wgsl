
// Returns the share of the light that a map lets through. entry: index of the map in the order.
fn shadowfit_read(entry: i32, position: vec3<f32>, normal: vec3<f32>, turn: f32) -> f32 {
    return shadowfit_compare(shadowfit_project(shadowfit_entry(entry), position, normal), turn);
}

// Returns how much shadows have faded at a point: 0 not at all, 1 completely.
fn shadowfit_faded(position: vec3<f32>) -> f32 {
    let beyond = shadowfit_view_depth(position) - shadowfit_receiver.fade_near;
    if beyond <= 0.0 {
        return 0.0;
    }
    // The least width makes a hard end.
    let share = saturate(beyond / max(shadowfit_receiver.fade_width, 1e-30));
    return share * share * (3.0 - 2.0 * share);
}

// Returns the share of the light that reaches a point according to the maps. turn: rotation of the discs, in
// radians.
fn shadowfit_turned(position: vec3<f32>, normal: vec3<f32>, turn: f32) -> f32 {
    // A product, not a branch: software rasterisers compile a shader for each draw if a uniform alone decides
    // a branch.
    let lit = f32(1u - shadowfit_receiver.is_off);
    let faded = shadowfit_faded(position);
    let selection = shadowfit_select(position);
    if selection.first < 0 {
        return lit;
    }
    var factor = shadowfit_read(selection.first, position, normal, turn);
    if selection.second >= 0 {
        factor = mix(shadowfit_read(selection.second, position, normal, turn), factor, selection.weight);
    }
    return lit * mix(factor, 1.0, faded);
}

// Returns the share of the light that reaches a point: 1 lit, 0 in shadow, 1 outside every map; 0 everywhere
// if the light is off.
fn shadowfit_factor(position: vec3<f32>, normal: vec3<f32>) -> f32 {
    return shadowfit_turned(position, normal, 0.0);
}

// Returns the share of shadowfit_factor, with discs rotated from pixel to pixel. pixel: xy of the fragment's
// builtin position.
fn shadowfit_factor_at(position: vec3<f32>, normal: vec3<f32>, pixel: vec2<f32>) -> f32 {
    return shadowfit_turned(position, normal, shadowfit_turn(pixel));
}

// Returns the index of the map with the greatest weight in shadowfit_factor at a point; -1 outside every map.
fn shadowfit_map_index(position: vec3<f32>) -> i32 {
    let selection = shadowfit_select(position);
    if selection.first < 0 {
        return -1;
    }
    let is_second = selection.second >= 0 && selection.weight < 0.5;
    return i32(shadowfit_entry(select(selection.first, selection.second, is_second)).layer);
}
