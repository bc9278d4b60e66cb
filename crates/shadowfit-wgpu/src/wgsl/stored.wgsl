
// Returns the depth at a texel of a map, by the map's index, for debug views. The texel is clamped to the
// layer's edge. Texel t of the map is stored at (t + texel_offset) mod size.
fn shadowfit_stored(map: i32, texel: vec2<i32>) -> f32 {
    let size = vec2<i32>(textureDimensions(shadowfit_texture));
    let shifted = clamp(texel, vec2<i32>(0), size - vec2<i32>(1)) + vec2<i32>(shadowfit_texel_offset(u32(map)));
    return shadowfit_load(u32(map), shifted % size);
}
