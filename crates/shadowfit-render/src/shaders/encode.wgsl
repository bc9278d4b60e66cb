// Display values of a picture. Comes after screen.wgsl and srgb.wgsl.

@group(0) @binding(0) var picture: texture_2d<f32>;

@fragment
fn fs_encode(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let color = textureLoad(picture, vec2<i32>(at.xy), 0);
    return vec4<f32>(encoded(color.rgb), color.a);
}
