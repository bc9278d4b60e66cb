
// Returns the depth at a texel of the layer. The texel may lie up to a map's size outside, where the map
// wraps around.
fn shadowfit_stored_texel(texel: vec2<f32>, projected: shadowfit_Projected) -> f32 {
    // Products, because HLSL 2021 has no choice by a vector.
    let ended = texel - projected.size * vec2<f32>(texel >= projected.size);
    let stored = ended + projected.size * vec2<f32>(texel < vec2<f32>(0.0));
    return shadowfit_load(projected.layer, vec2<i32>(stored));
}
