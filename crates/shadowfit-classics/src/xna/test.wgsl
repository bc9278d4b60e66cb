// Shadow test of the XNA Shadow Mapping sample. test.x: bias.

// Returns 1 in light, 0 in shadow.
fn xna_share(stored: f32, depth: f32, bias: f32) -> f32 {
    return select(1.0, 0.0, stored < depth - bias);
}

fn light_share(point: Point) -> f32 {
    return xna_share(stored_nearest(point.seen.uv), point.seen.depth, sample.test.x);
}
