// Lighting of depth testing with a comparison sampler. shading.x: ambient.

const DIFFUSE: vec3<f32> = vec3<f32>(0.5, 0.5, 0.4);
const SPECULAR: vec3<f32> = vec3<f32>(0.2, 0.2, 0.3);

fn comparison_colour(base: vec3<f32>, n_l: f32, r_v: f32, share: f32, ambient: f32) -> vec3<f32> {
    let mirrored = saturate(r_v);
    let full = base * (ambient + DIFFUSE * saturate(n_l) + SPECULAR * (mirrored * mirrored * mirrored));
    return mix(base * ambient, full, share);
}

fn colour(point: Point, share: f32) -> vec3<f32> {
    let n_l = dot(point.normal, point.to_light);
    let r_v = dot(reflect(-point.to_light, point.normal), point.to_eye);
    return comparison_colour(point.base, n_l, r_v, share, sample.shading.x);
}
