// Surface buffers of the full-screen passes. w of a position is 1 where there is a surface.

@group(1) @binding(0) var positions: texture_2d<f32>;
@group(1) @binding(1) var normals: texture_2d<f32>;
// Positions of back faces. In the blur pass: occlusion.
@group(1) @binding(2) var third: texture_2d<f32>;

fn within(pixel: vec2<i32>) -> vec2<i32> {
    return clamp(pixel, vec2<i32>(0), vec2<i32>(textureDimensions(positions)) - 1);
}
