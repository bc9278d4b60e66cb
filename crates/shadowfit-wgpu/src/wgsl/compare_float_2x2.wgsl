
// Does one look-up at a position in the layer, in texels: compares the four nearest texels, then weights them
// bilinearly, as a linear comparison sampler does.
fn shadowfit_look_up_at(at: vec2<f32>, depth: f32, projected: shadowfit_Projected) -> f32 {
    let corner = floor(at - vec2<f32>(0.5));
    let weight = at - vec2<f32>(0.5) - corner;
    let top = mix(
        shadowfit_lit(corner, projected, depth), shadowfit_lit(corner + vec2<f32>(1.0, 0.0), projected, depth),
        weight.x);
    let bottom = mix(
        shadowfit_lit(corner + vec2<f32>(0.0, 1.0), projected, depth),
        shadowfit_lit(corner + vec2<f32>(1.0, 1.0), projected, depth), weight.x);
    return mix(top, bottom, weight.y);
}
