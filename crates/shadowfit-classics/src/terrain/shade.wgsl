// The terrain sample's shading. shading.x: diffuse, shading.y: ambient.

const IN_SHADOW: f32 = 0.3;

fn terrain_colour(base: vec3<f32>, n_l: f32, share: f32, diffuse: f32, ambient: f32) -> vec3<f32> {
    return base * (mix(IN_SHADOW, 1.0 + diffuse * max(0.0, n_l), share) + ambient);
}

fn colour(point: Point, share: f32) -> vec3<f32> {
    return terrain_colour(point.base, dot(point.normal, point.to_light), share, sample.shading.x, sample.shading.y);
}
