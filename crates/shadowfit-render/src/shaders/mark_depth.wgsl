// The depth buffer of a picture of one sample. Comes after judged.wgsl.

@group(1) @binding(1) var depths: texture_2d<f32>;

fn scene_depth(pixel: vec2<i32>) -> f32 {
    return depth_at(depths, pixel);
}
