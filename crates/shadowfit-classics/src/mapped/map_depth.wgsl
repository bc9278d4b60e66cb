// A depth map that the sampler compares.

@group(1) @binding(0) var map: texture_depth_2d;
@group(1) @binding(1) var map_sampler: sampler_comparison;

// Reads the depth at a texel with comparisons, bit by bit: the greatest depth that passes. OpenGL's shaders
// cannot load it.
fn stored_in(texel: vec2<i32>) -> f32 {
    let uv = (vec2<f32>(texel) + 0.5) / vec2<f32>(textureDimensions(map));
    // The bits of floats from 0 to 1 are in the order of their values.
    var bits = 0u;
    for (var bit = 29; bit >= 0; bit -= 1) {
        let tried = min(bits | (1u << u32(bit)), 0x3f800000u);
        let is_passed = textureSampleCompareLevel(map, map_sampler, uv, bitcast<f32>(tried)) > 0.5;
        bits = select(bits, tried, is_passed);
    }
    return bitcast<f32>(bits);
}

// Share of light by less-or-equal: of one texel, or of 2 x 2 with a linear sampler.
fn compared(uv: vec2<f32>, depth: f32) -> f32 {
    return textureSampleCompareLevel(map, map_sampler, uv, saturate(depth));
}
