// The picture's factors after the resolve pass.

@group(GROUP) @binding(BINDING_0) var shadowfit_factors: texture_2d<f32>;

// Share of the light that reaches a point that the depth buffer shows at a pixel: as it was resolved, and the filter's
// where it was not. pixel: xy of the fragment's builtin position.
fn shadowfit_resolved(position: vec3<f32>, normal: vec3<f32>, pixel: vec2<f32>) -> f32 {
    let at = vec2<u32>(pixel);
    if all(at < textureDimensions(shadowfit_factors)) {
        let factor = textureLoad(shadowfit_factors, at, 0).x;
        if factor >= 0.0 {
            return factor;
        }
    }
    return shadowfit_factor_at(position, normal, pixel);
}
