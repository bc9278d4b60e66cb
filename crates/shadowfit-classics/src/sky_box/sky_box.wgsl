// A cube around the eye, seen from inside and looked up by position.

struct SkyBox {
    // Clip space from positions relative to the eye.
    clip_from_world: mat4x4<f32>,
}

@group(0) @binding(0) var<uniform> sky_box: SkyBox;
@group(0) @binding(1) var sky_texture: texture_cube<f32>;
@group(0) @binding(2) var sky_sampler: sampler;

struct SkyBoxVertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
}

// Corners of the cube's side at x = 1: two triangles, counter-clockwise seen from outside.
fn side_corner(index: u32) -> vec3<f32> {
    var corners = array<vec2<f32>, 6>(
        vec2<f32>(-1.0, -1.0), vec2<f32>(1.0, -1.0), vec2<f32>(1.0, 1.0),
        vec2<f32>(-1.0, -1.0), vec2<f32>(1.0, 1.0), vec2<f32>(-1.0, 1.0));
    return vec3<f32>(1.0, corners[index]);
}

@vertex
fn vs_sky_box(@builtin(vertex_index) index: u32) -> SkyBoxVertex {
    let corner = side_corner(index % 6u);
    let side = index / 6u;
    // Rotates the side from axis to axis, and for the opposite sides by half a turn about another axis.
    // Neither mirrors.
    let turned = select(select(corner.yzx, corner.zxy, side % 3u == 1u), corner, side % 3u == 0u);
    let opposite = vec3<f32>(-turned.x, -turned.y, -turned.z).zyx;
    let position = select(opposite, turned, side < 3u);
    let clip = sky_box.clip_from_world * vec4<f32>(position, 1.0);
    // At the far plane, which is depth 0.
    return SkyBoxVertex(vec4<f32>(clip.xy, 0.0, clip.w), position);
}

@fragment
fn fs_sky_box(in: SkyBoxVertex) -> @location(0) vec4<f32> {
    return vec4<f32>(textureSample(sky_texture, sky_sampler, in.position).rgb, 1.0);
}
