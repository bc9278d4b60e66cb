// First stage of the headlight street. Each point shows the map's grey at its projected position, without a
// bounds test.

fn colour(point: Point, share: f32) -> vec3<f32> {
    return vec3<f32>(stored_linear(point.seen.uv));
}
