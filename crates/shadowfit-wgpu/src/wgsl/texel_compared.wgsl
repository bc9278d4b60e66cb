
// Returns the stored depth at a texel of a depth texture, for shaders that can only compare. It searches bit
// by bit for the greatest depth that passes the comparison. With reversed depth, it searches for the greatest
// depth that fails, and returns the next one.
fn shadowfit_load(layer: u32, texel: vec2<i32>) -> f32 {
    let at = (vec2<f32>(texel) + 0.5) * shadowfit_unit();
    // Floats of 0 to 1 are ordered like their bits.
    var bits = 0u;
    for (var bit = 29; bit >= 0; bit -= 1) {
        let tried = min(bits | (1u << u32(bit)), SHADOWFIT_ONE);
        let depth = bitcast<f32>(tried);
        let is_passed = textureSampleCompareLevel(shadowfit_texture, shadowfit_sampler, at, i32(layer), depth) > 0.5;
        bits = select(bits, tried, is_passed != IS_REVERSED);
    }
    let is_far = textureSampleCompareLevel(shadowfit_texture, shadowfit_sampler, at, i32(layer), 0.0) > 0.5;
    return bitcast<f32>(select(bits, bits + 1u, IS_REVERSED && !is_far));
}

// Bits of the float 1.
const SHADOWFIT_ONE: u32 = 0x3f800000u;
