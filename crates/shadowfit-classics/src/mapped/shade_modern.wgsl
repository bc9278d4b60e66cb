// Modern lighting of a sample: linear, with the reflectance and the tone curve of the other scenes.
// shading.x: irradiance of the light. shading.y: irradiance of sky and ground.

fn colour(point: Point, share: f32) -> vec3<f32> {
    let base = decoded(point.base);
    let facing = smoothstep(0.0, 0.08, dot(point.geometric, point.to_light));
    let normal = select(point.normal, -point.normal, dot(point.normal, point.geometric) < 0.0);
    let direct = reflectance(base, normal, point.to_eye, point.to_light) * (sample.shading.x * share * facing);
    let ambient = base * (sample.shading.y * (0.75 + 0.25 * normal.y));
    return encoded(tone_map(direct + ambient));
}
