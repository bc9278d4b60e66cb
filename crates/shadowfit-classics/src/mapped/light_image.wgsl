// Image that a lamp projects. White everywhere if the lamp has none.

@group(1) @binding(2) var light_image: texture_2d<f32>;
@group(1) @binding(3) var light_image_sampler: sampler;

fn light_image_at(uv: vec2<f32>) -> f32 {
    return textureSampleLevel(light_image, light_image_sampler, uv, 0.0).r;
}

// Returns 1 inside the light's image, 0 outside of it and behind the lamp.
fn inside_image(seen: Seen) -> f32 {
    let is_inside = all(seen.uv >= vec2<f32>(0.0)) && all(seen.uv <= vec2<f32>(1.0)) && seen.w > 0.0;
    return select(0.0, 1.0, is_inside);
}
