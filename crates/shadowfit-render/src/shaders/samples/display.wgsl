// Display values, which the classic techniques compute in.

// Encoded colour from a linear one (sRGB).
fn encoded(color: vec3<f32>) -> vec3<f32> {
    let linear = saturate(color);
    return select(1.055 * pow(linear, vec3<f32>(1.0 / 2.4)) - 0.055, linear * 12.92, linear <= vec3<f32>(0.0031308));
}
