// The shading of the XNA Shadow Mapping sample. shading.x: ambient, which the texture does not colour.

fn xna_colour(base: vec3<f32>, n_l: f32, share: f32, ambient: f32) -> vec3<f32> {
    return (base * saturate(n_l) + ambient) * mix(0.5, 1.0, share);
}

fn colour(point: Point, share: f32) -> vec3<f32> {
    return xna_colour(point.base, dot(point.normal, point.to_light), share, sample.shading.x);
}
