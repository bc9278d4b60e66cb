// Sets rectangles of a depth map to the far value: a triangle over the whole map, clipped by the scissor
// rectangle.

@vertex
fn vs_clear(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    return vec4<f32>(corner * 4.0 - 1.0, FAR, 1.0);
}
