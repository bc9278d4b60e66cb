// The depth buffer of a picture of several samples, of which the first is read.

@group(1) @binding(1) var depths: texture_depth_multisampled_2d;

fn scene_depth(pixel: vec2<i32>) -> f32 {
    return textureLoad(depths, pixel, 0);
}
