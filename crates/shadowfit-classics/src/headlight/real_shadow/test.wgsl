// Shadow test of the headlight street's second stage. test.x: bias.

// Returns 1 inside the light's image where depth - bias <= stored, else 0.
fn real_shadow_share(inside: f32, stored: f32, depth: f32, bias: f32) -> f32 {
    return select(0.0, inside, depth - bias <= stored);
}

fn light_share(point: Point) -> f32 {
    return real_shadow_share(inside_image(point.seen), stored_linear(point.seen.uv), point.seen.depth, sample.test.x)
        * light_image_at(point.seen.uv);
}
