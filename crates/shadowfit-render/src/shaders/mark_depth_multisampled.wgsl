// The depth buffer of a multisampled picture. Only the first sample is read.

@group(1) @binding(1) var depths: texture_depth_multisampled_2d;

fn scene_depth(pixel: vec2<i32>) -> f32 {
    return textureLoad(depths, pixel, 0);
}
