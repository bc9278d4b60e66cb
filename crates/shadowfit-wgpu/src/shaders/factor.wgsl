
// Share of the light that a map lets through, by its place in the order.
fn shadowfit_read(entry: i32, position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let map = shadowfit_entry(entry);
    return shadowfit_compare(map.layer, map.size, shadowfit_project(map, position, normal));
}

// Share of the light that reaches a point: 1 lit, 0 in shadow, 1 outside every map.
fn shadowfit_factor(position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let choice = shadowfit_choose(position);
    if choice.first < 0 {
        return 1.0;
    }
    let factor = shadowfit_read(choice.first, position, normal);
    if choice.second < 0 {
        return factor;
    }
    return mix(shadowfit_read(choice.second, position, normal), factor, choice.weight);
}

// Index of the map that weighs more in shadowfit_factor at a point: -1 outside every map.
fn shadowfit_map_index(position: vec3<f32>) -> i32 {
    let choice = shadowfit_choose(position);
    if choice.first < 0 {
        return -1;
    }
    let is_second = choice.second >= 0 && choice.weight < 0.5;
    return i32(shadowfit_entry(select(choice.first, choice.second, is_second)).layer);
}
