
// Returns the colour of a caster's fragment: its depth in the first channel. Depth clamp limits the depth
// buffer's values to 0..1, but not z of the position that a shader reads.
fn shadowfit_caster_color(depth: f32) -> vec4<f32> {
    return vec4<f32>(saturate(depth), 0.0, 0.0, 1.0);
}
