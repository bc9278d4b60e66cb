// Restores the static casters' depths in the shown layer where moving casters were drawn over them. Follows
// the caster's WGSL and clear.wgsl, whose triangle restores rectangles.

@group(0) @binding(0) var static_depth: texture_2d<f32>;
// Reads the nearest texel: OpenGL's shaders cannot load from depth textures.
@group(0) @binding(1) var nearest: sampler;

// Sides of a box: bits of the corners, two triangles per side, counter-clockwise from outside.
const CORNERS: array<u32, 36> = array<u32, 36>(
    0u, 4u, 6u, 0u, 6u, 2u, 1u, 3u, 7u, 1u, 7u, 5u,
    0u, 1u, 5u, 0u, 5u, 4u, 2u, 6u, 7u, 2u, 7u, 3u,
    0u, 2u, 3u, 0u, 3u, 1u, 4u, 5u, 7u, 4u, 7u, 6u,
);

// Outline of a box as the light sees it, flattened into the range of depths.
@vertex
fn vs_mend_box(
    @builtin(vertex_index) index: u32, @location(0) box_min: vec3<f32>, @location(1) box_max: vec3<f32>,
) -> @builtin(position) vec4<f32> {
    var corners = CORNERS;
    let bits = corners[index];
    let is_max = vec3<bool>((bits & 1u) != 0u, (bits & 2u) != 0u, (bits & 4u) != 0u);
    let clip = shadowfit_caster_position(select(box_min, box_max, is_max));
    return vec4<f32>(clip.xy, 0.5, 1.0);
}

@fragment
fn fs_mend(@builtin(position) at: vec4<f32>) -> @builtin(frag_depth) f32 {
    return textureSampleLevel(static_depth, nearest, at.xy / vec2<f32>(textureDimensions(static_depth)), 0.0).x;
}
