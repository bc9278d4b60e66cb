// The probe pass: triangle and shadow factor of each pixel. Comes after scene.wgsl.

// Returns the triangle's number plus one, and the bits of the shadow factor. Takes derivatives, so call it in
// uniform control flow.
fn probed(in: SceneOut, triangle: u32) -> vec2<u32> {
    let geometric = geometric_normal(in.position, dpdx(in.position), dpdy(in.position));
    let factor = shadowfit_exact_factor(in.position, geometric, in.clip.xy);
    if is_cut_out(in.uv, in.color.a) {
        discard;
    }
    return vec2<u32>(triangle + 1u, bitcast<u32>(factor));
}
