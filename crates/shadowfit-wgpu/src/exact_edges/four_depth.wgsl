
// Returns the depths of the four texels around a corner between texels, counter-clockwise from the lower left
// one. corner: position from the map's left and top, in texels.
fn stored_around(corner: vec2<f32>, projected: shadowfit_Projected) -> vec4<f32> {
    let shifted = corner + projected.texel_offset;
    let at = select(shifted, shifted - projected.size, shifted >= projected.size) * projected.unit;
    return textureGather(shadowfit_texture, texels, at, i32(projected.layer));
}
