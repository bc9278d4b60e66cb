
// Returns the colour of a caster's fragment: the bits of its depth in four bytes, the lowest first. A byte k
// is written as k/255, which the target stores as k.
fn shadowfit_caster_color(depth: f32) -> vec4<f32> {
    let bits = bitcast<u32>(saturate(depth));
    let bytes = (vec4<u32>(bits) >> vec4<u32>(0u, 8u, 16u, 24u)) & vec4<u32>(255u);
    return vec4<f32>(bytes) / 255.0;
}
