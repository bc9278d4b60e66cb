// What the passes of a classic sample share: the uniform. Positions are relative to the camera's eye. Colours are display values: nothing is
// linear but what says so.

struct Sample {
    clip_from_world: mat4x4<f32>,
    // Clip space of the light's image.
    light_from_world: mat4x4<f32>,
    // Direction toward the light (w = 0), or its position (w = 1).
    light: vec4<f32>,
    // What the shadow test reads; each test says what.
    test: vec4<f32>,
    // What a shadow test reads besides.
    further: vec4<f32>,
    // What the shading reads; each shading says what.
    shading: vec4<f32>,
    // Width and height of the map, in texels.
    map_size: vec2<f32>,
    padding: vec2<f32>,
}

@group(0) @binding(0) var<uniform> sample: Sample;
