// A sample's map in a corner of the picture, its stored depths as greys. The viewport is the corner.

struct Corner {
    @builtin(position) clip: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn vs_inset(@builtin(vertex_index) index: u32) -> Corner {
    let uv = vec2<f32>(f32((index << 1u) & 2u), f32(index & 2u));
    return Corner(vec4<f32>(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0, 0.0, 1.0), uv);
}

@fragment
fn fs_inset(in: Corner) -> @location(0) vec4<f32> {
    return vec4<f32>(vec3<f32>(stored_nearest(in.uv)), 1.0);
}
