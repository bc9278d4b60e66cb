// Uniform of the passes of a classic sample. Positions are relative to the camera's eye. Colours are display
// values unless marked as linear.

struct Sample {
    clip_from_world: mat4x4<f32>,
    // Clip space of the light's image.
    light_from_world: mat4x4<f32>,
    // Direction toward the light (w = 0), or its position (w = 1).
    light: vec4<f32>,
    // Numbers of the shadow test. Each test documents its own.
    test: vec4<f32>,
    // Further numbers of a shadow test.
    further: vec4<f32>,
    // Numbers of the shading. Each shading documents its own.
    shading: vec4<f32>,
    // Width and height of the map, in texels.
    map_size: vec2<f32>,
    padding: vec2<f32>,
}

@group(0) @binding(0) var<uniform> sample: Sample;
