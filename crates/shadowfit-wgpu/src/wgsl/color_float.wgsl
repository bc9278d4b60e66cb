
// Colour of a caster's fragment: its depth in the first channel. Depth clamp holds the depth buffer's depth within 0..1,
// but not the position's that a shader reads.
fn shadowfit_caster_color(depth: f32) -> vec4<f32> {
    return vec4<f32>(saturate(depth), 0.0, 0.0, 1.0);
}
