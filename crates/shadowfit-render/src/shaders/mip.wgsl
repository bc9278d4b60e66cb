// One level of a texture from the level above it, averaged by the linear sampler.

@group(0) @binding(0) var source: texture_2d<f32>;
@group(0) @binding(1) var source_sampler: sampler;

struct MipVertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn vs_mip(@builtin(vertex_index) index: u32) -> MipVertex {
    let uv = vec2<f32>(f32((index << 1u) & 2u), f32(index & 2u));
    return MipVertex(vec4<f32>(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0, 0.0, 1.0), uv);
}

@fragment
fn fs_mip(in: MipVertex) -> @location(0) vec4<f32> {
    return textureSampleLevel(source, source_sampler, in.uv, 0.0);
}
