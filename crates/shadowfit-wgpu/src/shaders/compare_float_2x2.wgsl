// One look-up at a position in the map, in texels, with the depth of the point's plane there: the four nearest texels,
// each compared, then weighted bilinearly, as a linear comparison sampler does.
fn shadowfit_look_up(texel: vec2<f32>, projected: shadowfit_Projected) -> f32 {
    let inside = clamp(texel, vec2<f32>(0.5), projected.size - vec2<f32>(0.5));
    let depth = projected.depth + dot(projected.gradient, inside - projected.texel);
    let corner = floor(inside - vec2<f32>(0.5));
    let weight = inside - vec2<f32>(0.5) - corner;
    let top = mix(
        shadowfit_lit(corner, projected, depth), shadowfit_lit(corner + vec2<f32>(1.0, 0.0), projected, depth),
        weight.x);
    let bottom = mix(
        shadowfit_lit(corner + vec2<f32>(0.0, 1.0), projected, depth),
        shadowfit_lit(corner + vec2<f32>(1.0, 1.0), projected, depth), weight.x);
    return mix(top, bottom, weight.y);
}
