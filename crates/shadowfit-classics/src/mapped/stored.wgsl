// Reads of a map at texture coordinates, clamped to its border: the nearest texel, or linear interpolation of
// four.

fn stored_clamped(texel: vec2<i32>) -> f32 {
    return stored_in(clamp(texel, vec2<i32>(0), vec2<i32>(sample.map_size) - 1));
}

// Clamps texture coordinates far outside or not finite.
fn texels(uv: vec2<f32>) -> vec2<f32> {
    return clamp(uv, vec2<f32>(-1.0), vec2<f32>(2.0)) * sample.map_size;
}

fn stored_nearest(uv: vec2<f32>) -> f32 {
    return stored_clamped(vec2<i32>(floor(texels(uv))));
}

fn stored_linear(uv: vec2<f32>) -> f32 {
    let at = texels(uv) - 0.5;
    let first = floor(at);
    let t = at - first;
    let texel = vec2<i32>(first);
    let upper = mix(stored_clamped(texel), stored_clamped(texel + vec2<i32>(1, 0)), t.x);
    let lower = mix(stored_clamped(texel + vec2<i32>(0, 1)), stored_clamped(texel + vec2<i32>(1, 1)), t.x);
    return mix(upper, lower, t.y);
}
