// Depth bits of a block of a map's texels, one texel per pixel. Comes after screen.wgsl and the shadow map's
// WGSL.

struct Block {
    // Left top texel of the block.
    first: vec2<i32>,
    // Last texel of the map.
    last: vec2<i32>,
    map: u32,
    padding_0: u32,
    padding_1: u32,
    padding_2: u32,
}

@group(0) @binding(0) var<uniform> block: Block;

@fragment
fn fs_block(@builtin(position) at: vec4<f32>) -> @location(0) u32 {
    let texel = clamp(block.first + vec2<i32>(at.xy), vec2<i32>(0), block.last);
    return bitcast<u32>(shadowfit_stored(i32(block.map), texel));
}
