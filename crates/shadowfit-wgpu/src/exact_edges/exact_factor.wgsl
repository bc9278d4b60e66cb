// The picture's factors after the edge pass.

@group(GROUP) @binding(BINDING_0) var shadowfit_factors: texture_2d<f32>;

// What is known of a pixel: its factor, and -1 where the filter decides.
fn shadowfit_stored_factor(pixel: vec2<f32>) -> f32 {
    let at = vec2<u32>(pixel);
    if all(at < textureDimensions(shadowfit_factors)) {
        return textureLoad(shadowfit_factors, at, 0).x;
    }
    return -1.0;
}

// Whether rays were traced for a pixel: the lowest bit of its factor tells. pixel: xy of the fragment's builtin position.
fn shadowfit_is_traced(pixel: vec2<f32>) -> bool {
    let factor = shadowfit_stored_factor(pixel);
    return factor >= 0.0 && (bitcast<u32>(factor) & 1u) == 1u;
}

// Whether a pixel is left to the filter. pixel: xy of the fragment's builtin position.
fn shadowfit_is_filtered(pixel: vec2<f32>) -> bool {
    return shadowfit_stored_factor(pixel) < 0.0;
}

// Share of the light that reaches a point that the depth buffer shows at a pixel: the exact factor, and the filter's
// where it was not. pixel: xy of the fragment's builtin position.
fn shadowfit_exact_factor(position: vec3<f32>, normal: vec3<f32>, pixel: vec2<f32>) -> f32 {
    let factor = shadowfit_stored_factor(pixel);
    if factor >= 0.0 {
        return factor;
    }
    return shadowfit_factor_at(position, normal, pixel);
}
