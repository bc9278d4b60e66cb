// Where a map's texels lie in its layer: texel t of the map is stored at (t + wrap) mod size.

// The depth at a texel of the map, clamped to its border.
fn shadowfit_texel(texel: vec2<f32>, projected: shadowfit_Projected) -> f32 {
    let shifted = clamp(texel, vec2<f32>(0.0), projected.size - vec2<f32>(1.0)) + projected.wrap;
    let stored = select(shifted, shifted - projected.size, shifted >= projected.size);
    return shadowfit_load(projected.layer, vec2<i32>(stored));
}

// The depth at a texel of a map, by the map's index, for views of it; clamped to the layer's edge.
fn shadowfit_stored(map: u32, texel: vec2<i32>) -> f32 {
    let size = vec2<i32>(textureDimensions(shadowfit_texture));
    let shifted = clamp(texel, vec2<i32>(0), size - vec2<i32>(1)) + vec2<i32>(shadowfit_wrap(map));
    return shadowfit_load(map, select(shifted, shifted - size, shifted >= size));
}
