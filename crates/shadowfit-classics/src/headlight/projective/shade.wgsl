// The headlight street's first stage: each point shows the map's grey where the lamp projects it, without a bounds test.

fn colour(point: Point, share: f32) -> vec3<f32> {
    return vec3<f32>(stored_linear(point.seen.uv));
}
