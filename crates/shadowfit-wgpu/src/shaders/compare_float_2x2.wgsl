// The four nearest texels, each compared, then weighted bilinearly: what a linear comparison
// sampler does.
fn shadowfit_compare(map: u32, uv: vec3<f32>) -> f32 {
    let at = uv.xy * vec2<f32>(textureDimensions(shadowfit_texture)) - vec2<f32>(0.5);
    let corner = vec2<i32>(floor(at));
    let weight = fract(at);
    let top = mix(
        shadowfit_lit(map, corner, uv.z), shadowfit_lit(map, corner + vec2<i32>(1, 0), uv.z), weight.x);
    let bottom = mix(
        shadowfit_lit(map, corner + vec2<i32>(0, 1), uv.z), shadowfit_lit(map, corner + vec2<i32>(1, 1), uv.z),
        weight.x);
    return mix(top, bottom, weight.y);
}
