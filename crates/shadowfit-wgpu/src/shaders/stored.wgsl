// Where a map's texels lie in its layer: texel t of the map is stored at (t + wrap) mod size.

// The depth at a texel of the layer; up to a map's size beside it, where the map wraps around.
fn shadowfit_stored_texel(texel: vec2<f32>, projected: shadowfit_Projected) -> f32 {
    let ended = select(texel, texel - projected.size, texel >= projected.size);
    let stored = select(ended, ended + projected.size, texel < vec2<f32>(0.0));
    return shadowfit_load(projected.layer, vec2<i32>(stored));
}

// The depth at a texel of a map, by the map's index, for views of it; clamped to the layer's edge.
fn shadowfit_stored(map: u32, texel: vec2<i32>) -> f32 {
    let size = vec2<i32>(textureDimensions(shadowfit_texture));
    let shifted = clamp(texel, vec2<i32>(0), size - vec2<i32>(1)) + vec2<i32>(shadowfit_wrap(map));
    return shadowfit_load(map, select(shifted, shifted - size, shifted >= size));
}
