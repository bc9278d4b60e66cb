// Shading of the headlight street. shading.x: power of the lamp, shading.y: ambient.

fn headlight_colour(base: vec3<f32>, n_l: f32, share: f32, power: f32, ambient: f32) -> vec3<f32> {
    return base * (saturate(n_l) * power * share + ambient);
}

fn colour(point: Point, share: f32) -> vec3<f32> {
    return headlight_colour(
        point.base, dot(point.normal, point.to_light), share, sample.shading.x, sample.shading.y);
}
