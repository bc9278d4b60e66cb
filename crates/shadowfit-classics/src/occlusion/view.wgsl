// Shows occlusion alone: white is open. Comes after screen.wgsl.

@group(0) @binding(0) var occluded: texture_2d<f32>;

@fragment
fn fs_occlusion(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    return vec4<f32>(vec3<f32>(1.0 - textureLoad(occluded, vec2<i32>(at.xy), 0).x), 1.0);
}
