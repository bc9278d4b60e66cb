// Shadow factors after the edge pass, for the engine's main pass.

@group(GROUP) @binding(BINDING_0) var shadowfit_factors: texture_2d<f32>;

// Returns the stored factor of a pixel, or -1 where the filter decides.
fn shadowfit_stored_factor(pixel: vec2<f32>) -> f32 {
    let at = vec2<u32>(pixel);
    if all(at < textureDimensions(shadowfit_factors)) {
        return textureLoad(shadowfit_factors, at, 0).x;
    }
    return -1.0;
}

// Returns whether rays were traced for a pixel, from the lowest bit of its factor. pixel: xy of the
// fragment's builtin position.
fn shadowfit_is_traced(pixel: vec2<f32>) -> bool {
    let factor = shadowfit_stored_factor(pixel);
    return factor >= 0.0 && (bitcast<u32>(factor) & 1u) == 1u;
}

// Returns whether the filter decides a pixel. pixel: xy of the fragment's builtin position.
fn shadowfit_is_filtered(pixel: vec2<f32>) -> bool {
    return shadowfit_stored_factor(pixel) < 0.0;
}

// Returns the share of the light that reaches the visible point at a pixel: the exact factor, or the filter's
// factor where edges were not traced. pixel: xy of the fragment's builtin position.
fn shadowfit_exact_factor(position: vec3<f32>, normal: vec3<f32>, pixel: vec2<f32>) -> f32 {
    let factor = shadowfit_stored_factor(pixel);
    if factor >= 0.0 {
        return factor;
    }
    return shadowfit_factor_at(position, normal, pixel);
}
