// Clears a part of a picture: black, at the depth of the sky. Comes after screen.wgsl.

@fragment
fn fs_clear() -> @location(0) vec4<f32> {
    return vec4<f32>(0.0, 0.0, 0.0, 1.0);
}
