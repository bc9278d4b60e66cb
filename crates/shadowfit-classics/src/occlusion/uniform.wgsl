// Uniform of the passes of screen-space ambient occlusion.

struct Occlusion {
    // View space from positions relative to the eye.
    view_from_world: mat4x4<f32>,
    // Texture coordinates of a view-space point: 0.5 + this * (x, y) / depth.
    uv_from_view: vec2<f32>,
    // Height of a picture at view depth 1.
    height: f32,
    // View depth of the far plane.
    far: f32,
    radius: f32,
    scale: f32,
    bias: f32,
    intensity: f32,
    // 1 with level of detail, else 0.
    detail: f32,
    padding_0: f32,
    padding_1: f32,
    padding_2: f32,
    ambient: vec4<f32>,
    diffuse: vec4<f32>,
}

@group(GROUP) @binding(0) var<uniform> occlusion: Occlusion;
